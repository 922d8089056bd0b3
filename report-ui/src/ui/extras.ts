/** Buttons beside what can be copied or saved. */

import { h } from "../dom";

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
    return h("button", { type: "button", "onclick": () => {
        const link = h("a", { href: URL.createObjectURL(new Blob([quoted.textContent ?? ""], { type: "application/json" })), download: name });
        link.click();
        setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    } }, `save as ${name}`);
}
