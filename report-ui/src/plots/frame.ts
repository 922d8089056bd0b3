/** What all plots have in common: size, axes with decimal prefixes, a heading with a legend. */

import uPlot from "uplot";
import { swatch } from "../dom";
import { h, setText } from "../dom";
import { onLayout } from "../layout";
import { prefixOf, si, tick } from "../format";

export interface Curve {
    name: string;
    colour: string;
    dash: number[];
    /** Value at the moment; none for a curve that has no moment. */
    now?: () => number;
}

const INK = "#3a3f47";
const GRID = { stroke: "#e4e7eb", width: 1 };
const FONT = "12px system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";

/** An axis that writes its values with a decimal prefix: `displacement [µm]`. */
export function axis(label: string, unit: string, largest: number, more: Partial<uPlot.Axis> = {}): uPlot.Axis {
    const [prefix, factor] = prefixOf(largest, unit);
    const shown = unit === "" ? label : `${label} [${prefix}${unit}]`;
    return {
        label: shown,
        labelFont: FONT,
        labelSize: 22,
        labelGap: 2,
        font: FONT,
        stroke: INK,
        grid: GRID,
        ticks: { ...GRID, size: 5 },
        values: (_, splits) => splits.map((v) => (v === null ? "" : tick(v / factor))),
        ...more,
    };
}

/** Room for the numbers of an upright axis. */
export const UPRIGHT = { size: 58 };

/** The element of a plot: title, legend with values at the moment, a place for the drawing, a note. */
export class Panel {
    readonly element = h("figure", { class: "plot" });
    readonly place = h("div", { class: "place" });
    private readonly legend = h("ul", { class: "legend" });
    private values: { element: HTMLDataElement; now: () => number; unit: string }[] = [];
    private plot: uPlot | null = null;
    /** Called after every change of size. */
    resized: () => void = () => {};

    constructor(title: string, private readonly height: number, note = "") {
        const caption = h("figcaption", {}, h("span", { class: "title" }, title), this.legend);
        this.element.append(caption, this.place);
        if (note !== "") {
            this.element.append(h("p", { class: "small" }, note));
        }
        new ResizeObserver(() => this.resize()).observe(this.place);
        onLayout(() => this.resize());
    }

    get width(): number {
        return Math.max(200, Math.floor(this.place.clientWidth));
    }

    /** Puts another drawing into the place. */
    show(options: Omit<uPlot.Options, "width" | "height">, data: uPlot.AlignedData): uPlot {
        this.plot?.destroy();
        this.plot = new uPlot({ ...options, width: this.width, height: this.height }, data, this.place);
        return this.plot;
    }

    /** Names the curves; values at the moment follow the names. */
    name(curves: Curve[], unit: string): void {
        this.values = [];
        const entries = curves.map((curve) => {
            const entry = h("li", {}, swatch(curve.colour, curve.dash), h("span", {}, curve.name));
            if (curve.now !== undefined) {
                const element = h("data");
                this.values.push({ element, now: curve.now, unit });
                entry.append(element);
            }
            return entry;
        });
        this.legend.replaceChildren(...entries);
    }

    /** Brings the values of the legend up to date. */
    update(): void {
        for (const { element, now, unit } of this.values) {
            const value = now();
            element.value = String(value);
            setText(element, si(value, unit));
        }
    }

    private resize(): void {
        if (this.plot !== null && this.plot.width !== this.width) {
            this.plot.setSize({ width: this.width, height: this.height });
            this.resized();
        }
    }
}
