/** Numbers for people: the same rules as the tables of the command line. A minus is U+2212, a zero has no sign. */

const PREFIXES: [string, number][] = [
    ["G", 1e9], ["M", 1e6], ["k", 1e3], ["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9], ["p", 1e-12],
];
/** Size in SI, or of a pure number, from which it is one: what is less is rounding. */
export const NOTHING = 1e-15;

/** Decimal notation with that many significant digits. */
export function significant(value: number, digits: number): string {
    if (Math.abs(value) < NOTHING || !Number.isFinite(value)) {
        return plainText(value);
    }
    const rounded = Number(value.toExponential(digits - 1));
    const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(rounded))));
    return minus(rounded.toFixed(Math.min(decimals, 30)));
}

/** A value with its unit and a decimal prefix, four significant digits unless said: `1.198 µm`, `53.40 kN`; nobody
 * reads km/s². */
export function si(value: number, unit: string, digits = 4): string {
    if (Math.abs(value) < NOTHING || !Number.isFinite(value)) {
        return `${plainText(value)} ${unit}`.trim();
    }
    const rounded = Number(value.toExponential(digits - 1));
    const size = Math.abs(rounded);
    const prefix = PREFIXES.find(([, factor]) => size >= factor && !(factor > 1 && unit === "m/s²"));
    if (unit === "" || prefix === undefined || size >= 1e12) {
        const small = unit === "" && size >= 1e-3 && size < 1e5;
        return `${small ? significant(rounded, digits) : minus(rounded.toExponential(digits - 1))} ${unit}`.trim();
    }
    return `${significant(rounded / prefix[1], digits)} ${prefix[0]}${unit}`;
}

/** As `si`, without zeros behind the last digit: `4 mm`. */
export function short(value: number, unit: string, digits = 4): string {
    const [number, ...rest] = si(value, unit, digits).split(" ");
    const plain = number.includes(".") && !number.includes("e") ? number.replace(/\.?0+$/, "") : number;
    return [plain, ...rest].join(" ");
}

/** The decimal prefix that brings `largest` between 1 and 1000: its letter and its factor. */
export function prefixOf(largest: number, unit: string): [string, number] {
    if (unit === "" || unit === "m/s²" || !(largest > 0) || !Number.isFinite(largest)) {
        return ["", 1];
    }
    return PREFIXES.find(([, factor]) => largest >= factor) ?? ["p", 1e-12];
}

/** The least round number that is not below a size: where a scale of colours ends. */
export function roundEnd(largest: number): number {
    if (!(largest > 0) || !Number.isFinite(largest)) {
        return largest;
    }
    const power = Math.floor(Math.log10(largest));
    const ends = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].map((m) => Number(`${m}e${power}`));
    return ends.find((end) => end >= largest * (1 - 1e-9)) ?? largest;
}

/** A time in seconds with as many decimals as multiples of `interval` [s] have; at most two more than its first digit. */
export function seconds(time: number, interval: number): string {
    return `${minus(time.toFixed(interval > 0 ? decimalsOf(interval) : 3))} s`;
}

function decimalsOf(interval: number): number {
    const first = Math.max(1, Math.ceil(-Math.log10(interval) - 1e-9));
    const isWhole = (decimals: number) => {
        const digits = interval * 10 ** decimals;
        return Math.abs(digits - Math.round(digits)) < 1e-6 * digits;
    };
    return Math.min(9, [first, first + 1].find(isWhole) ?? first + 2);
}

/** Superscripts in place of the digits of units as files spell them: `m/s2` becomes `m/s²`. */
export function unitText(unit: string): string {
    return unit === "1" ? "" : unit.replace(/2$/, "²").replace(/3$/, "³");
}

/** Thousands apart: `19 600`. */
export function count(value: number): string {
    return String(value).replace(/\B(?=(\d{3})+(?!\d))/g, "\u202f");
}

/** A number of an axis that reaches as far as `largest`, without the digits that rounding leaves behind. */
export function tick(value: number, largest: number): string {
    return Math.abs(value) <= 1e-9 * Math.abs(largest) ? "0" : minus(String(Number(value.toPrecision(6))));
}

/** Powers of ten as they are written on paper: `3·10⁻⁵`. */
export function power(value: number): string {
    const [digits, exponent] = value.toExponential(0).split("e");
    const raised = [...String(Number(exponent))].map((c) => (c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)])).join("");
    return `${digits}·10${raised}`;
}

/** `second`, `third`, `4th`, `21st`. */
export function ordinal(n: number): string {
    const words: Record<number, string> = { 2: "second", 3: "third" };
    const tens = n % 100;
    const ending = tens > 10 && tens < 14 ? "th" : (["th", "st", "nd", "rd"][n % 10] ?? "th");
    return words[n] ?? `${n}${ending}`;
}

function plainText(value: number): string {
    if (Math.abs(value) < NOTHING) {
        return "0";
    }
    return Number.isNaN(value) ? "not a number" : value > 0 ? "∞" : "−∞";
}

function minus(text: string): string {
    return /^-0(\.0*)?$/.test(text) ? text.slice(1) : text.replace("e+", "e").replace(/-/g, "−");
}
