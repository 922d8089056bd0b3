/** A browser, pages of reports in it, and numbers as they are shown. */

import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync",
];

export function launch() {
    const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
    assert.ok(existsSync(executablePath), `no browser at ${executablePath}: set CHROMIUM`);
    return chromium.launch({ executablePath, args: FLAGS });
}

/** Opens a report; `problems` fills with everything that the page complains of or asks the network for. */
export async function open(browser, results, options = {}) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
    const page = await context.newPage();
    const problems = [];
    const address = pathToFileURL(join(results, "report.html")).href;
    page.on("console", (message) => {
        if (["error", "warning"].includes(message.type())) {
            problems.push(message.text());
        }
    });
    page.on("pageerror", (error) => problems.push(String(error)));
    page.on("request", (request) => request.url() === address || problems.push(`request for ${request.url()}`));
    await page.goto(address);
    // The data are inflated after the page is there.
    if (options.javaScriptEnabled !== false) {
        await page.waitForFunction(() => window.concioReport !== undefined);
    }
    return { page, problems };
}

/** Goes to a frame as a user does: by the keys. */
export async function goTo(page, frame) {
    // In a list the keys are the list's.
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press("Home");
    for (let k = 0; k < Math.floor(frame / 10); k++) {
        await page.keyboard.press("Shift+ArrowRight");
    }
    for (let k = 0; k < frame % 10; k++) {
        await page.keyboard.press("ArrowRight");
    }
}

const FACTORS = { G: 1e9, M: 1e6, k: 1e3, "": 1, m: 1e-3, µ: 1e-6, n: 1e-9, p: 1e-12 };

/** A number as it is written, and half a unit of its last digit, both in SI. */
export function shown(text, unit) {
    const found = text.replace("−", "-").match(/^(-?\d+(?:\.(\d+))?)(?:e([+-]?\d+))? ?(.*)$/);
    assert.ok(found, `"${text}" is not a number`);
    const [, digits, decimals = "", power = "0", rest] = found;
    assert.ok(rest.endsWith(unit), `"${text}" is not in ${unit}`);
    const factor = FACTORS[rest.slice(0, rest.length - unit.length)] * 10 ** Number(power);
    assert.ok(Number.isFinite(factor), `"${text}" has an unknown prefix`);
    return { value: Number(digits) * factor, half: 0.5 * 10 ** -decimals.length * factor };
}

/** Fails unless the element shows `truth`, to its last digit and, in its machine-readable value, to 10⁻⁶ of `size`. */
export async function assertShows(element, truth, unit, size, what) {
    const [text, exact] = await element.evaluate((e) => [e.textContent, e.value]);
    const { value, half } = shown(text, unit);
    assert.ok(Math.abs(Number(exact) - truth) <= 1e-6 * size + 1e-30, `${what}: ${exact} instead of ${truth}, of at most ${size}`);
    assert.ok(Math.abs(value - truth) <= 1.001 * half + 1e-6 * size, `${what}: shows ${text} instead of ${truth}`);
}
