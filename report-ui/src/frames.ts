/**
 * Displacements, velocities and accelerations of every unknown at the frames; of blocks that rise and turn also how far they
 * have risen [m] and their rotation in rad, counterclockwise.
 *
 * A joint moves by 10⁻⁷ m between blocks that move by 5·10⁻³ m, so that 32-bit floats would swallow it. All values of one
 * frame are whole multiples, of 40 bits, of one quantum: differences of two blocks are exact to a quantum, which is
 * 2⁻³⁸ of the largest value in the frame, wherever in the wall the two are. Any frame can be read without the others.
 */

import type { Report } from "./data";

export const FIELDS = ["displacement", "velocity", "acceleration"] as const;
/** What blocks do beside that in a planar run; 0 in others. */
export const TURNS = ["vertical", "rotation"] as const;
export type Field = (typeof FIELDS)[number] | (typeof TURNS)[number];

const HIGH = 2 ** 32;
/** The number that stands for a value that is not finite. */
const NOT_FINITE = -(2 ** 39);

interface Column {
    quantum: Float64Array;
    low: Uint32Array;
    high: Int8Array;
}

export class Frames {
    readonly time: Float64Array;
    readonly count: number;
    readonly unknowns: number;
    private readonly columns: Partial<Record<Field, Column>>;

    constructor(report: Report) {
        this.time = report.array("frame/time") as Float64Array;
        this.count = this.time.length;
        this.unknowns = report.blocks + (report.beam < 0 ? 0 : 1);
        const column = (field: Field): Column => ({
            quantum: report.array(`frame/${field}/quantum`) as Float64Array,
            low: report.array(`frame/${field}/low`) as Uint32Array,
            high: report.array(`frame/${field}/high`) as Int8Array,
        });
        const fields: readonly Field[] = report.contents.planar ? [...FIELDS, ...TURNS] : FIELDS;
        this.columns = Object.fromEntries(fields.map((field) => [field, column(field)]));
    }

    /** One value of one frame; 0 for the base, which is unknown −1. */
    value(field: Field, frame: number, unknown: number): number {
        const column = this.columns[field];
        if (unknown < 0 || column === undefined) {
            return 0;
        }
        const { quantum, low, high } = column;
        const at = frame * this.unknowns + unknown;
        const steps = high[at] * HIGH + low[at];
        return steps === NOT_FINITE ? NaN : steps * quantum[frame];
    }

    /** All values of one frame. */
    read(field: Field, frame: number, into: Float64Array): void {
        const column = this.columns[field];
        if (column === undefined) {
            into.fill(0);
            return;
        }
        const { quantum, low, high } = column;
        const [step, start] = [quantum[frame], frame * this.unknowns];
        for (let i = 0; i < this.unknowns; i++) {
            const steps = high[start + i] * HIGH + low[start + i];
            into[i] = steps === NOT_FINITE ? NaN : steps * step;
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
