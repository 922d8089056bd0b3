/**
 * Reports of runs whose blocks rise and turn, made by hand of reports of shear runs: the page cannot tell them from those of
 * planar runs. `node browser/turned.mjs FROM TO` makes one for measurements.
 */

import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

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
    const [, , text] = page.match(/(id="concio-contents">)(.*?)<\/script>/s);
    const [, , digits] = page.match(/(id="concio-numbers">)(.*?)<\/script>/s);
    const contents = JSON.parse(text);
    const parts = [Buffer.from(digits.trim(), "base64")];
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
    const quantum = 2 ** -38;
    for (const name of ["vertical", "rotation"]) {
        const steps = Array.from({ length: frames * columns }, (_, k) => {
            const [frame, i] = [Math.floor(k / columns), k % columns];
            return i < blocks ? Math.round(motion(frame, frames, i)[name] / quantum) : 0;
        });
        add(`frame/${name}/quantum`, "f64", new Float64Array(frames).fill(quantum));
        add(`frame/${name}/low`, "u32", Uint32Array.from(steps, (s) => ((s % 2 ** 32) + 2 ** 32) % 2 ** 32));
        add(`frame/${name}/high`, "i8", Int8Array.from(steps, (s) => Math.floor(s / 2 ** 32)));
    }
    for (const name of ["slip", "opening", "pressure", "friction"]) {
        const value = (_, k) => touch(Math.floor(k / joints), frames, k % joints)[name];
        add(`frame/joint/${name}`, "f32", Float32Array.from({ length: frames * joints }, value));
    }
    contents.planar = true;
    mkdirSync(to, { recursive: true });
    const bytes = Buffer.concat(parts).toString("base64");
    const contentsText = JSON.stringify(contents).replaceAll("<", "\\u003c");
    const made = page.replace(text, () => contentsText).replace(digits, () => bytes);
    writeFileSync(join(to, "report.html"), made);
    return to;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    makeTurned(process.argv[2], process.argv[3]);
}
