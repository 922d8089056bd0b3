/** Elements in one line each. */

import { DASHES } from "./colour";

type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;

/** An element: attributes as they are, `on…` functions as listeners, `text` as its content. */
export function h<K extends keyof HTMLElementTagNameMap>(
    tag: K,
    attributes: Attributes = {},
    ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (typeof value === "function") {
            element.addEventListener(name.slice(2), value);
        } else if (typeof value === "boolean") {
            element.toggleAttribute(name, value);
        } else {
            element.setAttribute(name, String(value));
        }
    }
    element.append(...children);
    return element;
}

const SVG = "http://www.w3.org/2000/svg";

/** A piece of the line of that number, which a curve is drawn with. */
export function swatch(number: number, width = 2): SVGSVGElement {
    const svg = document.createElementNS(SVG, "svg");
    svg.setAttribute("width", "26");
    svg.setAttribute("height", "10");
    svg.setAttribute("aria-hidden", "true");
    svg.setAttribute("class", "swatch");
    const line = document.createElementNS(SVG, "path");
    line.setAttribute("d", "M0 5H26");
    line.setAttribute("style", `stroke:var(--line-${number % DASHES.length})`);
    line.setAttribute("stroke-width", String(width));
    line.setAttribute("stroke-dasharray", DASHES[number % DASHES.length].join(" "));
    svg.append(line);
    return svg;
}

/** Changes a text only when it differs: layout costs more than a comparison. */
export function setText(element: Element, text: string): void {
    if (element.textContent !== text) {
        element.textContent = text;
    }
}
