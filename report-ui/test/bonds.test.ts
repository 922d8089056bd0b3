import { expect, test } from "vitest";
import { Moment, history, quantitiesOf, isDamage } from "../src/quantities";
import { Store } from "../src/store";
import { barMarks, largestText } from "../src/ui/bar";
import { made, madeBonded } from "./made";

const damage = (report: ReturnType<typeof made>, when: "moment" | "peak") => quantitiesOf(report, "joint", when).find(isDamage);

test("bonded walls open with their cracks at the end", () => {
    const store = new Store(madeBonded());
    expect([store.paint.key, store.paint.when]).toEqual(["damage", "peak"]);
    expect([...store.moment.values(store.paint)]).toEqual([1, 0, NaN]);
    const scale = store.scale(store.moment.values(store.paint));
    expect([scale.low, scale.high, scale.zero]).toEqual([0, 1, false]);
    expect(barMarks(store, scale)).toEqual(["0 intact", "0.5", "1 broken"]);
    expect(largestText(store, scale)).toBe("1 of 2 bonds cracked, 1 broken; white: not bonded");
    // A wall without bonds has no damage to show.
    expect([damage(made(), "moment"), new Store(made()).paint.key]).toEqual([undefined, "displacement"]);
});

test("damage grows from frame to frame", () => {
    const report = madeBonded();
    const q = damage(report, "moment");
    if (q === undefined) {
        throw new Error("no damage");
    }
    expect([...history(report, q, 0)]).toEqual([0, 0.25, 1]);
    expect([...history(report, q, 2)]).toEqual([NaN, NaN, NaN]);
    const moment = new Moment(report);
    moment.frame = 1;
    expect([...moment.values(q)]).toEqual([0.25, 0, NaN]);
    expect(moment.value(q, 0)).toBe(0.25);
});
