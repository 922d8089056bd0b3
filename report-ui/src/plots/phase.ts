/** One quantity over another along the whole run, with a mark at the moment; a click goes to the nearest point. */

import uPlot from "uplot";
import { h } from "../dom";
import { largest } from "../quantities";
import type { Store } from "../store";
import { axis, Panel, UPRIGHT } from "./frame";
import type { Curve } from "./frame";
import { range } from "./time";

export interface PhaseCurve extends Curve {
    x: Float64Array;
    y: Float64Array;
}

export class PhasePlot {
    readonly panel: Panel;
    private plot: uPlot | null = null;
    private curves: PhaseCurve[] = [];
    private marks: HTMLElement[] = [];

    constructor(private readonly store: Store, private readonly title: string, height: number) {
        this.panel = new Panel(title, height);
        this.panel.resized = () => this.place();
        store.on("frame", () => this.place());
    }

    show(x: [string, string], y: [string, string], curves: PhaseCurve[]): void {
        this.curves = curves;
        const size = (of: "x" | "y") => Math.max(...curves.map((c) => largest(c[of])), 0);
        const [left, right, low, high] = [...ends(curves.map((c) => c.x)), ...ends(curves.map((c) => c.y))];
        const options: Omit<uPlot.Options, "width" | "height"> = {
            legend: { show: false },
            padding: [8, 12, 0, 0],
            cursor: { points: { show: false }, drag: { x: false, y: false } },
            scales: { x: { time: false, range: () => range(left, right) }, y: { range: () => range(low, high) } },
            axes: [axis(...x, size("x"), { size: 34 }), axis(...y, size("y"), UPRIGHT)],
            // The library draws functions of x; a trajectory returns, so it is drawn by hand over two points of frame.
            series: [{}, { stroke: "transparent", points: { show: false } }],
            hooks: { draw: [(plot) => this.trace(plot), () => this.place()] },
        };
        this.plot = this.panel.show(options, [[left, right], [low, high]]);
        this.panel.name(curves, "");
        this.panel.place.setAttribute("role", "img");
        this.panel.place.setAttribute("aria-label", `${this.title}: ${y[0]} over ${x[0]} of ${curves.map((c) => c.name).join(", ")}`);
        this.marks = curves.map((c) => h("div", { class: "dot", style: `background:${c.colour}` }));
        this.plot.over.append(...this.marks);
        this.plot.over.addEventListener("pointerdown", (event) => this.goToNearest(event));
    }

    private trace(plot: uPlot): void {
        const { ctx, bbox } = plot;
        ctx.save();
        ctx.beginPath();
        ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
        ctx.clip();
        const ratio = uPlot.pxRatio;
        for (const { x, y, colour, dash } of this.curves) {
            ctx.strokeStyle = colour;
            ctx.lineWidth = 1.1 * ratio;
            ctx.setLineDash(dash.map((d) => d * ratio));
            ctx.beginPath();
            for (let k = 0; k < x.length; k++) {
                ctx.lineTo(plot.valToPos(x[k], "x", true), plot.valToPos(y[k], "y", true));
            }
            ctx.stroke();
        }
        ctx.restore();
    }

    private place(): void {
        const plot = this.plot;
        if (plot === null || this.marks.length !== this.curves.length) {
            return;
        }
        this.marks.forEach((mark, c) => {
            const { x, y } = this.curves[c];
            const [left, top] = [plot.valToPos(x[this.store.frame], "x"), plot.valToPos(y[this.store.frame], "y")];
            mark.style.transform = `translate(${left.toFixed(1)}px,${top.toFixed(1)}px)`;
        });
    }

    private goToNearest(event: PointerEvent): void {
        const plot = this.plot;
        if (plot === null) {
            return;
        }
        const area = plot.over.getBoundingClientRect();
        const [px, py] = [event.clientX - area.left, event.clientY - area.top];
        let [nearest, found] = [Infinity, this.store.frame];
        for (const { x, y } of this.curves) {
            for (let k = 0; k < x.length; k++) {
                const distance = Math.hypot(plot.valToPos(x[k], "x") - px, plot.valToPos(y[k], "y") - py);
                if (distance < nearest) {
                    [nearest, found] = [distance, k];
                }
            }
        }
        this.store.play(false);
        this.store.go(found);
    }
}

function ends(lists: Float64Array[]): [number, number] {
    let [low, high] = [Infinity, -Infinity];
    for (const list of lists) {
        for (const value of list) {
            if (Number.isFinite(value)) {
                low = Math.min(low, value);
                high = Math.max(high, value);
            }
        }
    }
    return low <= high ? [low, high] : [-1, 1];
}
