//! Numbers with units: a bare number is SI, a string carries its unit (`"10 mm"`, `"2 kN/m"`, `"0.3 g"`).
//! Units are converted here, at the border; everything behind it is SI.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

/// A physical dimension and the units in which it may be written.
pub trait Dimension: Copy + Clone + Default + PartialEq + fmt::Debug + 'static {
    /// Name used in messages and in the schema.
    const NAME: &'static str;
    /// Units and their factor to SI; the first is the SI unit.
    const UNITS: &'static [(&'static str, f64)];
}

/// A number of dimension `D`, held in SI.
#[derive(Clone, Copy, Default, PartialEq, PartialOrd)]
pub struct Quantity<D> {
    si: f64,
    dimension: PhantomData<D>,
}

impl<D: Dimension> Quantity<D> {
    /// From a value in SI.
    pub const fn from_si(si: f64) -> Self {
        Quantity { si, dimension: PhantomData }
    }
    /// The value in SI.
    pub const fn si(self) -> f64 {
        self.si
    }
    /// Reads `"10 mm"`; the blank may be missing. The error names the units that are allowed.
    pub fn parse(text: &str) -> Result<Self, String> {
        let text = text.trim();
        let split = number_end(text);
        let (number, unit) = (&text[..split], text[split..].trim());
        let value: f64 = number
            .parse()
            .map_err(|_| format!("`{text}` does not start with a number; write for example {}", Self::example()))?;
        if unit.is_empty() {
            return Err(format!(
                "`{text}` has no unit; write a bare number for {} or one of: {}",
                D::UNITS[0].0,
                Self::units()
            ));
        }
        let factor = D::UNITS
            .iter()
            .find(|(name, _)| *name == unit)
            .map(|(_, factor)| *factor)
            .ok_or_else(|| format!("`{unit}` is not a unit of {}; allowed: {}", D::NAME, Self::units()))?;
        Ok(Self::from_si(value * factor))
    }
    fn units() -> String {
        D::UNITS.iter().map(|(u, _)| *u).collect::<Vec<_>>().join(", ")
    }
    fn example() -> String {
        format!("\"1.5 {}\"", D::UNITS[0].0)
    }
}

/// Length of the number that `text` starts with.
fn number_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut i = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    while i < bytes.len() && (bytes[i].is_ascii_digit() || bytes[i] == b'.') {
        i += 1;
    }
    if matches!(bytes.get(i), Some(b'e' | b'E')) {
        let mut j = i + 1;
        j += usize::from(matches!(bytes.get(j), Some(b'+' | b'-')));
        if bytes.get(j).is_some_and(u8::is_ascii_digit) {
            while bytes.get(j).is_some_and(u8::is_ascii_digit) {
                j += 1;
            }
            i = j;
        }
    }
    i
}

impl<D: Dimension> From<f64> for Quantity<D> {
    fn from(si: f64) -> Self {
        Self::from_si(si)
    }
}

impl<D: Dimension> fmt::Debug for Quantity<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.si, D::UNITS[0].0)
    }
}

impl<D: Dimension> fmt::Display for Quantity<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.si, D::UNITS[0].0)
    }
}

impl<D: Dimension> Serialize for Quantity<D> {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        s.serialize_f64(self.si)
    }
}

impl<'de, D: Dimension> Deserialize<'de> for Quantity<D> {
    fn deserialize<De: Deserializer<'de>>(d: De) -> Result<Self, De::Error> {
        struct Visitor<D>(PhantomData<D>);
        impl<D: Dimension> de::Visitor<'_> for Visitor<D> {
            type Value = Quantity<D>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(
                    f,
                    "a {}: a number in {} or a string with its unit ({})",
                    D::NAME,
                    D::UNITS[0].0,
                    Quantity::<D>::units()
                )
            }
            fn visit_f64<E: de::Error>(self, v: f64) -> Result<Self::Value, E> {
                Ok(Quantity::from_si(v))
            }
            fn visit_i64<E: de::Error>(self, v: i64) -> Result<Self::Value, E> {
                Ok(Quantity::from_si(v as f64))
            }
            fn visit_u64<E: de::Error>(self, v: u64) -> Result<Self::Value, E> {
                Ok(Quantity::from_si(v as f64))
            }
            fn visit_str<E: de::Error>(self, v: &str) -> Result<Self::Value, E> {
                Quantity::parse(v).map_err(E::custom)
            }
        }
        d.deserialize_any(Visitor(PhantomData))
    }
}

impl<D: Dimension> JsonSchema for Quantity<D> {
    fn schema_name() -> Cow<'static, str> {
        D::NAME.replace(' ', "-").into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": format!("A {}: a number in {}, or a string with one of the units {}.", D::NAME, D::UNITS[0].0, Self::units()),
            "anyOf": [{ "type": "number" }, { "type": "string", "pattern": "^\\s*[-+]?[0-9.]+([eE][-+]?[0-9]+)?\\s*\\S+\\s*$" }],
        })
    }
}

macro_rules! dimension {
    ($alias:ident, $tag:ident, $name:literal, $($unit:literal = $factor:expr),+) => {
        #[doc = concat!("Dimension of ", $name, ".")]
        #[derive(Debug, Clone, Copy, Default, PartialEq, PartialOrd)]
        pub struct $tag;
        impl Dimension for $tag {
            const NAME: &'static str = $name;
            const UNITS: &'static [(&'static str, f64)] = &[$(($unit, $factor)),+];
        }
        #[doc = concat!("A ", $name, ".")]
        pub type $alias = Quantity<$tag>;
    };
}

dimension!(
    Length,
    LengthTag,
    "length",
    "m" = 1.0,
    "cm" = 1e-2,
    "mm" = 1e-3,
    "um" = 1e-6,
    "µm" = 1e-6,
    "in" = 0.0254,
    "ft" = 0.3048
);
dimension!(Mass, MassTag, "mass", "kg" = 1.0, "t" = 1e3, "g" = 1e-3);
dimension!(Time, TimeTag, "time", "s" = 1.0, "ms" = 1e-3, "us" = 1e-6, "µs" = 1e-6, "min" = 60.0);
dimension!(Frequency, FrequencyTag, "frequency", "Hz" = 1.0, "kHz" = 1e3);
dimension!(Velocity, VelocityTag, "velocity", "m/s" = 1.0, "cm/s" = 1e-2, "mm/s" = 1e-3, "um/s" = 1e-6, "µm/s" = 1e-6);
dimension!(
    Acceleration,
    AccelerationTag,
    "acceleration",
    "m/s2" = 1.0,
    "m/s²" = 1.0,
    "cm/s2" = 1e-2,
    "cm/s²" = 1e-2,
    "mm/s2" = 1e-3,
    "gal" = 1e-2,
    "Gal" = 1e-2,
    "g" = crate::G
);
dimension!(
    ForcePerLength,
    ForcePerLengthTag,
    "force per length",
    "N/m" = 1.0,
    "kN/m" = 1e3,
    "MN/m" = 1e6,
    "GN/m" = 1e9,
    "N/mm" = 1e3,
    "kN/mm" = 1e6
);
dimension!(
    SpecificWeight,
    SpecificWeightTag,
    "specific weight",
    "N/m3" = 1.0,
    "N/m³" = 1.0,
    "kN/m3" = 1e3,
    "kN/m³" = 1e3
);
