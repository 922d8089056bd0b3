/** One quantity over another along the whole run, with a mark at the moment; a click goes to the nearest point. */

import uPlot from "uplot";
import { h } from "../dom";
import { largest } from "../quantities";
import { headed } from "../save";
import type { Store } from "../store";
import { axis, colourOf, dashOf, LEVEL, Panel, UPRIGHT } from "./frame";
import type { Curve, Options } from "./frame";
import { range } from "./time";

export interface PhaseCurve extends Curve {
    x: ArrayLike<number>;
    y: ArrayLike<number>;
    /** Where it is at the frames, and the instants of its points [s], where these are others than the frames. */
    at?: { x: ArrayLike<number>; y: ArrayLike<number>; time: ArrayLike<number> };
}

export class PhasePlot {
    readonly panel: Panel;
    private plot: uPlot | null = null;
    private curves: PhaseCurve[] = [];
    private marks: HTMLElement[] = [];

    constructor(private readonly store: Store, private readonly title: string, height: number, note = "") {
        this.panel = new Panel(title, height, store.report.contents.name, note);
        this.panel.resized = () => this.place();
        store.on("frame", () => this.place());
    }

    show(x: [string, string], y: [string, string], curves: PhaseCurve[]): void {
        this.curves = curves;
        const size = (of: "x" | "y") => Math.max(...curves.map((c) => largest(c[of])), 0);
        const [left, right, low, high] = [...ends(curves.map((c) => c.x)), ...ends(curves.map((c) => c.y))];
        const options = (scale: number): Options => ({
            legend: { show: false },
            padding: [8 * scale, 12 * scale, 0, 0],
            cursor: { points: { show: false }, drag: { x: false, y: false } },
            scales: { x: { time: false, range: () => range(left, right) }, y: { range: () => range(low, high) } },
            axes: [axis(...x, size("x"), scale, LEVEL), axis(...y, size("y"), scale, UPRIGHT)],
            // The library draws functions of x; a trajectory returns, so it is drawn by hand over two points of frame.
            series: [{}, { stroke: "transparent", points: { show: false } }],
            hooks: { draw: [(plot) => this.trace(plot, curves, scale), () => this.place()] },
        });
        this.plot = this.panel.show((scale) => ({ options: options(scale), data: [[left, right], [low, high]] }));
        this.panel.name(curves, "");
        const { time } = this.store.report.frames;
        this.panel.table = () => [
            { head: "time [s]", values: curves[0]?.at?.time ?? time },
            ...curves.flatMap((c) => {
                const of = ([label, unit]: [string, string]) => headed(c.name === "" ? label : `${c.name}: ${label}`, unit);
                return [{ head: of(x), values: c.x }, { head: of(y), values: c.y }];
            }),
        ];
        this.panel.place.setAttribute("role", "img");
        this.panel.place.setAttribute("aria-label", `${this.title}: ${y[0]} over ${x[0]} of ${curves.map((c) => c.name).join(", ")}`);
        this.marks = curves.map((c) => h("div", { class: "dot", style: `background:var(--line-${c.line})` }));
        this.plot.over.append(...this.marks);
        this.plot.over.addEventListener("pointerdown", (event) => this.goToNearest(event));
    }

    private trace(plot: uPlot, curves: PhaseCurve[], scale: number): void {
        const { ctx, bbox } = plot;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        const ratio = uPlot.pxRatio * scale;
        for (const { x, y, line } of curves) {
            ctx.strokeStyle = colourOf(line);
            ctx.lineWidth = 1.1 * ratio;
            ctx.setLineDash(dashOf(line).map((d) => d * ratio));
            ctx.beginPath();
            for (let k = 0; k < x.length; k++) {
                ctx.lineTo(plot.valToPos(x[k], "x", true), plot.valToPos(y[k], "y", true));
            }
            ctx.stroke();
        }
        ctx.restore();
    }

    private place(): void {
        const { plot, store } = this;
        if (plot === null || this.marks.length !== this.curves.length) {
            return;
        }
        this.marks.forEach((mark, c) => {
            const { x, y } = this.curves[c].at ?? this.curves[c];
            const [left, top] = [plot.valToPos(x[store.frame], "x"), plot.valToPos(y[store.frame], "y")];
            mark.hidden = !Number.isFinite(left + top);
            mark.style.transform = `translate(${left.toFixed(1)}px,${top.toFixed(1)}px)`;
        });
    }

    private goToNearest(event: PointerEvent): void {
        const { plot, store } = this;
        if (plot === null) {
            return;
        }
        const area = plot.over.getBoundingClientRect();
        const [px, py] = [event.clientX - area.left, event.clientY - area.top];
        const { time } = store.report.frames;
        let [nearest, found] = [Infinity, store.time];
        for (const { x, y, at } of this.curves) {
            for (let k = 0; k < x.length; k++) {
                const distance = Math.hypot(plot.valToPos(x[k], "x") - px, plot.valToPos(y[k], "y") - py);
                if (distance < nearest) {
                    [nearest, found] = [distance, (at?.time ?? time)[k]];
                }
            }
        }
        store.play(false);
        store.goToTime(found);
    }
}

function ends(lists: ArrayLike<number>[]): [number, number] {
    let [low, high] = [Infinity, -Infinity];
    for (const list of lists) {
        for (let k = 0; k < list.length; k++) {
            if (Number.isFinite(list[k])) {
                low = Math.min(low, list[k]);
                high = Math.max(high, list[k]);
            }
        }
    }
    return low <= high ? [low, high] : [-1, 1];
}
