/** The report of a run whose blocks rise and turn, in a browser; the run is made by hand (`turned.mjs`). */

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { assertShows, goTo, launch, open } from "./page.mjs";
import { makeTurned, motion, touch } from "./turned.mjs";
import { concio, desk, example, run, wall } from "./truth.mjs";

const place = desk();
let browser;
let results;

before(async () => {
    const text = wall("xtask/walls/driven-top").replace('duration = "0.5 s"', 'duration = "0.2 s"');
    const from = run(place.folder, "shear", `${text}\n[output]\ninterval = "1 ms"\nframes = "2 ms"\n`);
    results = makeTurned(from, join(place.folder, "turned"));
    browser = await launch();
});

after(async () => {
    await browser?.close();
    place.remove();
});

/** Facts of the page at its frame: where the corners of a block are in the window, by the numbers in the page alone. */
const corners = (page, block) => page.evaluate((name) => {
    const { store, stage } = window.concioReport;
    const { report, frame, magnify } = store;
    document.querySelector(".stage canvas").scrollIntoView({ block: "center" });
    const i = report.contents.block_names.indexOf(name);
    const [u, v, turn] = ["displacement", "vertical", "rotation"].map((field) => report.frames.value(field, frame, i));
    const { x0, x1, y0, y1 } = report.block;
    const [cx, cy] = [(x0[i] + x1[i]) / 2, (y0[i] + y1[i]) / 2];
    const area = document.querySelector(".stage canvas").getBoundingClientRect();
    return [[x0[i], y0[i]], [x1[i], y0[i]], [x1[i], y1[i]], [x0[i], y1[i]]].map(([x, y]) => {
        const [rx, ry] = [x - cx, y - cy];
        const moved = [cx + u + Math.cos(turn) * rx - Math.sin(turn) * ry, cy + v + Math.sin(turn) * rx + Math.cos(turn) * ry];
        const [dx, dy] = [magnify * (moved[0] - x), magnify * (moved[1] - y)];
        return [area.left + stage.view.x(x + dx), area.top + stage.view.y(y + dy)];
    });
}, block);

/** Opacity of the canvas at points of the window. */
const opacities = (page, points) => page.evaluate((points) => {
    const canvas = document.querySelector(".stage canvas");
    const area = canvas.getBoundingClientRect();
    const ratio = window.devicePixelRatio || 1;
    const { data, width } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return points.map(([x, y]) => data[4 * (Math.floor((y - area.top) * ratio) * width + Math.floor((x - area.left) * ratio)) + 3]);
}, points);

const painted = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

test("quantities are those of a planar run, with the numbers of its frames", async () => {
    const { page, problems } = await open(browser, results);
    const frames = await page.evaluate(() => window.concioReport.store.report.frames.count);
    const options = await page.locator("#paint option").allTextContents();
    for (const label of ["vertical displacement relative to the base", "rotation relative to the base", "slip", "opening"]) {
        assert.ok(options.includes(label), `${label} is no choice: ${options.join("; ")}`);
    }
    assert.ok(!options.includes("elastic force") && !options.includes("damping force"), options.join("; "));
    const names = await page.evaluate(() => {
        const { block_names, joint_names } = window.concioReport.store.report.contents;
        return { block: block_names, joint: joint_names };
    });
    for (const frame of [0, 33, frames - 1]) {
        await goTo(page, frame);
        const i = names.block.length - 2;
        const middle = (await corners(page, names.block[i])).reduce(([a, b], [x, y]) => [a + x / 4, b + y / 4], [0, 0]);
        await page.mouse.move(...middle);
        // Until the page has followed the pointer it tells of what was under it before.
        await page.waitForFunction((name) => document.querySelector(".tooltip:not([hidden]) strong")?.textContent === name, names.block[i]);
        const { vertical, rotation } = motion(frame, frames, i);
        await assertShows(page.locator('.tooltip data[data-key="moment/vertical"]'), vertical, "m", 0.03, "rise");
        await assertShows(page.locator('.tooltip data[data-key="moment/rotation"]'), rotation, "rad", 0.3, "rotation");
        const joint = await page.locator('[data-item^="joint/"]').first().getAttribute("data-item");
        const e = names.joint.indexOf(joint.slice("joint/".length));
        for (const [key, value] of Object.entries(touch(frame, frames, e))) {
            const cell = page.locator(`[data-item="${joint}"] data[data-key="moment/${key}"]`);
            const [unit, size] = { slip: ["m", 1e-3], opening: ["m", 6e-3], pressure: ["N", 700], friction: ["N", 300] }[key];
            await assertShows(cell, value, unit, size, `${joint} ${key}`);
        }
    }
    assert.deepEqual(problems, []);
});

test("blocks are drawn turned, where their frame puts them, at any magnification", async () => {
    const { page, problems } = await open(browser, results);
    await page.locator("body").press("End");
    assert.equal(await page.locator("#factor").evaluate((e) => Number(e.value)), 1, "such rotations are seen as they are");
    // At the left end of the wall, where nothing is beyond it.
    const block = "p1c3b1";
    for (const factor of ["1", "2"]) {
        await page.locator("#factor").selectOption(factor);
        await painted(page);
        const outline = await corners(page, block);
        const centre = outline.reduce(([a, b], [x, y]) => [a + x / 4, b + y / 4], [0, 0]);
        const toward = ([x, y], part) => [centre[0] + part * (x - centre[0]), centre[1] + part * (y - centre[1])];
        if (factor === "1") {
            const around = [outline[0], outline[3]].flatMap((corner) => [toward(corner, 0.9), toward(corner, 1.2)]);
            assert.deepEqual(await opacities(page, around), [255, 0, 255, 0], "inside and outside of the corners on the left");
        }
        await page.mouse.move(...toward(outline[0], 0.7));
        await page.waitForSelector(".tooltip:not([hidden])");
        assert.equal(await page.locator(".tooltip strong").textContent(), block);
    }
    assert.deepEqual(problems, []);
});

test("it plays with every quantity", async () => {
    const { page, problems } = await open(browser, results);
    const options = await page.locator("#paint option").evaluateAll((all) => all.map((o) => o.value));
    for (const value of options) {
        await page.locator("#paint").selectOption(value);
        await painted(page);
    }
    await page.locator("body").press("Home");
    await page.locator("body").press(" ");
    await page.waitForFunction(() => Number(document.querySelector(".player input").value) > 5);
    assert.deepEqual(problems, []);
});

/** The corners of a block at the frame, from the table of corners that the program itself exports. */
const moved = (page, name, corners) => page.evaluate(([name, corners, centre]) => {
    const { store, stage } = window.concioReport;
    const { report, frame, magnify } = store;
    document.querySelector(".stage canvas").scrollIntoView({ block: "center" });
    const i = report.contents.block_names.indexOf(name);
    const [u, v, turn] = ["displacement", "vertical", "rotation"].map((field) => report.frames.value(field, frame, i));
    const canvas = document.querySelector(".stage canvas").getBoundingClientRect();
    return corners.map(([x, y]) => {
        const [rx, ry] = [x - centre[0], y - centre[1]];
        const [dx, dy] = [u + (Math.cos(turn) - 1) * rx - Math.sin(turn) * ry, v + Math.sin(turn) * rx + (Math.cos(turn) - 1) * ry];
        return [canvas.left + stage.view.x(x + magnify * dx), canvas.top + stage.view.y(y + magnify * dy)];
    });
}, [name, corners, centreOf(corners)]);

function centreOf(corners) {
    let [area, x, y] = [0, 0, 0];
    corners.forEach(([ax, ay], k) => {
        const [bx, by] = corners[(k + 1) % corners.length];
        const cross = ax * by - bx * ay;
        [area, x, y] = [area + cross, x + (ax + bx) * cross, y + (ay + by) * cross];
    });
    return [x / (3 * area), y / (3 * area)];
}

test("the voussoirs of an arch are drawn with their own corners, at rest and as they fall", async () => {
    const from = run(place.folder, "arch", example("17-arch").replace('duration = "3.2 s"', 'duration = "2.4 s"'));
    concio(from, "export", ".", "--csv");
    const rows = readFileSync(join(from, "csv", "corners.csv"), "utf8").trimEnd().split("\n").slice(1).map((line) => line.split(","));
    const { page, problems } = await open(browser, from);
    await page.locator("#factor").selectOption("1");
    for (const key of ["Home", "End"]) {
        await page.locator("body").press(key);
        await painted(page);
        for (const name of ["p1c1b6", "p1c1b16"]) {
            const outline = await moved(page, name, rows.filter((row) => row[0] === name).map((row) => row.slice(1).map(Number)));
            assert.equal(outline.length, 4);
            const [left, right] = [Math.min, Math.max].map((end) => end(...outline.map(([x]) => x)));
            const [top, bottom] = [Math.min, Math.max].map((end) => end(...outline.map(([, y]) => y)));
            const centre = centreOf(outline);
            const inside = outline.map(([x, y]) => [centre[0] + 0.85 * (x - centre[0]), centre[1] + 0.85 * (y - centre[1])]);
            assert.deepEqual(await opacities(page, inside), [255, 255, 255, 255], `${key}: inside ${name}`);
            // A haunch leaves two corners of the rectangle around it: those towards the back and the soffit.
            const leans = name === "p1c1b6" ? [[left + 2, top + 2], [right - 2, bottom - 2]] : [[right - 2, top + 2], [left + 2, bottom - 2]];
            assert.deepEqual(await opacities(page, leans), [0, 0], `${key}: beside ${name}`);
            await page.mouse.move(...centre);
            await page.waitForSelector(".tooltip:not([hidden])");
            assert.equal(await page.locator(".tooltip strong").textContent(), name);
            await page.mouse.move(1, 1);
        }
    }
    // The browser grumbles at the second time that the test looks at the pixels.
    assert.deepEqual(problems.filter((text) => !text.includes("willReadFrequently")), []);
});
