/**
 * Tables of numbers: whole ones, each told by how it differs from what its neighbours foretell, column by column; of all numbers
 * the lowest bytes come first, then the next (pack.rs writes them). `steps` are multiples of a step, 2 to an eighth of the
 * exponent, of one for the whole table or one for each column; `floats` are 32-bit floats.
 */

export interface Table {
    type: "floats" | "steps";
    at: number;
    rows: number;
    columns: number;
    planes: number;
    from: "nothing" | "above" | "left" | "both";
    bits: number;
}

/** The numbers of a table, row by row; `bytes` begin at the table. */
export function readTable(table: Table, bytes: Uint8Array, exponents: () => Int32Array): Float32Array | Float64Array {
    const whole = readWhole(table, bytes);
    if (table.type === "floats") {
        return floats(whole);
    }
    const steps = Float64Array.from(exponents(), (exponent) => 2 ** Math.floor(exponent / 8) * 2 ** ((exponent - 8 * Math.floor(exponent / 8)) / 8));
    const hole = -(2 ** (table.bits - 1));
    for (let k = 0; k < whole.length; k++) {
        whole[k] = whole[k] === hole ? NaN : whole[k] * steps[steps.length === 1 ? 0 : k % table.columns];
    }
    return whole;
}

function readWhole({ rows, columns, planes, from }: Table, bytes: Uint8Array): Float64Array {
    const count = rows * columns;
    const whole = new Float64Array(count);
    const [above, left] = [from === "above" || from === "both", from === "left" || from === "both"];
    for (let column = 0; column < columns; column++) {
        for (let row = 0; row < rows; row++) {
            let told = 0;
            for (let plane = planes - 1; plane >= 0; plane--) {
                told = told * 256 + bytes[plane * count + column * rows + row];
            }
            const here = row * columns + column;
            let value = told % 2 === 0 ? told / 2 : -(told + 1) / 2;
            if (above && row > 0) {
                value += whole[here - columns];
            }
            if (left && column > 0) {
                value += whole[here - 1];
                if (above && row > 0) {
                    value -= whole[here - columns - 1];
                }
            }
            whole[here] = value;
        }
    }
    return whole;
}

/** Floats whose bits, taken as a number with a sign, are these. */
function floats(whole: Float64Array): Float32Array {
    const bits = new Uint32Array(whole.length);
    for (let k = 0; k < whole.length; k++) {
        bits[k] = whole[k] < 0 ? 0x80000000 + -whole[k] : whole[k];
    }
    return new Float32Array(bits.buffer);
}
