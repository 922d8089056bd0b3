import { expect, test } from "vitest";
import { extent } from "../src/extent";
import { history, peak, quantitiesOf } from "../src/quantities";
import { Store } from "../src/store";
import { grown } from "../src/wall/outline";
import { pick } from "../src/wall/pick";
import { Places } from "../src/wall/places";
import { automaticScale, View } from "../src/wall/view";
import { made, madePlanar, MOTION, RISE, TOUCH, TURN } from "./made";

/** A planar report at a frame, its places brought up to date. */
function at(frame: number, magnify: number) {
    const report = madePlanar();
    const store = new Store(report);
    const view = new View(report);
    view.fit(600, 400);
    store.moment.frame = frame;
    store.magnify = magnify;
    const places = new Places(report, view);
    places.update(store, 0);
    return { report, store, view, places };
}

test("the corners of a block turned by a right angle are those of its rectangle, turned", () => {
    const { view, places } = at(1, 1);
    // The right block, 0.25 m × 0.05 m around (0.385, 0.025): counterclockwise its bottom left corner comes to the bottom right.
    const [x, y] = [0.385 + MOTION[1][1], 0.025 + RISE[1][1]];
    const expected = [[0.025, -0.125], [0.025, 0.125], [-0.025, 0.125], [-0.025, -0.125]];
    places.corners(1).forEach(([cx, cy], k) => {
        expect(cx).toBeCloseTo(view.x(x + expected[k][0]), 6);
        expect(cy).toBeCloseTo(view.y(y + expected[k][1]), 6);
    });
    expect(places.isUpright(0)).toBe(true);
    expect(places.isUpright(1)).toBe(false);
    expect(places.angle(1)).toBeCloseTo(-Math.PI / 2, 9);
});

test("ways of points are enlarged as a whole, so that what touches goes on touching", () => {
    const [once, often] = [at(2, 1), at(2, 50)];
    const way = ({ places, view }: typeof once, column: number, x: number, y: number) => {
        const [cx, cy] = places.point(column, x, y);
        return [cx - view.x(x), cy - view.y(y)];
    };
    for (const column of [0, 1]) {
        const [small, large] = [once, often].map((run) => way(run, column, 0.255, 0.05));
        small.forEach((value, k) => expect(large[k]).toBeCloseTo(50 * value, 9));
    }
    // The mean of the two sides is where the joint is drawn.
    const [a, b] = [0, 1].map((column) => way(once, column, 0.255, 0));
    const [x0, y0] = once.places.line(1);
    expect(x0 - once.view.x(0.255)).toBeCloseTo(0.5 * (a[0] + b[0]), 9);
    expect(y0 - once.view.y(0)).toBeCloseTo(0.5 * (a[1] + b[1]), 9);
});

test("pointing finds a block where it is, not where it was", () => {
    const { report, view, places } = at(1, 1);
    const point = (x: number, y: number) => pick(view, report, places, view.x(x), view.y(y), 0);
    expect(point(0.39, 0.125 + 0.1)).toEqual({ owner: "block", index: 1 });
    expect(point(0.48, 0.025)).toBeNull();
    expect(point(0.1, 0.025)).toEqual({ owner: "block", index: 0 });
});

test("how far blocks go is found in the frames", () => {
    const { way, frame, vertical, rotation, above } = extent(madePlanar());
    expect([frame, vertical]).toEqual([1, expect.closeTo(0.1, 9)]);
    expect(rotation).toBeCloseTo(TURN[1][1], 9);
    // A quarter turn brings (a, b) from the centre to (−b, a), and the centre moves too.
    const ways = [[-0.125, -0.025], [0.125, -0.025], [0.125, 0.025], [-0.125, 0.025]].map(([a, b]) => {
        return Math.hypot(MOTION[1][1] - b - a, RISE[1][1] + a - b);
    });
    expect(way).toBeCloseTo(Math.max(...ways), 6);
    expect(above).toBeCloseTo(0.025 + RISE[1][1] + 0.125 - 0.05, 9);
});

test("a joint whose sides are far apart is no joint any more", () => {
    // The right block rises by 0.1 m and turns: the head joint of 0.05 m is left, the joint under the left block is not.
    const { report, view, places } = at(1, 1);
    expect([0, 1].map((e) => places.hasParted(e))).toEqual([false, true]);
    expect(at(2, 1).places.hasParted(1)).toBe(false);
    // Magnified or not, it is the same joint.
    expect(at(2, 1000).places.hasParted(1)).toBe(false);
    const [x0, y0, x1, y1] = places.line(1);
    expect(pick(view, report, places, (x0 + x1) / 2, (y0 + y1) / 2, 3)).not.toEqual({ owner: "joint", index: 1 });
});

test("the frame of the largest way is none after a collapse", () => {
    const report = madePlanar();
    report.contents.frames.standing = 1;
    expect(extent(report)).toMatchObject({ frame: 0, way: 0, vertical: expect.closeTo(0.1, 9) });
});

test("blocks that turn are drawn as they are where that is seen, and enlarged where it is not", () => {
    const report = madePlanar();
    expect(automaticScale(report, new View(report))).toBe(1);
    const still = Object.entries({ vertical: RISE, rotation: TURN, displacement: MOTION }).map(([field, rows]) =>
        [`frame/${field}`, Float64Array.from(rows.flat(), (v) => v * 1e-6)]);
    const small = madePlanar(Object.fromEntries(still));
    const scale = automaticScale(small, new View(small));
    expect(scale).toBeGreaterThan(100);
    expect(scale * extent(small).way).toBeLessThanOrEqual(0.05 * 0.51 * (1 + 1e-9));
});

test("what joints do in a planar run comes from the frames", () => {
    const report = madePlanar();
    expect(quantitiesOf(report, "joint", "moment").map((q) => q.key)).toEqual(Object.keys(TOUCH));
    for (const q of quantitiesOf(report, "joint", "moment")) {
        const size = TOUCH[q.key as keyof typeof TOUCH];
        history(report, q, 2).forEach((value, frame) => expect(value).toBeCloseTo(size * (3 * frame + 2 - 3), 3));
        if (q.key !== "opening") {
            expect(peak(report, q)).toBeCloseTo(size * 5, 3);
        }
    }
    const turn = quantitiesOf(report, "block", "moment").find((q) => q.key === "rotation");
    expect(turn && history(report, turn, 1)[1]).toBeCloseTo(Math.PI / 2, 9);
    expect(quantitiesOf(made(), "block", "moment").map((q) => q.key)).toEqual(["displacement", "velocity", "acceleration"]);
});

test("marks lie around an outline, turned or not", () => {
    const square = (angle: number): [number, number][] => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => {
        return [Math.cos(angle) * x - Math.sin(angle) * y, Math.sin(angle) * x + Math.cos(angle) * y];
    });
    grown(square(0), 0.5).forEach(([x, y]) => expect([Math.abs(x), Math.abs(y)]).toEqual([1.5, 1.5]));
    grown(square(0.7), 0.5).forEach(([x, y]) => expect(Math.hypot(x, y)).toBeCloseTo(1.5 * Math.SQRT2, 12));
    grown(square(0).reverse(), 0.5).forEach(([x, y]) => expect([Math.abs(x), Math.abs(y)]).toEqual([1.5, 1.5]));
});
