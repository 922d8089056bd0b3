/** Force over displacement of the whole wall: what it bears, and how it comes back. */

import { h } from "../dom";
import { NOTHING } from "../format";
import { PhasePlot } from "../plots/phase";
import { largest } from "../quantities";
import type { Store } from "../store";

interface Loop {
    name: string;
    x: string;
    y: string;
    labels: [string, string];
    /** −1 where the force is told as the one that acts on the wall, against its displacement. */
    sign: number;
}

const COURSE: Loop = {
    name: "base shear over displacement of the top course",
    x: "top/displacement", y: "base/shear", labels: ["displacement of the top course", "base shear"], sign: -1,
};
const BASE: Loop = {
    name: "base shear over displacement of the top beam",
    x: "beam/displacement", y: "base/shear", labels: ["displacement of the top beam", "base shear"], sign: -1,
};
const BEAM: Loop = {
    name: "force of the top beam over its displacement",
    x: "beam/displacement", y: "top/force", labels: ["displacement of the top beam", "force of the top beam"], sign: 1,
};
const NOTE = "Base shear is the force of the wall on the base, so that it rises with the displacement; displacements are relative to the base.";

/** The plot with its choice; null where nothing moves or bears. Drawn by the function that comes with it. */
export function loopPlot(store: Store, height: number): { element: HTMLElement; show: () => void } | null {
    const { report } = store;
    // With an actuator at the top its curve is that of the laboratory.
    const order = report.contents.beam.kind === "driven" ? [BEAM, BASE, COURSE] : [BASE, COURSE, BEAM];
    const loops = order.filter(({ x, y }) => report.together([x, y])?.values.every((values) => largest(values) >= NOTHING));
    if (loops.length === 0) {
        return null;
    }
    const plot = new PhasePlot(store, "Force over displacement", height, NOTE);
    const show = (loop: Loop) => {
        const found = report.together([loop.x, loop.y]);
        if (found === null) {
            return;
        }
        const signed = (values: ArrayLike<number>) => (loop.sign > 0 ? values : Float32Array.from(values, (v) => 0 - v));
        const [x, y] = found.values;
        const at = {
            x: report.atFrames(report.channel(loop.x)),
            y: Float64Array.from(report.atFrames(report.channel(loop.y)), (v) => loop.sign * v),
            time: found.time,
        };
        plot.show([loop.labels[0], "m"], [loop.labels[1], "N"], [{ name: "", line: 0, x, y: signed(y), at }]);
    };
    if (loops.length > 1) {
        const options = loops.map((loop, k) => h("option", { value: k }, loop.name));
        const select = h("select", { "data-choice": "loop", "aria-label": "Force over displacement of", "onchange": (event) => {
            show(loops[Number((event.target as HTMLSelectElement).value)]);
        } }, ...options);
        plot.panel.choices.append(select);
    } else {
        plot.panel.choices.append(loops[0].name);
    }
    return { element: plot.panel.element, show: () => show(loops[0]) };
}
