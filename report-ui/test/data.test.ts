import { deflateSync } from "node:zlib";
import { expect, test } from "vitest";
import { decode } from "../src/base64";
import { LAYOUT, open } from "../src/data";
import { inflate } from "../src/inflate";
import { readTable } from "../src/tables";
import type { Table } from "../src/tables";
import { automaticScale, rounded, View } from "../src/wall/view";
import { made, MOTION } from "./made";

test("base64 of every length", () => {
    for (let length = 0; length < 40; length++) {
        const bytes = Uint8Array.from({ length }, (_, k) => (k * 71 + 250) % 256);
        expect(decode(Buffer.from(bytes).toString("base64"))).toEqual(bytes);
    }
    expect(() => decode("abc")).toThrow("cut off");
});

test("frames are read whole, one by one, and over time", () => {
    const { frames } = made();
    const row = new Float64Array(3);
    frames.read("displacement", 1, row);
    row.forEach((value, i) => {
        expect(value).toBe(MOTION[1][i]);
        expect(frames.value("displacement", 1, i)).toBe(value);
    });
    expect(frames.value("displacement", 2, 2)).toBeNaN();
    expect(frames.value("velocity", 2, 1)).toBeCloseTo(-2e-2, 9);
    expect(frames.value("displacement", 1, -1)).toBe(0);
    expect([...frames.history("displacement", 0)].map((v) => v.toFixed(6))).toEqual(["0.000000", "0.004999", "-0.001000"]);
});

/** A table as pack.rs writes it, of whole numbers row by row. */
function written(rows: number[][], from: Table["from"], more: Partial<Table> = {}): [Table, Uint8Array] {
    const [height, width] = [rows.length, rows[0].length];
    const at = (r: number, c: number) => BigInt(rows[r]?.[c] ?? 0);
    const told = Array.from({ length: width * height }, (_, k) => {
        const [c, r] = [Math.floor(k / height), k % height];
        const foretold = { nothing: 0n, above: at(r - 1, c), left: at(r, c - 1), both: at(r - 1, c) + at(r, c - 1) - at(r - 1, c - 1) }[from];
        const apart = at(r, c) - foretold;
        return apart < 0n ? -2n * apart - 1n : 2n * apart;
    });
    const planes = 6;
    const bytes = Uint8Array.from({ length: planes * told.length }, (_, k) => Number((told[k % told.length] >> BigInt(8 * Math.floor(k / told.length))) & 255n));
    return [{ type: "steps", at: 0, rows: height, columns: width, planes, from, bits: 40, ...more }, bytes];
}

test("tables come back however their numbers are foretold", () => {
    const rows = [[1, -2, 3], [2 ** 38, -(2 ** 38), 7], [-5, 0, 2 ** 31]];
    for (const from of ["nothing", "above", "left", "both"] as const) {
        expect([...readTable(...written(rows, from), () => Int32Array.from([-16]))]).toEqual(rows.flat().map((v) => v / 4));
        // A step of its own for every column: 1, √2, 2.
        const own = [...readTable(...written(rows, from), () => Int32Array.from([0, 4, 8]))];
        rows.flat().forEach((v, k) => expect(own[k]).toBeCloseTo(v * 2 ** (0.5 * (k % 3)), 3));
    }
    expect(readTable(...written([[-(2 ** 39), 1]], "left"), () => Int32Array.from([0]))).toEqual(Float64Array.from([NaN, 1]));
});

test("floats come back to the bit, whatever their signs", () => {
    const values = Float32Array.from([0, 1.5, -1.5, 3e38, -1e-45, NaN, -Infinity]);
    const bits = [...new Uint32Array(values.buffer)].map((b) => (b >= 2 ** 31 ? -(b - 2 ** 31) : b));
    expect(readTable(...written([bits], "left", { type: "floats", bits: 32 }), () => new Int32Array(0))).toEqual(values);
});

test("data are inflated: the table of contents first, the numbers from a multiple of 8 on", async () => {
    const { contents } = made();
    const text = new TextEncoder().encode(JSON.stringify({ ...contents, arrays: {}, block_names: [], joint_names: [], joint_kinds: [], joint_laws: [] }));
    const head = new Uint8Array(8);
    new DataView(head.buffer).setBigUint64(0, BigInt(text.length), true);
    const bytes = Buffer.concat([head, text]);
    expect(() => open(Uint8Array.from(bytes).buffer)).toThrow("lack block/x0");
    const inflated = await inflate(Uint8Array.from(deflateSync(bytes)));
    expect(new Uint8Array(inflated)).toEqual(Uint8Array.from(bytes));
    expect(LAYOUT).toBe(contents.layout);
});

test("the frame nearest to a time", () => {
    const { frames } = made();
    expect([-1, 0, 0.04, 0.06, 0.149, 0.151, 9].map((t) => frames.nearest(t))).toEqual([0, 0, 0, 1, 1, 2, 2]);
});

test("data of another layout, and data that lack something, are refused", () => {
    const { contents } = made();
    expect(() => new (made().constructor as never as new (...a: unknown[]) => unknown)({ ...contents, layout: 99 }, new ArrayBuffer(0))).toThrow("layout 99");
    expect(() => made().array("no/such")).toThrow("no/such");
});

test("the scale of displacements is 1, 2 or 5 times a power of ten", () => {
    expect([0.9, 1, 4.9, 5, 19.99, 20, 12345].map(rounded)).toEqual([0.5, 1, 2, 5, 10, 20, 10000]);
    expect([NaN, 0, Infinity].map(rounded)).toEqual([1, 1, 1]);
    const report = made({ "envelope/block/displacement": Float64Array.from([1e-3, 2e-3, 1]) });
    // 0.51 m of wall: the blocks' 2 mm would take 5 % of it twelve times enlarged, half of the beam's 5 mm ten times.
    expect(automaticScale(report, new View(report))).toBe(10);
    expect(automaticScale(made(), new View(report))).toBe(0.01);
});
