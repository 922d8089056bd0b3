/** Histories and phase portraits of what is selected. */

import { h } from "../dom";
import { unitText } from "../format";
import { coarseness } from "../coarse";
import { PhasePlot } from "../plots/phase";
import { TimePlot } from "../plots/time";
import { history, quantitiesOf } from "../quantities";
import type { Owner, Quantity } from "../quantities";
import type { Store } from "../store";

/** The two plots of the selected blocks, or of the selected joints. */
export class Response {
    readonly element = h("div", { class: "response" });
    private readonly plots = h("div", { class: "pair" });
    private readonly empty: HTMLElement;
    private readonly note: HTMLElement;
    private readonly time: TimePlot;
    private readonly phase: PhasePlot;
    private readonly quantities: Quantity[];
    private shown: Quantity;
    /** What the phase portrait has upright: a quantity of the owner. */
    private upright: Quantity;

    constructor(private readonly store: Store, private readonly owner: Owner) {
        this.quantities = quantitiesOf(store.report, owner, "moment");
        [this.shown, this.upright] = this.quantities;
        if (store.report.contents.planar && owner === "joint") {
            // Frames hold no velocities of joints there: force over slip says more than opening over slip.
            this.upright = this.quantities.find((q) => q.key === "friction") ?? this.upright;
        }
        const name = owner === "block" ? "blocks" : "joints";
        const against = owner === "block" ? ", relative to the base" : "";
        this.time = new TimePlot(store, `Selected ${name}${against}`, 230);
        this.phase = new PhasePlot(store, `Phase portrait of the ${name}${against}`, 230);
        this.empty = h("p", { class: "empty" }, `No ${owner} is selected.`);
        this.note = h("p", { class: "small frames" }, coarseness(store.report));
        const heading = h("h3", {}, owner === "block" ? "Blocks" : "Joints");
        const choices = h("div", { class: "controls" },
            this.choice("history of", this.quantities, this.shown, (q) => (this.shown = q)),
            this.choice("phase portrait", this.quantities.slice(1), this.upright, (q) => (this.upright = q)),
        );
        this.plots.append(this.time.panel.element, this.phase.panel.element);
        this.element.append(h("div", { class: "bar" }, heading, choices), this.plots, this.note, this.empty);
        store.on("selection", () => this.render());
    }

    private choice(label: string, list: Quantity[], chosen: Quantity, set: (q: Quantity) => void): HTMLElement {
        const options = list.map((q, k) => h("option", { value: k, selected: q === chosen }, q.label));
        const select = h("select", { "data-choice": `${this.owner}/${label}`, "onchange": (event) => {
            set(list[Number((event.target as HTMLSelectElement).value)]);
            this.render();
        } }, ...options);
        return h("label", { class: "field" }, h("span", {}, label), select);
    }

    /** Length of time that the histories show [s]. */
    get span(): number {
        return this.time.span;
    }

    render(): void {
        const { store, owner } = this;
        const members = store.of(owner);
        this.plots.hidden = members.length === 0;
        this.note.hidden = this.plots.hidden;
        this.empty.hidden = members.length > 0;
        if (members.length === 0) {
            return;
        }
        const { report } = store;
        const of = (q: Quantity) => members.map((index) => history(report, q, index));
        const named = members.map((index, k) => ({ name: store.name({ owner, index }), line: k }));
        const values = of(this.shown);
        const curves = named.map((line, k) => ({ ...line, values: values[k], now: () => values[k][store.frame] }));
        this.time.show(this.shown.label, unitText(this.shown.unit), report.frames.time, curves);
        const [x, y] = [of(this.quantities[0]), of(this.upright)];
        const axes = [this.quantities[0], this.upright].map((q): [string, string] => [q.label, unitText(q.unit)]);
        this.phase.show(axes[0], axes[1], named.map((line, k) => ({ ...line, x: x[k], y: y[k] })));
    }
}
