/** Curves over time with a line at the moment; a click or a drag moves the moment, with Shift it enlarges a stretch. */

import type uPlot from "uplot";
import { h } from "../dom";
import { largest } from "../quantities";
import { headed } from "../save";
import type { Store } from "../store";
import { axis, colourOf, dashOf, LEVEL, Panel, UPRIGHT } from "./frame";
import type { Curve, Options } from "./frame";

export interface TimeCurve extends Curve {
    values: ArrayLike<number>;
}

export class TimePlot {
    readonly panel: Panel;
    private readonly now = h("div", { class: "now" });
    private plot: uPlot | null = null;

    constructor(private readonly store: Store, private readonly title: string, height: number, note = "") {
        this.panel = new Panel(title, height, store.report.contents.name, note);
        this.panel.resized = () => this.place();
        store.on("frame", () => this.update());
    }

    show(label: string, unit: string, time: ArrayLike<number>, curves: TimeCurve[]): void {
        const top = Math.max(...curves.map((c) => largest(c.values)), 0);
        const data = [time, ...curves.map((c) => c.values)] as unknown as uPlot.AlignedData;
        const options = (scale: number): Options => ({
            legend: { show: false },
            padding: [8 * scale, 12 * scale, 0, 0],
            cursor: {
                y: false,
                points: { show: false },
                drag: { x: true, y: false, setScale: true },
                bind: { mousedown: (_, __, handler) => (event) => (event.shiftKey ? handler(event) : null) },
            },
            scales: { x: { time: false }, y: { range: (_, low, high) => range(low, high) } },
            axes: [axis("time", "s", 1, scale, LEVEL), axis(label, unit, top, scale, UPRIGHT)],
            // Scales are settled with the first drawing only.
            hooks: { draw: [() => this.place()] },
            series: [{}, ...curves.map(({ line }) => ({
                stroke: () => colourOf(line), dash: dashOf(line).map((d) => d * scale), width: 1.4 * scale, points: { show: false },
            }))],
        });
        this.plot = this.panel.show((scale) => ({ options: options(scale), data }));
        this.panel.name(curves, unit);
        this.panel.table = () => [
            { head: "time [s]", values: time }, ...curves.map((c) => ({ head: headed(`${c.name} ${label}`.trim(), unit), values: c.values })),
        ];
        this.panel.place.setAttribute("role", "img");
        this.panel.place.setAttribute("aria-label", `${this.title} over time: ${curves.map((c) => c.name || label).join(", ")}`);
        this.plot.over.append(this.now);
        this.plot.over.style.overflow = "hidden";
        this.follow(this.plot);
        this.update();
    }

    /** Length of time shown [s]. */
    get span(): number {
        const { min, max } = this.plot?.scales.x ?? {};
        return (max ?? 0) - (min ?? 0);
    }

    private follow(plot: uPlot): void {
        const go = (event: PointerEvent) => {
            const left = event.clientX - plot.over.getBoundingClientRect().left;
            this.store.goToTime(plot.posToVal(left, "x"));
        };
        plot.over.addEventListener("pointerdown", (event) => {
            if (!event.shiftKey) {
                this.store.play(false);
                go(event);
            }
        });
        plot.over.addEventListener("pointermove", (event) => {
            if (event.buttons === 1 && !event.shiftKey) {
                go(event);
            }
        });
    }

    private update(): void {
        this.place();
        this.panel.update();
    }

    private place(): void {
        if (this.plot !== null && this.store.report.frames.count > 0) {
            this.now.style.transform = `translateX(${this.plot.valToPos(this.store.time, "x").toFixed(1)}px)`;
        }
    }
}

/** Ends of an axis around values from `low` to `high`, some room left. */
export function range(low: number, high: number): [number, number] {
    if (!Number.isFinite(low) || !Number.isFinite(high) || low === null || high === null) {
        return [-1, 1];
    }
    const room = 0.06 * (high - low) || Math.abs(high) * 0.1 || 1;
    return [low === 0 ? 0 : low - room, high === 0 ? 0 : high + room];
}
