/** A small made-up report: two blocks, a beam, joints of three kinds, three frames. */

import type { Bond, Contents, FrictionLaw, Numbers } from "../src/data";
import { LAYOUT, Report } from "../src/data";
import { FIELDS } from "../src/frames";
import type { Field } from "../src/frames";

export const LAW: FrictionLaw = { law: "stribeck", static: 0.6, dynamic: 0.42, slip_velocity: 1e-3, beta: 100, alpha: 0.7 };

/** Displacements of left block, right block and beam at three frames; velocities and accelerations are multiples. */
export const MOTION = [
    [0, 0, 0],
    [4.999e-3, 4.999e-3 + 1.234567e-7, -5e-3],
    [-1e-3, -2e-3, NaN],
];

const KINDS = new Map<Function, "f64" | "f32" | "i32">([[Float64Array, "f64"], [Float32Array, "f32"], [Int32Array, "i32"]]);

/** Of a planar run: how far left block, right block and beam rise and turn at three frames. */
export const RISE = [[0, 0, 0], [0, 0.1, 0], [0, 1e-3, 2e-3]];
export const TURN = [[0, 0, 0], [0, Math.PI / 2, 0], [0, -0.1, 0.01]];
/** Slips, openings, normal and tangential forces of the joints there, joint by joint and frame by frame. */
export const TOUCH = { slip: 1e-3, opening: 2e-3, pressure: 700, friction: 300 };

/** The same blocks as a planar run. */
export function madePlanar(more: Record<string, Numbers> = {}): Report {
    const touch = Object.entries(TOUCH).map(([name, size]) => [`frame/joint/${name}`, Float32Array.from({ length: 9 }, (_, k) => size * (k - 3))]);
    return made({ ...rows("vertical", RISE), ...rows("rotation", TURN), ...Object.fromEntries(touch), ...more }, true);
}

/** The same with a left block that is a trapezium, wider below, and a right one with a corner cut off. */
export function madePolygons(): Report {
    const real = (...values: number[]) => Float64Array.from(values);
    return madePlanar({
        "outline/start": Int32Array.from([0, 4, 9]),
        "outline/x": real(0, 0.25, 0.2, 0.05, 0.26, 0.51, 0.51, 0.36, 0.26),
        "outline/y": real(0, 0, 0.05, 0.05, 0, 0, 0.025, 0.05, 0.05),
        "outline/centre_x": real(0.125, CUT[0]),
        "outline/centre_y": real(0.05 * (0.25 + 2 * 0.15) / (3 * 0.4), CUT[1]),
    });
}

/** Centre of the right block: its rectangle less the triangle over half of its height and three fifths of its length. */
export const CUT = [[0.385, 0.46], [0.025, 0.125 / 3]].map(([whole, part]) => (0.0125 * whole - 0.001875 * part) / 0.010625);

/** A bond of the left block with the base that cracks and breaks, and of the head joint that holds. */
export function madeBonded(): Report {
    const bond = (damage: number, cracked: number | null): Bond => ({ strength: 1e3, damage, spent: 0, cracked, broken: damage === 1 ? 0.2 : null });
    return made({ "frame/bond/damage": Float64Array.from([0, 0, 0.25, 0, 1, 0]) }, false, { "0": bond(1, 0.05), "1": bond(0, null) });
}

export function made(more: Record<string, Numbers> = {}, planar = false, bonds: Record<string, Bond> = {}): Report {
    const real = (...values: number[]) => Float64Array.from(values);
    const arrays: Record<string, Numbers> = {
        "block/x0": real(0, 0.26), "block/x1": real(0.25, 0.51), "block/y0": real(0, 0), "block/y1": real(0.05, 0.05),
        "block/mass": real(3, 3), "block/bed": real(0.01, 0.01), "block/head": real(0.01, 0.01),
        "joint/a": Int32Array.from([0, 0, 1]), "joint/b": Int32Array.from([-1, 1, -2]), "joint/friction": Int32Array.from([0, -1, 0]),
        "joint/x0": real(0, 0.255, 0.26), "joint/x1": real(0.25, 0.255, 0.51), "joint/y0": real(0, 0, 0.05), "joint/y1": real(0, 0.05, 0.05),
        "joint/overlap": real(0.25, 0.05, 0.25), "joint/stiffness": real(1e8, 5e10, 1e8), "joint/damping": real(2000, 1000, 2000),
        "joint/normal_force_a": real(1000, 0, 900),
        "frame/time": real(0, 0.1, 0.2),
        "envelope/block/displacement": real(1, 2, 9), "envelope/block/velocity": real(1, 2, 9), "envelope/block/acceleration": real(1, 2, 9),
        "envelope/joint/velocity": real(1e-3, 2e-3, 0),
        ...frames(),
        ...more,
    };
    const contents: Contents = {
        layout: LAYOUT, name: "made", title: "", block_names: ["p1c1b1", "p1c1b2"],
        joint_names: ["base|p1c1b1", "p1c1b1|p1c1b2", "p1c1b2|top"], joint_kinds: ["base", "head", "top"],
        joint_laws: ["elastic", "no-tension", "elastic"], frictions: [LAW], bonds, planar, beam: { kind: "mass", label: "beam", moves: true },
        frames: { recorded: 3, every: 1, standing: 3, room: 1000, rounded: null }, curve: { samples: 3, points: 3, interval: 0.1, left_out: 0 }, loops: [], channels: [], spectrum: null,
        arrays: {},
    };
    let at = 0;
    const parts = Object.entries(arrays).map(([name, values]) => {
        contents.arrays[name] = { type: KINDS.get(values.constructor) ?? "f64", at, count: values.length };
        const start = at;
        at = Math.ceil((at + values.byteLength) / 8) * 8;
        return { values, start };
    });
    const bytes = new Uint8Array(at);
    parts.forEach(({ values, start }) => bytes.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), start));
    return new Report(contents, bytes.buffer);
}

function frames(): Record<string, Numbers> {
    return Object.assign({}, ...FIELDS.map((field, k) => rows(field, MOTION.map((row) => row.map((v) => v * 10 ** k)))));
}

function rows(field: Field, values: number[][]): Record<string, Numbers> {
    return { [`frame/${field}`]: Float64Array.from(values.flat()) };
}
