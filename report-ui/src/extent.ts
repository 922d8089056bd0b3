/** How far the blocks of a planar run go: what the view, the colour scales and the first frame follow. */

import type { Report } from "./data";

export interface Extent {
    /** Longest way of a corner of a block at a frame [m], and the frame: what comes after a collapse is left out. */
    way: number;
    frame: number;
    /** Largest rise or fall [m] and rotation, in rad, signs dropped. */
    vertical: number;
    rotation: number;
    /** How far corners go beyond the wall at rest [m]. */
    left: number;
    right: number;
    above: number;
    below: number;
}

const known = new WeakMap<Report, Extent>();

/** Of all frames of the page; found once. */
export function extent(report: Report): Extent {
    const found = known.get(report) ?? measure(report);
    known.set(report, found);
    return found;
}

function measure(report: Report): Extent {
    const { frames, blocks, outline } = report;
    const { x0, x1, y0, y1 } = report.block;
    const [u, v, turn] = [0, 1, 2].map(() => new Float64Array(frames.unknowns));
    const [left, right] = [x0.reduce((a, b) => Math.min(a, b)), x1.reduce((a, b) => Math.max(a, b))];
    const [bottom, top] = [y0.reduce((a, b) => Math.min(a, b)), y1.reduce((a, b) => Math.max(a, b))];
    const found: Extent = { way: 0, frame: 0, vertical: 0, rotation: 0, left: 0, right: 0, above: 0, below: 0 };
    for (let frame = 0; frame < frames.count; frame++) {
        frames.read("displacement", frame, u);
        frames.read("vertical", frame, v);
        frames.read("rotation", frame, turn);
        for (let i = 0; i < blocks; i++) {
            if (!Number.isFinite(u[i] + v[i] + turn[i])) {
                continue;
            }
            found.vertical = Math.max(found.vertical, Math.abs(v[i]));
            found.rotation = Math.max(found.rotation, Math.abs(turn[i]));
            const [sine, less] = turned(turn[i]);
            for (let k = outline.start[i]; k < outline.start[i + 1]; k++) {
                const [rx, ry] = [outline.x[k] - outline.centreX[i], outline.y[k] - outline.centreY[i]];
                const [dx, dy] = [u[i] + less * rx - sine * ry, v[i] + sine * rx + less * ry];
                const way = Math.hypot(dx, dy);
                if (way > found.way && frame < report.contents.frames.standing) {
                    [found.way, found.frame] = [way, frame];
                }
                found.left = Math.max(found.left, left - outline.x[k] - dx);
                found.right = Math.max(found.right, outline.x[k] + dx - right);
                found.above = Math.max(found.above, outline.y[k] + dy - top);
                found.below = Math.max(found.below, bottom - outline.y[k] - dy);
            }
        }
    }
    return found;
}

/** sin φ, and cos φ − 1 with all its digits. */
export function turned(rotation: number): [number, number] {
    return [Math.sin(rotation), -2 * Math.sin(0.5 * rotation) ** 2];
}
