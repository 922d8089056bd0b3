import { expect, test } from "vitest";
import { View } from "../src/wall/view";
import { made } from "./made";

/** Metres at a point of the canvas. */
const under = (view: View, x: number, y: number) => [(x - view.x(0)) / view.zoom, (view.y(0) - y) / view.zoom];

test("the wall is enlarged about the pointer, shifts with it, and fits again", () => {
    const view = new View(made());
    const height = view.fit(600, 400);
    const [whole, left, top] = [view.zoom, view.x(0), view.y(0)];
    const before = under(view, 300, 60);
    view.enlarge(4, 300, 60);
    expect(view.zoom / whole).toBeCloseTo(4, 12);
    under(view, 300, 60).forEach((value, k) => expect(value).toBeCloseTo(before[k], 12));
    const at = view.x(0);
    view.pan(-25, 0);
    expect(view.x(0)).toBeCloseTo(at - 25, 12);
    // Not beyond the edges of the picture, not smaller than the whole, not endlessly larger.
    view.pan(1e6, 1e6);
    expect([view.x(0), view.y(0)]).toEqual([4 * left, 4 * top]);
    view.pan(-1e6, -1e6);
    expect(view.x(0)).toBeCloseTo(4 * left - 3 * 600, 9);
    expect(view.y(0)).toBeCloseTo(4 * top - 3 * Math.ceil(height), 9);
    view.enlarge(1e9);
    expect(view.enlarged).toBe(40);
    view.enlarge(0);
    expect([view.zoom, view.x(0), view.y(0)]).toEqual([whole, left, top]);
});
