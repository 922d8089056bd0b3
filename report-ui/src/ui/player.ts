/** Play, pause, scrub, speed; the keys that do the same. */

import { h, setText } from "../dom";
import { seconds } from "../format";
import type { Store } from "../store";

const SPEEDS = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10];
/** Time by the clock that the whole run takes at the speed that is chosen at first [s]. */
const COMFORTABLE = 10;

export class Player {
    readonly element = h("div", { class: "player" });
    private readonly button = h("button", { type: "button", class: "play", "onclick": () => this.store.play(!this.store.playing) });
    private readonly slider: HTMLInputElement;
    private readonly clock = h("output", { class: "clock" });
    private last = 0;
    /** Time of the run that the pictures shown lag behind [s]. */
    private due = 0;

    constructor(private readonly store: Store) {
        const { frames } = store.report;
        this.slider = h("input", { type: "range", min: 0, max: Math.max(0, frames.count - 1), step: 1, value: 0, "aria-label": "Time" });
        this.slider.addEventListener("input", () => {
            store.play(false);
            store.go(Number(this.slider.value));
        });
        const end = frames.time[frames.count - 1] ?? 0;
        store.speed = SPEEDS.find((s) => end / s <= COMFORTABLE * 1.3) ?? 10;
        const speeds = h("select", { "aria-label": "Speed", "onchange": (event) => {
            store.speed = Number((event.target as HTMLSelectElement).value);
        } }, ...SPEEDS.map((s) => h("option", { value: s, selected: s === store.speed }, speedText(s))));
        const step = (label: string, sign: string, by: number) =>
            h("button", { type: "button", class: "step", "aria-label": label, title: label, "onclick": () => this.step(by) }, sign);
        const peak = h("button", { type: "button", class: "peak", title: "To the largest displacement of a block", "onclick": () => {
            store.play(false);
            store.go(store.peakFrame);
        } }, "peak");
        this.element.append(
            this.button, step("One frame back", "‹", -1), step("One frame on", "›", 1), peak, this.slider, this.clock,
            h("label", { class: "field" }, h("span", {}, "speed"), speeds),
        );
        store.on("frame", () => this.show());
        store.on("play", () => this.start());
        document.addEventListener("keydown", (event) => this.key(event));
        this.show();
        this.start();
    }

    private step(by: number): void {
        this.store.play(false);
        this.store.go(this.store.frame + by);
    }

    private show(): void {
        const { frames } = this.store.report;
        const interval = frames.count > 1 ? frames.time[1] - frames.time[0] : 0;
        const text = seconds(this.store.time, interval);
        this.slider.value = String(this.store.frame);
        this.slider.setAttribute("aria-valuetext", text);
        setText(this.clock, `t = ${text}`);
    }

    private start(): void {
        const { playing } = this.store;
        setText(this.button, playing ? "❚❚" : "▶");
        this.button.setAttribute("aria-label", playing ? "Pause" : "Play");
        this.button.title = playing ? "Pause (space)" : "Play (space)";
        if (playing) {
            this.due = this.store.time;
            this.last = performance.now();
            requestAnimationFrame((now) => this.tick(now));
        }
    }

    private tick(now: number): void {
        const { store } = this;
        if (!store.playing) {
            return;
        }
        // A tab that was asleep goes on where it was.
        this.due += Math.min(0.25, Math.max(0, (now - this.last) / 1000)) * store.speed;
        this.last = now;
        const { time, count } = store.report.frames;
        let frame = store.frame;
        while (frame + 1 < count && time[frame + 1] <= this.due) {
            frame++;
        }
        store.go(frame);
        if (frame >= count - 1) {
            store.play(false);
            return;
        }
        requestAnimationFrame((next) => this.tick(next));
    }

    private key(event: KeyboardEvent): void {
        const target = event.target as HTMLElement;
        const typing = target.closest("input:not([type=range]), textarea, select") !== null;
        if (typing || event.ctrlKey || event.metaKey || event.altKey) {
            return;
        }
        const pressed = target.closest("button, summary, [role=listbox], a") !== null;
        if (event.key === " " && !pressed) {
            this.store.play(!this.store.playing);
        } else if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
            this.step((event.key === "ArrowLeft" ? -1 : 1) * (event.shiftKey ? 10 : 1));
        } else if ((event.key === "Home" || event.key === "End") && target.closest("[role=listbox], pre") === null) {
            this.step(event.key === "Home" ? -Infinity : Infinity);
        } else {
            return;
        }
        event.preventDefault();
    }
}

function speedText(speed: number): string {
    return speed === 1 ? "× 1 (real time)" : speed > 1 ? `× ${speed}` : `1/${Math.round(1 / speed)}`;
}
