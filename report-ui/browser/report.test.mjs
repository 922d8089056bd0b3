/**
 * The report in a browser, from file://, against the tables that `concio export` makes of the same run.
 * Every block and joint is kept at every sample there, so that each number on the page has its counterpart.
 */

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { assertShows, goTo, launch, open, shown } from "./page.mjs";
import { concio, desk, example, read, run, wall } from "./truth.mjs";

/** Samples from frame to frame in the runs below. */
const EVERY = 2;
const KEEP_ALL = '[output]\ninterval = "1 ms"\nframes = "2 ms"\nblocks = ["all"]\njoints = ["all"]\n';

const place = desk();
let browser;
const runs = {};

before(async () => {
    const driven = wall("xtask/walls/driven-top").replace('duration = "0.5 s"', 'duration = "0.3 s"');
    const panels = example("studies/two-panels").replace(/\[output\][^]*/, "").replace('duration = "1 s"', 'duration = "0.6 s"');
    for (const [name, text] of Object.entries({ driven, panels })) {
        const results = run(place.folder, name, `${text}\n${KEEP_ALL}`);
        runs[name] = { results, truth: read(results) };
    }
    browser = await launch();
});

after(async () => {
    await browser?.close();
    place.remove();
});

const at = (truth, channel, frame) => {
    assert.ok(channel in truth.histories, `no channel ${channel}`);
    return Number(truth.histories[channel][EVERY * frame]);
};

/** What a joint does at a frame, from the histories; friction by the law, from the coefficients in the tables. */
function jointTruth(truth, name, frame) {
    const row = truth.joints.get(name);
    const side = (end) => (end === "base" ? 0 : at(truth, end === "top" ? "beam/acceleration" : `block/${end}/acceleration`, frame));
    const sign = ["head", "connection"].includes(row.kind) ? -1 : 1;
    const of = (quantity) => at(truth, `joint/${name}/${quantity}`, frame);
    const v = sign * of("velocity");
    const [s, d, limit, beta] = ["friction_static", "friction_dynamic", "friction_slip_velocity", "friction_beta"].map((k) => Number(row[k]));
    const mu = (2 / Math.PI) * Math.atan((beta * v) / limit) * ((s - d) * Math.exp(-Math.abs(v) / limit) + d);
    return {
        displacement: [of("slip"), "m", "displacement"],
        velocity: [of("velocity"), "m/s", "velocity"],
        acceleration: [sign * (side(row.a) - side(row.b)), "m/s²", "acceleration"],
        elastic: [of("elastic"), "N", "force"],
        damping: [of("damping"), "N", "force"],
        friction: [row.friction_law === "none" ? 0 : Number(row.normal_force_a) * mu, "N", "force"],
    };
}

function blockTruth(truth, name, frame) {
    const of = (quantity, unit) => [at(truth, `block/${name}/${quantity}`, frame), unit, quantity];
    return { displacement: of("displacement", "m"), velocity: of("velocity", "m/s"), acceleration: of("acceleration", "m/s²") };
}

const UNITS = { displacement: "m", velocity: "m/s", acceleration: "m/s²", force: "N", slip: "m", opening: "m", closing: "m", dissipation: "J" };

/** Compares all numbers of a table, at the moment and peaks, and that all that should be there are. */
async function assertTable(table, truth, owner, name, frame) {
    const peaks = truth.peaks[owner].get(name);
    const moment = owner === "block" ? blockTruth(truth, name, frame) : jointTruth(truth, name, frame);
    const keys = await table.locator("data").evaluateAll((all) => all.map((e) => e.dataset.key));
    for (const key of Object.keys(moment)) {
        assert.ok(keys.includes(`moment/${key}`), `${name}: ${key} is not shown`);
    }
    for (const key of keys) {
        const [when, quantity] = key.split("/");
        const [value, unit, scale] = when === "moment" ? moment[quantity] : [Number(peaks[quantity]), UNITS[quantity], quantity];
        // Forces of joints that hardly move are measured by the forces of the wall.
        const size = Math.max(Number(peaks[scale]), scale === "force" ? 1 : 0);
        await assertShows(table.locator(`data[data-key="${key}"]`), value, unit, size, `${name} ${key} at frame ${frame}`);
    }
}

const numbers = (page) => page.evaluate(() => {
    const { frames } = window.concioReport.store.report;
    return { frames: frames.count, time: Array.from(frames.time) };
});

/** Where a block or a joint is drawn, in the window. */
const locate = (page, owner, name) => page.evaluate(([owner, name]) => {
    const { store, stage } = window.concioReport;
    const { report } = store;
    const { view } = stage;
    document.querySelector(".stage canvas").scrollIntoView({ block: "center" });
    const shift = (unknown) => (unknown < 0 ? 0 : report.frames.value("displacement", store.frame, unknown) * store.magnify * view.zoom);
    const area = document.querySelector(".stage canvas").getBoundingClientRect();
    const i = report.contents[`${owner}_names`].indexOf(name);
    const middle = (list, a, b) => (list[a][i] + list[b][i]) / 2;
    const moved = owner === "block" ? shift(i) : (shift(report.joint.a[i]) + shift(report.joint.b[i])) / 2;
    return [area.left + view.x(middle(report[owner], "x0", "x1")) + moved, area.top + view.y(middle(report[owner], "y0", "y1"))];
}, [owner, name]);

const WATCHED = {
    driven: { block: ["p1c6b2", "p1c1b1"], joint: ["p1c3b2|p1c4b2", "base|p1c1b2", "p1c6b2|top", "p1c4b2|p1c4b3"] },
    panels: { block: ["p1c6b1", "p2c2b1"], joint: ["p2c1b1|p2c2b1", "p2c3b2|top", "p1c5b1|p1c5b2"] },
};

for (const name of ["driven", "panels"]) {
    test(`${name}: pointing at a block or joint shows the numbers of the result`, async () => {
        const { results, truth } = runs[name];
        const { page, problems } = await open(browser, results);
        const { frames } = await numbers(page);
        assert.equal(frames, Math.ceil(truth.histories.time.length / EVERY));
        for (const frame of [0, 37, 101, frames - 1]) {
            await goTo(page, frame);
            for (const owner of ["block", "joint"]) {
                for (const item of WATCHED[name][owner]) {
                    await page.mouse.move(...(await locate(page, owner, item)));
                    await page.waitForSelector(".tooltip:not([hidden])");
                    assert.equal(await page.locator(".tooltip strong").textContent(), item);
                    await assertTable(page.locator(".tooltip"), truth, owner, item, frame);
                }
            }
        }
        assert.deepEqual(problems, []);
    });
}

test("selected blocks and joints have histories with the numbers of the result at the moment", async () => {
    const { results, truth } = runs.driven;
    const { page, problems } = await open(browser, results);
    const { time } = await numbers(page);
    while ((await page.locator(".cards .remove").count()) > 0) {
        await page.locator(".cards .remove").first().click();
    }
    await page.waitForSelector(".response .empty:not([hidden])");
    const [block, joint] = ["p1c5b3", "p1c2b4|p1c3b3"];
    await page.locator(".find summary").click();
    for (const item of [block, joint]) {
        await page.locator(".picker input").fill(item);
        await page.locator(".picker input").press("ArrowDown");
        const list = page.locator("[role=listbox]");
        while ((await list.locator(".active .name").textContent()) !== item) {
            await page.keyboard.press("ArrowDown");
        }
        await page.keyboard.press("Enter");
    }
    assert.deepEqual(await page.locator(".cards strong").allTextContents(), [joint, block]);
    const plots = page.locator(".response");
    for (const frame of [0, 42, 149]) {
        await goTo(page, frame);
        await assertTable(page.locator(`[data-item="block/${block}"]`), truth, "block", block, frame);
        await assertTable(page.locator(`[data-item="joint/${joint}"]`), truth, "joint", joint, frame);
        for (const [k, owner, item] of [[0, "block", block], [1, "joint", joint]]) {
            const moment = owner === "block" ? blockTruth(truth, item, frame) : jointTruth(truth, item, frame);
            for (const [place, [key, [value, unit, scale]]] of Object.entries(moment).entries()) {
                await page.locator(`[data-choice="${owner}/history of"]`).selectOption(String(place));
                const size = Math.max(Number(truth.peaks[owner].get(item)[scale]), scale === "force" ? 1 : 0);
                const legend = plots.nth(k).locator(".plot").first().locator(".legend data");
                await assertShows(legend, value, unit, size, `history of ${item} ${key} at frame ${frame}`);
            }
        }
    }
    // A click in a plot moves the time.
    await plots.first().scrollIntoViewIfNeeded();
    const area = await plots.first().locator(".u-over").first().boundingBox();
    await page.mouse.click(area.x + 0.25 * area.width, area.y + 0.5 * area.height);
    const seconds = parseFloat((await page.locator(".clock").textContent()).replace("t = ", ""));
    assert.ok(Math.abs(seconds - 0.25 * time.at(-1)) < 0.02 * time.at(-1), `the click went to ${seconds} s`);
    const frame = time.findIndex((t) => Math.abs(t - seconds) < 5e-4);
    await assertTable(page.locator(`[data-item="joint/${joint}"]`), truth, "joint", joint, frame);
    // Shift and a drag enlarge, a double click shows all again; the time stays.
    const [left, right] = [0.4, 0.6].map((part) => area.x + part * area.width);
    const span = () => page.evaluate(() => window.concioReport.span());
    const whole = await span();
    await page.keyboard.down("Shift");
    await page.mouse.move(left, area.y + 40);
    await page.mouse.down();
    await page.mouse.move(right, area.y + 60, { steps: 3 });
    await page.mouse.up();
    await page.keyboard.up("Shift");
    assert.ok((await span()) < 0.25 * whole, "the stretch is not enlarged");
    await page.mouse.dblclick(left, area.y + 40);
    assert.equal(await span(), whole);
    await goTo(page, frame);
    // A click in a phase portrait goes to the point nearest to it.
    const portrait = await plots.first().locator(".u-over").nth(1).boundingBox();
    await page.mouse.click(portrait.x + 2, portrait.y + 0.5 * portrait.height);
    assert.notEqual(await page.locator(".clock").textContent(), `t = ${seconds.toFixed(3)} s`);
    assert.deepEqual(problems, []);
});

test("curves of the run show the channels at the moment", async () => {
    const { results, truth } = runs.panels;
    const { page } = await open(browser, results);
    const [frame, curves] = [203, [
        ["Top of the wall", "top course", "top/displacement", "m"], ["Top of the wall", "top beam", "beam/displacement", "m"],
        ["Horizontal forces", "base", "base/shear", "N"], ["Horizontal forces", "top beam", "top/force", "N"],
        ["Energy by mechanism", "friction", "energy/friction", "J"], ["Energy by mechanism", "work done", "energy/input", "J"],
        ["Base acceleration", "base", "base/acceleration", "m/s²"],
    ]];
    await goTo(page, frame);
    for (const [title, curve, channel, unit] of curves) {
        const plot = page.locator(".plot", { hasText: title }).first();
        await plot.scrollIntoViewIfNeeded();
        const entry = plot.locator(".legend li").filter({ has: page.locator(`span:text-is("${curve}")`) });
        const size = Math.max(...truth.histories[channel].map((v) => Math.abs(Number(v))));
        await assertShows(entry.locator("data"), at(truth, channel, frame), unit, size, channel);
    }
    await page.locator(".plot", { hasText: "Response spectrum" }).scrollIntoViewIfNeeded();
    await page.waitForSelector("#motion .uplot canvas");
});

test("it plays, pauses and scrubs", async () => {
    const { results, truth } = runs.driven;
    const { page, problems } = await open(browser, results);
    const { frames, time } = await numbers(page);
    const clock = page.locator(".clock");
    // It opens at the largest displacement and plays from the start.
    const sizes = time.map((_, frame) => at(truth, "peak/displacement", frame));
    const peak = sizes.indexOf(Math.max(...sizes));
    assert.equal(await clock.textContent(), `t = ${time[peak].toFixed(3)} s`);
    await page.locator("body").press(" ");
    await page.waitForFunction((peak) => Number(document.querySelector(".player input").value) < peak / 2, peak);
    await page.waitForFunction(() => document.querySelector(".player input").value !== "0");
    assert.equal(await page.locator(".play").getAttribute("aria-label"), "Pause");
    await page.keyboard.press(" ");
    assert.equal(await page.locator(".play").getAttribute("aria-label"), "Play");
    const stopped = await clock.textContent();
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.equal(await clock.textContent(), stopped);
    const slider = page.locator(".player input");
    await slider.fill(String(frames - 2));
    assert.equal(await clock.textContent(), `t = ${time[frames - 2].toFixed(3)} s`);
    const before = await page.locator(".stage canvas").screenshot();
    // Played from near its end it ends there, and from the end it starts anew.
    await page.locator(".field", { hasText: "speed" }).locator("select").selectOption("10");
    await page.locator(".play").click();
    await page.waitForFunction(() => document.querySelector(".play").getAttribute("aria-label") === "Play");
    assert.equal(await slider.inputValue(), String(frames - 1));
    await page.locator("body").press("Home");
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
    assert.notDeepEqual(await page.locator(".stage canvas").screenshot(), before, "the wall does not move");
    await page.locator(".peak").click();
    assert.equal(await clock.textContent(), `t = ${time[peak].toFixed(3)} s`);
    assert.deepEqual(problems, []);
});

test("everything can be reached with the keyboard, and focus is seen", async () => {
    const { page } = await open(browser, runs.driven.results);
    const reached = new Set();
    for (let k = 0; k < 40; k++) {
        await page.keyboard.press("Tab");
        const [name, outline, inside] = await page.evaluate(() => {
            const e = document.activeElement;
            const labels = e.labels?.[0]?.textContent ?? "";
            return [e.getAttribute("aria-label") ?? (labels || e.textContent).slice(0, 40), getComputedStyle(e).outlineStyle, e !== document.body];
        });
        if (!inside) {
            break;
        }
        assert.notEqual(outline, "none", `focus on ${name} is not seen`);
        reached.add(name.replace(/^Wall of.*/, "wall").replace(/^(colour by|displacements|history of|speed).*/, "$1"));
    }
    for (const name of ["wall", "Larger", "Whole wall", "Play", "Time", "Speed", "colour by", "displacements", "Choose blocks and joints from a list", "history of"]) {
        assert.ok(reached.has(name), `${name} is not reached: ${[...reached].join("; ")}`);
    }
    const clock = page.locator(".clock");
    await page.locator(".player input").focus();
    await page.keyboard.press("End");
    assert.equal(await clock.textContent(), "t = 0.300 s");
    await page.keyboard.press("ArrowLeft");
    assert.equal(await clock.textContent(), "t = 0.298 s");
    assert.equal(await page.locator(".player input").getAttribute("aria-valuetext"), "0.298 s");
});

test("colours follow the choice, and the bar tells their range", async () => {
    const { results, truth } = runs.driven;
    const { page, problems } = await open(browser, results);
    await goTo(page, 120);
    const seen = new Set();
    const options = await page.locator("#paint option").evaluateAll((all) => all.map((o) => o.value));
    assert.equal(options.length, 20);
    for (const option of options) {
        await page.locator("#paint").selectOption(option);
        await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
        seen.add((await page.locator(".stage canvas").screenshot()).toString("base64"));
    }
    assert.ok(seen.size >= 19, `${seen.size} different pictures of 20 quantities`);
    await page.locator("#paint").selectOption({ label: "way slipped" });
    const most = Math.max(...[...truth.peaks.joint.values()].map((j) => Number(j.slip)));
    await page.waitForFunction(() => document.querySelector(".colour-bar .what").textContent.startsWith("way slipped"));
    const high = await page.locator(".colour-bar .marks span").last().textContent();
    // The bar ends at a round number.
    const end = shown(high, "m").value / most;
    assert.ok(end >= 0.999 && end < 2, `${high} for ${most}`);
    assert.deepEqual(problems, []);
});

const painted = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));

test("the wall is enlarged by keys, wheel and buttons, and drags; blocks are found where they are drawn", async () => {
    const { page, problems } = await open(browser, runs.driven.results);
    const factor = () => page.locator(".zoom .factor").textContent();
    const whole = await page.locator(".stage canvas").screenshot();
    await page.locator(".zoom button", { hasText: "+" }).click();
    assert.equal(await factor(), "× 1.5");
    await page.locator(".stage canvas").focus();
    await page.keyboard.press("+");
    assert.equal(await factor(), "× 2.3");
    const clock = await page.locator(".clock").textContent();
    const block = "p1c4b3";
    const [x, y] = await locate(page, "block", block);
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.locator(".clock").textContent(), clock, "the arrow keys shift the enlarged wall, not the time");
    const [shifted] = await locate(page, "block", block);
    assert.ok(shifted < x - 5, `${x} px to ${shifted} px`);
    await page.mouse.move(shifted, y);
    await page.waitForSelector(".tooltip:not([hidden])");
    assert.equal(await page.locator(".tooltip strong").textContent(), block);
    const selected = await page.locator(".cards strong").allTextContents();
    await page.mouse.down();
    await page.mouse.move(shifted + 30, y, { steps: 4 });
    await page.mouse.up();
    const [dragged] = await locate(page, "block", block);
    assert.ok(Math.abs(dragged - shifted - 30) < 1, `${shifted} px to ${dragged} px`);
    assert.deepEqual(await page.locator(".cards strong").allTextContents(), selected, "a drag does not select");
    await page.mouse.wheel(0, -200);
    await page.waitForFunction(() => window.concioReport.stage.view.enlarged > 3);
    const [wheeled, level] = await locate(page, "block", block);
    assert.ok(Math.hypot(wheeled - dragged, level - y) < 2, "what is under the pointer stays there");
    await page.locator(".zoom button", { hasText: "whole wall" }).click();
    assert.equal(await factor(), "× 1.0");
    await page.mouse.move(0, 0);
    await page.locator("body").press("Shift");
    await painted(page);
    await page.evaluate(() => document.activeElement.blur());
    assert.deepEqual(await page.locator(".stage canvas").screenshot(), whole);
    assert.deepEqual(problems, []);
});

test("nothing slipped: no scale, and the joint shown first is none of the slivers", async () => {
    const still = wall("crates/concio/tests/data/shear-panel").replace(/\[motion\][^]*/, "");
    const motion = '[motion]\nduration = "0.2 s"\nbase = { pulse = { shape = "one-sine", acceleration = "0.01 g", duration = "0.1 s" } }\n';
    const results = run(place.folder, "still", `${still}${motion}${KEEP_ALL}`);
    const truth = read(results);
    assert.ok([...truth.peaks.joint.values()].every((j) => Number(j.slip) === 0), "a joint slipped");
    const { page, problems } = await open(browser, results);
    await page.locator("#paint").selectOption({ label: "way slipped" });
    await page.waitForSelector(".colour-bar .nothing:not([hidden])");
    assert.equal(await page.locator(".colour-bar .nothing").textContent(), "no joint slipped");
    assert.ok(!(await page.locator(".colour-bar .scale").isVisible()));
    const opened = [...truth.peaks.joint.entries()].filter(([name]) => Number(truth.joints.get(name).overlap) > 0.01);
    const widest = opened.reduce((a, b) => (Number(b[1].opening) > Number(a[1].opening) ? b : a))[0];
    assert.equal(await page.locator(".cards strong").first().textContent(), widest);
    await page.locator("#paint").selectOption({ label: "energy dissipated" });
    await page.waitForSelector(".colour-bar .scale:not([hidden])");
    assert.ok(!(await page.locator(".colour-bar .nothing").isVisible()));
    assert.deepEqual(problems, []);
});

test("it is laid out anew for paper, and for the window again", async () => {
    const { page, problems } = await open(browser, runs.driven.results);
    const widths = () => page.evaluate(() => [...document.querySelectorAll(".uplot")].map((plot) => {
        const area = plot.closest(".plot").getBoundingClientRect();
        const beyond = plot.getBoundingClientRect().right - Math.min(area.right, document.body.getBoundingClientRect().right);
        return [plot.getBoundingClientRect().width, beyond];
    }));
    const drawn = (await widths()).length;
    const before = (await widths())[0];
    const wide = await page.locator(".stage canvas").boundingBox();
    await page.emulateMedia({ media: "print" });
    await page.waitForFunction((drawn) => document.querySelectorAll(".uplot").length > drawn, drawn);
    assert.ok((await page.evaluate(() => document.body.getBoundingClientRect().width)) <= 186 / 25.4 * 96 + 1);
    for (const [width, beyond] of await widths()) {
        assert.ok(width < 703 && beyond < 1, `a plot of ${width} px reaches ${beyond} px beyond its place`);
    }
    const canvas = await page.locator(".stage canvas").boundingBox();
    assert.ok(canvas.width <= 703, `${canvas.width} px of wall`);
    await page.emulateMedia({ media: "screen" });
    // Plots that paper has brought out stand before it now.
    const back = (width) => [...document.querySelectorAll(".uplot")].some((plot) => plot.getBoundingClientRect().width === width);
    await page.waitForFunction(back, before[0]);
    await page.waitForFunction((width) => document.querySelector(".stage canvas").getBoundingClientRect().width === width, wide.width);
    assert.deepEqual(problems, []);
});

test("a phone shows it without scrolling sideways", async () => {
    const { page, problems } = await open(browser, runs.panels.results, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390);
    await goTo(page, 50);
    const [x, y] = await locate(page, "block", "p2c2b1");
    await page.evaluate((top) => window.scrollTo(0, top - 300), y);
    await page.touchscreen.tap(...(await locate(page, "block", "p2c2b1")));
    await page.waitForSelector('[data-item="block/p2c2b1"]');
    assert.ok(x > 0 && x < 390);
    await assertTable(page.locator('[data-item="block/p2c2b1"]'), runs.panels.truth, "block", "p2c2b1", 50);
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390);
    assert.deepEqual(problems, []);
});

test("warnings, input and the way to reproduce it are on the page", async () => {
    const text = example("01-first-wall").replace(/\[motion\][^]*/, "");
    const motion = '[motion]\nduration = "0.2 s"\nbase = { synthetic = { seed = 1, pga = "0.3 g", duration = "6 s" } }\n[output]\nframes = 0\n';
    const results = run(place.folder, "cut", `# <b>marked</b>\n${text}${motion}`);
    const { warnings, inputs_hash } = JSON.parse(readFileSync(join(results, "summary.json"), "utf8"));
    assert.ok(warnings.some((w) => w.includes("cuts the accelerogram of the base")), warnings.join("\n"));
    const { page, problems } = await open(browser, results);
    const body = await page.locator("body").textContent();
    for (const part of [...warnings, inputs_hash, "concio run cut.toml --out cut", "# <b>marked</b>", "kept no frames"]) {
        assert.ok(body.includes(part), part);
    }
    writeFileSync(join(place.folder, "case.json"), await page.locator("#resolved").textContent());
    concio(place.folder, "run", "case.json", "--out", "again");
    const again = JSON.parse(readFileSync(join(place.folder, "again", "summary.json"), "utf8"));
    assert.equal(again.inputs_hash, inputs_hash);
    assert.deepEqual(problems, []);
});

test("without scripts it says what is missing and shows drawings", async () => {
    const { page } = await open(browser, runs.panels.results, { javaScriptEnabled: false });
    assert.ok((await page.locator("noscript, body").allInnerTexts()).join().includes("need JavaScript"));
    assert.ok((await page.locator("svg").count()) > 5);
    assert.ok(await page.locator("#w0 svg").isVisible());
    assert.ok(!(await page.locator("#w1 svg").isVisible()));
});
