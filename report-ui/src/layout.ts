/** Layout for paper: plots and the wall are drawings of fixed size, so that they have to be drawn anew. */

const listeners: ((printing: boolean) => void)[] = [];

/** Calls after the page has taken the width of the paper, and after it has taken that of the window again. */
export function onLayout(listener: (printing: boolean) => void): void {
    listeners.push(listener);
}

export function isPrinting(): boolean {
    return document.body.classList.contains("printing");
}

/** Lays the page out for paper while it is printed. */
export function followPrinting(): void {
    const set = (printing: boolean) => {
        if (printing !== isPrinting()) {
            document.body.classList.toggle("printing", printing);
            listeners.forEach((listener) => listener(printing));
        }
    };
    window.addEventListener("beforeprint", () => set(true));
    window.addEventListener("afterprint", () => set(false));
    // Some browsers tell of printing in this way only.
    window.matchMedia("print").addEventListener("change", (event) => set(event.matches));
}
