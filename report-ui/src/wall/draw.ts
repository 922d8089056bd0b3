/** The wall at the moment: base, blocks, joints, beam, marks of what is selected and pointed at. */

import { isDark, step, STEPS } from "../colour";
import type { Scale } from "../colour";
import type { Report } from "../data";
import type { Item, Store } from "../store";
import { palette } from "../theme";
import { grown, rest } from "./outline";
import type { Point } from "./outline";
import type { Places } from "./places";
import type { View } from "./view";

/** Letters on bricks and on the beam, which are light whatever the page is. */
const INK = "#222";
/** Lower and upper side of the beam above the wall [px]. */
const BEAM = [5, 25];
const FONT = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";

/** Width of the joint that does most, over the width of one that does nothing. */
const THICKEST = 3.3;
/** Blocks up to which each bears its name. */
const MOST_NAMED = 250;

/** Draws everything. */
export function draw(context: CanvasRenderingContext2D, size: [number, number], view: View, store: Store, at: Places): Scale {
    const values = store.moment.values(store.paint);
    const colours = store.scale(values);
    context.clearRect(0, 0, ...size);
    const { report } = store;
    ghost(context, view, report, at.base);
    base(context, view, at.base);
    mortar(context, view, report, at);
    if (store.paint.owner === "block") {
        blocks(context, view, report, at, (i) => step(colours, values[i]), colours);
    } else {
        blocks(context, view, report, at, null, colours);
        colouredJoints(context, view, report, at, values, colours);
    }
    beam(context, view, report, at);
    names(context, view, store, at, values, colours);
    (["block", "joint"] as const).forEach((owner) =>
        store.of(owner).forEach((index, place) => mark(context, view, report, at, { owner, index }, palette().lines[place], 2.5)),
    );
    if (store.hover !== null) {
        mark(context, view, report, at, store.hover, palette().ground, 1.5);
    }
    return colours;
}

/** Outline at rest, to see the motion against. */
function ghost(context: CanvasRenderingContext2D, view: View, report: Report, shift: number): void {
    context.strokeStyle = palette().rest;
    context.setLineDash([4, 4]);
    context.lineWidth = 1;
    context.beginPath();
    for (const [[x0, y0], [x1, y1]] of rest(report).contour) {
        context.moveTo(view.x(x0) + shift, view.y(y0));
        context.lineTo(view.x(x1) + shift, view.y(y1));
    }
    context.stroke();
    context.setLineDash([]);
}

function base(context: CanvasRenderingContext2D, view: View, shift: number): void {
    const [left, right] = [view.x(view.bounds.left) + shift - 10, view.x(view.bounds.right) + shift + 10];
    const y = view.y(view.bounds.bottom) + 2;
    context.strokeStyle = palette().ground;
    context.lineWidth = 1.2;
    context.beginPath();
    context.moveTo(left, y);
    context.lineTo(right, y);
    for (let x = left + 8; x <= right; x += 9) {
        context.moveTo(x, y);
        context.lineTo(x - 7, y + 8);
    }
    context.stroke();
}

/** Every block with half a joint around it, and a rectangle with a whole one below: what blocks leave uncovered is mortar. */
function mortar(context: CanvasRenderingContext2D, view: View, report: Report, at: Places): void {
    const { x0, x1, y0, y1, bed, head } = report.block;
    // Thinner than that it cannot be seen.
    if (view.zoom * Math.max(bed[0], head[0]) < 0.7) {
        return;
    }
    context.fillStyle = palette().mortar;
    const around = rest(report).mortar;
    for (let i = 0; i < report.blocks; i++) {
        const outline = around[i];
        if (outline !== null) {
            fillOutline(context, at, i, outline);
            continue;
        }
        const left = Math.max(x0[i] - head[i] / 2, view.bounds.left);
        const right = Math.min(x1[i] + head[i] / 2, view.bounds.right);
        fill(context, view, at, i, [left, Math.max(y0[i] - bed[i], view.bounds.bottom), right, y1[i]]);
    }
}

/** Fills a rectangle, left, bottom, right, top [m] at rest, that moves with a column. */
function fill(context: CanvasRenderingContext2D, view: View, at: Places, column: number, [left, bottom, right, top]: number[]): void {
    if (at.isUpright(column)) {
        const [x, y] = at.point(column, left, top);
        context.fillRect(x, y, (right - left) * view.zoom, (top - bottom) * view.zoom);
        return;
    }
    fillOutline(context, at, column, [[left, bottom], [right, bottom], [right, top], [left, top]]);
}

/** Fills an outline [m] that moves with a column. */
function fillOutline(context: CanvasRenderingContext2D, at: Places, column: number, corners: Point[]): void {
    context.beginPath();
    for (const [x, y] of corners) {
        context.lineTo(...at.point(column, x, y));
    }
    context.fill();
}

function blocks(
    context: CanvasRenderingContext2D,
    view: View,
    report: Report,
    at: Places,
    stepOf: ((block: number) => number) | null,
    colours: Scale,
): void {
    let last = -2;
    for (let i = 0; i < report.blocks; i++) {
        const k = stepOf === null ? -1 : stepOf(i);
        if (k !== last) {
            context.fillStyle = k < 0 ? (stepOf === null ? palette().brick : palette().none) : colours.colours[k];
            last = k;
        }
        at.fill(context, i);
    }
    // In a large wall outlines would hide the colours.
    if (view.zoom * Math.sqrt((view.width * view.height) / report.blocks) < 9) {
        return;
    }
    context.strokeStyle = "#5f5a54";
    context.lineWidth = 0.6;
    context.beginPath();
    for (let i = 0; i < report.blocks; i++) {
        at.trace(context, i);
    }
    context.stroke();
}

/** Joints by value: large sizes lie on top and are thicker. */
function colouredJoints(
    context: CanvasRenderingContext2D,
    view: View,
    report: Report,
    at: Places,
    values: ArrayLike<number>,
    colours: Scale,
): void {
    const members: number[][] = Array.from({ length: STEPS + 1 }, () => []);
    for (let e = 0; e < report.joints; e++) {
        members[step(colours, values[e]) + 1].push(e);
    }
    const size = (k: number) => (colours.low < 0 ? Math.abs((2 * k) / (STEPS - 1) - 1) : k / (STEPS - 1));
    const order = Array.from({ length: STEPS }, (_, k) => k).sort((a, b) => size(a) - size(b));
    const thin = thinnest(view);
    const stroke = (list: number[], colour: string, width: number) => {
        if (list.length === 0) {
            return;
        }
        context.strokeStyle = colour;
        context.lineWidth = width;
        context.beginPath();
        for (const e of list.filter((joint) => !at.hasParted(joint))) {
            const [x0, y0, x1, y1] = at.line(e);
            context.moveTo(x0, y0);
            context.lineTo(x1, y1);
        }
        context.stroke();
    };
    stroke(members[0], palette().none, thin);
    order.forEach((k) => stroke(members[k + 1], colours.colours[k], thin * (1.3 + (THICKEST - 1.3) * size(k))));
}

/** Width of a joint that does nothing [px]. */
function thinnest(view: View): number {
    return Math.max(1, Math.min(2.5, 0.005 * view.zoom));
}

function beam(context: CanvasRenderingContext2D, view: View, report: Report, at: Places): void {
    if (report.beam < 0 || view.beam === null) {
        return;
    }
    const [low, high] = BEAM.map((height) => view.bounds.top + height / view.zoom);
    const [left, right] = view.beam;
    context.fillStyle = palette().beam;
    context.strokeStyle = palette().ground;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(...at.point(report.beam, left, low));
    context.lineTo(...at.point(report.beam, right, low));
    context.lineTo(...at.point(report.beam, right, high));
    context.lineTo(...at.point(report.beam, left, high));
    context.closePath();
    context.fill();
    context.stroke();
    const [x, y] = at.point(report.beam, (left + right) / 2, (low + high) / 2);
    text(context, report.contents.beam.label, [x, y, at.angle(report.beam)], (right - left) * view.zoom - 8, 12, INK);
}

function names(context: CanvasRenderingContext2D, view: View, store: Store, at: Places, values: ArrayLike<number>, colours: Scale): void {
    const { blocks, contents, outline } = store.report;
    if (blocks > MOST_NAMED * view.enlarged ** 2) {
        return;
    }
    const { room } = rest(store.report);
    for (let i = 0; i < blocks; i++) {
        const [width, height] = [room[i][0] * view.zoom, room[i][1] * view.zoom];
        if (height < 11 || width < 26) {
            continue;
        }
        const k = store.paint.owner === "block" ? step(colours, values[i]) : -1;
        const colour = k >= 0 && isDark(colours, k) ? "#fff" : INK;
        const [x, y] = at.point(i, outline.centreX[i], outline.centreY[i]);
        text(context, contents.block_names[i], [x, y, at.angle(i)], width - 4, Math.min(12, height - 1), colour);
    }
}

/** A text around a point, turned clockwise by an angle; left out when it does not fit. */
function text(
    context: CanvasRenderingContext2D,
    words: string,
    [x, y, angle]: [number, number, number],
    width: number,
    size: number,
    colour: string,
): void {
    context.font = `${size}px ${FONT}`;
    if (words === "" || context.measureText(words).width > width) {
        return;
    }
    context.fillStyle = colour;
    context.textAlign = "center";
    context.textBaseline = "middle";
    if (angle === 0) {
        context.fillText(words, x, y + 0.5);
        return;
    }
    context.save();
    context.translate(x, y);
    context.rotate(angle);
    context.fillText(words, 0, 0.5);
    context.restore();
}

/** A frame around an item, outside of it: it must not hide the colour. */
function mark(
    context: CanvasRenderingContext2D,
    view: View,
    report: Report,
    at: Places,
    item: Item,
    colour: string,
    widest: number,
): void {
    // In a wall of small blocks a wide frame would hide the neighbours.
    const { x0, x1, y0, y1 } = report.block;
    const side = view.zoom * Math.min(x1[0] - x0[0], y1[0] - y0[0]);
    const width = Math.max(1, Math.min(widest, 0.12 * side));
    const edge = Math.min(1, 0.5 * width);
    const by = 0.5 * width + edge;
    const gap = 0.5 * THICKEST * thinnest(view);
    const corners = item.owner === "block" ? grown(at.corners(item.index), by) : around(at.line(item.index), gap + by);
    const outline = new Path2D();
    corners.forEach(([x, y], k) => (k === 0 ? outline.moveTo(x, y) : outline.lineTo(x, y)));
    outline.closePath();
    // An edge around the mark keeps it plain on any colour.
    context.strokeStyle = palette().halo;
    context.lineWidth = width + 2 * edge;
    context.stroke(outline);
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke(outline);
}

/** A rectangle around a line, with its sides that far from it. */
function around([x0, y0, x1, y1]: [number, number, number, number], by: number): Point[] {
    const length = Math.hypot(x1 - x0, y1 - y0);
    const [tx, ty] = length === 0 ? [by, 0] : [(by * (x1 - x0)) / length, (by * (y1 - y0)) / length];
    return [[x0 - tx + ty, y0 - ty - tx], [x1 + tx + ty, y1 + ty - tx], [x1 + tx - ty, y1 + ty + tx], [x0 - tx - ty, y0 - ty + tx]];
}
