/**
 * Times by the clock, for people: `npm run measure -- DIR…` with folders that hold a report. Opens each, waits until the wall is
 * drawn, then draws every frame in turn; software rendering, as in a browser without a graphics card.
 */

import { statSync } from "node:fs";
import { join } from "node:path";
import { launch, open } from "./page.mjs";

const browser = await launch();
for (const folder of process.argv.slice(2)) {
    const size = statSync(join(folder, "report.html")).size / 1e6;
    const start = performance.now();
    const { page, problems } = await open(browser, folder);
    await page.waitForFunction(() => window.concioReport !== undefined);
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    const loaded = performance.now() - start;
    const times = await page.evaluate(async () => {
        const { store, stage } = window.concioReport;
        const all = {};
        const planar = store.report.contents.planar;
        for (const label of planar ? ["horizontal displacement", "tangential force"] : ["displacement", "friction force"]) {
            const select = document.querySelector("#paint");
            select.value = [...select.options].find((o) => o.text.startsWith(label)).value;
            select.dispatchEvent(new Event("change"));
            const count = Math.min(400, store.report.frames.count);
            const found = [];
            for (let k = 0; k < count; k++) {
                const start = performance.now();
                store.go(Math.floor((k * store.report.frames.count) / count));
                stage.paint();
                // Commands to the canvas are collected: reading a pixel makes them happen.
                document.querySelector(".stage canvas").getContext("2d").getImageData(0, 0, 1, 1);
                found.push(performance.now() - start);
                if (k % 20 === 0) {
                    await new Promise((done) => requestAnimationFrame(done));
                }
            }
            found.sort((a, b) => a - b);
            all[label] = [found[found.length >> 1], found[Math.floor(found.length * 0.95)]];
        }
        return { blocks: store.report.blocks, joints: store.report.joints, frames: store.report.frames.count, all };
    });
    const per = Object.entries(times.all).map(([label, [median, slow]]) => `${label} ${median.toFixed(1)} ms (95 %: ${slow.toFixed(1)} ms)`);
    console.log(`${folder}: ${times.blocks} blocks, ${times.joints} joints, ${times.frames} frames, ${size.toFixed(1)} MB; `
        + `loaded in ${(loaded / 1000).toFixed(2)} s; a picture of ${per.join(", of ")}${problems.length > 0 ? `; ${problems}` : ""}`);
    await page.close();
}
await browser.close();
