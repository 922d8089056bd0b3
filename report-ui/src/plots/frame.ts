/** What all plots have in common: size, axes with decimal prefixes, a heading with a legend, buttons that save them. */

import uPlot from "uplot";
import { DASHES } from "../colour";
import { h, setText, swatch } from "../dom";
import { onLayout } from "../layout";
import { NOTHING, prefixOf, si, tick } from "../format";
import { csv, fileName, savePicture, saveText } from "../save";
import type { Column } from "../save";
import { forPaper, onTheme, palette } from "../theme";

export interface Curve {
    name: string;
    /** Number of the line that it is drawn with. */
    line: number;
    /** Value at the moment; none for a curve that has no moment. */
    now?: () => number;
}

export type Options = Omit<uPlot.Options, "width" | "height">;

/** A drawing, all of it so many times as large as on the page: for pictures that are saved. */
export type Draw = (scale: number) => { options: Options; data: uPlot.AlignedData };

const FONT = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";
/** Size of saved pictures: width, height of the plot, room above it and letters [px], and pixels of each. */
const PICTURE = { width: 900, height: 420, head: 54, letters: 13, sharp: 2 };

/** Colour of a line in the palette of the moment. */
export function colourOf(line: number): string {
    const { lines } = palette();
    return lines[line % lines.length];
}

export function dashOf(line: number): number[] {
    return DASHES[line % DASHES.length];
}

/** An axis that writes its values with a decimal prefix: `displacement [µm]`. */
export function axis(label: string, unit: string, largest: number, scale: number, size: number, more: Partial<uPlot.Axis> = {}): uPlot.Axis {
    const nothing = largest < NOTHING;
    const [prefix, factor] = nothing ? ["", 1] : prefixOf(largest, unit);
    const font = `${12 * scale}px ${FONT}`;
    const grid = { stroke: () => palette().grid, width: scale };
    return {
        label: unit === "" ? label : `${label} [${prefix}${unit}]`,
        labelFont: font,
        labelSize: 22 * scale,
        labelGap: 2 * scale,
        font,
        size: size * scale,
        gap: 5 * scale,
        space: (size === UPRIGHT ? 30 : 50) * scale,
        stroke: () => palette().ink,
        grid,
        ticks: { ...grid, size: 5 * scale },
        values: (_, splits) => splits.map((v) => (v === null ? "" : tick(v / factor, nothing ? 1 : largest / factor))),
        ...more,
    };
}

/** Room for the numbers of an upright axis, and of a level one [px]. */
export const UPRIGHT = 58;
export const LEVEL = 34;

/** The element of a plot: title, legend with values at the moment, a place for the drawing, a note. */
export class Panel {
    readonly element = h("figure", { class: "plot" });
    readonly place = h("div", { class: "place" });
    /** Beside the title: what can be chosen. */
    readonly choices = h("span", { class: "choices" });
    /** What a table of the plot holds. */
    table: () => Column[] = () => [];
    private readonly legend = h("ul", { class: "legend" });
    private values: { element: HTMLDataElement; now: () => number; unit: string }[] = [];
    private curves: Curve[] = [];
    private plot: uPlot | null = null;
    private draw: Draw | null = null;
    /** Called after every change of size. */
    resized: () => void = () => {};

    /** `file` begins the names of what is saved. */
    constructor(private readonly title: string, private readonly height: number, private readonly file: string, note = "") {
        const saves = h("span", { class: "saves" },
            this.button("CSV", `Save the numbers of “${title}” as they are drawn`, () => this.saveTable()),
            this.button("PNG", `Save the picture of “${title}”`, () => void this.savePicture()),
        );
        const head = h("span", { class: "head" }, h("span", { class: "title" }, title), this.choices, saves);
        this.element.append(h("figcaption", {}, head, this.legend), this.place);
        if (note !== "") {
            this.element.append(h("p", { class: "small" }, note));
        }
        new ResizeObserver(() => this.resize()).observe(this.place);
        onLayout(() => this.resize());
        onTheme(() => this.plot?.redraw(false));
    }

    private button(text: string, label: string, act: () => void): HTMLElement {
        return h("button", { type: "button", class: "save", "aria-label": label, title: label, "onclick": act }, text);
    }

    get width(): number {
        return Math.max(200, Math.floor(this.place.clientWidth));
    }

    /** Puts another drawing into the place. */
    show(draw: Draw): uPlot {
        this.plot?.destroy();
        this.draw = draw;
        const { options, data } = draw(1);
        this.plot = new uPlot({ ...options, width: this.width, height: this.height }, data, this.place);
        return this.plot;
    }

    /** Names the curves; values at the moment follow the names. */
    name(curves: Curve[], unit: string): void {
        this.values = [];
        this.curves = curves;
        const entries = curves.filter((curve) => curve.name !== "").map((curve) => {
            const entry = h("li", {}, swatch(curve.line), h("span", {}, curve.name));
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

    private saveTable(): void {
        saveText(`${fileName(this.file, this.title)}.csv`, csv(this.table()), "text/csv");
    }

    private async savePicture(): Promise<void> {
        const { draw } = this;
        if (draw !== null) {
            await savePicture(`${fileName(this.file, this.title)}.png`, await forPaper(() => this.picture(draw)));
        }
    }

    /** The plot for paper, with its title and legend. */
    private async picture(draw: Draw): Promise<HTMLCanvasElement> {
        // The library draws with the pixels of this screen.
        const scale = PICTURE.sharp / uPlot.pxRatio;
        const { options, data } = draw(scale);
        const size = { width: PICTURE.width * scale, height: PICTURE.height * scale };
        const plot = await new Promise<uPlot>((done) => {
            const hooks = { ...options.hooks, draw: [...(options.hooks?.draw ?? []), done] };
            new uPlot({ ...options, ...size, hooks }, data, document.createElement("div"));
        });
        const canvas = h("canvas", { width: plot.ctx.canvas.width, height: plot.ctx.canvas.height + PICTURE.head * PICTURE.sharp });
        const context = canvas.getContext("2d") as CanvasRenderingContext2D;
        context.fillStyle = palette().paper;
        context.fillRect(0, 0, canvas.width, canvas.height);
        context.drawImage(plot.ctx.canvas, 0, PICTURE.head * PICTURE.sharp);
        plot.destroy();
        context.scale(PICTURE.sharp, PICTURE.sharp);
        this.heading(context);
        return canvas;
    }

    private heading(context: CanvasRenderingContext2D): void {
        context.fillStyle = palette().ink;
        context.textBaseline = "middle";
        context.font = `600 ${PICTURE.letters + 1}px ${FONT}`;
        context.fillText(this.title, 12, 16);
        context.font = `${PICTURE.letters}px ${FONT}`;
        let x = 12;
        for (const { name, line } of this.curves.filter((curve) => curve.name !== "")) {
            context.strokeStyle = colourOf(line);
            context.lineWidth = 2;
            context.setLineDash(dashOf(line));
            context.beginPath();
            context.moveTo(x, 38);
            context.lineTo(x + 26, 38);
            context.stroke();
            context.fillText(name, x + 32, 38);
            x += 32 + context.measureText(name).width + 20;
        }
    }

    private resize(): void {
        if (this.plot !== null && this.plot.width !== this.width) {
            this.plot.setSize({ width: this.width, height: this.height });
            this.resized();
        }
    }
}
