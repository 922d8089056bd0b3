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
    /// Reads `"10 mm"`; the blank may be missing.
    ///
    /// # Errors
    /// What is wrong and, after `; allowed: `, the units that are allowed.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (number, unit) = parts(text);
        let text = text.trim();
        let value: f64 = number.parse().map_err(|_| {
            format!("`{text}` does not start with a number; allowed: a text such as {}", Self::example())
        })?;
        if unit.is_empty() {
            return Err(format!(
                "`{text}` has no unit; allowed: a number without quotes (in {}), or a text with one of {}",
                D::UNITS[0].0,
                Self::units()
            ));
        }
        let factor = factor(D::UNITS, unit).map_err(|near| {
            format!("`{unit}` is not a unit of {}{}; allowed: {}", D::NAME, meant(near), Self::units())
        })?;
        Ok(Self::from_si(in_si(value, factor)))
    }
    fn units() -> String {
        D::UNITS.iter().map(|(u, _)| *u).collect::<Vec<_>>().join(", ")
    }
    fn example() -> String {
        format!("\"1.5 {}\"", D::UNITS[0].0)
    }
}

/// A text as its number and its unit.
pub(crate) fn parts(text: &str) -> (&str, &str) {
    let text = text.trim();
    let split = number_end(text);
    (&text[..split], text[split..].trim())
}

/// The factor of a unit, however its powers, its product and its micro are written, and in capitals or small letters where that
/// tells nothing else; else the unit that comes near it in all but its letters' size.
fn factor(units: &[(&'static str, f64)], unit: &str) -> Result<f64, Option<&'static str>> {
    let written = normal(unit);
    if let Some((_, factor)) = units.iter().find(|(name, _)| normal(name) == written) {
        return Ok(*factor);
    }
    let found = units.iter().find(|(name, _)| normal(name).eq_ignore_ascii_case(&written));
    let (name, factor) = found.ok_or(None)?;
    // All in capitals M is m: nobody builds in megametres. Else M is mega and m a thousandth, which are never taken for each other.
    let capitals = !written.bytes().any(|b| b.is_ascii_lowercase());
    let mistakable = |(a, b): (char, char)| match (a, b) {
        ('m', 'M') => true,
        ('M', 'm') => !capitals,
        _ => false,
    };
    if written.chars().zip(normal(name).chars()).any(mistakable) { Err(Some(name)) } else { Ok(*factor) }
}

/// A unit with plain figures for powers, a blank for a product and `u` for micro.
fn normal(unit: &str) -> String {
    let plain = |c: char| match c {
        '²' => '2',
        '³' => '3',
        'µ' | 'μ' => 'u',
        '·' | '⋅' | '*' => ' ',
        other => other,
    };
    unit.chars().filter(|c| *c != '^').map(plain).collect()
}

fn meant(near: Option<&'static str>) -> String {
    near.map_or(String::new(), |name| format!(", did you mean `{name}`? (M is a million, m a thousandth)"))
}

/// Divides by a thousand where a thousandth, which no binary number is, would be multiplied with: 350 mm is 0.35 m to the last bit.
fn in_si(value: f64, factor: f64) -> f64 {
    let parts = 1.0 / factor;
    if factor < 1.0 && parts.fract() == 0.0 { value / parts } else { value * factor }
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
        write!(f, "{} {}", shown(self.si), D::UNITS[0].0)
    }
}

/// Digits beyond which a number in a message shows nothing but rounding.
const DIGITS: usize = 12;

/// A number as a message shows it: without the digits that rounding leaves behind, with an exponent where zeros would have to be
/// counted.
pub fn shown(v: f64) -> String {
    if v == 0.0 {
        return "0".into();
    }
    if !v.is_finite() {
        return v.to_string();
    }
    let v: f64 = format!("{v:.*e}", DIGITS - 1).parse().unwrap_or(v);
    if (1e-4..1e7).contains(&v.abs()) { v.to_string() } else { format!("{v:e}") }
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
                    "a {}: a number in {} or a text with its unit ({})",
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
            "description": format!("A {}: a number in {}, or a text with one of the units {}.", D::NAME, D::UNITS[0].0, Self::units()),
            "anyOf": [{ "type": "number" }, { "type": "string", "pattern": TEXT_PATTERN }],
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
dimension!(Force, ForceTag, "force", "N" = 1.0, "kN" = 1e3, "MN" = 1e6);
dimension!(
    DampingConstant,
    DampingConstantTag,
    "damping constant",
    "N s/m" = 1.0,
    "Ns/m" = 1.0,
    "kN s/m" = 1e3,
    "kNs/m" = 1e3,
    "MN s/m" = 1e6,
    "N s/mm" = 1e3,
    "kN s/mm" = 1e6
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
    ForcePerVolume,
    ForcePerVolumeTag,
    "stiffness per area",
    "N/m3" = 1.0,
    "N/m³" = 1.0,
    "kN/m3" = 1e3,
    "MN/m3" = 1e6,
    "GN/m3" = 1e9,
    "N/mm3" = 1e9,
    "N/mm³" = 1e9,
    "kN/mm3" = 1e12,
    "Pa/m" = 1.0,
    "MPa/m" = 1e6,
    "MPa/mm" = 1e9,
    "GPa/m" = 1e9,
    "GPa/mm" = 1e12
);
dimension!(
    SpecificWeight,
    SpecificWeightTag,
    "specific weight",
    "N/m3" = 1.0,
    "N/m³" = 1.0,
    "kN/m3" = 1e3,
    "kN/m³" = 1e3,
    "kg/m3" = crate::G,
    "t/m3" = 1e3 * crate::G
);
dimension!(
    Stress,
    StressTag,
    "stress",
    "Pa" = 1.0,
    "kPa" = 1e3,
    "MPa" = 1e6,
    "N/mm2" = 1e6,
    "N/mm²" = 1e6,
    "kN/m2" = 1e3,
    "kN/m²" = 1e3
);
dimension!(EnergyPerArea, EnergyPerAreaTag, "energy per area", "N/m" = 1.0, "J/m2" = 1.0, "J/m²" = 1.0, "N/mm" = 1e3);
dimension!(
    Angle,
    AngleTag,
    "angle",
    "rad" = 1.0,
    "deg" = std::f64::consts::PI / 180.0,
    "°" = std::f64::consts::PI / 180.0
);

/// Stiffness of a joint: a number for each joint, or one for each area of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stiffness {
    /// Of a joint [N/m], as the key says: of a half-brick contact or of the whole joint.
    PerJoint(ForcePerLength),
    /// Of a square metre of joint [N/m³].
    PerArea(ForcePerVolume),
}

impl Stiffness {
    /// Of a joint [N/m] that has the area `area` [m²]; what is given per joint has no regard to the area.
    pub fn over(self, area: f64) -> f64 {
        match self {
            Stiffness::PerJoint(k) => k.si(),
            Stiffness::PerArea(k) => k.si() * area,
        }
    }

    /// The number in SI, in N/m or per area in N/m³: to be held against bounds, not to compute with.
    pub fn amount(self) -> f64 {
        self.over(1.0)
    }

    /// Reads `"54 MN/m"` or `"36 N/mm3"`.
    ///
    /// # Errors
    /// As [`Quantity::parse`].
    pub fn parse(text: &str) -> Result<Self, String> {
        let unit = parts(text).1;
        let [per_joint, per_area] =
            [ForcePerLengthTag::UNITS, ForcePerVolumeTag::UNITS].map(|units| factor(units, unit));
        if per_area.is_ok() || (per_joint == Err(None) && per_area != Err(None)) {
            return Quantity::parse(text).map(Stiffness::PerArea);
        }
        let per_joint = Quantity::parse(text).map(Stiffness::PerJoint);
        per_joint.map_err(|message| {
            let per_area = Quantity::<ForcePerVolumeTag>::units();
            format!("{message}; per area of the joint: {per_area}").replace("of force per length", "of stiffness")
        })
    }
}

impl Default for Stiffness {
    fn default() -> Self {
        Stiffness::PerJoint(ForcePerLength::default())
    }
}

impl From<f64> for Stiffness {
    /// Per joint [N/m].
    fn from(si: f64) -> Self {
        Stiffness::PerJoint(si.into())
    }
}

impl fmt::Display for Stiffness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Stiffness::PerJoint(k) => k.fmt(f),
            Stiffness::PerArea(k) => k.fmt(f),
        }
    }
}

impl Serialize for Stiffness {
    /// Per area as a text with its unit, so that it is read as what it was.
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Stiffness::PerJoint(k) => k.serialize(s),
            // All digits, which a message leaves out.
            Stiffness::PerArea(k) => s.collect_str(&format_args!("{} {}", k.si(), ForcePerVolumeTag::UNITS[0].0)),
        }
    }
}

impl<'de> Deserialize<'de> for Stiffness {
    fn deserialize<De: Deserializer<'de>>(d: De) -> Result<Self, De::Error> {
        struct Visitor;
        impl de::Visitor<'_> for Visitor {
            type Value = Stiffness;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let (per_joint, per_area) = (ForcePerLength::units(), ForcePerVolume::units());
                write!(f, "a stiffness: a number in N/m or a text with its unit ({per_joint}; per area: {per_area})")
            }
            fn visit_f64<E: de::Error>(self, v: f64) -> Result<Stiffness, E> {
                Ok(v.into())
            }
            fn visit_i64<E: de::Error>(self, v: i64) -> Result<Stiffness, E> {
                Ok((v as f64).into())
            }
            fn visit_u64<E: de::Error>(self, v: u64) -> Result<Stiffness, E> {
                Ok((v as f64).into())
            }
            fn visit_str<E: de::Error>(self, v: &str) -> Result<Stiffness, E> {
                Stiffness::parse(v).map_err(E::custom)
            }
        }
        d.deserialize_any(Visitor)
    }
}

impl JsonSchema for Stiffness {
    fn schema_name() -> Cow<'static, str> {
        "stiffness".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let (per_joint, per_area) = (ForcePerLength::units(), ForcePerVolume::units());
        json_schema!({
            "description": format!(
                "A stiffness: a number in N/m, or a text with one of the units {per_joint}; per area of the joint with one of {per_area}."
            ),
            "anyOf": [{ "type": "number" }, { "type": "string", "pattern": TEXT_PATTERN }],
        })
    }
}

/// What a number with a unit looks like.
pub(crate) const TEXT_PATTERN: &str = "^\\s*[-+]?[0-9.]+([eE][-+]?[0-9]+)?\\s*\\S+( \\S+)?\\s*$";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stiffness_keeps_what_it_is_given_for() {
        let read = |json: &str| serde_json::from_str::<Stiffness>(json).map_err(|e| e.to_string());
        assert_eq!(read("5.4e7"), Ok(5.4e7.into()));
        assert_eq!(read("\"54 MN/m\"").map(|k| k.over(7.0)), Ok(54e6));
        for (text, si) in [("36 N/mm3", 36e9), ("36 MPa/mm", 36e9), ("0.036 GPa/mm", 36e9), ("36e9 N/m³", 36e9)] {
            let per_area = read(&format!("\"{text}\"")).expect(text);
            assert!(matches!(per_area, Stiffness::PerArea(_)), "{text}");
            assert!((per_area.over(0.015) / (0.015 * si) - 1.0).abs() < 1e-15, "{text}");
        }
        // Odd digits too come back to the bit.
        for stiffness in [Stiffness::from(0.1 + 0.2), Stiffness::PerArea((1e11 / 3.0).into())] {
            let json = serde_json::to_string(&stiffness).expect("written");
            assert_eq!(read(&json), Ok(stiffness), "{json}");
        }
        let wrong = read("\"3 kg\"").expect_err("a mass");
        assert!(wrong.contains("`kg` is not a unit of stiffness; allowed: N/m") && wrong.contains("N/mm3"), "{wrong}");
        assert!(read("\"36\"").expect_err("no unit").contains("has no unit"));
    }

    #[test]
    fn units_are_converted() {
        let length = |text| Length::parse(text).map(Quantity::si);
        assert_eq!(length("10 mm"), Ok(0.01));
        assert_eq!(length("10mm"), Ok(0.01));
        assert_eq!(length(" -2.5e1 cm "), Ok(-0.25));
        assert_eq!(length("1 ft"), Ok(0.3048));
        assert_eq!(length("1e3 µm"), Ok(1e-3));
        assert_eq!(Acceleration::parse("0.8 g").map(Quantity::si), Ok(0.8 * 9.81));
        assert_eq!(ForcePerLength::parse("2 kN/m").map(Quantity::si), Ok(2e3));
        assert_eq!(SpecificWeight::parse("18 kN/m3").map(Quantity::si), Ok(18e3));
        assert_eq!(Mass::parse("3 t").map(Quantity::si), Ok(3e3));
        assert_eq!(Stress::parse("0.2 MPa").map(Quantity::si), Ok(0.2e6));
        assert_eq!(Stress::parse("0.2 N/mm²").map(Quantity::si), Ok(0.2e6));
        assert_eq!(EnergyPerArea::parse("0.05 N/mm").map(Quantity::si), Ok(50.0));
        assert_eq!(Force::parse("2.5 kN").map(Quantity::si), Ok(2500.0));
        assert_eq!(DampingConstant::parse("3 kN s/m").map(Quantity::si), Ok(3e3));
        assert_eq!(Angle::parse("45 °").map(Quantity::si), Ok(std::f64::consts::FRAC_PI_4));
    }

    /// Weights from densities, powers and micro as people write them, units in capitals.
    #[test]
    fn units_are_read_as_they_are_written() {
        let weight = |text| SpecificWeight::parse(text).map(Quantity::si);
        // 1 kg has a weight of g.
        assert_eq!((weight("1800 kg/m3"), weight("1.8 t/m^3")), (Ok(1800.0 * crate::G), Ok(1.8 * (1e3 * crate::G))));
        assert_eq!((weight("18 kN/m^3"), weight("18 KN/M3"), weight("18 kn/m³")), (Ok(18e3), Ok(18e3), Ok(18e3)));
        let length = |text| Length::parse(text).map(Quantity::si);
        assert_eq!((length("250 MM"), length("25 CM"), length("10 μm")), (Ok(0.25), Ok(0.25), Ok(1e-5)));
        let stiff = |text| Stiffness::parse(text).map(|k| k.over(1.0));
        assert_eq!((stiff("54 MN/m^3"), stiff("36 N/MM3"), stiff("54 MN/M")), (Ok(54e6), Ok(36e9), Ok(54e6)));
        assert_eq!(DampingConstant::parse("3 kN·s/m").map(Quantity::si), Ok(3e3));
        assert_eq!(Stress::parse("2 Mpa").map(Quantity::si), Ok(2e6));
        for (wrong, meant) in [
            (Force::parse("3 mN").err(), "`MN`"),
            (Stress::parse("2 mPa").err(), "`MPa`"),
            (Stress::parse("2 mpa").err(), "`MPa`"),
        ] {
            assert!(wrong.as_ref().is_some_and(|w| w.contains(&format!("did you mean {meant}?"))), "{wrong:?}");
        }
        assert!(stiff("3 mN/m3").expect_err("a thousandth").contains("`MN/m3`"));
    }

    /// However the letters of a unit are turned, what is read is what it means, and a small m never stands for a million.
    fn turned<D: Dimension>() {
        for (name, factor) in D::UNITS {
            let letters: Vec<usize> =
                name.char_indices().filter(|(_, c)| c.is_ascii_alphabetic()).map(|(i, _)| i).collect();
            for turn in 0..1usize << letters.len() {
                let mut text: Vec<u8> = name.bytes().collect();
                for (k, i) in letters.iter().enumerate() {
                    let c = text[*i];
                    text[*i] = if turn >> k & 1 == 1 { c ^ 0x20 } else { c };
                }
                let text = String::from_utf8(text).expect("letters turned");
                let Ok(read) = Quantity::<D>::parse(&format!("1 {text}")) else { continue };
                assert_eq!(read.si(), in_si(1.0, *factor), "{text} for {name}");
                let million = name.bytes().zip(text.bytes()).any(|(a, b)| a == b'M' && b == b'm');
                assert!(!million, "{text} for {name}");
            }
        }
    }

    #[test]
    fn units_with_letters_of_any_size_mean_what_they_mean_or_nothing() {
        turned::<LengthTag>();
        turned::<MassTag>();
        turned::<TimeTag>();
        turned::<FrequencyTag>();
        turned::<VelocityTag>();
        turned::<AccelerationTag>();
        turned::<ForceTag>();
        turned::<DampingConstantTag>();
        turned::<ForcePerLengthTag>();
        turned::<ForcePerVolumeTag>();
        turned::<SpecificWeightTag>();
        turned::<StressTag>();
        turned::<EnergyPerAreaTag>();
        turned::<AngleTag>();
    }

    /// A sum of tenths, and numbers at the ends of what a message writes out.
    #[test]
    fn messages_show_no_digits_of_rounding() {
        for (v, text) in [
            (0.1 + 0.2, "0.3"),
            (-0.0, "0"),
            (1.0 / 3.0, "0.333333333333"),
            (123_456.789, "123456.789"),
            (1e-5, "1e-5"),
            (3.0 * 1.1e7, "3.3e7"),
            (9_999_999.999_999_9, "1e7"),
        ] {
            assert_eq!(shown(v), text);
        }
        assert_eq!(Length::from_si(0.1 + 0.2).to_string(), "0.3 m");
    }

    #[test]
    fn parts_of_a_unit_are_what_the_decimal_says() {
        for k in 1..2000 {
            for (unit, power) in [("cm", -2), ("mm", -3), ("um", -6)] {
                let expected: f64 = format!("{k}e{power}").parse().unwrap();
                assert_eq!(Length::parse(&format!("{k} {unit}")).map(Quantity::si), Ok(expected), "{k} {unit}");
            }
            assert_eq!(Time::parse(&format!("{k} ms")).map(Quantity::si), Ok(k as f64 / 1e3));
        }
    }

    #[test]
    fn an_exponent_is_not_taken_for_a_unit() {
        assert_eq!(Length::parse("1e2m").map(Quantity::si), Ok(100.0));
        assert!(Length::parse("1e m").is_err());
    }

    #[test]
    fn wrong_texts_name_what_is_allowed() {
        for (text, cause) in [
            ("", "does not start"),
            ("mm", "does not start"),
            ("1", "no unit"),
            ("1 kg", "not a unit of length"),
            ("1 Mm", "did you mean `mm`?"),
            ("1.2.3 m", "does not start"),
            ("- m", "does not start"),
            ("nan m", "does not start"),
        ] {
            let message = Length::parse(text).expect_err(text);
            assert!(message.contains(cause) && message.contains("; allowed: "), "{text}: {message}");
        }
    }
}
