import { expect, test } from "vitest";
import { bondText } from "../src/ui/values";

test("a bond is told with its strength and what became of it", () => {
    const intact = { strength: 8803.4, damage: 0, spent: 0, cracked: null, broken: null };
    expect(bondText(intact)).toBe("bond of 8.80 kN, intact");
    const cracked = { ...intact, damage: 0.3512, spent: 0.01234, cracked: 0.28232148 };
    expect(bondText(cracked)).toBe("bond of 8.80 kN, cracked at 0.2823 s, damage 0.351 at the end, 12.3 mJ taken");
    expect(bondText({ ...cracked, damage: 1, broken: 0.5 })).toContain("cracked at 0.2823 s, broken at 0.5000 s, 12.3 mJ taken");
});
