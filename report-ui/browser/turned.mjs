/**
 * Reports of runs whose blocks rise and turn, made by hand of reports of shear runs: the page cannot tell them from those of
 * planar runs. `node browser/turned.mjs FROM TO` makes one for measurements.
 */

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { deflateSync, inflateSync } from "node:zlib";

/** How far block i has risen [m] and turned, in rad, when a run of so many frames is at one of them. */
export function motion(frame, frames, i) {
    const part = frame / Math.max(1, frames - 1);
    return { vertical: 0.01 * part * (1 + (i % 3)), rotation: 0.3 * part * Math.cos(i) };
}

/** What a joint does then: slip and opening [m], normal and tangential force [N]. */
export function touch(frame, frames, e) {
    const part = frame / Math.max(1, frames - 1);
    return { slip: 1e-3 * part * Math.sin(e), opening: 2e-3 * part * (e % 4), pressure: 700 * (1 - part), friction: 300 * part * Math.sin(e) };
}

/** Writes into the folder `to` the report in `from` with blocks that rise and turn. */
export function makeTurned(from, to) {
    const page = readFileSync(join(from, "report.html"), "utf8");
    const [, , packed] = page.match(/(id="concio-data">)(.*?)<\/script>/s);
    // The length of the table of contents, that table, and from the next multiple of 8 on the numbers.
    const all = inflateSync(Buffer.from(packed.trim(), "base64"));
    const end = 8 + Number(all.readBigUInt64LE(0));
    const contents = JSON.parse(all.subarray(8, end).toString("utf8"));
    const parts = [all.subarray(Math.ceil(end / 8) * 8)];
    let length = parts[0].length;
    const add = (name, type, values) => {
        const pad = (8 - (length % 8)) % 8;
        const bytes = Buffer.from(values.buffer, values.byteOffset, values.byteLength);
        contents.arrays[name] = { type, at: length + pad, count: values.length };
        parts.push(Buffer.alloc(pad), bytes);
        length += pad + bytes.length;
    };
    const frames = contents.arrays["frame/time"].count;
    const [blocks, joints] = [contents.block_names.length, contents.joint_names.length];
    const columns = blocks + (contents.beam.moves ? 1 : 0);
    for (const name of ["vertical", "rotation"]) {
        const value = (_, k) => (k % columns < blocks ? motion(Math.floor(k / columns), frames, k % columns)[name] : 0);
        add(`frame/${name}`, "f64", Float64Array.from({ length: frames * columns }, value));
    }
    for (const name of ["slip", "opening", "pressure", "friction"]) {
        const value = (_, k) => touch(Math.floor(k / joints), frames, k % joints)[name];
        add(`frame/joint/${name}`, "f32", Float32Array.from({ length: frames * joints }, value));
    }
    contents.planar = true;
    mkdirSync(to, { recursive: true });
    const text = Buffer.from(JSON.stringify(contents), "utf8");
    const head = Buffer.alloc(8);
    head.writeBigUInt64LE(BigInt(text.length));
    const pad = Buffer.alloc((8 - (text.length % 8)) % 8);
    const made = deflateSync(Buffer.concat([head, text, pad, ...parts])).toString("base64");
    writeFileSync(join(to, "report.html"), page.replace(packed, () => made));
    return to;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    makeTurned(process.argv[2], process.argv[3]);
}
