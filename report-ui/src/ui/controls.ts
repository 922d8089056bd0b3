/** What the colours stand for, how much displacements are enlarged, whether the base moves. */

import { h } from "../dom";
import { count } from "../format";
import { fullLabel, quantitiesOf, QUANTITIES } from "../quantities";
import type { Store } from "../store";
import { rounded } from "../wall/view";
import type { Stage } from "./stage";

export function controls(store: Store, stage: Stage): HTMLElement {
    const element = h("div", { class: "controls" });
    element.append(field("colour by", paintChoice(store)));
    if (store.report.frames.count > 0) {
        element.append(field("colour scale", spanChoice(store)), field("displacements", factorChoice(store, stage)));
        if (stage.baseFactor > 0) {
            element.append(baseChoice(store, stage));
        }
    }
    return element;
}

function field(label: string, control: HTMLElement): HTMLElement {
    return h("label", { class: "field" }, h("span", {}, label), control);
}

function paintChoice(store: Store): HTMLElement {
    const groups = (["moment", "peak"] as const).flatMap((when) =>
        (["block", "joint"] as const).map((owner) => {
            const label = `${owner === "block" ? "Blocks" : "Joints"}, ${when === "moment" ? "at the moment" : "peak over the run"}`;
            const options = quantitiesOf(store.report, owner, when).map((q) =>
                h("option", { value: QUANTITIES.indexOf(q), selected: q === store.paint }, fullLabel(q)),
            );
            return { when, group: h("optgroup", { label }, ...options) };
        }),
    );
    const shown = groups.filter(({ when }) => when === "peak" || store.report.frames.count > 0);
    return h("select", { id: "paint", "onchange": (event) => {
        store.paint = QUANTITIES[Number((event.target as HTMLSelectElement).value)];
        store.tell("view");
    } }, ...shown.map(({ group }) => group));
}

function spanChoice(store: Store): HTMLElement {
    return h("select", { "onchange": (event) => {
        store.span = (event.target as HTMLSelectElement).value as "run" | "moment";
        store.tell("view");
    } }, h("option", { value: "run" }, "peak of the run"), h("option", { value: "moment" }, "peak of the moment"));
}

function factorChoice(store: Store, stage: Stage): HTMLElement {
    const { automatic } = stage;
    const others = [1];
    for (let factor = Math.max(1, automatic / 100); factor <= automatic * 101; factor = rounded(factor * 2.51)) {
        others.push(rounded(factor));
    }
    const options = [...new Set(others)].sort((a, b) => a - b).map((f) =>
        h("option", { value: f }, f === 1 ? "× 1 (as they are)" : `× ${count(f)}`),
    );
    return h("select", { id: "factor", "onchange": (event) => {
        store.magnify = Number((event.target as HTMLSelectElement).value);
        store.tell("view");
    } }, h("option", { value: automatic, selected: true }, `automatic: × ${count(automatic)}`), ...options);
}

function baseChoice(store: Store, stage: Stage): HTMLElement {
    const box = h("input", { type: "checkbox", "onchange": (event) => {
        store.baseMoves = (event.target as HTMLInputElement).checked;
        store.tell("view");
    } });
    const factor = stage.baseFactor >= 1 ? `× ${count(stage.baseFactor)}` : `× 1/${count(Math.round(1 / stage.baseFactor))}`;
    return h("label", { class: "field check" }, box, h("span", {}, `show the motion of the base (${factor})`));
}
