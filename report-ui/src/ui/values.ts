/** The numbers of a block or joint: at the moment and at their peaks. */

import type { Bond } from "../data";
import { h, setText } from "../dom";
import { si, significant, unitText } from "../format";
import { isDamage, peakKey, quantitiesOf } from "../quantities";
import type { Quantity } from "../quantities";
import type { Item, Store } from "../store";

/** A number on the page and where it comes from. */
export interface Cell {
    element: HTMLDataElement;
    value: () => number;
    unit: string;
}

/** Brings numbers up to date. */
export function fill(cells: Cell[]): void {
    for (const { element, value, unit } of cells) {
        const now = value();
        element.value = String(now);
        setText(element, si(now, unit));
    }
}

/** One row per quantity: at the moment, peak. */
export function valueTable(store: Store, item: Item): { table: HTMLTableElement; cells: Cell[] } {
    const cells: Cell[] = [];
    const cell = (q: Quantity | undefined) => {
        if (q === undefined) {
            return h("td", {}, "");
        }
        const element = h("data", { "data-key": `${q.when}/${q.key}` });
        cells.push({ element, value: () => store.moment.value(q, item.index), unit: unitText(q.unit) });
        return h("td", {}, element);
    };
    const { report } = store;
    const peaks = quantitiesOf(report, item.owner, "peak").filter((q) => applies(store, item, q));
    const now = report.frames.count > 0 ? quantitiesOf(report, item.owner, "moment").filter((q) => !isDamage(q) || applies(store, item, q)) : [];
    const peakOf = (q: Quantity) => peaks.find((p) => p.key === peakKey(q));
    const paired = now.map((q) => [q, peakOf(q)] as const);
    const single = peaks.filter((p) => !paired.some(([, peak]) => peak === p)).map((p) => [undefined, p] as const);
    const rows = [...paired, ...single].map(([q, p]) => {
        const label = q?.label ?? p?.label ?? "";
        return h("tr", {}, h("th", { scope: "row" }, label), cell(q), cell(p));
    });
    const measured = item.owner === "block" ? h("th", { class: "against" }, "relative to the base") : h("td");
    const head = h("tr", {}, measured, h("th", { scope: "col" }, "now"), h("th", { scope: "col" }, "peak"));
    fill(cells);
    return { table: h("table", { class: "values" }, h("thead", {}, head), h("tbody", {}, ...rows)), cells };
}

/** Opening and closing are of head joints and connections, but where blocks rise and turn; slip of joints that rub. */
function applies(store: Store, item: Item, q: Quantity): boolean {
    const { upright, friction } = store.report.joint;
    if (isDamage(q)) {
        return store.report.bond[item.index] >= 0;
    }
    if (item.owner === "joint" && (q.key === "opening" || q.key === "closing")) {
        return upright[item.index] || store.report.contents.planar;
    }
    return item.owner === "block" || q.key !== "slip" || friction[item.index] >= 0;
}

/** What a block or joint is, in a few words. */
export function facts(store: Store, { owner, index }: Item): string {
    const { report } = store;
    if (owner === "block") {
        const { x0, x1, y0, y1, mass } = report.block;
        const size = `${si(x1[index] - x0[index], "m", 3)} × ${si(y1[index] - y0[index], "m", 3)}`;
        return `block, ${size}, ${si(mass[index] * 1000, "g", 3)}`;
    }
    const { stiffness, normal, friction, overlap } = report.joint;
    const { joint_kinds, joint_laws, frictions } = report.contents;
    const law = frictions[friction[index]];
    const parts = [
        `${joint_kinds[index]} joint of ${si(overlap[index], "m", 3)}`,
        report.contents.planar && stiffness[index] === 0 ? joint_laws[index] : `${joint_laws[index]}, ${si(stiffness[index], "N/m", 3)}`,
    ];
    if (law !== undefined) {
        parts.push(`N = ${si(normal[index], "N", 3)}, μs = ${law.static}, μd = ${law.dynamic}`);
    }
    const bond = report.contents.bonds[String(index)];
    if (bond !== undefined) {
        parts.push(bondText(bond));
    }
    return parts.join("; ");
}

/** What held a joint and what became of it. */
export function bondText(bond: Bond): string {
    const held = `bond of ${si(bond.strength, "N", 3)}`;
    if (bond.cracked === null) {
        return `${held}, intact`;
    }
    const cracked = `cracked at ${significant(bond.cracked, 4)} s`;
    const left = bond.broken === null ? `damage ${significant(bond.damage, 3)} at the end` : `broken at ${significant(bond.broken, 4)} s`;
    return `${held}, ${cracked}, ${left}, ${si(bond.spent, "J", 3)} taken`;
}
