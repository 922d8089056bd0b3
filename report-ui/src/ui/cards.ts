/** What is selected: name, kind, numbers at the moment and peaks. */

import { h, swatch } from "../dom";
import type { Item, Store } from "../store";
import { facts, fill, valueTable } from "./values";
import type { Cell } from "./values";

export class Cards {
    readonly element = h("div", { class: "cards" });
    private cells: Cell[] = [];

    constructor(private readonly store: Store) {
        store.on("selection", () => this.render());
        store.on("frame", () => fill(this.cells));
        this.render();
    }

    private render(): void {
        this.cells = [];
        const cards = this.store.selected.map((item) => this.card(item));
        const empty = h("p", { class: "empty" }, "Nothing is selected. Click blocks and joints of the wall, or choose them in the list.");
        this.element.replaceChildren(...(cards.length > 0 ? cards.reverse() : [empty]));
    }

    private card(item: Item): HTMLElement {
        const { store } = this;
        const line = store.of(item.owner).indexOf(item.index);
        const { table, cells } = valueTable(store, item);
        this.cells.push(...cells);
        const name = store.name(item);
        const remove = h("button", { type: "button", class: "remove", "aria-label": `Remove ${name}`, title: "Remove", "onclick": () => store.toggle(item) }, "×");
        const head = h("header", {}, swatch(line), h("strong", {}, name), remove);
        return h("article", { "data-item": `${item.owner}/${name}` }, head, h("p", { class: "small" }, facts(store, item)), table);
    }
}
