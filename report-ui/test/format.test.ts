import { expect, test } from "vitest";
import { isDark, scale, step, STEPS } from "../src/colour";
import { count, ordinal, power, prefixOf, roundEnd, seconds, short, si, significant, tick, unitText } from "../src/format";

test("numbers as the command line writes them", () => {
    expect(si(1.198e-6, "m")).toBe("1.198 µm");
    expect(si(-2.348e5, "N")).toBe("−234.8 kN");
    expect(si(0.99999, "J")).toBe("1.000 J");
    expect(si(999.96, "J")).toBe("1.000 kJ");
    expect(si(0, "J")).toBe("0 J");
    expect(si(1e-15, "m")).toBe("1.000e−15 m");
    expect(si(1686.2, "m/s²")).toBe("1686 m/s²");
    expect(si(2.5e-4, "m/s²")).toBe("250.0 µm/s²");
    expect(si(NaN, "m")).toBe("not a number m");
    expect(si(-Infinity, "N")).toBe("−∞ N");
    expect(si(0.25, "")).toBe("0.2500");
    expect(significant(-0.0123456, 3)).toBe("−0.0123");
});

test("zeros have no sign, rounding is 0, and there is one minus", () => {
    for (const nothing of [0, -0, 1e-23, -3e-17]) {
        expect([si(nothing, "m"), significant(nothing, 3), short(nothing, "N"), tick(nothing, 1)]).toEqual(["0 m", "0", "0 N", "0"]);
    }
    expect([si(-1.25e-14, "m"), si(-2.5e13, "N")]).toEqual(["−1.250e−14 m", "−2.500e13 N"]);
    expect(seconds(-0.0001, 0.01)).toBe("0.00 s");
    expect([short(4e-3, "m"), short(1200, "N"), short(-0.25, ""), short(100, "J")]).toEqual(["4 mm", "1.2 kN", "−0.25", "100 J"]);
});

test("scales of colours end at round numbers", () => {
    expect([3.47e-3, 1, 9.3, 0.0101, 250, 5.2e-9, 0, Infinity].map(roundEnd)).toEqual([4e-3, 1, 10, 0.012, 250, 6e-9, 0, Infinity]);
    const { low, high, largest } = scale(3.47e-3, true);
    expect([low, high, largest]).toEqual([-4e-3, 4e-3, 3.47e-3]);
    expect(scale(1e-23, false).zero).toBe(true);
});

test("orders of size and of place", () => {
    expect([6.66e-5, 2e-10].map(power)).toEqual(["7·10⁻⁵", "2·10⁻¹⁰"]);
    expect([2, 3, 4, 11, 21, 22, 112].map(ordinal)).toEqual(["second", "third", "4th", "11th", "21st", "22nd", "112th"]);
});

test("times, ticks, counts, units", () => {
    expect(seconds(0.3, 0.00125)).toBe("0.30000 s");
    expect(seconds(0.015, 0.015)).toBe("0.015 s");
    expect(seconds(0.0375, 0.0125)).toBe("0.0375 s");
    expect(seconds(1, 1 / 3)).toBe("1.000 s");
    expect(seconds(0.3, 0.1 * 3 - 0.2)).toBe("0.3 s");
    expect(seconds(12, 0.01)).toBe("12.00 s");
    expect([0.1 + 0.2, -2.5, 1.7e-13].map((v) => tick(v, 5))).toEqual(["0.3", "−2.5", "0"]);
    expect(count(19600)).toBe("19\u202f600");
    expect([unitText("m/s2"), unitText("1"), unitText("N")]).toEqual(["m/s²", "", "N"]);
    expect(prefixOf(3e-3, "m")).toEqual(["m", 1e-3]);
    expect(prefixOf(3000, "m/s²")).toEqual(["", 1]);
    expect(prefixOf(0, "N")).toEqual(["", 1]);
});

/** Brightness as the eye weighs the colours. */
function brightness(colour: string): number {
    const [r, g, b] = (colour.match(/\d+/g) ?? []).map(Number);
    return 0.299 * r + 0.587 * g + 0.114 * b;
}

test("brightness runs in one direction, so that the scales can be read in grey", () => {
    const falls = scale(1, false).colours.map(brightness);
    const rises = scale(1, true).colours.map(brightness);
    for (let k = 1; k < STEPS; k++) {
        expect(falls[k]).toBeLessThan(falls[k - 1]);
        expect(rises[k]).toBeGreaterThan(rises[k - 1]);
    }
    expect(isDark(scale(1, false), STEPS - 1)).toBe(true);
    expect(isDark(scale(1, false), 0)).toBe(false);
});

test("values find their step", () => {
    const signed = scale(2, true);
    expect([-9, -2, 0, 2, 9, NaN].map((v) => step(signed, v))).toEqual([0, 0, 64, STEPS - 1, STEPS - 1, -1]);
    expect(step(scale(0, false), 0)).toBe(0);
    expect([scale(0, false), scale(NaN, true), signed].map((s) => s.zero)).toEqual([true, true, false]);
});
