/** What the user has chosen, and who wants to know. */

import { damageScale, scale } from "./colour";
import type { Scale } from "./colour";
import type { Report } from "./data";
import { extent } from "./extent";
import { isDamage, largest, Moment, peak, quantitiesOf } from "./quantities";
import type { Owner, Quantity } from "./quantities";

/** A block or a joint. */
export interface Item {
    owner: Owner;
    index: number;
}

export type Topic = "frame" | "play" | "view" | "hover" | "selection";

/** Blocks, and joints, that can be selected at once: as many as there are kinds of line. */
export const MOST_SELECTED = 6;

export class Store {
    readonly moment: Moment;
    playing = false;
    /** Seconds of the run per second by the clock. */
    speed = 1;
    /** What the colours stand for. */
    paint: Quantity;
    /** Whether the colour scale spans the whole run or the moment. */
    span: "run" | "moment" = "run";
    /** Factor on displacements. */
    magnify = 1;
    /** Whether the drawing moves with the base. */
    baseMoves = false;
    hover: Item | null = null;
    selected: Item[] = [];
    /** Frame with the largest displacement of a block, as far as frames show it. */
    readonly peakFrame: number;
    /** Whether the time is still the one at which the page opened. */
    private untouched = true;
    private readonly listeners: Record<Topic, (() => void)[]> = { frame: [], play: [], view: [], hover: [], selection: [] };
    private readonly peaks = new Map<Quantity, number>();

    constructor(readonly report: Report) {
        this.moment = new Moment(report);
        const when = report.frames.count > 0 ? "moment" : "peak";
        // Of a bonded wall the cracks at the end are asked for first, wherever the wall is shown.
        const cracks = quantitiesOf(report, "joint", "peak").find(isDamage);
        this.paint = cracks ?? quantitiesOf(report, "block", when)[0];
        const channel = report.channel("peak/displacement");
        const sizes = channel < 0 ? new Float64Array(1) : report.atFrames(channel);
        const largestAt = sizes.reduce((best, size, k) => (size > sizes[best] ? k : best), 0);
        this.peakFrame = report.contents.planar ? extent(report).frame : largestAt;
        // A wall at rest says nothing: the page opens at its largest displacement, and plays from the start.
        this.moment.frame = this.peakFrame;
    }

    on(topic: Topic, listener: () => void): void {
        this.listeners[topic].push(listener);
    }

    tell(topic: Topic): void {
        this.listeners[topic].forEach((listener) => listener());
    }

    get frame(): number {
        return this.moment.frame;
    }

    get time(): number {
        return this.report.frames.time[this.moment.frame] ?? 0;
    }

    /** Goes to a frame; beyond the ends, to the end. */
    go(frame: number): void {
        const last = this.report.frames.count - 1;
        this.untouched = false;
        const at = Math.max(0, Math.min(last, Math.round(frame)));
        if (at !== this.moment.frame && last >= 0) {
            this.moment.frame = at;
            this.tell("frame");
        }
    }

    goToTime(time: number): void {
        this.go(this.report.frames.nearest(time));
    }

    play(on: boolean): void {
        if (on && (this.untouched || this.frame >= this.report.frames.count - 1)) {
            this.go(0);
        }
        this.playing = on && this.report.frames.count > 1;
        this.tell("play");
    }

    setHover(item: Item | null): void {
        if (item?.owner !== this.hover?.owner || item?.index !== this.hover?.index) {
            this.hover = item;
            this.tell("hover");
        }
    }

    isSelected(item: Item): boolean {
        return this.selected.some((s) => s.owner === item.owner && s.index === item.index);
    }

    /** Selects an item, or lets it go; the oldest of its kind makes room. */
    toggle(item: Item): void {
        if (this.isSelected(item)) {
            this.selected = this.selected.filter((s) => s.owner !== item.owner || s.index !== item.index);
        } else {
            const of = this.selected.filter((s) => s.owner === item.owner);
            const oldest = of.length >= MOST_SELECTED ? of[0] : null;
            this.selected = [...this.selected.filter((s) => s !== oldest), item];
        }
        this.tell("selection");
    }

    of(owner: Owner): number[] {
        return this.selected.filter((s) => s.owner === owner).map((s) => s.index);
    }

    name(item: Item): string {
        const { block_names, joint_names } = this.report.contents;
        return item.owner === "block" ? block_names[item.index] : joint_names[item.index];
    }

    /** Colours for values of what is painted. */
    scale(values: ArrayLike<number>): Scale {
        if (isDamage(this.paint)) {
            return damageScale(largest(values));
        }
        const now = this.paint.when === "moment";
        // Joints open from nothing.
        const signed = now && this.paint.key !== "opening";
        if (now && this.span === "moment") {
            return scale(largest(values), signed);
        }
        let known = this.peaks.get(this.paint);
        if (known === undefined) {
            known = peak(this.report, this.paint);
            this.peaks.set(this.paint, known);
        }
        return scale(known, signed);
    }
}
