/** What the page brings along, deflated: a table of contents in JSON and the numbers in one block of bytes behind it. */

import { decode } from "./base64";
import { inflate } from "./inflate";
import { readTable } from "./tables";
import type { Table } from "./tables";
import { Frames } from "./frames";

/** Friction of a joint, equation (6) of the theory. */
export interface FrictionLaw {
    law: string;
    static: number;
    dynamic: number;
    slip_velocity: number;
    beta: number;
    alpha: number;
}

/** What held a bonded joint [N] and what became of it: damage, 0 to 1, and energy [J] at the end, instants [s] or null. */
export interface Bond {
    strength: number;
    damage: number;
    spent: number;
    cracked: number | null;
    broken: number | null;
}

/** A history that the run kept at every sample. */
export interface Channel {
    name: string;
    unit: string;
    description: string;
}

/** Where an array of plain numbers lies in the bytes. */
interface Place {
    type: "f64" | "f32" | "i32";
    at: number;
    count: number;
}

/** The table of contents; docs/results.md describes what it points to. */
export interface Contents {
    layout: number;
    name: string;
    title: string;
    block_names: string[];
    joint_names: string[];
    joint_kinds: string[];
    joint_laws: string[];
    frictions: FrictionLaw[];
    /** By the index of the joint. */
    bonds: Record<string, Bond>;
    /** Whether blocks rise and turn, and frames hold what joints do. */
    planar: boolean;
    /** `moves`: it is the last column of the frames. */
    beam: { kind: "free" | "driven" | "tied" | "mass"; label: string; moves: boolean };
    /**
     * `standing`: how many of the page's frames show the wall up to its collapse, that instant included; `room`: for how many times
     * as many there would be some; `rounded`: by how much numbers of blocks and of joints are rounded at most, over their
     * largest, null where they are not.
     */
    frames: { recorded: number; every: number; standing: number; room: number; rounded: [number, number] | null };
    curve: { samples: number; points: number; interval: number; left_out: number };
    /** Channels that are drawn over each other, where their curves are thinned. */
    loops: string[];
    channels: Channel[];
    spectrum: { damping: number; interval: number } | null;
    arrays: Record<string, Place | Table>;
}

export type Numbers = Float64Array | Float32Array | Int32Array;

const TYPES = { f64: Float64Array, f32: Float32Array, i32: Int32Array };

/** Layout of the data that this program reads. */
export const LAYOUT = 5;

/** The data of a report. Blocks, joints and unknowns are called by their indices. */
export class Report {
    readonly blocks: number;
    readonly joints: number;
    /** Edges [m] and mass [kg] of the blocks, thickness of the mortar below and beside them [m]. */
    readonly block: {
        x0: Float64Array;
        x1: Float64Array;
        y0: Float64Array;
        y1: Float64Array;
        mass: Float64Array;
        bed: Float64Array;
        head: Float64Array;
    };
    /**
     * Outlines of the blocks at rest [m]: the corners of block i, counterclockwise, are those from `start[i]` to
     * `start[i + 1]`, and it turns about its centre. `rectangle[i]` is 1 where it is an upright rectangle: a canvas draws those
     * several times faster than outlines.
     */
    readonly outline: {
        start: Int32Array;
        x: Float64Array;
        y: Float64Array;
        centreX: Float64Array;
        centreY: Float64Array;
        rectangle: Uint8Array;
    };
    /** Sides as columns of the frames (−1: the base), contact lines [m], laws in SI. */
    readonly joint: {
        a: Int32Array;
        b: Int32Array;
        x0: Float64Array;
        y0: Float64Array;
        x1: Float64Array;
        y1: Float64Array;
        overlap: Float64Array;
        stiffness: Float64Array;
        damping: Float64Array;
        normal: Float64Array;
        /** Index into `contents.frictions`, −1 for none. */
        friction: Int32Array;
        /** Compression only. */
        unilateral: boolean[];
        /** Head joints and connections: their relative displacement is a gap. */
        upright: boolean[];
    };
    /** Column of the top beam in the frames, −1 without a beam. */
    readonly beam: number;
    readonly frames: Frames;
    /** Places of the bonded joints in the frames' list of bonds, −1 for a joint that is not bonded. */
    readonly bond: Int32Array;
    private readonly known = new Map<string, Numbers>();

    /** `from`: where the numbers begin in the bytes, a multiple of 8. */
    constructor(readonly contents: Contents, private readonly bytes: ArrayBuffer, private readonly from = 0) {
        if (contents.layout !== LAYOUT) {
            throw new Error(`the data have layout ${contents.layout}, this page reads ${LAYOUT}`);
        }
        this.blocks = contents.block_names.length;
        this.joints = contents.joint_names.length;
        const real = (name: string) => this.array(name) as Float64Array;
        const whole = (name: string) => this.array(name) as Int32Array;
        this.block = {
            x0: real("block/x0"),
            x1: real("block/x1"),
            y0: real("block/y0"),
            y1: real("block/y1"),
            mass: real("block/mass"),
            bed: real("block/bed"),
            head: real("block/head"),
        };
        this.outline = this.has("outline/start") ? this.polygons() : rectangles(this.block);
        this.beam = contents.beam.moves ? this.blocks : -1;
        this.joint = {
            a: whole("joint/a"),
            b: whole("joint/b").map((side) => (side === -2 ? this.beam : side)),
            x0: real("joint/x0"),
            y0: real("joint/y0"),
            x1: real("joint/x1"),
            y1: real("joint/y1"),
            overlap: real("joint/overlap"),
            stiffness: real("joint/stiffness"),
            damping: real("joint/damping"),
            normal: real("joint/normal_force_a"),
            friction: whole("joint/friction"),
            unilateral: contents.joint_laws.map((law, k) => isUpright(contents.joint_kinds[k]) && ["no-tension", "rigid"].includes(law)),
            upright: contents.joint_kinds.map(isUpright),
        };
        this.bond = new Int32Array(this.joints).fill(-1);
        const bonded = Object.keys(contents.bonds).map(Number).sort((a, b) => a - b);
        bonded.forEach((joint, k) => (this.bond[joint] = k));
        this.frames = new Frames(this);
    }

    /** Whether joints are bonded. */
    get bonded(): boolean {
        return Object.keys(this.contents.bonds).length > 0;
    }

    /** Outlines as the page brings them, where a block is no upright rectangle. */
    private polygons(): Report["outline"] {
        const { x0, x1, y0, y1 } = this.block;
        const start = this.array("outline/start") as Int32Array;
        const [x, y, centreX, centreY] = ["x", "y", "centre_x", "centre_y"].map((name) => this.array(`outline/${name}`) as Float64Array);
        const isCorner = (i: number, k: number) => (x[k] === x0[i] || x[k] === x1[i]) && (y[k] === y0[i] || y[k] === y1[i]);
        const isRectangle = (i: number) => {
            const corners = Array.from({ length: start[i + 1] - start[i] }, (_, k) => start[i] + k);
            return corners.length === 4 && corners.every((k) => isCorner(i, k));
        };
        return { start, x, y, centreX, centreY, rectangle: Uint8Array.from(x0.keys(), (i) => (isRectangle(i) ? 1 : 0)) };
    }

    has(name: string): boolean {
        return name in this.contents.arrays;
    }

    /** An array by its name. */
    array(name: string): Numbers {
        const known = this.known.get(name);
        if (known !== undefined) {
            return known;
        }
        const place = this.contents.arrays[name];
        if (place === undefined) {
            throw new Error(`the data of the report lack ${name}`);
        }
        const array = "planes" in place
            ? readTable(place, new Uint8Array(this.bytes, this.from + place.at), () => this.array(`${name}/exponent`) as Int32Array)
            : new TYPES[place.type](this.bytes, this.from + place.at, place.count);
        this.known.set(name, array);
        return array;
    }

    /** Column of a channel, −1 when the run kept none of that name. */
    channel(name: string): number {
        return this.contents.channels.findIndex((channel) => channel.name === name);
    }

    /** A channel's curve over `curve/time`. */
    curve(channel: number): Float32Array {
        return row(this.array("curve/values") as Float32Array, channel, this.contents.curve.points);
    }

    /** Times [s] and values of channels that belong to each other sample by sample; none where the run kept one of them not. */
    together(names: string[]): { time: Float64Array; values: Float32Array[] } | null {
        const channels = names.map((name) => this.channel(name));
        if (channels.includes(-1)) {
            return null;
        }
        if (!this.has("loop/values")) {
            return { time: this.array("curve/time") as Float64Array, values: channels.map((channel) => this.curve(channel)) };
        }
        const time = this.array("loop/time") as Float64Array;
        const all = this.array("loop/values") as Float32Array;
        return { time, values: names.map((name) => row(all, this.contents.loops.indexOf(name), time.length)) };
    }

    /** A channel's values at the frames. */
    atFrames(channel: number): Float64Array {
        const count = this.frames.count;
        return (this.array("channel/frames") as Float64Array).subarray(channel * count, (channel + 1) * count);
    }
}

function row(values: Float32Array, index: number, length: number): Float32Array {
    return values.subarray(index * length, (index + 1) * length);
}

/** Reads the data out of the page. */
export async function readPage(page: Document): Promise<Report> {
    const text = page.getElementById("concio-data")?.textContent ?? "";
    return open(await inflate(decode(text.trim())));
}

/** The data out of inflated bytes: the length of the table of contents, the table, the numbers from a multiple of 8 on. */
export function open(bytes: ArrayBuffer): Report {
    const length = Number(new DataView(bytes).getBigUint64(0, true));
    const contents = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 8, length))) as Contents;
    return new Report(contents, bytes, 8 + 8 * Math.ceil(length / 8));
}

/** Outlines of upright rectangles. */
function rectangles({ x0, x1, y0, y1 }: Report["block"]): Report["outline"] {
    const corners = (of: (i: number) => number[]) => Float64Array.from([...x0.keys()].flatMap(of));
    return {
        start: Int32Array.from({ length: x0.length + 1 }, (_, i) => 4 * i),
        x: corners((i) => [x0[i], x1[i], x1[i], x0[i]]),
        y: corners((i) => [y0[i], y0[i], y1[i], y1[i]]),
        centreX: x0.map((left, i) => 0.5 * (left + x1[i])),
        centreY: y0.map((low, i) => 0.5 * (low + y1[i])),
        rectangle: new Uint8Array(x0.length).fill(1),
    };
}

function isUpright(kind: string): boolean {
    return kind === "head" || kind === "connection";
}
