/** The run as a whole: force over displacement, top of the wall, forces, energies, input motion and its spectrum. */

import { h } from "../dom";
import { count, NOTHING, unitText } from "../format";
import { onLayout } from "../layout";
import { axis, colourOf, LEVEL, Panel, UPRIGHT } from "../plots/frame";
import { TimePlot } from "../plots/time";
import { largest } from "../quantities";
import type { Store } from "../store";
import { loopPlot } from "./loop";

interface Figure {
    title: string;
    label: string;
    /** Names of channels and what they are called. */
    curves: [string, string][];
    height?: number;
}

const RESPONSE: Figure[] = [
    { title: "Top of the wall, relative to the base", label: "displacement", curves: [["top/displacement", "top course"], ["beam/displacement", "top beam"]] },
    { title: "Horizontal forces on the wall", label: "force", curves: [["base/shear", "base"], ["top/force", "top beam"]] },
    { title: "Largest displacement of a block at each instant", label: "displacement", curves: [["peak/displacement", "largest"]] },
];
const ENERGY: Figure[] = [
    {
        title: "Energy by mechanism",
        label: "energy",
        height: 260,
        curves: [
            ["energy/input", "work done"], ["energy/friction", "friction"], ["energy/damping", "damping"], ["energy/elastic", "elastic"],
            ["energy/kinetic", "kinetic"], ["energy/bond", "broken bonds"], ["energy/device", "hysteresis of devices"], ["energy/impact", "impacts"], ["energy/nonreciprocal", "unbalanced friction"],
        ],
    },
    { title: "Residual of the energy account", label: "energy", height: 260, curves: [["energy/residual", "residual"]] },
];
const INPUT: Figure[] = [
    { title: "Base acceleration", label: "acceleration", curves: [["base/acceleration", "base"]] },
    { title: "Base displacement", label: "displacement", curves: [["base/displacement", "base"]] },
];

export function overview(store: Store): HTMLElement[] {
    const beam = store.report.contents.beam.kind;
    const input = [...INPUT];
    if (beam === "driven") {
        input.push({ title: "Motion of the driven beam, relative to the base", label: "displacement", curves: [["beam/displacement", "top beam"]] });
    }
    const spectrum = responseSpectrum(store);
    const loop = loopPlot(store, 260);
    if (loop !== null) {
        later(loop.element, loop.show);
    }
    return [
        section("response", "The run as a whole", [...(loop === null ? [] : [loop.element]), ...figures(store, RESPONSE)], thinned(store)),
        section("energy", "Energy", figures(store, ENERGY), ""),
        section("motion", "Input motion", [...figures(store, input), ...(spectrum === null ? [] : [spectrum])], "", "Nothing moves base or top."),
    ];
}

function section(id: string, title: string, plots: HTMLElement[], note: string, empty = "No history differs from zero."): HTMLElement {
    const body = plots.length > 0 ? h("div", { class: "grid" }, ...plots) : h("p", { class: "empty" }, empty);
    const notes = note === "" ? [] : [h("p", { class: "small" }, note)];
    return h("section", { id }, h("h2", {}, title), body, ...notes);
}

function thinned(store: Store): string {
    const { samples, points } = store.report.contents.curve;
    return samples > points
        ? `Curves of the run are drawn through the lowest and highest of every ${Math.round((2 * samples) / points)} of their `
            + `${count(samples)} samples, forces over displacements through as many as hold their extremes; all samples are in result.h5. `
            + "The values beside the names are those at the frame shown."
        : "";
}

/** Figures whose channels are not zero throughout. */
function figures(store: Store, list: Figure[]): HTMLElement[] {
    return list.flatMap((figure) => {
        const { report } = store;
        const found = figure.curves
            .map(([channel, name]) => ({ channel: report.channel(channel), name }))
            .filter(({ channel }) => channel >= 0 && largest(report.curve(channel)) >= NOTHING);
        if (found.length === 0) {
            return [];
        }
        const unit = unitText(report.contents.channels[found[0].channel].unit);
        const curves = found.map(({ channel, name }, k) => {
            const frames = report.atFrames(channel);
            const now = report.frames.count > 0 ? { now: () => frames[store.frame] } : {};
            return { name, line: k, values: report.curve(channel), ...now };
        });
        const plot = new TimePlot(store, figure.title, figure.height ?? 210);
        later(plot.panel.element, () => plot.show(figure.label, unit, report.array("curve/time"), curves));
        return [plot.panel.element];
    });
}

/** Draws when the element comes near the window, or is printed: a long page opens at once. */
function later(element: HTMLElement, show: () => void): void {
    let waits = true;
    const now = () => {
        if (waits) {
            waits = false;
            observer.disconnect();
            show();
        }
    };
    const observer = new IntersectionObserver((entries) => entries.some((entry) => entry.isIntersecting) && now(), { rootMargin: "400px" });
    onLayout((printing) => printing && now());
    observer.observe(element);
}

function responseSpectrum(store: Store): HTMLElement | null {
    const { spectrum } = store.report.contents;
    if (spectrum === null) {
        return null;
    }
    const { report } = store;
    const [period, psa] = [report.array("spectrum/period"), report.array("spectrum/psa")];
    const note = `Of the base acceleration as the run kept it, every ${spectrum.interval} s.`;
    const title = `Response spectrum of the base, ${100 * spectrum.damping} % damping`;
    const panel = new Panel(title, 210, report.contents.name, note);
    panel.table = () => [{ head: "period [s]", values: period }, { head: "pseudo-acceleration [m/s²]", values: psa }];
    later(panel.element, () => panel.show((scale) => ({
        options: {
            legend: { show: false },
            padding: [8 * scale, 12 * scale, 0, 0],
            cursor: { show: false },
            scales: { x: { time: false, distr: 3, range: () => [period[0], period[period.length - 1]] }, y: { range: (_, __, high) => [0, high * 1.08 || 1] } },
            axes: [
                axis("period", "s", 1, scale, LEVEL, { splits: () => [0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 4], filter: (_, splits) => splits }),
                axis("pseudo-acceleration", "m/s²", largest(psa), scale, UPRIGHT),
            ],
            series: [{}, { stroke: () => colourOf(0), width: 1.5 * scale, points: { show: false } }],
        },
        data: [period, psa] as never,
    })));
    panel.place.setAttribute("role", "img");
    panel.place.setAttribute("aria-label", "Response spectrum: pseudo-acceleration over period");
    return panel.element;
}
