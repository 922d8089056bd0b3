/** Files that the reader saves: tables and pictures. A page from a folder may do that too, because nothing is fetched. */

import { h } from "./dom";

/** A column of a table: its name with the unit, `time [s]`. */
export interface Column {
    head: string;
    values: ArrayLike<number>;
}

/** `displacement [m]`; numbers without unit have none. */
export function headed(name: string, unit: string): string {
    return unit === "" ? name : `${name} [${unit}]`;
}

/** Comma-separated values: one header line, numbers with a point and a hyphen, nothing where there is none. */
export function csv(columns: Column[]): string {
    const rows = Math.max(0, ...columns.map((c) => c.values.length));
    const lines = [columns.map((c) => quoted(c.head)).join(",")];
    for (let k = 0; k < rows; k++) {
        lines.push(columns.map((c) => (k < c.values.length ? written(c.values[k], c.values instanceof Float32Array) : "")).join(","));
    }
    return `${lines.join("\r\n")}\r\n`;
}

function written(value: number, single: boolean): string {
    // Of 32-bit floats the digits that they have; of two zeros neither has a sign.
    return Number.isFinite(value) ? String((single ? Number(value.toPrecision(8)) : value) + 0) : "";
}

function quoted(name: string): string {
    // Spreadsheets would take such a name for a formula.
    const text = /^[=+\-@\t\r]/.test(name) ? `'${name}` : name;
    return /[",\r\n]/.test(text) ? `"${text.replace(/"/g, '""')}"` : text;
}

/** A name for a file: letters, digits and hyphens. */
export function fileName(...parts: string[]): string {
    const slug = (text: string) => text.toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "");
    return parts.map(slug).filter((part) => part !== "").join("-");
}

export function save(name: string, content: Blob): void {
    const link = h("a", { href: URL.createObjectURL(content), download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export function saveText(name: string, text: string, type: string): void {
    save(name, new Blob([text], { type: `${type};charset=utf-8` }));
}

export async function savePicture(name: string, canvas: HTMLCanvasElement): Promise<void> {
    const content = await new Promise<Blob | null>((done) => canvas.toBlob(done, "image/png"));
    if (content !== null) {
        save(name, content);
    }
}
