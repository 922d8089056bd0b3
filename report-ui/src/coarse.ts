/** What frames cannot show, and what to write into the wall file to see it. */

import type { Report } from "./data";
import { si } from "./format";

/** A note under plots that join frames by straight lines. */
export function coarseness(report: Report): string {
    const { time, count } = report.frames;
    if (count < 2) {
        return "";
    }
    const interval = time[1] - time[0];
    const drawn = `Drawn from frames ${si(interval, "s", 3)} apart, joined by straight lines: what happens between two frames is not shown, `
        + "and corners of the lines are no sign of stick-slip.";
    const finer = roundUp(interval / Math.min(10, Math.max(1, report.contents.frames.room)));
    if (finer > 0.6 * interval) {
        return `${drawn} The page holds no more frames of this run; [output] blocks = ["name"] and joints = ["name"] keep `
            + "histories at every sample in result.h5.";
    }
    const length = `"${Number((finer * 1000).toPrecision(6))} ms"`;
    const sampled = report.contents.curve.interval > finer * (1 + 1e-9) ? `interval = ${length} and ` : "";
    return `${drawn} Smooth curves: under [output] of the wall file set ${sampled}frames = ${length}.`;
}

/** The smallest of 1, 2, 5 times a power of ten not below a length of time. */
function roundUp(value: number): number {
    const power = 10 ** Math.floor(Math.log10(value) + 1e-9);
    return ([1, 2, 5].find((m) => m * power >= value * (1 - 1e-9)) ?? 10) * power;
}
