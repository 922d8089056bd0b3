/**
 * Where the points of the wall are on the canvas. A point keeps its place in its block; its way from where it is at rest,
 * that of the rotation included, is enlarged as a whole, so that blocks that touch do so however much it is enlarged.
 */

import type { Report } from "../data";
import { turned } from "../extent";
import type { Store } from "../store";
import type { View } from "./view";

/** Part of its length by which the sides of a joint come apart before they are no neighbours any more. */
const PARTED = 0.5;

export class Places {
    /** Shift of the base [px]. */
    base = 0;
    private readonly shiftX: Float64Array;
    private readonly shiftY: Float64Array;
    /** What a rotation makes of an arm of one metre [px]: along it and across. */
    private readonly along: Float64Array;
    private readonly across: Float64Array;
    private readonly centreX: Float64Array;
    private readonly centreY: Float64Array;
    /** What a way of one metre makes on the canvas [px]. */
    private scale = 1;
    private readonly at: [number, number] = [0, 0];

    constructor(private readonly report: Report, private readonly view: View) {
        const columns = report.frames.unknowns;
        [this.shiftX, this.shiftY, this.along, this.across] = [0, 1, 2, 3].map(() => new Float64Array(columns));
        const { centreX, centreY } = report.outline;
        // A beam turns about the middle of its lower side.
        const beam = view.beam ?? [view.bounds.left, view.bounds.right];
        this.centreX = Float64Array.from({ length: columns }, (_, i) => centreX[i] ?? 0.5 * (beam[0] + beam[1]));
        this.centreY = Float64Array.from({ length: columns }, (_, i) => centreY[i] ?? view.bounds.top);
    }

    /** Brings it up to the moment. */
    update(store: Store, baseShift: number): void {
        const { report } = this;
        this.base = baseShift;
        this.shiftX.fill(baseShift);
        this.shiftY.fill(0);
        if (report.frames.count === 0) {
            return;
        }
        const factor = store.magnify * this.view.zoom;
        this.scale = factor;
        const finite = (value: number) => (Number.isFinite(value) ? value : 0);
        const z = store.moment.field("displacement");
        for (let i = 0; i < z.length; i++) {
            this.shiftX[i] += factor * finite(z[i]);
        }
        if (!report.contents.planar) {
            return;
        }
        const [rise, turn] = [store.moment.field("vertical"), store.moment.field("rotation")];
        for (let i = 0; i < z.length; i++) {
            const [sine, less] = turned(finite(turn[i]));
            this.shiftY[i] = factor * finite(rise[i]);
            [this.across[i], this.along[i]] = [factor * sine, factor * less];
        }
    }

    /** Whether a column has not turned. */
    isUpright(column: number): boolean {
        return this.across[column] === 0 && this.along[column] === 0;
    }

    /** Angle by which a column is seen turned on the canvas, clockwise, in rad. */
    angle(column: number): number {
        return -Math.atan2(this.across[column], this.view.zoom + this.along[column]);
    }

    /** Where the point of a column that is at (x, y) [m] at rest is [px]; the same array at every call. */
    point(column: number, x: number, y: number): [number, number] {
        const { at, view } = this;
        [at[0], at[1]] = [view.x(x), view.y(y)];
        if (column < 0) {
            at[0] += this.base;
            return at;
        }
        const [rx, ry] = [x - this.centreX[column], y - this.centreY[column]];
        at[0] += this.shiftX[column] + this.along[column] * rx - this.across[column] * ry;
        at[1] -= this.shiftY[column] + this.across[column] * rx + this.along[column] * ry;
        return at;
    }

    /** Corners of a block [px]. */
    corners(block: number): [number, number][] {
        const { start, x, y } = this.report.outline;
        const list: [number, number][] = [];
        for (let k = start[block]; k < start[block + 1]; k++) {
            const [cx, cy] = this.point(block, x[k], y[k]);
            list.push([cx, cy]);
        }
        return list;
    }

    /** Fills a block. */
    fill(context: CanvasRenderingContext2D, block: number): void {
        if (this.isRectangle(block)) {
            context.fillRect(...this.rectangle(block));
            return;
        }
        context.beginPath();
        this.trace(context, block);
        context.fill();
    }

    private isRectangle(block: number): boolean {
        return this.report.outline.rectangle[block] === 1 && this.isUpright(block);
    }

    /** Left, top, width, height of a block that is an upright rectangle [px]. */
    private rectangle(block: number): [number, number, number, number] {
        const { x0, x1, y0, y1 } = this.report.block;
        const [left, top] = this.point(block, x0[block], y1[block]);
        const { zoom } = this.view;
        return [left, top, (x1[block] - x0[block]) * zoom, (y1[block] - y0[block]) * zoom];
    }

    /** Adds the outline of a block to the path of a canvas. */
    trace(context: CanvasRenderingContext2D, block: number): void {
        if (this.isRectangle(block)) {
            context.rect(...this.rectangle(block));
            return;
        }
        const { start, x, y } = this.report.outline;
        for (let k = start[block]; k < start[block + 1]; k++) {
            const [cx, cy] = this.point(block, x[k], y[k]);
            if (k === start[block]) {
                context.moveTo(cx, cy);
            } else {
                context.lineTo(cx, cy);
            }
        }
        context.closePath();
    }

    /** Whether the sides of a joint are no neighbours any more: further apart at both its ends than half its length. */
    hasParted(joint: number): boolean {
        if (!this.report.contents.planar) {
            return false;
        }
        const { a, b, x0, y0, x1, y1, overlap } = this.report.joint;
        const limit = PARTED * overlap[joint] * this.scale;
        const apart = (x: number, y: number) => {
            const [ax, ay] = this.point(a[joint], x, y);
            const [bx, by] = this.point(b[joint], x, y);
            return Math.hypot(ax - bx, ay - by);
        };
        return Math.min(apart(x0[joint], y0[joint]), apart(x1[joint], y1[joint])) > limit;
    }

    /** Ends of a joint's line, which goes with the mean of its sides [px]. */
    line(joint: number): [number, number, number, number] {
        const { a, b, x0, y0, x1, y1 } = this.report.joint;
        const end = (x: number, y: number): [number, number] => {
            const [ax, ay] = this.point(a[joint], x, y);
            const [bx, by] = this.point(b[joint], x, y);
            return [0.5 * (ax + bx), 0.5 * (ay + by)];
        };
        return [...end(x0[joint], y0[joint]), ...end(x1[joint], y1[joint])];
    }
}
