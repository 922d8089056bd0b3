//! Units of a card: a force, a length and the second; mass follows.

use concio::{InputError, Result};

/// Forces [N].
const FORCES: [(&str, f64); 7] = [
    ("N", 1.0),
    ("kN", 1e3),
    ("MN", 1e6),
    ("daN", 10.0),
    ("kgf", 9.80665),
    ("lbf", 4.448_221_615_260_5),
    ("kip", 4_448.221_615_260_5),
];
/// Lengths [m].
const LENGTHS: [(&str, f64); 5] = [("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("in", 0.0254), ("ft", 0.3048)];

/// A consistent system of units. Mass is force s²/length: N-m has kg, N-mm has t, kN-m has t.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Units {
    /// Unit of force [N].
    force: f64,
    /// Unit of length [m].
    length: f64,
}

impl Units {
    /// N, m, kg, s.
    pub const SI: Units = Units { force: 1.0, length: 1.0 };

    /// Reads `N-mm`, `kN-m`, `lbf-in`; `SI` is `N-m`. A third part that names the mass (`N-mm-t`) has to be the one that follows.
    ///
    /// # Errors
    /// Words that are no units, a mass that is not consistent.
    pub fn parse(text: &str) -> Result<Units> {
        let allowed = "SI, or a force and a length such as N-mm, kN-m, N-mm-t, lbf-in; forces N, daN, kN, MN, kgf, lbf, kip; lengths m, cm, mm, in, ft";
        let wrong = |what: String| InputError::new(what).allowed(allowed);
        if text == "SI" {
            return Ok(Units::SI);
        }
        let parts: Vec<&str> = text.split('-').collect();
        let [force, length, mass @ ..] = &parts[..] else {
            return Err(wrong(format!("`{text}` is no system of units")).into());
        };
        let of = |table: &[(&str, f64)], name: &str| table.iter().find(|(n, _)| *n == name).map(|(_, v)| *v);
        let (Some(force), Some(length)) = (of(&FORCES, force), of(&LENGTHS, length)) else {
            return Err(wrong(format!("`{text}` is no system of units")).into());
        };
        let units = Units { force, length };
        match mass {
            [] => Ok(units),
            [name] => {
                let known = of(&[("kg", 1.0), ("t", 1e3), ("g", 1e-3)], name);
                if known.is_some_and(|kg| (units.mass() / kg - 1.0).abs() < 1e-12) {
                    Ok(units)
                } else {
                    Err(wrong(format!("`{name}` is not the mass of {}-{}", parts[0], parts[1])).into())
                }
            }
            _ => Err(wrong(format!("`{text}` is no system of units")).into()),
        }
    }

    /// Unit of mass [kg].
    pub fn mass(&self) -> f64 {
        self.force / self.length
    }

    /// As they are written: `N-mm`.
    pub fn name(&self) -> String {
        let of = |table: &[(&str, f64)], value: f64| {
            table.iter().find(|(_, v)| *v == value).map_or_else(|| format!("{value}"), |(n, _)| (*n).to_string())
        };
        format!("{}-{}", of(&FORCES, self.force), of(&LENGTHS, self.length))
    }

    /// Mass as it is written.
    pub fn mass_name(&self) -> String {
        match self.mass() {
            1.0 => "kg".into(),
            m if (m / 1e3 - 1.0).abs() < 1e-12 => "t".into(),
            _ => {
                let name = self.name();
                let (force, length) = name.split_once('-').unwrap_or((&name, ""));
                format!("{force} s2/{length}")
            }
        }
    }

    /// A number in SI whose unit is N^force m^length kg^mass, in these units.
    pub fn convert(&self, value: f64, [force, length, mass]: [i32; 3]) -> f64 {
        value / (self.force.powi(force) * self.length.powi(length) * self.mass().powi(mass))
    }
}
