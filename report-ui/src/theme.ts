/** Light and dark: what canvases are drawn with, and which of the two the page wears. Paper is light. */

import { isPrinting, onLayout } from "./layout";

/** Colours that drawings take; those of the rest of the page are in style.css. */
export interface Palette {
    /** Lines and letters of plots, and their grid. */
    ink: string;
    grid: string;
    /** Around what is marked on the wall. */
    halo: string;
    /** Ground and outline of the beam; outline of the wall at rest. */
    ground: string;
    rest: string;
    brick: string;
    mortar: string;
    beam: string;
    /** Joints without a value. */
    none: string;
    /** The page beneath. */
    paper: string;
    /** Curves and what is selected. */
    lines: string[];
}

const LIGHT: Palette = {
    ink: "#3a3f47", grid: "#e4e7eb", halo: "#ffffff", ground: "#222222", rest: "#c9ccd1", brick: "#ecd9c6", mortar: "#e6e1d8", beam: "#d6dae0",
    none: "#ffffff", paper: "#ffffff",
    lines: ["#0b3c6f", "#c0390b", "#2a8f4f", "#8a5bb5", "#b87900", "#555555", "#148a9c"],
};
/** The wall stays light, so that its colours mean the same. */
const DARK: Palette = {
    ink: "#c3c9d2", grid: "#2c333d", halo: "#12161c", ground: "#c3c9d2", rest: "#525c69", brick: "#d6c5b4", mortar: "#c9c4ba", beam: "#aab2bd",
    none: "#f1efec", paper: "#14181e",
    lines: ["#79b8ff", "#ff8f66", "#5fd08c", "#c7a5f0", "#ecb64f", "#c3c9d2", "#56cfe0"],
};

export type Choice = "automatic" | "light" | "dark";
const KEY = "concio-theme";

const listeners: (() => void)[] = [];
const prefersDark = () => window.matchMedia("(prefers-color-scheme: dark)");
/** Whether something is drawn that is to be saved: for paper. */
let saving = false;

/** Calls after the colours have changed. */
export function onTheme(listener: () => void): void {
    listeners.push(listener);
}

/** What the user has chosen, as far as this browser remembers it for pages from files. */
export function choice(): Choice {
    const chosen = document.documentElement.dataset.theme;
    return chosen === "light" || chosen === "dark" ? chosen : "automatic";
}

export function choose(chosen: Choice): void {
    if (chosen === "automatic") {
        delete document.documentElement.dataset.theme;
    } else {
        document.documentElement.dataset.theme = chosen;
    }
    try {
        localStorage.setItem(KEY, chosen);
    } catch {
        // Some browsers keep nothing for pages from files: then the choice is this page's.
    }
    changed();
}

export function isDark(): boolean {
    return choice() === "automatic" ? prefersDark().matches : choice() === "dark";
}

export function palette(): Palette {
    return isDark() && !isPrinting() && !saving ? DARK : LIGHT;
}

/** Draws for paper. */
export async function forPaper<T>(draw: () => T | Promise<T>): Promise<T> {
    saving = true;
    try {
        return await draw();
    } finally {
        saving = false;
    }
}

/** Follows the system and the printer; samples of lines take their colours from the document. */
export function followTheme(): void {
    prefersDark().addEventListener("change", changed);
    onLayout(changed);
    changed();
}

function changed(): void {
    palette().lines.forEach((colour, k) => document.documentElement.style.setProperty(`--line-${k}`, colour));
    listeners.forEach((listener) => listener());
}
