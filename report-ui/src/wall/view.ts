/** Where the wall lies on the canvas, and how much its displacements are enlarged. */

import type { Report } from "../data";
import { extent } from "../extent";
import { envelope, largest, quantitiesOf } from "../quantities";

/** Part of the wall's larger side that the largest displacement takes on the canvas. */
const SHOWN = 0.05;
/** The same for the motion of the base. */
const BASE_SHOWN = 0.06;
/** Part of the wall's larger side that blocks may go beyond it before they leave the picture. */
const MOST_BEYOND = 0.6;
/** Largest enlargement of the wall over its whole. */
const MOST_ENLARGED = 40;

export interface Bounds {
    left: number;
    right: number;
    bottom: number;
    top: number;
}

export class View {
    readonly bounds: Bounds;
    /** Pixels per metre. */
    zoom = 1;
    /** Times that the wall is larger than when it fits. */
    enlarged = 1;
    /** Left and right end of the top beam, null without one. */
    readonly beam: [number, number] | null;
    /** Room for blocks that go beyond the wall: left, right, above, below [m]. */
    private readonly beyond: [number, number, number, number];
    private originX = 0;
    private originY = 0;
    /** Place of the wall's corner when it fits [px], and size of the canvas. */
    private home = { zoom: 1, x: 0, y: 0, width: 0, height: 0 };

    constructor(report: Report) {
        const { x0, x1, y0, y1 } = report.block;
        const ends = (values: Float64Array, better: (a: number, b: number) => number) => values.reduce((a, b) => better(a, b));
        this.bounds = { left: ends(x0, Math.min), right: ends(x1, Math.max), bottom: ends(y0, Math.min), top: ends(y1, Math.max) };
        const tops = report.contents.joint_kinds.flatMap((kind, e) => (kind === "top" ? [e] : []));
        const end = (line: Float64Array, better: (a: number, b: number) => number) => tops.map((e) => line[e]).reduce((a, b) => better(a, b));
        this.beyond = [0, 0, 0, 0];
        if (report.contents.planar && automaticScale(report, this) === 1) {
            const { left, right, above, below } = extent(report);
            const most = MOST_BEYOND * Math.max(this.width, this.height);
            this.beyond = [Math.min(left, most), Math.min(right, most), Math.min(above, most), Math.min(below, most)];
        }
        this.beam = tops.length === 0 ? null : [end(report.joint.x0, Math.min), end(report.joint.x1, Math.max)];
    }

    get width(): number {
        return this.bounds.right - this.bounds.left;
    }

    get height(): number {
        return this.bounds.top - this.bounds.bottom;
    }

    /** Fits the wall into a canvas of that width and at most that height; the height taken, all in pixels. */
    fit(width: number, most: number): number {
        const [above, below] = [this.beam === null ? 12 : 40, 20];
        const side = Math.max(16, width * 0.09);
        const room = Math.max(60, most - above - below);
        const [left, right, higher, lower] = this.beyond;
        const [wide, high] = [this.width + left + right, this.height + higher + lower];
        this.zoom = Math.min((width - 2 * side) / wide, room / high);
        const height = high * this.zoom + above + below;
        this.originX = 0.5 * (width - wide * this.zoom) + (left - this.bounds.left) * this.zoom;
        this.originY = above + (this.bounds.top + higher) * this.zoom;
        this.home = { zoom: this.zoom, x: this.originX, y: this.originY, width, height: Math.ceil(height) };
        this.enlarged = 1;
        return height;
    }

    /** Enlarges by a factor, the point of the canvas at (x, y) [px] stays; between the whole wall and `MOST_ENLARGED`. */
    enlarge(factor: number, x = 0.5 * this.home.width, y = 0.5 * this.home.height): void {
        const enlarged = Math.max(1, Math.min(MOST_ENLARGED, this.enlarged * factor));
        const by = enlarged / this.enlarged;
        this.enlarged = enlarged;
        this.zoom = this.home.zoom * enlarged;
        this.moveTo(x + (this.originX - x) * by, y + (this.originY - y) * by);
    }

    /** Shifts the wall on the canvas [px], as far as it fills it. */
    pan(dx: number, dy: number): void {
        this.moveTo(this.originX + dx, this.originY + dy);
    }

    /** No edge of the picture as it is when the wall fits comes into the canvas. */
    private moveTo(x: number, y: number): void {
        const { home, enlarged } = this;
        const within = (value: number, at: number, length: number) => Math.min(at * enlarged, Math.max(at * enlarged - length * (enlarged - 1), value));
        this.originX = within(x, home.x, home.width);
        this.originY = within(y, home.y, home.height);
    }

    x(x: number): number {
        return this.originX + x * this.zoom;
    }

    y(y: number): number {
        return this.originY - y * this.zoom;
    }
}

/**
 * The factor that makes the largest displacement of the run plain to see: 1, 2 or 5 times a power of ten. Blocks that rise and
 * turn are drawn as they are where that can be seen, and never smaller.
 */
export function automaticScale(report: Report, view: View): number {
    if (report.contents.planar) {
        return Math.max(1, rounded((SHOWN * Math.max(view.width, view.height)) / extent(report).way));
    }
    const displacement = quantitiesOf(report, "block", "peak").find((q) => q.key === "displacement");
    const ofBlocks = displacement === undefined ? 0 : largest(envelope(report, displacement).subarray(0, report.blocks));
    // A beam that slides far over the wall may go half a step out of the picture, but not leave it.
    const ofBeam = report.beam < 0 ? 0 : largest(report.frames.history("displacement", report.beam));
    const peak = Math.max(ofBlocks, ofBeam / 2);
    return rounded((SHOWN * Math.max(view.width, view.height)) / peak);
}

/** The factor for the motion of the base. */
export function baseScale(peak: number, view: View): number {
    return rounded((BASE_SHOWN * Math.max(view.width, view.height)) / peak);
}

/** The largest of 1, 2, 5 times a power of ten not above a factor. */
export function rounded(factor: number): number {
    if (!(factor > 0) || !Number.isFinite(factor)) {
        return 1;
    }
    const power = 10 ** Math.floor(Math.log10(factor) + 1e-9);
    return [5, 2, 1].map((m) => m * power).find((f) => f <= factor * (1 + 1e-9)) ?? power;
}
