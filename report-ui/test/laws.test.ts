import { expect, test } from "vitest";
import { coefficient, largestCoefficient, spring } from "../src/laws";
import { history, Moment, peak, quantitiesOf, QUANTITIES } from "../src/quantities";
import { LAW, made } from "./made";

const find = (owner: "block" | "joint", when: "moment" | "peak", key: string) => {
    const found = QUANTITIES.find((q) => q.owner === owner && q.when === when && q.key === key);
    if (found === undefined) {
        throw new Error(key);
    }
    return found;
};

test("friction is odd, steep at rest, dynamic far beyond the slip velocity: equation (6)", () => {
    for (const v of [1e-7, 1e-5, 1e-3, 0.1]) {
        expect(coefficient(LAW, -v)).toBe(-coefficient(LAW, v));
    }
    expect(coefficient(LAW, 0)).toBe(0);
    const slope = coefficient(LAW, 1e-9) / 1e-9;
    expect(slope / ((2 / Math.PI) * 100 * 0.6 / 1e-3)).toBeCloseTo(1, 3);
    expect(coefficient(LAW, 1)).toBeCloseTo((2 / Math.PI) * Math.atan(1e5) * 0.42 + 0.7, 12);
    // The theory gives about 1 − √(1/β) of the static coefficient for the largest.
    const largest = largestCoefficient({ ...LAW, alpha: 0 }, 0.1);
    expect(largest).toBeGreaterThan(0.89 * 0.6);
    expect(largest).toBeLessThan(0.6);
});

test("springs: both ways, or in compression only", () => {
    expect(spring(false, 10, -2)).toBe(-20);
    expect(spring(true, 10, -2)).toBe(0);
    expect(spring(true, 10, 2)).toBe(20);
});

test("joints at a moment: signs and forces of equations (2) to (5)", () => {
    const report = made();
    const moment = new Moment(report);
    moment.frame = 2;
    const at = (joint: number, key: string) => moment.value(find("joint", "moment", key), joint);
    // On the base: δ = x_a.
    expect(at(0, "displacement")).toBeCloseTo(-1e-3, 12);
    expect(at(0, "elastic") / -1e5).toBeCloseTo(1, 8);
    expect(at(0, "damping") / (2000 * -1e-2)).toBeCloseTo(1, 8);
    expect(at(0, "friction") / (1000 * coefficient(LAW, -1e-2))).toBeCloseTo(1, 8);
    // A head joint: the gap is x_right − x_left = −1 mm, so it is closed and pushes the left block back.
    expect(at(1, "displacement")).toBeCloseTo(-1e-3, 12);
    expect(at(1, "elastic") / 5e7).toBeCloseTo(1, 8);
    expect(at(1, "friction")).toBe(0);
    // Under a beam whose motion is not a number nothing is made up.
    expect(at(2, "elastic")).toBeNaN();
    moment.frame = 1;
    expect(at(1, "displacement") / 1.234567e-7).toBeCloseTo(1, 6);
    expect(at(1, "elastic")).toBe(0);
});

test("histories are the moments one after the other", () => {
    const report = made();
    const moment = new Moment(report);
    for (const q of (["block", "joint"] as const).flatMap((owner) => quantitiesOf(report, owner, "moment"))) {
        const values = history(report, q, 1);
        for (let frame = 0; frame < 3; frame++) {
            moment.frame = frame;
            expect(moment.value(q, 1)).toEqual(values[frame]);
            expect(moment.values(q)[1]).toEqual(values[frame]);
        }
    }
});

test("forces kept with the frames come before those of a law", () => {
    const stored = Float32Array.from({ length: 9 }, (_, k) => 100 + k);
    const moment = new Moment(made({ "frame/joint/friction": stored }));
    moment.frame = 1;
    expect(moment.value(find("joint", "moment", "friction"), 2)).toBe(105);
    expect(history(moment.report, find("joint", "moment", "friction"), 0)).toEqual(Float64Array.from([100, 103, 106]));
});

test("friction of a set-valued law without a kept force is not made up", () => {
    const report = made();
    report.contents.frictions[0] = { ...LAW, law: "coulomb" };
    expect(new Moment(report).value(find("joint", "moment", "friction"), 0)).toBeNaN();
});

test("the largest values span the colours", () => {
    const report = made();
    expect(peak(report, find("block", "peak", "displacement"))).toBe(2);
    expect(peak(report, find("joint", "moment", "damping"))).toBe(2);
    const friction = peak(report, find("joint", "moment", "friction"));
    expect(friction).toBeGreaterThanOrEqual(1000 * coefficient(LAW, 1e-3));
    expect(friction).toBeLessThan(600);
});
