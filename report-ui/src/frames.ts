/**
 * Displacements, velocities and accelerations of every unknown at the frames; of blocks that rise and turn also how far they
 * have risen [m] and their rotation in rad, counterclockwise. A joint moves by 10⁻⁷ m between blocks that move by 5·10⁻³ m: 32-bit
 * floats would swallow it.
 */

import type { Report } from "./data";

export const FIELDS = ["displacement", "velocity", "acceleration"] as const;
/** What blocks do beside that in a planar run; 0 in others. */
export const TURNS = ["vertical", "rotation"] as const;
export type Field = (typeof FIELDS)[number] | (typeof TURNS)[number];

export class Frames {
    readonly time: Float64Array;
    readonly count: number;
    readonly unknowns: number;
    /** Frame by frame. */
    private readonly values: Partial<Record<Field, Float64Array>>;

    constructor(report: Report) {
        this.time = report.array("frame/time") as Float64Array;
        this.count = this.time.length;
        this.unknowns = report.blocks + (report.beam < 0 ? 0 : 1);
        const fields: readonly Field[] = report.contents.planar ? [...FIELDS, ...TURNS] : FIELDS;
        this.values = Object.fromEntries(fields.map((field) => [field, report.array(`frame/${field}`) as Float64Array]));
    }

    /** One value of one frame; 0 for the base, which is unknown −1. */
    value(field: Field, frame: number, unknown: number): number {
        const values = this.values[field];
        return unknown < 0 || values === undefined ? 0 : values[frame * this.unknowns + unknown];
    }

    /** All values of one frame. */
    read(field: Field, frame: number, into: Float64Array): void {
        const values = this.values[field];
        if (values === undefined) {
            into.fill(0);
        } else {
            into.set(values.subarray(frame * this.unknowns, (frame + 1) * this.unknowns));
        }
    }

    /** Values of one unknown at all frames. */
    history(field: Field, unknown: number): Float64Array {
        return Float64Array.from({ length: this.count }, (_, frame) => this.value(field, frame, unknown));
    }

    /** The frame nearest to a time. */
    nearest(time: number): number {
        let [low, high] = [0, this.count - 1];
        while (high - low > 1) {
            const middle = (low + high) >> 1;
            if (this.time[middle] <= time) {
                low = middle;
            } else {
                high = middle;
            }
        }
        return Math.abs(this.time[high] - time) < Math.abs(time - this.time[low]) ? high : low;
    }
}
