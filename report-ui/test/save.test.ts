import { expect, test } from "vitest";
import { csv, fileName, headed } from "../src/save";

test("tables have units in their heads, points, hyphens, and nothing for what is no number", () => {
    const table = csv([
        { head: headed("time", "s"), values: [0, 0.1] }, { head: headed("base, \"b\"", "N"), values: [-1.5e-7, NaN] }, { head: headed("damage", ""), values: [-0] },
    ]);
    expect(table).toBe('time [s],"base, ""b"" [N]",damage\r\n0,-1.5e-7,0\r\n0.1,,\r\n');
});

test("floats of 32 bits have the digits that they have", () => {
    expect(csv([{ head: "x", values: Float32Array.from([0.1, -1e-7, 16777216]) }])).toBe("x\r\n0.1\r\n-1e-7\r\n16777216\r\n");
    expect(csv([{ head: "x", values: Float64Array.from([0.1 + 0.2]) }])).toBe("x\r\n0.30000000000000004\r\n");
});

test("names of files have letters, digits and hyphens", () => {
    expect(fileName("Façade 1", "Force over displacement, “all”")).toBe("façade-1-force-over-displacement-all");
    expect(fileName("../x", "")).toBe("x");
});
