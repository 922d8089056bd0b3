/** The wall as it is shown, for paper: with its colours, the instant and the factor on displacements. */

import { NOTHING, seconds, count } from "../format";
import { fullLabel } from "../quantities";
import type { Store } from "../store";
import { palette } from "../theme";
import { barMarks, largestText, whenText } from "../ui/bar";
import { draw } from "./draw";
import type { Places } from "./places";
import type { View } from "./view";

const FONT = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";
/** Pixels of the picture for one of the page; room above the wall and below it, length and height of the bar of colours [px]. */
const SHARP = 3;
const [ABOVE, BELOW, LONG, HIGH] = [44, 62, 280, 12];

export function picture(store: Store, view: View, at: Places, [width, height]: [number, number]): HTMLCanvasElement {
    const sheet = (w: number, h: number): [HTMLCanvasElement, CanvasRenderingContext2D] => {
        const canvas = document.createElement("canvas");
        [canvas.width, canvas.height] = [w * SHARP, h * SHARP];
        const context = canvas.getContext("2d") as CanvasRenderingContext2D;
        context.scale(SHARP, SHARP);
        return [canvas, context];
    };
    const [wall, onto] = sheet(width, height);
    const scale = draw(onto, [width, height], view, store, at);
    const [canvas, context] = sheet(width, ABOVE + height + BELOW);
    context.fillStyle = palette().paper;
    context.fillRect(0, 0, width, ABOVE + height + BELOW);
    context.drawImage(wall, 0, ABOVE, width, height);
    context.fillStyle = palette().ink;
    context.textAlign = "center";
    context.textBaseline = "middle";
    const write = (text: string, x: number, y: number, font = `12px ${FONT}`) => {
        context.font = font;
        context.fillText(text, x, y, width - 16);
    };
    const { contents, frames } = store.report;
    write(contents.title === "" ? contents.name : contents.title, width / 2, 14, `600 14px ${FONT}`);
    const interval = frames.count > 1 ? frames.time[1] - frames.time[0] : 0;
    const instant = frames.count > 0 ? `t = ${seconds(store.time, interval)}, displacements × ${count(store.magnify)}` : "at rest";
    write(instant, width / 2, 33);
    const [left, top] = [(width - LONG) / 2, ABOVE + height + 22];
    write(`${fullLabel(store.paint)}, ${whenText(store)}${scale.largest >= NOTHING ? `; ${largestText(store, scale)}` : ""}`, width / 2, top - 12);
    const colours = context.createLinearGradient(left, 0, left + LONG, 0);
    scale.stops.forEach((colour, k) => colours.addColorStop(k / (scale.stops.length - 1), colour));
    context.fillStyle = colours;
    context.fillRect(left, top, LONG, HIGH);
    context.fillStyle = palette().ink;
    barMarks(store, scale).forEach((mark, k) => write(mark, left + (k * LONG) / 2, top + HIGH + 11));
    return canvas;
}
