import { readFileSync } from "node:fs";
import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";

/** The bundle is committed, so it carries the licence of what is in it, and it must be safe inside a page. */
function finish(): Plugin {
    return {
        name: "finish",
        generateBundle(_, bundle) {
            const licence = readFileSync(new URL("node_modules/uplot/LICENSE", import.meta.url), "utf8").trim();
            for (const file of Object.values(bundle)) {
                if (file.type === "chunk") {
                    file.code = `/*! This bundle contains uPlot (https://github.com/leeoniya/uPlot):\n\n${licence}\n*/\n${file.code}`;
                }
                const text = file.type === "chunk" ? file.code : String(file.source);
                if (/<\/(script|style)|<!--/i.test(text)) {
                    throw new Error(`${file.fileName} cannot stand in a page: it holds an end tag or a comment mark`);
                }
            }
        },
    };
}

export default defineConfig({
    plugins: [finish()],
    build: {
        // What file:// pages of the last three years understand.
        target: ["chrome108", "firefox115", "safari16"],
        outDir: process.env.CONCIO_REPORT_OUT ?? "../crates/concio-cli/src/report/app",
        emptyOutDir: true,
        cssCodeSplit: false,
        lib: { entry: "src/main.ts", name: "ConcioReport", formats: ["iife"], fileName: () => "app.js", cssFileName: "app" },
    },
    test: { include: ["test/**/*.test.ts"] },
});
