/** What outlines of blocks at rest bring with them: the contour of the wall, the mortar around polygons, room for names. */

import type { Report } from "../data";

export type Point = [number, number];

/** A convex outline with its sides moved outwards. */
export function grown(corners: Point[], by: number): Point[] {
    const n = corners.length;
    const area = corners.reduce((sum, [x, y], k) => sum + x * corners[(k + 1) % n][1] - y * corners[(k + 1) % n][0], 0);
    const sign = area < 0 ? -1 : 1;
    const normal = (k: number): Point => {
        const [[x0, y0], [x1, y1]] = [corners[(k + n) % n], corners[(k + 1) % n]];
        const length = Math.hypot(x1 - x0, y1 - y0) || 1;
        return [(sign * (y1 - y0)) / length, (sign * (x0 - x1)) / length];
    };
    return corners.map(([x, y], k) => {
        const [[ax, ay], [bx, by_]] = [normal(k - 1), normal(k)];
        // Acute corners would run far out.
        const factor = by / Math.max(0.3, 1 + ax * bx + ay * by_);
        return [x + factor * (ax + bx), y + factor * (ay + by_)];
    });
}

/** Corners of a block at rest [m]. */
export function atRest(report: Report, block: number): Point[] {
    const { start, x, y } = report.outline;
    return Array.from({ length: start[block + 1] - start[block] }, (_, k) => [x[start[block] + k], y[start[block] + k]]);
}

export interface Rest {
    /** The wall's outline: ends of straight lines [m]. */
    contour: [Point, Point][];
    /** Outlines of polygons with half a joint around them [m]; none of rectangles. */
    mortar: (Point[] | null)[];
    /** Width and height of what a name may take of a block, around its centre [m]. */
    room: Point[];
}

const known = new WeakMap<Report, Rest>();

/** Found once. */
export function rest(report: Report): Rest {
    const found = known.get(report) ?? find(report);
    known.set(report, found);
    return found;
}

function find(report: Report): Rest {
    const { x0, x1, y0, y1, bed, head } = report.block;
    const { rectangle } = report.outline;
    const [left, right] = [x0.reduce((a, b) => Math.min(a, b)), x1.reduce((a, b) => Math.max(a, b))];
    const [bottom, top] = [y0.reduce((a, b) => Math.min(a, b)), y1.reduce((a, b) => Math.max(a, b))];
    const within = ([x, y]: Point): Point => [Math.max(left, Math.min(right, x)), Math.max(bottom, Math.min(top, y))];
    const blocks = Array.from(x0.keys());
    const half = (i: number) => 0.5 * Math.max(bed[i], head[i]);
    return {
        contour: rectangle.every((r) => r === 1) ? sides([[left, bottom], [right, bottom], [right, top], [left, top]]) : free(report, half),
        mortar: blocks.map((i) => (rectangle[i] === 1 ? null : grown(atRest(report, i), half(i)).map(within))),
        room: blocks.map((i) => (rectangle[i] === 1 ? [x1[i] - x0[i], y1[i] - y0[i]] : roomIn(atRest(report, i), report.outline.centreX[i], report.outline.centreY[i]))),
    };
}

function sides(corners: Point[]): [Point, Point][] {
    return corners.map((corner, k) => [corner, corners[(k + 1) % corners.length]]);
}

/** Sides of blocks in whose middle no joint is. */
function free(report: Report, half: (block: number) => number): [Point, Point][] {
    const { a, b, x0, y0, x1, y1 } = report.joint;
    const joints: number[][] = Array.from({ length: report.blocks }, () => []);
    for (let e = 0; e < report.joints; e++) {
        [a[e], b[e]].filter((block) => block >= 0 && block < report.blocks).forEach((block) => joints[block].push(e));
    }
    return joints.flatMap((own, i) =>
        sides(atRest(report, i)).filter(([[px, py], [qx, qy]]) => {
            const slack = 1.5 * half(i) + 0.01 * Math.hypot(qx - px, qy - py);
            const [x, y] = [0.5 * (px + qx), 0.5 * (py + qy)];
            return own.every((e) => distanceTo([x0[e], y0[e], x1[e], y1[e]], x, y) > slack);
        }),
    );
}

/** A rectangle around the centre, half as high as the polygon is there. */
function roomIn(corners: Point[], x: number, y: number): Point {
    const [low, high] = chord(corners, 0, x);
    const across = [-0.25, 0, 0.25].map((part) => {
        const [left, right] = chord(corners, 1, y + part * (high - low));
        return 2 * Math.min(x - left, right - x);
    });
    return [Math.max(0, Math.min(...across)), 0.5 * (high - low)];
}

/** Where the line on which a coordinate is `at` runs through a convex outline: from and to in the other coordinate. */
function chord(corners: Point[], axis: 0 | 1, at: number): [number, number] {
    const other = axis === 0 ? 1 : 0;
    const crossed = sides(corners).filter(([p, q]) => p[axis] <= at !== q[axis] <= at).map(([p, q]) => {
        return p[other] + ((at - p[axis]) / (q[axis] - p[axis])) * (q[other] - p[other]);
    });
    return crossed.length === 0 ? [at, at] : [Math.min(...crossed), Math.max(...crossed)];
}

/** Distance of a point from a straight line between two ends. */
export function distanceTo([x0, y0, x1, y1]: [number, number, number, number], x: number, y: number): number {
    const [dx, dy] = [x1 - x0, y1 - y0];
    const length = dx * dx + dy * dy;
    const t = length === 0 ? 0 : Math.max(0, Math.min(1, ((x - x0) * dx + (y - y0) * dy) / length));
    return Math.hypot(x - x0 - t * dx, y - y0 - t * dy);
}
