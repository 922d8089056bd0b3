/** All blocks and joints in a list with a search, for the keyboard and for large walls. */

import { h } from "../dom";
import { count } from "../format";
import type { Item, Store } from "../store";

/** Entries that are shown at once. */
const MOST_SHOWN = 60;

export class Picker {
    readonly element = h("div", { class: "picker" });
    private readonly list = h("ul", { role: "listbox", tabindex: 0, "aria-multiselectable": "true", "aria-label": "Blocks and joints" });
    private readonly more = h("p", { class: "small", role: "status" });
    private readonly search: HTMLInputElement;
    private shown: Item[] = [];
    private active = 0;

    constructor(private readonly store: Store) {
        this.search = h("input", { type: "search", placeholder: "name or kind: p1c2b1, head, base …", "aria-label": "Search blocks and joints" });
        this.search.addEventListener("input", () => this.find());
        this.search.addEventListener("keydown", (event) => {
            if (event.key === "ArrowDown" || event.key === "Enter") {
                this.list.focus();
                event.preventDefault();
            }
        });
        this.list.addEventListener("keydown", (event) => this.key(event));
        this.list.addEventListener("click", (event) => {
            const at = [...this.list.children].indexOf((event.target as HTMLElement).closest("li") as HTMLElement);
            if (at >= 0) {
                this.active = at;
                store.toggle(this.shown[at]);
            }
        });
        this.element.append(this.search, this.list, this.more);
        store.on("selection", () => this.render());
        this.find();
    }

    private find(): void {
        const words = this.search.value.toLowerCase().split(/\s+/).filter((word) => word !== "");
        const { block_names, joint_names, joint_kinds } = this.store.report.contents;
        const fits = (text: string) => words.every((word) => text.includes(word));
        const found: Item[] = [];
        block_names.forEach((name, index) => fits(`block ${name}`.toLowerCase()) && found.push({ owner: "block", index }));
        joint_names.forEach((name, index) =>
            fits(`joint ${joint_kinds[index]} ${name}`.toLowerCase()) && found.push({ owner: "joint", index }),
        );
        this.shown = found.slice(0, MOST_SHOWN);
        this.active = 0;
        const left = found.length - this.shown.length;
        this.more.textContent = found.length === 0 ? "Nothing bears that name." : left > 0 ? `${count(left)} more: type to narrow the list.` : "";
        this.render();
    }

    private render(): void {
        const { joint_kinds } = this.store.report.contents;
        this.list.replaceChildren(...this.shown.map((item, k) => {
            const kind = item.owner === "block" ? "block" : `${joint_kinds[item.index]} joint`;
            const chosen = String(this.store.isSelected(item));
            const name = h("span", { class: "name" }, this.store.name(item));
            return h("li", { role: "option", id: `option-${k}`, "aria-selected": chosen, class: k === this.active ? "active" : "" }, name, h("span", { class: "kind" }, kind));
        }));
        this.list.setAttribute("aria-activedescendant", this.shown.length > 0 ? `option-${this.active}` : "");
    }

    private key(event: KeyboardEvent): void {
        const last = this.shown.length - 1;
        const moves: Record<string, number> = { ArrowDown: this.active + 1, ArrowUp: this.active - 1, Home: 0, End: last };
        if (event.key in moves) {
            this.active = Math.max(0, Math.min(last, moves[event.key]));
            this.render();
            this.list.children[this.active]?.scrollIntoView({ block: "nearest" });
            this.store.setHover(this.shown[this.active] ?? null);
        } else if ((event.key === "Enter" || event.key === " ") && this.shown.length > 0) {
            this.store.toggle(this.shown[this.active]);
        } else {
            return;
        }
        event.preventDefault();
    }
}
