/**
 * Colours of values. The brightness of both scales runs in one direction, so that they can be read in grey: sizes from light
 * to dark, signed values from dark blue (negative) through grey (zero) to light yellow (positive), safe for the
 * colour-blind.
 */

import { NOTHING, roundEnd } from "./format";

type Triple = [number, number, number];

const SIZES = ["#fffbe6", "#ffefb0", "#fed976", "#feb24c", "#fd8d3c", "#f4542d", "#dc1f23", "#b10026", "#700021"];
const SIGNED = ["#0a2f6b", "#1f4e9a", "#4273b8", "#6a8aad", "#929a9a", "#b3aa7e", "#d2bd5e", "#ecd650", "#fff79b"];
/** Colours are taken in so many steps. */
export const STEPS = 128;

function triple(hex: string): Triple {
    const value = parseInt(hex.slice(1), 16);
    return [value >> 16, (value >> 8) & 255, value & 255];
}

function table(stops: string[]): string[] {
    const triples = stops.map(triple);
    return Array.from({ length: STEPS }, (_, k) => {
        const place = (k / (STEPS - 1)) * (stops.length - 1);
        const low = Math.min(Math.floor(place), stops.length - 2);
        const mixed = triples[low].map((v, c) => Math.round(v + (triples[low + 1][c] - v) * (place - low)));
        return `rgb(${mixed.join(",")})`;
    });
}

/** A scale of colours over values. */
export interface Scale {
    colours: string[];
    stops: string[];
    low: number;
    high: number;
    /** The largest size of what is shown, rounded up to the end of the scale. */
    largest: number;
    /** Whether no value differs from zero: then the ends say nothing. */
    zero: boolean;
}

/** The scale for values up to `largest`, either sign if `signed`. */
export function scale(largest: number, signed: boolean): Scale {
    const zero = !(largest >= NOTHING);
    const high = zero ? 1 : roundEnd(largest);
    const [colours, stops] = signed ? [SIGNED_TABLE, SIGNED] : [SIZES_TABLE, SIZES];
    return { colours, stops, low: signed ? -high : 0, high, largest, zero };
}

/** The scale of damage: from intact to broken, whatever there is. */
export function damageScale(largest: number): Scale {
    return { ...scale(largest, false), high: 1 };
}

const SIZES_TABLE = table(SIZES);
const SIGNED_TABLE = table(SIGNED);

/** Step of a value; −1 for one that is not a number. */
export function step(s: Scale, value: number): number {
    if (Number.isNaN(value)) {
        return -1;
    }
    const place = (value - s.low) / (s.high - s.low);
    return Math.max(0, Math.min(STEPS - 1, Math.round(place * (STEPS - 1))));
}

/** Whether letters on that step have to be light. */
export function isDark(s: Scale, k: number): boolean {
    const [r, g, b] = (s.colours[k].match(/\d+/g) ?? ["255", "255", "255"]).map(Number);
    return 0.3 * r + 0.59 * g + 0.11 * b < 140;
}

/** Lines of selected things and of several curves in one plot; they differ in dash pattern and in brightness too. Their colours are the palette's. */
export const DASHES: number[][] = [[], [7, 3], [2, 3], [9, 3, 2, 3], [4, 2], [12, 4], [1, 2]];
