/** Numbers for people: the same rules as the tables of the command line. */

const PREFIXES: [string, number][] = [
    ["G", 1e9], ["M", 1e6], ["k", 1e3], ["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9], ["p", 1e-12],
];

/** Decimal notation with that many significant digits. */
export function significant(value: number, digits: number): string {
    if (value === 0 || !Number.isFinite(value)) {
        return plainText(value);
    }
    const rounded = Number(value.toExponential(digits - 1));
    const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.abs(rounded))));
    return minus(rounded.toFixed(Math.min(decimals, 30)));
}

/** A value with its unit and a decimal prefix, four significant digits unless said: `1.198 µm`, `53.40 kN`; nobody
 * reads km/s². */
export function si(value: number, unit: string, digits = 4): string {
    if (value === 0 || !Number.isFinite(value)) {
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

/** The decimal prefix that brings `largest` between 1 and 1000: its letter and its factor. */
export function prefixOf(largest: number, unit: string): [string, number] {
    if (unit === "" || unit === "m/s²" || !(largest > 0) || !Number.isFinite(largest)) {
        return ["", 1];
    }
    return PREFIXES.find(([, factor]) => largest >= factor) ?? ["p", 1e-12];
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

/** A number of an axis without the digits that rounding leaves behind. */
export function tick(value: number): string {
    return minus(String(Number(value.toPrecision(6))));
}

function plainText(value: number): string {
    if (value === 0) {
        return "0";
    }
    return Number.isNaN(value) ? "not a number" : value > 0 ? "∞" : "−∞";
}

function minus(text: string): string {
    return text.replace("-", "−");
}
