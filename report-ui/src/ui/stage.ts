/** The canvas with the wall, what the pointer does on it, the colour bar. */

import { h } from "../dom";
import { isPrinting, onLayout } from "../layout";
import { largest } from "../quantities";
import { fileName, savePicture } from "../save";
import type { Store } from "../store";
import { forPaper, onTheme } from "../theme";
import { draw } from "../wall/draw";
import { pick } from "../wall/pick";
import { picture } from "../wall/picture";
import { Places } from "../wall/places";
import { automaticScale, baseScale, View } from "../wall/view";
import { ColourBar } from "./bar";
import { Tooltip } from "./tooltip";
import { Zoom } from "./zoom";

/** A wall of at least so many blocks that is at least so many times as long as high takes the whole width of the page. */
const [MANY, LONG] = [150, 1.9];
/** Height of the wall on paper, at most [px]. */
const ON_PAPER = 430;
/** Change of the height allowed that the wall is not fitted anew for: the bars of a phone's browser come and go [px]. */
const SLIGHT = 100;

export class Stage {
    readonly element = h("div", { class: "stage" });
    readonly view: View;
    /** Factor on displacements that suits the run. */
    readonly automatic: number;
    /** Factor on the motion of the base; 0 when the base is at rest. */
    readonly baseFactor: number;
    private readonly canvas = h("canvas", { tabindex: 0, role: "img" });
    private readonly context: CanvasRenderingContext2D;
    private readonly bar = new ColourBar();
    private readonly tooltip: Tooltip;
    private readonly zoom: Zoom;
    /** Whether the wall needs the whole width of the page. */
    readonly wide: boolean;
    private readonly base: Float64Array | null;
    private readonly at: Places;
    private size: [number, number] = [0, 0];
    /** Height that the canvas may take [px]. */
    private most = 0;
    private waiting = false;

    constructor(private readonly store: Store) {
        const { report } = store;
        this.view = new View(report);
        this.automatic = automaticScale(report, this.view);
        store.magnify = this.automatic;
        const channel = report.channel("base/displacement");
        this.base = channel < 0 ? null : report.atFrames(channel);
        const peak = this.base === null ? 0 : largest(this.base);
        this.baseFactor = peak > 0 ? baseScale(peak, this.view) : 0;
        this.at = new Places(report, this.view);
        this.context = this.canvas.getContext("2d") as CanvasRenderingContext2D;
        this.tooltip = new Tooltip(store);
        this.wide = report.blocks >= MANY && this.view.width >= LONG * this.view.height;
        this.zoom = new Zoom(this.canvas, this.view, () => this.redraw());
        const save = h("button", { type: "button", class: "save", "aria-label": "Save the picture of the wall", title: "Save the picture of the wall", "onclick": () => void this.save() }, "PNG");
        this.zoom.element.append(save);
        this.bar.element.append(this.zoom.element);
        this.element.append(this.canvas, this.tooltip.element, this.bar.element);
        new ResizeObserver(() => this.resize()).observe(this.element);
        window.addEventListener("resize", () => this.resize());
        onLayout(() => this.resize());
        onTheme(() => this.redraw());
        (["frame", "view", "hover", "selection"] as const).forEach((topic) => store.on(topic, () => this.redraw()));
        this.listen();
    }

    /** Draws with the next picture of the screen, however often it is called before. */
    redraw(): void {
        if (!this.waiting) {
            this.waiting = true;
            requestAnimationFrame(() => {
                this.waiting = false;
                this.paint();
            });
        }
    }

    private async save(): Promise<void> {
        const { store, view, at, size } = this;
        const { name } = store.report.contents;
        await savePicture(`${fileName(name, "wall")}.png`, await forPaper(() => picture(store, view, at, size)));
    }

    /** Draws at once. */
    paint(): void {
        if (this.size[0] === 0) {
            return;
        }
        const { store, view } = this;
        const moves = store.baseMoves && this.base !== null && this.baseFactor > 0;
        const baseShift = moves && this.base !== null ? this.base[store.frame] * this.baseFactor * view.zoom : 0;
        this.at.update(store, baseShift);
        this.bar.show(store, draw(this.context, this.size, view, store, this.at));
        this.describe();
    }

    private describe(): void {
        const { blocks, joints } = this.store.report;
        const label = `Wall of ${blocks} blocks and ${joints} joints, coloured by ${this.store.paint.label}. `
            + "Space plays, the arrow keys step, the list beside the wall selects; plus, minus and 0 enlarge it, "
            + "then the arrow keys shift it.";
        if (this.canvas.getAttribute("aria-label") !== label) {
            this.canvas.setAttribute("aria-label", label);
        }
    }

    private resize(): void {
        const width = Math.floor(this.element.clientWidth);
        const most = isPrinting() ? ON_PAPER : Math.min(900, Math.max(220, 0.72 * window.innerHeight));
        if (width === 0 || (width === this.size[0] && Math.abs(most - this.most) < SLIGHT)) {
            return;
        }
        this.most = most;
        const height = Math.ceil(this.view.fit(width, most));
        this.zoom.show();
        const ratio = window.devicePixelRatio || 1;
        this.canvas.width = Math.round(width * ratio);
        this.canvas.height = Math.round(height * ratio);
        this.canvas.style.height = `${height}px`;
        this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
        this.size = [width, height];
        this.paint();
    }

    private listen(): void {
        const under = (event: PointerEvent | MouseEvent, reach: number) => {
            // Blocks are where they are drawn: what is about to be drawn anew has to be before it is looked for.
            if (this.waiting) {
                this.paint();
            }
            const area = this.canvas.getBoundingClientRect();
            const [x, y] = [event.clientX - area.left, event.clientY - area.top];
            this.tooltip.at = [x, y, area.width];
            return pick(this.view, this.store.report, this.at, x, y, reach);
        };
        this.canvas.addEventListener("pointermove", (event) => {
            this.store.setHover(under(event, event.pointerType === "touch" ? 12 : 6));
            this.tooltip.place();
        });
        this.canvas.addEventListener("pointerleave", (event) => {
            if (event.pointerType !== "touch") {
                this.store.setHover(null);
            }
        });
        this.canvas.addEventListener("click", (event) => {
            if (this.zoom.moved) {
                return;
            }
            const touch = (event as PointerEvent).pointerType === "touch";
            const item = under(event, touch ? 12 : 6);
            this.store.setHover(item);
            this.tooltip.place();
            if (item !== null) {
                this.store.toggle(item);
            }
        });
    }
}
