/** Enlarges the wall on its canvas and shifts it: wheel, two fingers, keys, buttons. */

import { h, setText } from "../dom";
import type { View } from "../wall/view";

const STEP = 1.5;
/** Way of the pointer that makes a drag of a click [px]. */
const DRAG = 5;
/** Way of the wheel that enlarges by e [px]. */
const WHEEL = 400;

const HINT = "The wheel with Ctrl, or without once the wall is clicked; two fingers; the keys +, − and 0. An enlarged wall is dragged.";

export class Zoom {
    readonly element = h("div", { class: "zoom", role: "group", "aria-label": "Size of the wall", title: HINT });
    private readonly factor = h("output", { class: "factor" });
    /** Pointers that are down, by their numbers. */
    private readonly down = new Map<number, [number, number]>();
    private start: [number, number] = [0, 0];
    /** Whether the pointer has shifted or enlarged the wall since it went down: then it does not select. */
    moved = false;

    constructor(private readonly canvas: HTMLCanvasElement, private readonly view: View, private readonly changed: () => void) {
        const button = (label: string, sign: string, act: () => void) =>
            h("button", { type: "button", "aria-label": label, title: label, "onclick": act }, sign);
        this.element.append(
            button("Smaller", "−", () => this.by(1 / STEP)), this.factor, button("Larger", "+", () => this.by(STEP)),
            button("Whole wall", "whole wall", () => this.by(0)),
        );
        canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
        canvas.addEventListener("keydown", (event) => this.key(event));
        canvas.addEventListener("pointerdown", (event) => this.press(event));
        canvas.addEventListener("pointermove", (event) => this.move(event));
        (["pointerup", "pointercancel"] as const).forEach((name) => canvas.addEventListener(name, (event) => this.down.delete(event.pointerId)));
        this.show();
    }

    /** Brings the buttons and the pointer up to date. */
    show(): void {
        const { enlarged } = this.view;
        setText(this.factor, `× ${enlarged.toFixed(enlarged < 9.95 ? 1 : 0)}`);
        this.canvas.classList.toggle("enlarged", enlarged > 1);
    }

    private by(factor: number, at?: [number, number]): void {
        this.view.enlarge(factor, ...(at ?? []));
        this.show();
        this.changed();
    }

    private pan(dx: number, dy: number): void {
        this.view.pan(dx, dy);
        this.changed();
    }

    private place(event: MouseEvent): [number, number] {
        const area = this.canvas.getBoundingClientRect();
        return [event.clientX - area.left, event.clientY - area.top];
    }

    /** The wheel scrolls the page unless Ctrl is held (so two fingers on a pad come, too) or the wall has the focus. */
    private wheel(event: WheelEvent): void {
        const whole = this.view.enlarged <= 1 && event.deltaY > 0;
        if (event.ctrlKey || (document.activeElement === this.canvas && !whole)) {
            event.preventDefault();
            const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1) * (event.ctrlKey ? 3 : 1);
            this.by(Math.exp(-Math.max(-WHEEL, Math.min(WHEEL, pixels)) / WHEEL), this.place(event));
        }
    }

    private key(event: KeyboardEvent): void {
        if (event.ctrlKey || event.metaKey || event.altKey) {
            return;
        }
        const by = 0.1 * this.canvas.clientHeight;
        const ways: Record<string, [number, number]> = { ArrowLeft: [by, 0], ArrowRight: [-by, 0], ArrowUp: [0, by], ArrowDown: [0, -by] };
        const factors: Record<string, number> = { "+": STEP, "=": STEP, "-": 1 / STEP, "0": 0 };
        if (event.key in factors) {
            this.by(factors[event.key]);
        } else if (event.key in ways && this.view.enlarged > 1) {
            this.pan(...ways[event.key]);
        } else {
            return;
        }
        // Elsewhere on the page the arrows step from frame to frame.
        event.stopPropagation();
        event.preventDefault();
    }

    private press(event: PointerEvent): void {
        const at = this.place(event);
        this.down.set(event.pointerId, at);
        if (this.down.size === 1) {
            [this.start, this.moved] = [at, false];
        }
    }

    private move(event: PointerEvent): void {
        const before = this.down.get(event.pointerId);
        if (before === undefined) {
            return;
        }
        if (event.buttons === 0) {
            this.down.delete(event.pointerId);
            return;
        }
        const at = this.place(event);
        this.down.set(event.pointerId, at);
        const other = [...this.down].find(([id]) => id !== event.pointerId)?.[1];
        if (other !== undefined) {
            this.moved = true;
            this.by(distance(at, other) / Math.max(1, distance(before, other)), [0.5 * (at[0] + other[0]), 0.5 * (at[1] + other[1])]);
            return;
        }
        if (this.view.enlarged > 1 && (this.moved || distance(at, this.start) > DRAG)) {
            if (!this.moved) {
                this.moved = true;
                this.canvas.setPointerCapture(event.pointerId);
            }
            this.pan(at[0] - before[0], at[1] - before[1]);
        }
    }
}

function distance(a: [number, number], b: [number, number]): number {
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
}
