/** The quantities that can be shown: at the moment, from the frames, or their peaks, from the envelopes. */

import type { Report } from "./data";
import { FIELDS } from "./frames";
import type { Field } from "./frames";
import { JOINT_KEYS, jointValue, largestCoefficient } from "./laws";
import type { JointKey } from "./laws";

export type Owner = "block" | "joint";

export interface Quantity {
    key: string;
    owner: Owner;
    /** At the moment, or the peak over all steps of the solver. */
    when: "moment" | "peak";
    label: string;
    unit: string;
}

const BLOCK_LABELS: Record<Field, [string, string]> = {
    displacement: ["displacement", "m"],
    velocity: ["velocity", "m/s"],
    acceleration: ["acceleration", "m/s²"],
};
const JOINT_LABELS: Record<JointKey, [string, string]> = {
    displacement: ["relative displacement", "m"],
    velocity: ["relative velocity", "m/s"],
    acceleration: ["relative acceleration", "m/s²"],
    elastic: ["elastic force", "N"],
    damping: ["damping force", "N"],
    friction: ["friction force", "N"],
};
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

export const QUANTITIES: Quantity[] = [
    ...FIELDS.map((key) => quantity(key, "block", "moment", ...BLOCK_LABELS[key])),
    ...JOINT_KEYS.map((key) => quantity(key, "joint", "moment", ...JOINT_LABELS[key])),
    ...FIELDS.map((key) => quantity(key, "block", "peak", ...BLOCK_LABELS[key])),
    ...JOINT_PEAKS.map(([key, label, unit]) => quantity(key, "joint", "peak", label, unit)),
];

function quantity(key: string, owner: Owner, when: Quantity["when"], label: string, unit: string): Quantity {
    return { key, owner, when, label, unit };
}

/** Label that says what the motion of a block is measured against, for places without a heading that does. */
export function fullLabel(q: Quantity): string {
    return q.owner === "block" ? `${q.label} relative to the base` : q.label;
}

export function quantitiesOf(owner: Owner, when: Quantity["when"]): Quantity[] {
    return QUANTITIES.filter((q) => q.owner === owner && q.when === when);
}

/** The envelope behind a peak quantity. */
export function envelope(report: Report, q: Quantity): Float64Array {
    return report.array(`envelope/${q.owner}/${q.key}`) as Float64Array;
}

/** What the whole wall does at one frame; reads a frame when it is first asked for. */
export class Moment {
    frame = 0;
    private readonly fields: Record<Field, Float64Array>;
    private readonly known: Record<Field, number> = { displacement: -1, velocity: -1, acceleration: -1 };

    constructor(readonly report: Report) {
        const empty = () => new Float64Array(report.frames.unknowns);
        this.fields = { displacement: empty(), velocity: empty(), acceleration: empty() };
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
        return this.joint(q.key as JointKey, keptForce(this.report, q))(index);
    }

    /** A quantity of any joint at this frame. */
    private joint(key: JointKey, kept: Float32Array | undefined): (index: number) => number {
        const { report, frame } = this;
        const motion = (field: Field, unknown: number) => (unknown < 0 ? 0 : this.field(field)[unknown]);
        return (index) => jointValue(report, index, key, motion, kept, frame * report.joints);
    }

    /** One quantity of all blocks or joints. */
    values(q: Quantity): Float64Array {
        if (q.when === "peak") {
            return envelope(this.report, q);
        }
        const { blocks, joints } = this.report;
        if (q.owner === "block") {
            return this.field(q.key as Field).subarray(0, blocks);
        }
        const value = this.joint(q.key as JointKey, keptForce(this.report, q));
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
    const kept = keptForce(report, q);
    return Float64Array.from({ length: report.frames.count }, (_, frame) => {
        const motion = (field: Field, unknown: number) => report.frames.value(field, frame, unknown);
        return jointValue(report, index, q.key as JointKey, motion, kept, frame * report.joints);
    });
}

/** Forces of all joints at all frames, where the page holds them: for laws that are no functions of the motion. */
function keptForce(report: Report, q: Quantity): Float32Array | undefined {
    const name = `frame/joint/${q.key}`;
    return report.has(name) ? (report.array(name) as Float32Array) : undefined;
}

/** Largest size that a quantity has in the whole run, from the envelopes. */
export function peak(report: Report, q: Quantity): number {
    if (q.owner === "joint" && q.when === "moment" && q.key !== "elastic") {
        const speed = envelope(report, { ...q, when: "peak", key: "velocity" });
        if (q.key === "damping") {
            return largest(speed.map((v, joint) => v * report.joint.damping[joint]));
        }
        if (q.key === "friction") {
            // Of devices with laws of their own, which count here, the frames alone say how much they bear.
            const bound = largest(speed.map((v, joint) => frictionBound(report, joint, v)));
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
