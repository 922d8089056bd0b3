import { expect, test } from "vitest";
import { decode } from "../src/base64";
import { automaticScale, rounded, View } from "../src/wall/view";
import { made, MOTION } from "./made";

test("base64 of every length", () => {
    for (let length = 0; length < 40; length++) {
        const bytes = Uint8Array.from({ length }, (_, k) => (k * 71 + 250) % 256);
        expect(decode(Buffer.from(bytes).toString("base64"))).toEqual(bytes);
    }
    expect(() => decode("abc")).toThrow("cut off");
});

test("frames come back to a quantum, and so do small differences of large displacements", () => {
    const { frames } = made();
    const row = new Float64Array(3);
    frames.read("displacement", 1, row);
    row.forEach((value, i) => {
        expect(Math.abs(value - MOTION[1][i])).toBeLessThanOrEqual(2 ** -45);
        expect(frames.value("displacement", 1, i)).toBe(value);
    });
    expect(Math.abs((row[1] - row[0]) / 1.234567e-7 - 1)).toBeLessThan(1e-6);
    expect(frames.value("displacement", 2, 2)).toBeNaN();
    expect(frames.value("velocity", 2, 1)).toBeCloseTo(-2e-2, 9);
    expect(frames.value("displacement", 1, -1)).toBe(0);
    expect([...frames.history("displacement", 0)].map((v) => v.toFixed(6))).toEqual(["0.000000", "0.004999", "-0.001000"]);
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
