/** Inflates the data of the page with what browsers bring along. */

export async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<ArrayBuffer> {
    if (typeof DecompressionStream === "undefined") {
        throw new Error("this browser cannot inflate data; Chrome 80, Edge 80, Firefox 113, Safari 16.4 and later ones can");
    }
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
}
