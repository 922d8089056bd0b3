/** The bar below the wall: colours and what they stand for. */

import type { Scale } from "../colour";
import { h, setText } from "../dom";
import { short, si, unitText } from "../format";
import { isDamage } from "../quantities";
import type { Store } from "../store";

/** What the colours stand for, with numbers at both ends. */
export class ColourBar {
    readonly element = h("div", { class: "colour-bar" });
    private readonly title = h("span", { class: "what" });
    private readonly strip = h("span", { class: "strip" });
    private readonly span: HTMLElement;
    /** In place of numbers when there is nothing to tell apart. */
    private readonly nothing = h("span", { class: "nothing" });
    private readonly note = h("span", { class: "impacts" });
    private readonly ends = [h("span"), h("span"), h("span")];
    private readonly peak = h("span", { class: "largest" });

    constructor() {
        const marks = h("span", { class: "marks" }, ...this.ends);
        this.span = h("span", { class: "scale" }, this.strip, marks);
        this.element.append(this.title, this.span, this.peak, this.nothing, this.note);
    }

    show(store: Store, scale: Scale): void {
        const { paint } = store;
        const when = whenText(store);
        setText(this.title, paint.owner === "block"
            ? `${paint.label} of the blocks relative to the base, ${when}` : `${paint.label} of the joints, ${when}`);
        this.span.hidden = scale.zero;
        this.nothing.hidden = !scale.zero;
        setText(this.nothing, nothing(store));
        const impacts = paint.owner === "joint" && paint.key === "acceleration" && !scale.zero;
        this.note.hidden = !impacts;
        setText(this.note, impacts ? IMPACTS : "");
        this.strip.style.backgroundImage = `linear-gradient(to right, ${scale.stops.join(",")})`;
        barMarks(store, scale).forEach((mark, k) => setText(this.ends[k], mark));
        this.peak.hidden = scale.zero;
        setText(this.peak, largestText(store, scale));
    }
}

/** Of which instant the colours are. */
export function whenText({ paint }: Store): string {
    const over = isDamage(paint) ? "at the end of the run" : "peak over the run";
    return paint.when === "peak" ? over : "at the moment";
}

/** What stands below the ends and the middle of the bar. */
export function barMarks({ paint }: Store, scale: Scale): string[] {
    if (isDamage(paint)) {
        return ["0 intact", "0.5", "1 broken"];
    }
    return [scale.low, 0.5 * (scale.low + scale.high), scale.high].map((value) => (value === 0 ? "0" : short(value, unitText(paint.unit))));
}

/** What the ends are rounded from, or how many bonds have given way. */
export function largestText(store: Store, scale: Scale): string {
    if (!isDamage(store.paint)) {
        return `largest ${si(scale.largest, unitText(store.paint.unit), 3)}`;
    }
    const values = Array.from(store.moment.values(store.paint)).filter((v) => !Number.isNaN(v));
    const count = (is: (v: number) => boolean) => values.filter(is).length;
    const all = values.length < store.report.joints ? "; white: not bonded" : "";
    return `${count((v) => v > 0)} of ${values.length} bonds cracked, ${count((v) => v === 1)} broken${all}`;
}

const IMPACTS = "Peaks are impacts in head joints: they go about with √κ, the root of the joints’ penalty stiffness. Compare places, not sizes.";

function nothing({ paint, span }: Store): string {
    if (isDamage(paint)) {
        return paint.when === "moment" ? "no joint has cracked yet" : "no joint cracked";
    }
    if (paint.key === "slip") {
        return "no joint slipped";
    }
    return paint.when === "moment" && span === "moment" ? "zero everywhere at this moment" : "zero everywhere";
}
