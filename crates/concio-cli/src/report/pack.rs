//! Numbers of a report as bytes: arrays one behind the other, little-endian, with a table of contents.
//!
//! Tables are whole numbers, each told by how it differs from what its neighbours foretell: blocks beside each other move alike, and a
//! joint that rests does so for long. What is left is small, and its bytes, the lowest of all numbers first, then the next, are
//! what deflating makes short.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Map, Value, json};

/// How the numbers of a table are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Digits {
    /// 32-bit floats: seven digits of each.
    Float,
    /// Whole multiples, of that many bits with their sign, of one power of two for the whole table: differences are exact.
    Shared(u32),
    /// Whole multiples of a step of its own for every column, so that what moves little is known as well as what moves far.
    Own(u32),
}

impl Digits {
    /// By how much a number is rounded at most, over the largest of the table or column; none of floats.
    pub fn rounding(self) -> Option<f64> {
        match self {
            Digits::Float => None,
            Digits::Shared(bits) => Some(0.5f64.powi(bits as i32 - 2)),
            Digits::Own(bits) => Some(0.5 * 2f64.powf(1.0 / PARTS) / most(bits)),
        }
    }
}

/// Steps are powers of two, and so many between them.
const PARTS: f64 = 8.0;
/// Bits by which what moves little is known better than what moves farthest, at most: beyond that it is as good as at rest.
const FINER: u32 = 6;

/// The largest whole number of so many bits; the one below its opposite stands for what is not finite.
fn most(bits: u32) -> f64 {
    ((1u64 << (bits - 1)) - 1) as f64
}

/// What a step is worth.
fn step(exponent: i32) -> f64 {
    let whole = exponent.div_euclid(PARTS as i32);
    2f64.powi(whole) * 2f64.powf(f64::from(exponent.rem_euclid(PARTS as i32)) / PARTS)
}

/// What a number is foretold by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum From {
    Nothing,
    /// The row before.
    Above,
    /// The column before.
    Left,
    /// Both, less what is between them.
    Both,
}

const WAYS: [(From, &str); 4] =
    [(From::Nothing, "nothing"), (From::Above, "above"), (From::Left, "left"), (From::Both, "both")];

impl From {
    fn foretell(self, at: impl Fn(usize, usize) -> i64) -> i64 {
        match self {
            From::Nothing => 0,
            From::Above => at(1, 0),
            From::Left => at(0, 1),
            From::Both => at(1, 0) + at(0, 1) - at(1, 1),
        }
    }
}

/// Bytes and their table of contents.
#[derive(Debug, Default)]
pub struct Pack {
    bytes: Vec<u8>,
    contents: Map<String, Value>,
}

impl Pack {
    fn add(&mut self, name: &str, mut entry: Value, values: impl Iterator<Item = u8>) {
        // Arrays of the page's language start at multiples of their width.
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
        entry["at"] = json!(self.bytes.len());
        self.contents.insert(name.into(), entry);
        self.bytes.extend(values);
    }

    /// Real numbers with all their digits.
    pub fn reals(&mut self, name: &str, values: &[f64]) {
        let entry = json!({"type": "f64", "count": values.len()});
        self.add(name, entry, values.iter().flat_map(|v| v.to_le_bytes()));
    }

    /// Indices, −1 and −2 among them.
    pub fn indices(&mut self, name: &str, values: &[i32]) {
        let entry = json!({"type": "i32", "count": values.len()});
        self.add(name, entry, values.iter().flat_map(|v| v.to_le_bytes()));
    }

    /// A table, row by row, that is read row by row or column by column.
    pub fn table(&mut self, name: &str, columns: usize, values: &[f64], digits: Digits) {
        let rows = values.len().checked_div(columns).unwrap_or(0);
        let (numbers, exponents) = whole(values, columns, digits);
        let (way, told) = foretold(&numbers, rows, columns);
        let most = told.iter().copied().max().unwrap_or(0);
        let planes = (u64::BITS - most.leading_zeros()).div_ceil(8);
        let (kind, bits) = match digits {
            Digits::Float => ("floats", 32),
            Digits::Shared(bits) | Digits::Own(bits) => ("steps", bits),
        };
        let entry =
            json!({"type": kind, "rows": rows, "columns": columns, "planes": planes, "from": way, "bits": bits});
        let bytes = (0..planes).flat_map(|plane| told.iter().map(move |u| (u >> (8 * plane)) as u8));
        self.add(name, entry, bytes);
        if kind == "steps" {
            self.indices(&format!("{name}/exponent"), &exponents);
        }
    }

    /// The table of contents, and the bytes.
    pub fn finish(self) -> (Value, Vec<u8>) {
        (Value::Object(self.contents), self.bytes)
    }
}

/// A text and the bytes behind it, which start at a multiple of 8, deflated: its length comes first.
pub fn deflated(text: &str, bytes: &[u8]) -> Vec<u8> {
    let mut out = ZlibEncoder::new(Vec::new(), Compression::default());
    let pad = [0; 8];
    let length = (text.len() as u64).to_le_bytes();
    let parts = [&length, text.as_bytes(), &pad[..text.len().next_multiple_of(8) - text.len()], bytes];
    // Into memory: nothing that could fail.
    let written = parts.into_iter().try_for_each(|part| out.write_all(part));
    written.and_then(|()| out.finish()).unwrap_or_default()
}

/// The numbers as whole ones, and the exponents of the steps that those are multiples of: of one for all, or of one for each column.
fn whole(values: &[f64], columns: usize, digits: Digits) -> (Vec<i64>, Vec<i32>) {
    match digits {
        Digits::Float => (values.iter().map(|v| of_float(*v as f32)).collect(), Vec::new()),
        Digits::Shared(bits) => {
            let exponent = exponent(values.iter(), bits);
            (values.iter().map(|v| steps(*v, exponent, bits)).collect(), vec![exponent])
        }
        Digits::Own(bits) => {
            let column = |c: usize| values.iter().skip(c).step_by(columns);
            let least = part(values.iter(), bits + FINER);
            let exponents: Vec<i32> = (0..columns).map(|c| part(column(c), bits).max(least)).collect();
            let of = |(k, v): (usize, &f64)| steps(*v, exponents[k % columns], bits);
            (values.iter().enumerate().map(of).collect(), exponents)
        }
    }
}

/// The bits of a float as a number that rises with it.
fn of_float(value: f32) -> i64 {
    let bits = value.to_bits();
    let size = i64::from(bits & 0x7fff_ffff);
    if bits >> 31 == 0 { size } else { -size }
}

fn largest<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    values.filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()))
}

/// Of a step that is a power of two: the largest number takes one bit less than there is room for.
fn exponent<'a>(values: impl Iterator<Item = &'a f64>, bits: u32) -> i32 {
    // Powers below that are no normal numbers; motions so small are none.
    match largest(values) {
        0.0 => 0,
        largest => ((largest.log2().ceil() as i32).max(-900) - (bits as i32 - 2)) * PARTS as i32,
    }
}

/// Of the least step by which the largest number has room.
fn part<'a>(values: impl Iterator<Item = &'a f64>, bits: u32) -> i32 {
    match largest(values) {
        0.0 => i32::MIN / 2,
        largest => (PARTS * ((largest.log2().max(-900.0)) - most(bits).log2())).ceil() as i32,
    }
}

fn steps(value: f64, exponent: i32, bits: u32) -> i64 {
    // The number that stands for a value that is not finite.
    if !value.is_finite() {
        return -(1 << (bits - 1));
    }
    if value == 0.0 { 0 } else { (value / step(exponent)).round() as i64 }
}

/// How the numbers differ from what foretells them best, column by column: even where they are larger, odd where smaller.
fn foretold(numbers: &[i64], rows: usize, columns: usize) -> (&'static str, Vec<u64>) {
    let of = |way: From| {
        let at = move |row: usize, column: usize| {
            let before = |up: usize, left: usize| {
                if row < up || column < left { 0 } else { numbers[(row - up) * columns + column - left] }
            };
            let apart = numbers[row * columns + column] - way.foretell(before);
            ((apart << 1) ^ (apart >> 63)) as u64
        };
        (0..columns).flat_map(move |column| (0..rows).map(move |row| at(row, column)))
    };
    // Every number costs about as many bits as it has.
    let cost = |way: From| of(way).map(|u| u64::from(u64::BITS - u.leading_zeros())).sum::<u64>();
    let best = WAYS.into_iter().min_by_key(|(way, _)| cost(*way)).unwrap_or(WAYS[0]);
    (best.1, of(best.0).collect())
}

#[cfg(test)]
pub mod tests {
    use std::io::Read as _;

    use super::*;

    /// What the page makes of its data: the table of contents and the numbers.
    pub fn inflated(bytes: &[u8]) -> (Value, Vec<u8>) {
        let mut all = Vec::new();
        flate2::read::ZlibDecoder::new(bytes).read_to_end(&mut all).expect("deflated data");
        let length = u64::from_le_bytes(all[..8].try_into().expect("eight bytes")) as usize;
        let contents = serde_json::from_slice(&all[8..8 + length]).expect("JSON");
        (contents, all.split_off(8 + length.next_multiple_of(8)))
    }

    /// A table as the page reads it, row by row.
    pub fn read(arrays: &Value, bytes: &[u8], name: &str) -> Vec<f64> {
        let entry = &arrays[name];
        let number = |key: &str| entry[key].as_u64().unwrap_or_else(|| panic!("{name}: {key}")) as usize;
        let (at, rows, columns) = (number("at"), number("rows"), number("columns"));
        let way = WAYS.iter().find(|(_, called)| entry["from"] == *called).expect("a way").0;
        let mut numbers = vec![0i64; rows * columns];
        for column in 0..columns {
            for row in 0..rows {
                let of_plane = |p: usize| u64::from(bytes[at + p * rows * columns + column * rows + row]) << (8 * p);
                let told: u64 = (0..number("planes")).map(of_plane).sum();
                let apart = (told >> 1) as i64 ^ -((told & 1) as i64);
                let before = |up: usize, left: usize| {
                    if row < up || column < left { 0 } else { numbers[(row - up) * columns + column - left] }
                };
                numbers[row * columns + column] = apart + way.foretell(before);
            }
        }
        if entry["type"] == "floats" {
            let of = |m: &i64| f32::from_bits(m.unsigned_abs() as u32 | if *m < 0 { 1 << 31 } else { 0 });
            return numbers.iter().map(|m| f64::from(of(m))).collect();
        }
        let place = &arrays[format!("{name}/exponent")];
        let count = place["count"].as_u64().expect("exponents") as usize;
        let from = place["at"].as_u64().expect("exponents") as usize;
        let exponent =
            |k: usize| i32::from_le_bytes(bytes[from + 4 * (k % count)..][..4].try_into().expect("four bytes"));
        let hole = -(1i64 << (number("bits") - 1));
        let value = |(k, m): (usize, &i64)| if *m == hole { f64::NAN } else { *m as f64 * step(exponent(k % columns)) };
        numbers.iter().enumerate().map(value).collect()
    }

    fn back(values: &[f64], columns: usize, digits: Digits) -> Vec<f64> {
        let mut pack = Pack::default();
        pack.table("t", columns, values, digits);
        let (arrays, bytes) = pack.finish();
        read(&arrays, &bytes, "t")
    }

    #[test]
    fn small_differences_of_large_displacements_survive() {
        let row = [4.999e-3, 4.999e-3 + 1.234_567e-7, -5.0e-3, 0.0];
        let found = back(&row, 4, Digits::Shared(40));
        assert!(((found[1] - found[0]) / 1.234_567e-7 - 1.0).abs() < 1e-6);
        // A 32-bit float would have lost it.
        assert!((f64::from(row[1] as f32 - row[0] as f32) / 1.234_567e-7 - 1.0).abs() > 1e-4);
        for (v, found) in row.iter().zip(&found) {
            assert!((found - v).abs() <= 5e-3 / 2f64.powi(37), "{v}");
        }
        // With 32 bits to four digits.
        let found = back(&row, 4, Digits::Shared(32));
        assert!(((found[1] - found[0]) / 1.234_567e-7 - 1.0).abs() < 1e-4);
    }

    #[test]
    fn columns_of_any_size_come_back_as_well_as_their_bits_say() {
        let at = |row: usize, column: usize| 10f64.powi(-4 * column as i32) * ((row * (column + 3)) as f64).sin();
        let values: Vec<f64> = (0..50).flat_map(|row| (0..4).map(move |column| at(row, column))).collect();
        let found = back(&values, 4, Digits::Own(16));
        for (k, (v, found)) in values.iter().zip(&found).enumerate() {
            // What moves little has a few bits more than what moves farthest, and no more.
            let size = 10f64.powi(-4 * (k % 4) as i32).max(0.5f64.powi(FINER as i32));
            let rounding = Digits::Own(16).rounding().expect("bits");
            assert!((v - found).abs() <= size * rounding * (1.0 + 1e-9), "{v} became {found}");
        }
        assert_eq!(back(&values, 4, Digits::Float), values.iter().map(|v| f64::from(*v as f32)).collect::<Vec<_>>());
    }

    /// However numbers are foretold, they come back.
    #[test]
    fn every_way_of_foretelling_comes_back() {
        // What a row and a column have in common, beside what every number has for itself.
        let common = |k: i64| k * k * 7919 % 1009 * 4096;
        let own = |r: i64, c: i64| (r * r * 31 + c * c * 17 + r * c * 7919) % 97 - 48;
        for (way, of_row, of_column) in [("nothing", 0, 0), ("above", 0, 1), ("left", 1, 0), ("both", 1, 1)] {
            let at = |r: i64, c: i64| (own(r, c) + of_row * common(r) + of_column * common(c + 50)) as f64;
            let values: Vec<f64> = (0..40).flat_map(|r| (0..30).map(move |c| at(r, c))).collect();
            let mut pack = Pack::default();
            pack.table("t", 30, &values, Digits::Shared(40));
            let (arrays, bytes) = pack.finish();
            assert_eq!(arrays["t"]["from"], way);
            assert_eq!(read(&arrays, &bytes, "t"), values, "{way}");
        }
    }

    #[test]
    fn tables_without_size_and_values_that_are_not_finite() {
        for digits in [Digits::Shared(40), Digits::Own(16), Digits::Float] {
            assert_eq!(back(&[0.0, -0.0], 2, digits), [0.0, 0.0]);
            assert!(back(&[], 3, digits).is_empty() && back(&[], 0, digits).is_empty());
            let found = back(&[f64::NAN, 1.0, 0.5, -1.0], 2, digits);
            let expected = [1.0, 0.5, -1.0];
            let off = found[1..].iter().zip(expected).map(|(v, e)| (v - e).abs()).fold(0.0, f64::max);
            assert!(found[0].is_nan() && off <= digits.rounding().unwrap_or(0.0), "{found:?}");
        }
        assert_eq!(back(&[2f64.powi(-899)], 1, Digits::Shared(40)), [2f64.powi(-899)]);
        assert_eq!(back(&[1e-300], 1, Digits::Shared(40)), [0.0]);
    }

    #[test]
    fn arrays_are_aligned_and_told() {
        let mut pack = Pack::default();
        pack.indices("a", &[1, -2, 3]);
        pack.reals("b", &[0.5]);
        let (contents, bytes) = pack.finish();
        assert_eq!(contents["b"], json!({"type": "f64", "at": 16, "count": 1}));
        assert_eq!(bytes[16..], 0.5f64.to_le_bytes());
        assert_eq!(bytes[4..8], (-2i32).to_le_bytes());
        let (told, numbers) = inflated(&deflated(r#"{"arrays":1}"#, &bytes));
        assert_eq!((told, numbers), (json!({"arrays": 1}), bytes));
    }
}
