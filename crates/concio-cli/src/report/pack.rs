//! Numbers of a report as bytes: arrays one behind the other, little-endian, with a table of contents.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Map, Value, json};

/// Bits that a value of a frame has, its sign included: a quantum is 2⁻³⁸ of the largest value of the frame, so that
/// joint displacements of 10⁻⁷ m come out to better than 10⁻⁶ of themselves between blocks that moved 5·10⁻³ m.
const BITS: u32 = 40;
/// The number that stands for a value that is not finite.
const NOT_FINITE: i64 = -(1 << (BITS - 1));

/// Bytes and their table of contents.
#[derive(Debug, Default)]
pub struct Pack {
    bytes: Vec<u8>,
    contents: Map<String, Value>,
}

impl Pack {
    fn add(&mut self, name: &str, kind: &str, count: usize, values: impl Iterator<Item = u8>) {
        // Arrays of the page's language start at multiples of their width.
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
        self.contents.insert(name.into(), json!({"type": kind, "at": self.bytes.len(), "count": count}));
        self.bytes.extend(values);
    }

    /// Real numbers with all their digits.
    pub fn reals(&mut self, name: &str, values: &[f64]) {
        self.add(name, "f64", values.len(), values.iter().flat_map(|v| v.to_le_bytes()));
    }

    /// Real numbers for curves, seven digits of them.
    pub fn curves(&mut self, name: &str, values: &[f32]) {
        self.add(name, "f32", values.len(), values.iter().flat_map(|v| v.to_le_bytes()));
    }

    /// Indices, −1 and −2 among them.
    pub fn indices(&mut self, name: &str, values: &[i32]) {
        self.add(name, "i32", values.len(), values.iter().flat_map(|v| v.to_le_bytes()));
    }

    /// Rows of values that are to be subtracted from each other: whole multiples of one quantum per row.
    pub fn rows<'a>(&mut self, name: &str, rows: impl Iterator<Item = &'a [f64]>) {
        let (mut quanta, mut low, mut high) = (Vec::new(), Vec::new(), Vec::new());
        for row in rows {
            let quantum = quantum(row);
            quanta.push(quantum);
            for steps in row.iter().map(|v| steps(*v, quantum)) {
                low.extend_from_slice(&(steps as u32).to_le_bytes());
                high.push((steps >> 32) as u8);
            }
        }
        self.reals(&format!("{name}/quantum"), &quanta);
        self.add(&format!("{name}/low"), "u32", low.len() / 4, low.iter().copied());
        self.add(&format!("{name}/high"), "i8", high.len(), high.iter().copied());
    }

    /// The table of contents, and the bytes in base64.
    pub fn finish(self) -> (Value, String) {
        (Value::Object(self.contents), STANDARD.encode(self.bytes))
    }
}

/// What one step of a row is worth: a power of two, so that multiples of it are exact.
fn quantum(row: &[f64]) -> f64 {
    let largest = row.iter().filter(|v| v.is_finite()).fold(0.0, |m: f64, v| m.max(v.abs()));
    // Powers below that are no normal numbers; motions so small are none.
    let exponent = (largest.log2().ceil() as i32).max(-900) - (BITS as i32 - 2);
    if largest == 0.0 { 1.0 } else { 2f64.powi(exponent) }
}

fn steps(value: f64, quantum: f64) -> i64 {
    if value.is_finite() { (value / quantum).round() as i64 } else { NOT_FINITE }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn back(value: f64, row: &[f64]) -> f64 {
        let quantum = quantum(row);
        let steps = steps(value, quantum);
        assert!(steps.abs() <= 1 << 38, "{steps}");
        let (low, high) = (steps as u32, (steps >> 32) as i8);
        (i64::from(high) * (1 << 32) + i64::from(low)) as f64 * quantum
    }

    #[test]
    fn small_differences_of_large_displacements_survive() {
        let row = [4.999e-3, 4.999e-3 + 1.234_567e-7, -5.0e-3, 0.0];
        let difference = back(row[1], &row) - back(row[0], &row);
        assert!((difference / 1.234_567e-7 - 1.0).abs() < 1e-6, "{difference:e}");
        // A 32-bit float would have lost it.
        assert!((f64::from(row[1] as f32 - row[0] as f32) / 1.234_567e-7 - 1.0).abs() > 1e-4);
        for v in row {
            assert!((back(v, &row) - v).abs() <= 5e-3 / 2f64.powi(37), "{v}");
        }
    }

    #[test]
    fn rows_without_size_and_values_that_are_not_finite() {
        assert_eq!(back(0.0, &[0.0, 0.0]), 0.0);
        assert_eq!(back(1e-300, &[1e-300]), 0.0);
        assert_eq!(back(2f64.powi(-899), &[2f64.powi(-899)]), 2f64.powi(-899));
        assert_eq!(steps(f64::NAN, quantum(&[f64::NAN, 1.0])), NOT_FINITE);
        assert_eq!(steps(f64::INFINITY, 1.0), NOT_FINITE);
    }

    #[test]
    fn arrays_are_aligned_and_told() {
        let mut pack = Pack::default();
        pack.indices("a", &[1, -2, 3]);
        pack.reals("b", &[0.5]);
        let (contents, text) = pack.finish();
        assert_eq!(contents["b"], json!({"type": "f64", "at": 16, "count": 1}));
        let bytes = STANDARD.decode(text).expect("base64");
        assert_eq!(bytes[16..], 0.5f64.to_le_bytes());
        assert_eq!(bytes[4..8], (-2i32).to_le_bytes());
    }
}
