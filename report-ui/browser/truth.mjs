/** Results as the program itself exports them: tables that know nothing of the page. */

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const ROOT = join(dirname(fileURLToPath(import.meta.url)), "..", "..");
const CONCIO = process.env.CONCIO ?? join(ROOT, "target", "release", "concio");

/** A folder for runs, gone when `remove` is called. */
export function desk() {
    const folder = mkdtempSync(join(tmpdir(), "concio-report-"));
    return { folder, remove: () => rmSync(folder, { recursive: true, force: true }) };
}

export function concio(folder, ...words) {
    return execFileSync(CONCIO, words, { cwd: folder, stdio: ["ignore", "pipe", "pipe"], encoding: "utf8" });
}

/** Runs a wall file of that text; the folder with the results. */
export function run(folder, name, text) {
    writeFileSync(join(folder, `${name}.toml`), text);
    concio(folder, "run", `${name}.toml`, "--out", name);
    return join(folder, name);
}

export function example(name) {
    return wall(`examples/${name}`);
}

/** A wall file of the project, by its place in it. */
export function wall(place) {
    return readFileSync(join(ROOT, `${place}.toml`), "utf8");
}

/** All that a run keeps: histories of every block and joint, and the peaks. */
export function read(results) {
    concio(results, "export", ".", "--csv");
    const table = (name) => parse(readFileSync(join(results, "csv", `${name}.csv`), "utf8"));
    return {
        histories: table("histories"),
        peaks: { block: byName(table("block_envelopes")), joint: byName(table("joint_envelopes")) },
        blocks: byName(table("blocks")),
        joints: byName(table("joints")),
        summary: JSON.parse(readFileSync(join(results, "summary.json"), "utf8")),
    };
}

/** Columns by their names without units. */
function parse(text) {
    const [head, ...rows] = text.trimEnd().split(/\r?\n/).map(cells);
    const columns = {};
    head.forEach((title, k) => {
        columns[title.replace(/ \[[^\]]*\]$/, "")] = rows.map((row) => row[k]);
    });
    return columns;
}

function cells(line) {
    return [...line.matchAll(/(?:^|,)(?:"((?:[^"]|"")*)"|([^,]*))/g)].map((m) => m[1]?.replace(/""/g, '"') ?? m[2]);
}

function byName(columns) {
    const names = columns.name ?? columns.block ?? columns.joint;
    return new Map(names.map((name, k) => [name, Object.fromEntries(Object.entries(columns).map(([c, v]) => [c, v[k]]))]));
}
