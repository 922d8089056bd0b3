/** The wall at the moment: base, blocks, joints, beam, marks of what is selected and pointed at. */

import { isDark, LINES, step, STEPS } from "../colour";
import type { Scale } from "../colour";
import type { Report } from "../data";
import type { Item, Store } from "../store";
import type { View } from "./view";

const BRICK = "#ecd9c6";
const MORTAR = "#e6e1d8";
const INK = "#222";
const FONT = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";

/** Width of the joint that does most, over the width of one that does nothing. */
const THICKEST = 3.3;
/** Blocks up to which each bears its name. */
const MOST_NAMED = 250;

/** Horizontal shift of every column of the frames on the canvas [px], and of the base. */
export interface Shifts {
    column: Float64Array;
    base: number;
}

export function shifts(store: Store, view: View, baseShift: number, into: Float64Array): Shifts {
    into.fill(baseShift);
    if (store.report.frames.count > 0) {
        const z = store.moment.field("displacement");
        const factor = store.magnify * view.zoom;
        for (let i = 0; i < z.length; i++) {
            into[i] += Number.isFinite(z[i]) ? factor * z[i] : 0;
        }
    }
    return { column: into, base: baseShift };
}

/** Draws everything. */
export function draw(context: CanvasRenderingContext2D, size: [number, number], view: View, store: Store, at: Shifts): Scale {
    const values = store.moment.values(store.paint);
    const colours = store.scale(values);
    context.clearRect(0, 0, ...size);
    ghost(context, view, at.base);
    base(context, view, at.base);
    const { report } = store;
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
        store.of(owner).forEach((index, place) => mark(context, view, report, at, { owner, index }, LINES[place].colour, 2.5)),
    );
    if (store.hover !== null) {
        mark(context, view, report, at, store.hover, "#000", 1.5);
    }
    return colours;
}

/** Outline at rest, to see the motion against. */
function ghost(context: CanvasRenderingContext2D, view: View, shift: number): void {
    const { left, top } = view.bounds;
    context.strokeStyle = "#c9ccd1";
    context.setLineDash([4, 4]);
    context.lineWidth = 1;
    context.strokeRect(view.x(left) + shift, view.y(top), view.width * view.zoom, view.height * view.zoom);
    context.setLineDash([]);
}

function base(context: CanvasRenderingContext2D, view: View, shift: number): void {
    const [left, right] = [view.x(view.bounds.left) + shift - 10, view.x(view.bounds.right) + shift + 10];
    const y = view.y(view.bounds.bottom) + 2;
    context.strokeStyle = INK;
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

/** Every block with half a joint around it and a whole one below: what blocks leave uncovered is mortar. */
function mortar(context: CanvasRenderingContext2D, view: View, report: Report, at: Shifts): void {
    const { x0, x1, y0, y1, bed, head } = report.block;
    // Thinner than that it cannot be seen.
    if (view.zoom * Math.max(bed[0], head[0]) < 0.7) {
        return;
    }
    context.fillStyle = MORTAR;
    for (let i = 0; i < report.blocks; i++) {
        const left = Math.max(x0[i] - head[i] / 2, view.bounds.left);
        const right = Math.min(x1[i] + head[i] / 2, view.bounds.right);
        const [top, bottom] = [view.y(y1[i]), view.y(Math.max(y0[i] - bed[i], view.bounds.bottom))];
        context.fillRect(view.x(left) + at.column[i], top, (right - left) * view.zoom, bottom - top);
    }
}

function blocks(
    context: CanvasRenderingContext2D,
    view: View,
    report: Report,
    at: Shifts,
    stepOf: ((block: number) => number) | null,
    colours: Scale,
): void {
    const { x0, x1, y0, y1 } = report.block;
    let last = -2;
    for (let i = 0; i < report.blocks; i++) {
        const k = stepOf === null ? -1 : stepOf(i);
        if (k !== last) {
            context.fillStyle = k < 0 ? (stepOf === null ? BRICK : "#fff") : colours.colours[k];
            last = k;
        }
        const left = view.x(x0[i]) + at.column[i];
        context.fillRect(left, view.y(y1[i]), (x1[i] - x0[i]) * view.zoom, (y1[i] - y0[i]) * view.zoom);
    }
    // In a large wall outlines would hide the colours.
    if (view.zoom * Math.sqrt((view.width * view.height) / report.blocks) < 9) {
        return;
    }
    context.strokeStyle = "#5f5a54";
    context.lineWidth = 0.6;
    context.beginPath();
    for (let i = 0; i < report.blocks; i++) {
        const left = view.x(x0[i]) + at.column[i];
        context.rect(left, view.y(y1[i]), (x1[i] - x0[i]) * view.zoom, (y1[i] - y0[i]) * view.zoom);
    }
    context.stroke();
}

/** Ends of a joint's line, which goes with the mean of its sides. */
export function line(view: View, report: Report, at: Shifts, e: number): [number, number, number, number] {
    const j = report.joint;
    const side = (column: number) => (column < 0 ? at.base : at.column[column]);
    const shift = 0.5 * (side(j.a[e]) + side(j.b[e]));
    return [view.x(j.x0[e]) + shift, view.y(j.y0[e]), view.x(j.x1[e]) + shift, view.y(j.y1[e])];
}

/** Joints by value: large sizes lie on top and are thicker. */
function colouredJoints(
    context: CanvasRenderingContext2D,
    view: View,
    report: Report,
    at: Shifts,
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
        for (const e of list) {
            const [x0, y0, x1, y1] = line(view, report, at, e);
            context.moveTo(x0, y0);
            context.lineTo(x1, y1);
        }
        context.stroke();
    };
    stroke(members[0], "#fff", thin);
    order.forEach((k) => stroke(members[k + 1], colours.colours[k], thin * (1.3 + (THICKEST - 1.3) * size(k))));
}

/** Width of a joint that does nothing [px]. */
function thinnest(view: View): number {
    return Math.max(1, Math.min(2.5, 0.005 * view.zoom));
}

function beam(context: CanvasRenderingContext2D, view: View, report: Report, at: Shifts): void {
    if (report.beam < 0 || view.beam === null) {
        return;
    }
    const x = view.x(view.beam[0]) + at.column[report.beam];
    const width = (view.beam[1] - view.beam[0]) * view.zoom;
    const y = view.y(view.bounds.top) - 25;
    context.fillStyle = "#d6dae0";
    context.strokeStyle = INK;
    context.lineWidth = 1;
    context.fillRect(x, y, width, 20);
    context.strokeRect(x, y, width, 20);
    text(context, report.contents.beam.label, x + width / 2, y + 10, width - 8, 12, INK);
}

function names(context: CanvasRenderingContext2D, view: View, store: Store, at: Shifts, values: ArrayLike<number>, colours: Scale): void {
    const { block, blocks, contents } = store.report;
    if (blocks > MOST_NAMED * view.enlarged ** 2) {
        return;
    }
    for (let i = 0; i < blocks; i++) {
        const [width, height] = [(block.x1[i] - block.x0[i]) * view.zoom, (block.y1[i] - block.y0[i]) * view.zoom];
        if (height < 11 || width < 26) {
            continue;
        }
        const k = store.paint.owner === "block" ? step(colours, values[i]) : -1;
        const colour = k >= 0 && isDark(colours, k) ? "#fff" : INK;
        const x = view.x(block.x0[i]) + at.column[i] + width / 2;
        text(context, contents.block_names[i], x, view.y(block.y1[i]) + height / 2, width - 4, Math.min(12, height - 1), colour);
    }
}

/** A text around a point, left out when it does not fit. */
function text(context: CanvasRenderingContext2D, words: string, x: number, y: number, width: number, size: number, colour: string): void {
    context.font = `${size}px ${FONT}`;
    if (words === "" || context.measureText(words).width > width) {
        return;
    }
    context.fillStyle = colour;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(words, x, y + 0.5);
}

/** A frame around an item, outside of it: it must not hide the colour. */
function mark(
    context: CanvasRenderingContext2D,
    view: View,
    report: Report,
    at: Shifts,
    item: Item,
    colour: string,
    widest: number,
): void {
    const i = item.index;
    let [left, top, right, bottom, gap] = [0, 0, 0, 0, 0];
    if (item.owner === "block") {
        const { x0, x1, y0, y1 } = report.block;
        left = view.x(x0[i]) + at.column[i];
        [right, top, bottom] = [left + (x1[i] - x0[i]) * view.zoom, view.y(y1[i]), view.y(y0[i])];
    } else {
        [left, top, right, bottom] = line(view, report, at, i);
        [top, bottom] = [Math.min(top, bottom), Math.max(top, bottom)];
        gap = 0.5 * THICKEST * thinnest(view);
    }
    // In a wall of small blocks a wide frame would hide the neighbours.
    const { x0, x1, y0, y1 } = report.block;
    const side = view.zoom * Math.min(x1[0] - x0[0], y1[0] - y0[0]);
    const width = Math.max(1, Math.min(widest, 0.12 * side));
    const edge = Math.min(1, 0.5 * width);
    const grow = gap + 0.5 * width + edge;
    const outline = new Path2D();
    outline.rect(left - grow, top - grow, right - left + 2 * grow, bottom - top + 2 * grow);
    // A light edge around the mark keeps it plain on dark colours.
    context.strokeStyle = "#fff";
    context.lineWidth = width + 2 * edge;
    context.stroke(outline);
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.stroke(outline);
}
