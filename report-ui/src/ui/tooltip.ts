/** Name and numbers of the block or joint under the pointer. */

import { h } from "../dom";
import type { Item, Store } from "../store";
import { fill, valueTable } from "./values";
import type { Cell } from "./values";

export class Tooltip {
    readonly element = h("div", { class: "tooltip", role: "tooltip", hidden: true });
    /** Where the pointer is on the canvas, and how wide that is [px]. */
    at: [number, number, number] = [0, 0, 0];
    private cells: Cell[] = [];

    constructor(private readonly store: Store) {
        store.on("hover", () => this.show(store.hover));
        store.on("frame", () => fill(this.cells));
    }

    private show(item: Item | null): void {
        this.element.hidden = item === null;
        this.cells = [];
        if (item === null) {
            return;
        }
        const { table, cells } = valueTable(this.store, item);
        this.cells = cells;
        this.element.replaceChildren(h("strong", {}, this.store.name(item)), table);
        this.place();
    }

    /** Beside the pointer, inside the canvas. */
    place(): void {
        const [x, y, width] = this.at;
        const [own, gap] = [this.element.offsetWidth, 14];
        const left = x + gap + own <= width ? x + gap : Math.max(0, x - gap - own);
        this.element.style.transform = `translate(${left.toFixed(0)}px,${(y + gap).toFixed(0)}px)`;
    }
}
