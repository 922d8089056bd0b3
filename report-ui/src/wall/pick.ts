/** What lies under the pointer. */

import type { Report } from "../data";
import type { Item } from "../store";
import { distanceTo } from "./outline";
import type { Places } from "./places";
import type { View } from "./view";

/** The joint within `reach` pixels of a point, else the block around it. */
export function pick(view: View, report: Report, at: Places, x: number, y: number, reach: number): Item | null {
    const block = blockAt(report, at, x, y);
    // Inside a small block joints are only as near as a third of it, else the block could not be reached.
    const limit = block === null ? reach : Math.min(reach, nearLimit(view, report, block));
    let [nearest, found] = [limit, -1];
    for (let e = 0; e < report.joints; e++) {
        const distance = distanceTo(at.line(e), x, y);
        if (distance < nearest && !at.hasParted(e)) {
            [nearest, found] = [distance, e];
        }
    }
    if (found >= 0) {
        return { owner: "joint", index: found };
    }
    return block === null ? null : { owner: "block", index: block };
}

function nearLimit(view: View, report: Report, i: number): number {
    const { x0, x1, y0, y1 } = report.block;
    return 0.3 * view.zoom * Math.min(x1[i] - x0[i], y1[i] - y0[i]);
}

function blockAt(report: Report, at: Places, x: number, y: number): number | null {
    for (let i = report.blocks - 1; i >= 0; i--) {
        if (holds(at.corners(i), x, y)) {
            return i;
        }
    }
    return null;
}

/** Whether a point lies in a convex outline, its sides included. */
function holds(corners: [number, number][], x: number, y: number): boolean {
    let [left, right] = [false, false];
    corners.forEach(([x0, y0], k) => {
        const [x1, y1] = corners[(k + 1) % corners.length];
        const side = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0);
        left ||= side < 0;
        right ||= side > 0;
    });
    return !(left && right);
}
