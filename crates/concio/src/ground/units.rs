//! Units as record files write them. They differ from those of a wall file in one point: `g` is the standard
//! gravity 9.80665 m/s², because that is what the archives divided by; the wall file's `g` is the model's 9.81.

use crate::case::HistoryQuantity;

/// Standard gravity [m/s²]: what a record's `g` stands for, and the `g` of the Arias intensity.
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Units of acceleration that are read, for messages.
pub(super) const ACCELERATION_UNITS: &str =
    "g, g/10, mg, m/s2, cm/s2, mm/s2, gal, in/s2, ft/s2 (s^2, s², s/s, sec2 too)";
/// Units of displacement that are read, for messages.
pub(super) const DISPLACEMENT_UNITS: &str = "m, cm, mm, um, in, ft";

/// The units of a quantity, for messages.
pub(super) fn allowed(quantity: HistoryQuantity) -> &'static str {
    match quantity {
        HistoryQuantity::Acceleration => ACCELERATION_UNITS,
        HistoryQuantity::Displacement => DISPLACEMENT_UNITS,
    }
}

/// Factor from a unit of the quantity to SI; none for a unit it does not know. Upper and lower case are one.
pub(super) fn factor(unit: &str, quantity: HistoryQuantity) -> Option<f64> {
    let unit: String = unit.chars().filter(|c| !c.is_whitespace()).collect::<String>().to_lowercase();
    match quantity {
        HistoryQuantity::Acceleration => acceleration(&unit),
        HistoryQuantity::Displacement => length(&unit),
    }
}

fn acceleration(unit: &str) -> Option<f64> {
    match unit {
        "g" => Some(STANDARD_GRAVITY),
        "mg" => Some(STANDARD_GRAVITY * 1e-3),
        "ug" | "µg" | "μg" | "microg" => Some(STANDARD_GRAVITY * 1e-6),
        "g/10" => Some(STANDARD_GRAVITY * 0.1),
        "gal" | "gals" => Some(1e-2),
        _ => {
            let (numerator, denominator) = unit.split_once('/')?;
            let squared = ["s2", "s^2", "s**2", "s²", "s/s", "sec2", "sec^2", "sec**2", "sec²", "sec/sec"];
            if squared.contains(&denominator) { length(numerator) } else { None }
        }
    }
}

fn length(unit: &str) -> Option<f64> {
    match unit {
        "m" => Some(1.0),
        "cm" => Some(1e-2),
        "mm" => Some(1e-3),
        "um" | "µm" | "μm" => Some(1e-6),
        "in" => Some(0.0254),
        "ft" => Some(0.3048),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spellings_of_the_archives() {
        for (unit, si) in [
            ("cm/sec2", 1e-2),
            ("CM/SEC/SEC", 1e-2),
            ("cm/s^2", 1e-2),
            ("m/s²", 1.0),
            ("Gal", 1e-2),
            ("G", 9.80665),
            ("in / s2", 0.0254),
        ] {
            assert_eq!(factor(unit, HistoryQuantity::Acceleration), Some(si), "{unit}");
        }
        for unit in ["cm", "cm/s", "cm/sec", "counts", "", "/s2", "g/s2"] {
            assert_eq!(factor(unit, HistoryQuantity::Acceleration), None, "{unit}");
        }
        assert_eq!(factor("mm", HistoryQuantity::Displacement), Some(1e-3));
        assert_eq!(factor("g", HistoryQuantity::Displacement), None);
    }
}
