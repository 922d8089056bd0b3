/** The quantities that can be shown: at the moment, from the frames, or their peaks, from the envelopes. */

import type { Report } from "./data";
import { FIELDS, TURNS } from "./frames";
import type { Field } from "./frames";
import { extent } from "./extent";
import { JOINT_KEYS, jointValue, largestCoefficient, TOUCH_KEYS } from "./laws";
import type { JointKey } from "./laws";

export type Owner = "block" | "joint";

export interface Quantity {
    key: string;
    owner: Owner;
    /** At the moment, or the peak over all steps of the solver. */
    when: "moment" | "peak";
    label: string;
    unit: string;
    /** The runs that have it: those whose blocks move horizontally alone, or those whose blocks rise and turn. */
    model: "shear" | "planar";
}

const BLOCK_LABELS: Record<(typeof FIELDS)[number], [string, string]> = {
    displacement: ["displacement", "m"],
    velocity: ["velocity", "m/s"],
    acceleration: ["acceleration", "m/s²"],
};
const TURN_LABELS: Record<(typeof TURNS)[number], [string, string]> = {
    vertical: ["vertical displacement", "m"],
    rotation: ["rotation", "rad"],
};
const TOUCH_LABELS: Record<(typeof TOUCH_KEYS)[number], [string, string]> = {
    slip: ["slip", "m"],
    opening: ["opening", "m"],
    pressure: ["normal force", "N"],
    friction: ["tangential force", "N"],
};
const JOINT_LABELS: Record<(typeof JOINT_KEYS)[number], [string, string]> = {
    displacement: ["relative displacement", "m"],
    velocity: ["relative velocity", "m/s"],
    acceleration: ["relative acceleration", "m/s²"],
    elastic: ["elastic force", "N"],
    damping: ["damping force", "N"],
    friction: ["friction force", "N"],
};
/** What has become of the bonds of joints, in runs of both kinds: at the moment, and at the end, where it is largest. */
const DAMAGE = "damage";
/** Envelopes of joints, by their names in result files. */
const JOINT_PEAKS: [string, string, string][] = [
    ["displacement", "relative displacement", "m"],
    ["velocity", "relative velocity", "m/s"],
    ["acceleration", "relative acceleration", "m/s²"],
    ["force", "elastic force", "N"],
    ["slip", "way slipped", "m"],
    ["opening", "opening", "m"],
    ["closing", "closing", "m"],
    ["dissipation", "energy dissipated", "J"],
];

/** Envelopes that are called otherwise where blocks rise and turn. */
const PLANAR_PEAKS: Record<string, string> = { force: "force" };

export const QUANTITIES: Quantity[] = [
    ...FIELDS.map((key) => quantity("shear", key, "block", "moment", ...BLOCK_LABELS[key])),
    ...JOINT_KEYS.map((key) => quantity("shear", key, "joint", "moment", ...JOINT_LABELS[key])),
    ...FIELDS.map((key) => quantity("shear", key, "block", "peak", ...BLOCK_LABELS[key])),
    ...JOINT_PEAKS.map(([key, label, unit]) => quantity("shear", key, "joint", "peak", label, unit)),
    ...FIELDS.map((key) => quantity("planar", key, "block", "moment", `horizontal ${BLOCK_LABELS[key][0]}`, BLOCK_LABELS[key][1])),
    ...TURNS.map((key) => quantity("planar", key, "block", "moment", ...TURN_LABELS[key])),
    ...TOUCH_KEYS.map((key) => quantity("planar", key, "joint", "moment", ...TOUCH_LABELS[key])),
    ...FIELDS.map((key) => quantity("planar", key, "block", "peak", ...BLOCK_LABELS[key])),
    ...JOINT_PEAKS.map(([key, label, unit]) => quantity("planar", key, "joint", "peak", PLANAR_PEAKS[key] ?? label, unit)),
    ...(["shear", "planar"] as const).flatMap((model) =>
        (["moment", "peak"] as const).map((when) => quantity(model, DAMAGE, "joint", when, "damage of the bond", "1"))),
];

/** Whether a quantity is what has become of bonds, from 0, intact, to 1, broken. */
export function isDamage(q: Quantity): boolean {
    return q.key === DAMAGE;
}

function quantity(model: Quantity["model"], key: string, owner: Owner, when: Quantity["when"], label: string, unit: string): Quantity {
    return { key, owner, when, label, unit, model };
}

/** Label that says what the motion of a block is measured against, for places without a heading that does. */
export function fullLabel(q: Quantity): string {
    return q.owner === "block" ? `${q.label} relative to the base` : q.label;
}

export function quantitiesOf(report: Report, owner: Owner, when: Quantity["when"]): Quantity[] {
    const model = report.contents.planar ? "planar" : "shear";
    return QUANTITIES.filter((q) => q.model === model && q.owner === owner && q.when === when && (!isDamage(q) || report.bonded));
}

/** The envelope that is the peak of a quantity at the moment, by its key; null for those that have none. */
export function peakKey(q: Quantity): string | null {
    if (q.owner === "block") {
        return q.key;
    }
    // The force in the envelopes of a planar run is the one across upright joints and the one along the others.
    const none = q.model === "planar" && q.key !== "opening" && !isDamage(q);
    return none ? null : q.key === "elastic" ? "force" : q.key;
}

/** Peaks of all blocks or joints: a number of the page that is rounded or not. */
export type Values = Float64Array | Float32Array;

/** The envelope behind a peak quantity; of damage what there is at the end, not a number where nothing is bonded. */
export function envelope(report: Report, q: Quantity): Values {
    if (isDamage(q)) {
        return Float64Array.from({ length: report.joints }, (_, joint) => report.contents.bonds[String(joint)]?.damage ?? NaN);
    }
    return report.array(`envelope/${q.owner}/${q.key}`) as Values;
}

/** Damage of the bond of a joint at a frame; not a number where it is not bonded. */
function damage(report: Report, frame: number, joint: number): number {
    const bond = report.bond[joint];
    const bonds = Object.keys(report.contents.bonds).length;
    return bond < 0 ? NaN : (report.array("frame/bond/damage") as Float64Array)[frame * bonds + bond];
}

/** What the whole wall does at one frame; reads a frame when it is first asked for. */
export class Moment {
    frame = 0;
    private readonly fields: Record<Field, Float64Array>;
    private readonly known: Record<Field, number> = { displacement: -1, velocity: -1, acceleration: -1, vertical: -1, rotation: -1 };

    constructor(readonly report: Report) {
        const empty = () => new Float64Array(report.frames.unknowns);
        this.fields = { displacement: empty(), velocity: empty(), acceleration: empty(), vertical: empty(), rotation: empty() };
    }

    /** Values of all unknowns: blocks, then the beam. */
    field(field: Field): Float64Array {
        if (this.known[field] !== this.frame) {
            this.report.frames.read(field, this.frame, this.fields[field]);
            this.known[field] = this.frame;
        }
        return this.fields[field];
    }

    /** One quantity of one block or joint. */
    value(q: Quantity, index: number): number {
        if (q.when === "peak") {
            return envelope(this.report, q)[index];
        }
        if (this.report.frames.count === 0) {
            return NaN;
        }
        if (q.owner === "block") {
            return this.field(q.key as Field)[index];
        }
        return this.joint(q)(index);
    }

    /** A quantity of any joint at this frame. */
    private joint(q: Quantity): (index: number) => number {
        const { report, frame } = this;
        if (isDamage(q)) {
            return (index) => damage(report, frame, index);
        }
        const [key, kept] = [q.key as JointKey, keptForce(report, q)];
        const motion = (field: Field, unknown: number) => (unknown < 0 ? 0 : this.field(field)[unknown]);
        return (index) => jointValue(report, index, key, motion, kept, frame * report.joints);
    }

    /** One quantity of all blocks or joints. */
    values(q: Quantity): Values {
        if (q.when === "peak") {
            return envelope(this.report, q);
        }
        const { blocks, joints } = this.report;
        if (q.owner === "block") {
            return this.field(q.key as Field).subarray(0, blocks);
        }
        const value = this.joint(q);
        const values = new Float64Array(joints);
        for (let e = 0; e < joints; e++) {
            values[e] = value(e);
        }
        return values;
    }
}

/** The history of a moment quantity over the frames. */
export function history(report: Report, q: Quantity, index: number): Float64Array {
    if (q.owner === "block") {
        return report.frames.history(q.key as Field, index);
    }
    if (isDamage(q)) {
        return Float64Array.from({ length: report.frames.count }, (_, frame) => damage(report, frame, index));
    }
    const kept = keptForce(report, q);
    return Float64Array.from({ length: report.frames.count }, (_, frame) => {
        const motion = (field: Field, unknown: number) => report.frames.value(field, frame, unknown);
        return jointValue(report, index, q.key as JointKey, motion, kept, frame * report.joints);
    });
}

/** Forces of all joints at all frames, where the page holds them: for laws that are no functions of the motion. */
function keptForce(report: Report, q: Quantity): Values | undefined {
    const name = `frame/joint/${q.key}`;
    return report.has(name) ? (report.array(name) as Values) : undefined;
}

/** Largest size that a quantity has in the whole run, from the envelopes, or where there is none from the frames. */
export function peak(report: Report, q: Quantity): number {
    if (isDamage(q)) {
        return largest(envelope(report, q));
    }
    if (report.contents.planar && q.when === "moment") {
        if (q.key === "vertical" || q.key === "rotation") {
            return extent(report)[q.key];
        }
        if (q.owner === "joint") {
            const atFrames = largest(keptForce(report, q) ?? []);
            return q.key === "opening" ? Math.max(atFrames, largest(envelope(report, q))) : atFrames;
        }
    }
    if (q.owner === "joint" && q.when === "moment" && q.key !== "elastic") {
        const speed = envelope(report, { ...q, when: "peak", key: "velocity" });
        if (q.key === "damping") {
            return largest(Array.from(speed, (v, joint) => v * report.joint.damping[joint]));
        }
        if (q.key === "friction") {
            // Of devices with laws of their own, which count here, the frames alone say how much they bear.
            const bound = largest(Array.from(speed, (v, joint) => frictionBound(report, joint, v)));
            return Math.max(bound, largest(keptForce(report, q) ?? []));
        }
    }
    const values = envelope(report, q.key === "elastic" ? { ...q, key: "force" } : q);
    return largest(q.owner === "block" ? values.subarray(0, report.blocks) : values);
}

function frictionBound(report: Report, joint: number, speed: number): number {
    const law = report.joint.friction[joint];
    return law < 0 ? 0 : report.joint.normal[joint] * largestCoefficient(report.contents.frictions[law], speed);
}

/** The largest of the sizes that are finite; 0 when there are none. */
export function largest(values: ArrayLike<number>): number {
    let found = 0;
    for (let k = 0; k < values.length; k++) {
        const size = Math.abs(values[k]);
        if (size > found && size < Infinity) {
            found = size;
        }
    }
    return found;
}
