import { expect, test } from "vitest";
import { coarseness } from "../src/coarse";
import { firstItems } from "../src/first";
import { made } from "./made";

const peaks = (slip: number[], opening: number[], dissipation: number[], more = {}) => made({
    "envelope/joint/slip": Float64Array.from(slip), "envelope/joint/opening": Float64Array.from(opening),
    "envelope/joint/dissipation": Float64Array.from(dissipation), "envelope/joint/displacement": Float64Array.from([1, 0, 0]), ...more,
});
const joint = (index: number) => ({ owner: "joint", index });
const none = [0, 0, 0];

test("the page opens with the joint that slipped, else opened, else dissipated most", () => {
    expect(firstItems(peaks([1, 0, 2], [0, 9, 0], [9, 0, 0]))).toEqual([{ owner: "block", index: 1 }, joint(2)]);
    expect(firstItems(peaks(none, [0, 1, 0], [9, 0, 0]))[1]).toEqual(joint(1));
    expect(firstItems(peaks(none, none, [0, 0, 3]))[1]).toEqual(joint(2));
    expect(firstItems(peaks(none, none, none))[1]).toEqual(joint(0));
});

test("joints that touch less than a tenth of a brick are not chosen at first", () => {
    // Bed joints against the brick's 250 mm, the head joint against its 50 mm.
    const overlap = (...lengths: number[]) => ({ "joint/overlap": Float64Array.from(lengths) });
    expect(firstItems(peaks([1, 0, 2], none, none, overlap(0.25, 0.05, 0.024)))[1]).toEqual(joint(0));
    expect(firstItems(peaks([1, 0, 2], none, none, overlap(0.25, 0.05, 0.026)))[1]).toEqual(joint(2));
    expect(firstItems(peaks(none, [0, 1, 0], [0, 0, 1], overlap(0.25, 0.0051, 0.25)))[1]).toEqual(joint(1));
    expect(firstItems(peaks(none, [0, 1, 0], [0, 0, 1], overlap(0.25, 0.0049, 0.25)))[1]).toEqual(joint(2));
    expect(firstItems(peaks([1, 1, 1], none, none, overlap(0.01, 0.001, 0.01)))).toEqual([{ owner: "block", index: 1 }]);
});

test("the note on frames tells their distance and what to write for smooth curves", () => {
    const report = made();
    expect(coarseness(report)).toContain("frames 100 ms apart");
    expect(coarseness(report)).toContain('set interval = "10 ms" and frames = "10 ms"');
    report.contents.curve.interval = 0.01;
    expect(coarseness(report)).toContain('set frames = "10 ms"');
    // As many frames as a page holds: finer ones would be left out again.
    report.contents.frames.room = 1.2;
    expect(coarseness(report)).toContain("holds no more frames");
});
