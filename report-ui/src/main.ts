/** The interactive report: reads the data of the page and puts the wall, its controls and its plots into it. */

import "uplot/dist/uPlot.min.css";
import "./style.css";
import { readPage } from "./data";
import { h } from "./dom";
import { ordinal, power } from "./format";
import { firstItems } from "./first";
import { followPrinting } from "./layout";
import { Store } from "./store";
import { followTheme } from "./theme";
import { Cards } from "./ui/cards";
import { controls } from "./ui/controls";
import { addButtons, themeChoice } from "./ui/extras";
import { overview } from "./ui/overview";
import { Picker } from "./ui/picker";
import { Player } from "./ui/player";
import { Response } from "./ui/response";
import { Stage } from "./ui/stage";

function frameNote(store: Store): string {
    const { recorded, every, rounded } = store.report.contents.frames;
    if (recorded === 0) {
        return "This run kept no frames, so there is no motion to show: set output.frames in the wall file. Colours show peaks.";
    }
    const [blocks, joints] = (rounded ?? [0, 0]).map(power);
    const parts = [
        ...(every === 1 ? [] : [`holds every ${ordinal(every)} of ${recorded} frames`]),
        ...(rounded === null ? [] : [`rounds what it shows at a frame, of blocks to ${blocks} of their largest and of joints to ${joints}`]),
    ];
    return parts.length === 0 ? "" : `To stay below 8 MB this page ${parts.join(" and ")}; result.h5 has all. Peaks are those of all steps.`;
}

async function build(host: HTMLElement): Promise<void> {
    followPrinting();
    followTheme();
    themeChoice(document);
    const store = new Store(await readPage(document));
    const stage = new Stage(store);
    const moving = store.report.frames.count > 0;
    firstItems(store.report).forEach((item) => store.toggle(item));
    const note = frameNote(store);
    const left = h("div", { class: "left" }, stage.element, ...(moving ? [new Player(store).element] : []), controls(store, stage));
    if (note !== "") {
        left.append(h("p", { class: "small" }, note));
    }
    const find = h("details", { class: "find" }, h("summary", {}, "Choose blocks and joints from a list"), new Picker(store).element);
    const right = h("div", { class: "right" }, find, new Cards(store).element);
    const wall = h("section", { id: "wall" }, h("h2", {}, "The wall"), h("div", { class: stage.wide ? "columns wide" : "columns" }, left, right));
    host.append(wall);
    const [whole, ...rest] = overview(store);
    host.append(whole);
    let span = () => 0;
    if (moving) {
        const responses = (["block", "joint"] as const).map((owner) => new Response(store, owner));
        const hint = "A click in a plot moves the time; dragging with Shift enlarges a stretch of time, a double click shows all again.";
        const head = [h("h2", {}, "What is selected, over time"), h("p", { class: "small" }, hint)];
        host.append(h("section", { id: "selected" }, ...head, ...responses.map((r) => r.element)));
        responses.forEach((response) => response.render());
        span = () => responses[0].span;
    }
    host.append(...rest);
    addButtons(document);
    // For measurements of the time a picture takes, and for tests.
    Object.assign(window, { concioReport: { store, stage, span } });
}

const host = document.getElementById("app");
if (host !== null) {
    build(host).catch((error: unknown) => {
        host.replaceChildren(h("p", { class: "note bad" }, `The interactive part of this report cannot be shown: ${String(error)}`));
        throw error;
    });
}
