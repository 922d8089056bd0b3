/**
 * Joint laws, equations (2)–(6) of the theory: elastic w K δ, or κ K δ for a closed head joint; damping w C δ̇; friction
 * N μ(δ̇), μ(v) = (2/π) arctan(β v/δ_v) [(μ_s − μ_d) e^(−|v|/δ_v) + μ_d] + α |v| v. Here δ = x_a − x_b.
 */

import type { FrictionLaw, Report } from "./data";
import type { Field } from "./frames";

/** What a joint does at a frame. */
export const JOINT_KEYS = ["displacement", "velocity", "acceleration", "elastic", "damping", "friction"] as const;
/** The same where blocks rise and turn: it follows from no motion of two blocks alone, and the frames hold it. */
export const TOUCH_KEYS = ["slip", "opening", "pressure", "friction"] as const;
export type JointKey = (typeof JOINT_KEYS)[number] | (typeof TOUCH_KEYS)[number];

/** μ(v). */
export function coefficient(law: FrictionLaw, v: number): number {
    const speed = Math.abs(v);
    const level = (law.static - law.dynamic) * Math.exp(-speed / law.slip_velocity) + law.dynamic;
    const size = (2 / Math.PI) * Math.atan((law.beta * speed) / law.slip_velocity) * level + law.alpha * speed * speed;
    return v < 0 ? -size : size;
}

/** Elastic force at δ [N]. */
export function spring(unilateral: boolean, stiffness: number, d: number): number {
    return unilateral && d <= 0 ? 0 : stiffness * d;
}

/** Whether friction is a function of velocity, so that frames suffice to know it. */
export function isFunction(law: FrictionLaw): boolean {
    return law.law === "stribeck";
}

/**
 * A quantity of a joint, from a function that gives the motion of unknowns. Relative displacement, velocity and acceleration
 * of head joints and connections are those of the gap: positive opens. Forces are those on the lower or left
 * block, against its relative motion.
 *
 * Where the page holds the force of a law that is no function of the motion, `kept` gives it; NaN is a force that cannot
 * be known.
 */
export function jointValue(
    report: Report,
    joint: number,
    key: JointKey,
    motion: (field: Field, unknown: number) => number,
    kept?: ArrayLike<number>,
    at = 0,
): number {
    const { a, b, upright, unilateral, stiffness, damping, normal, friction } = report.joint;
    const difference = (field: Field) => motion(field, a[joint]) - motion(field, b[joint]);
    if (key === "displacement" || key === "velocity" || key === "acceleration") {
        const value = difference(key);
        return upright[joint] ? 0 - value : value;
    }
    if (kept !== undefined) {
        return kept[at + joint];
    }
    if (key === "elastic") {
        return spring(unilateral[joint], stiffness[joint], difference("displacement"));
    }
    if (key === "damping") {
        return damping[joint] * difference("velocity");
    }
    if (friction[joint] < 0) {
        return 0;
    }
    const law = report.contents.frictions[friction[joint]];
    return isFunction(law) ? normal[joint] * coefficient(law, difference("velocity")) : NaN;
}

/** Largest μ up to a speed; the law is not monotone. */
export function largestCoefficient(law: FrictionLaw, speed: number): number {
    let largest = coefficient(law, speed);
    for (let v = law.slip_velocity * 1e-4; v < speed; v *= 1.25) {
        largest = Math.max(largest, coefficient(law, v));
    }
    return largest;
}
