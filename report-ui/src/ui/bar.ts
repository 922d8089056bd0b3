/** The bar below the wall: colours and what they stand for. */

import type { Scale } from "../colour";
import { h, setText } from "../dom";
import { si, unitText } from "../format";
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

    constructor() {
        const marks = h("span", { class: "marks" }, ...this.ends);
        this.span = h("span", { class: "scale" }, this.strip, marks);
        this.element.append(this.title, this.span, this.nothing, this.note);
    }

    show(store: Store, scale: Scale): void {
        const { paint } = store;
        const when = paint.when === "peak" ? "peak over the run" : "at the moment";
        setText(this.title, paint.owner === "block"
            ? `${paint.label} of the blocks relative to the base, ${when}` : `${paint.label} of the joints, ${when}`);
        this.span.hidden = scale.zero;
        this.nothing.hidden = !scale.zero;
        setText(this.nothing, nothing(store));
        const impacts = paint.owner === "joint" && paint.key === "acceleration" && !scale.zero;
        this.note.hidden = !impacts;
        setText(this.note, impacts ? IMPACTS : "");
        this.strip.style.backgroundImage = `linear-gradient(to right, ${scale.stops.join(",")})`;
        [scale.low, 0.5 * (scale.low + scale.high), scale.high].forEach((value, k) =>
            setText(this.ends[k], value === 0 ? "0" : si(value, unitText(paint.unit), 3)),
        );
    }
}

const IMPACTS = "Peaks are impacts in head joints: they go about with √κ, the root of the joints’ penalty stiffness. Compare places, not sizes.";

function nothing({ paint, span }: Store): string {
    if (paint.key === "slip") {
        return "no joint slipped";
    }
    return paint.when === "moment" && span === "moment" ? "zero everywhere at this moment" : "zero everywhere";
}
