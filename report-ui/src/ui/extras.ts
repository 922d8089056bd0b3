/** Buttons beside what can be copied or saved, and the choice between light and dark. */

import { h } from "../dom";
import { saveText } from "../save";
import { choice, choose } from "../theme";
import type { Choice } from "../theme";

const THEMES: [Choice, string][] = [["automatic", "as the system"], ["light", "light"], ["dark", "dark"]];

/** Light, dark, or what the system prefers, in the head of the page. */
export function themeChoice(page: Document): void {
    const options = THEMES.map(([value, text]) => h("option", { value, selected: value === choice() }, text));
    const select = h("select", { id: "theme", "onchange": (event) => choose((event.target as HTMLSelectElement).value as Choice) }, ...options);
    page.querySelector("header")?.prepend(h("label", { class: "field theme" }, h("span", {}, "appearance"), select));
}

/** Adds a button to copy to every quoted text, and one to save to the resolved input. */
export function addButtons(page: Document): void {
    for (const quoted of page.querySelectorAll<HTMLElement>("pre.copy")) {
        const bar = h("div", { class: "buttons" }, copyButton(quoted));
        if (quoted.id === "resolved") {
            bar.append(saveButton(quoted, "case.json"));
        }
        quoted.before(bar);
    }
}

function copyButton(quoted: HTMLElement): HTMLElement {
    const button = h("button", { type: "button", "onclick": async () => {
        const selection = window.getSelection();
        selection?.selectAllChildren(quoted);
        // The clipboard is closed to pages from files in some browsers: the text is selected in any case.
        const copied = await navigator.clipboard?.writeText(quoted.textContent ?? "").then(() => true, () => false);
        button.textContent = copied ? "copied" : "selected";
    } }, "copy");
    return button;
}

function saveButton(quoted: HTMLElement, name: string): HTMLElement {
    return h("button", { type: "button", "onclick": () => saveText(name, quoted.textContent ?? "", "application/json") }, `save as ${name}`);
}
