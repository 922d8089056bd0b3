/** What is selected when the page opens. */

import { envelope, quantitiesOf } from "./quantities";
import type { Owner } from "./quantities";
import type { Report } from "./data";
import type { Item } from "./store";

/** Part of a brick's side that a joint has to touch: slivers, where a cut brick ends over a joint, tell little. */
const LEAST_CONTACT = 0.1;

/** The block displaced most and the joint that did most: slipped, else opened, else dissipated; opened first where blocks rock. */
export function firstItems(report: Report): Item[] {
    const joints = Array.from({ length: report.joints }, (_, e) => e).filter((e) => !isSliver(report, e));
    const blocks = Array.from({ length: report.blocks }, (_, i) => i);
    const first = report.contents.planar ? ["opening", "slip"] : ["slip", "opening"];
    const found = [worst(report, "block", blocks, ["displacement"]), worst(report, "joint", joints, [...first, "dissipation", "displacement"])];
    return found.filter((item) => item !== null);
}

/** The one of `among` with the largest peak of the first of these quantities that is not zero in all of them. */
function worst(report: Report, owner: Owner, among: number[], keys: string[]): Item | null {
    for (const key of keys) {
        const quantity = quantitiesOf(report, owner, "peak").find((q) => q.key === key);
        if (quantity === undefined || among.length === 0) {
            continue;
        }
        const values = envelope(report, quantity);
        const index = among.reduce((best, k) => (values[k] > values[best] ? k : best));
        if (values[index] > 0) {
            return { owner, index };
        }
    }
    return null;
}

/** Whether a joint touches less than a tenth of the larger brick beside it: of its height for upright joints. */
function isSliver(report: Report, e: number): boolean {
    const { a, b, upright, overlap } = report.joint;
    const { x0, x1, y0, y1 } = report.block;
    const sides = [a[e], b[e]].filter((side) => side >= 0 && side < report.blocks);
    const lengths = sides.map((i) => (upright[e] ? y1[i] - y0[i] : x1[i] - x0[i]));
    return overlap[e] < LEAST_CONTACT * Math.max(...lengths, 0);
}
