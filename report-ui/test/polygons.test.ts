import { expect, test } from "vitest";
import { Store } from "../src/store";
import { rest } from "../src/wall/outline";
import { pick } from "../src/wall/pick";
import { Places } from "../src/wall/places";
import { View } from "../src/wall/view";
import { CUT, made, madePolygons, MOTION, RISE } from "./made";

function at(frame: number) {
    const report = madePolygons();
    const store = new Store(report);
    const view = new View(report);
    view.fit(600, 400);
    store.moment.frame = frame;
    store.magnify = 1;
    const places = new Places(report, view);
    places.update(store, 0);
    return { report, view, places };
}

test("blocks without corners of their own are rectangles, others have theirs", () => {
    expect([...made().outline.rectangle]).toEqual([1, 1]);
    expect(made().outline.x).toHaveLength(8);
    const { outline } = madePolygons();
    expect([...outline.rectangle]).toEqual([0, 0]);
    expect([...outline.start]).toEqual([0, 4, 9]);
    expect([outline.centreX[1], outline.centreY[1]]).toEqual(CUT);
});

test("a polygon turned by a right angle goes round its centre of gravity", () => {
    const { view, places, report } = at(1);
    const [x, y] = [CUT[0] + MOTION[1][1], CUT[1] + RISE[1][1]];
    const corners = places.corners(1);
    expect(corners).toHaveLength(5);
    corners.forEach(([cx, cy], k) => {
        const [rx, ry] = [report.outline.x[4 + k] - CUT[0], report.outline.y[4 + k] - CUT[1]];
        expect(cx).toBeCloseTo(view.x(x - ry), 6);
        expect(cy).toBeCloseTo(view.y(y + rx), 6);
    });
});

test("pointing beside a sloping side finds nothing", () => {
    const { view, places, report } = at(0);
    const point = (x: number, y: number) => pick(view, report, places, view.x(x), view.y(y), 0);
    expect(point(0.03, 0.02)).toEqual({ owner: "block", index: 0 });
    expect(point(0.01, 0.045)).toBeNull();
    expect(point(0.4, 0.02)).toEqual({ owner: "block", index: 1 });
    expect(point(0.5, 0.045)).toBeNull();
});

test("the contour runs along the sides without joints, and round the rectangle of a wall of rectangles", () => {
    expect(rest(made()).contour.flat()).toContainEqual([0.51, 0.05]);
    expect(rest(made()).contour).toHaveLength(4);
    const { contour } = rest(madePolygons());
    // Joints are below the left block, between both, and above the right one: their sides are no contour.
    expect(contour).toContainEqual([[0.2, 0.05], [0.05, 0.05]]);
    expect(contour).toContainEqual([[0.51, 0.025], [0.36, 0.05]]);
    expect(contour).not.toContainEqual([[0, 0], [0.25, 0]]);
    expect(contour).not.toContainEqual([[0.26, 0.05], [0.26, 0]]);
});

test("names stay within polygons, mortar lies around them and within the wall", () => {
    const { room, mortar } = rest(madePolygons());
    const [width, height] = room[0];
    // The trapezium is as high as its middle: half of that for a name, and above it is 0.15 + 2 · 0.05 · part wide.
    expect(height).toBeCloseTo(0.025, 12);
    const centre = 0.05 * (0.25 + 2 * 0.15) / (3 * 0.4);
    expect(width).toBeCloseTo(0.15 + 2 * 0.05 * (0.05 - centre - 0.0125) / 0.05, 12);
    expect(rest(made()).mortar).toEqual([null, null]);
    const xs = mortar[1]?.map(([x]) => x) ?? [];
    expect(Math.min(...xs)).toBeCloseTo(0.255, 12);
    expect(Math.max(...xs)).toBe(0.51);
    const [roomOfRectangle] = rest(made()).room;
    expect(roomOfRectangle).toEqual([0.25, 0.05]);
});
