//! How far an opening reaches: a length, or so many courses or bricks.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use crate::quantity::{Length, TEXT_PATTERN, parts, shown};

/// A length, or a number of courses or bricks: `0.6`, `"60 cm"`, `"4 courses"`, `"2.5 bricks"`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Extent {
    /// A length.
    Length(Length),
    /// So many courses, each with its mortar.
    Courses(f64),
    /// So many bricks, each with its mortar.
    Bricks(f64),
}

impl Extent {
    /// Reads `"60 cm"`, `"4 courses"` or `"1 brick"`.
    ///
    /// # Errors
    /// What is wrong and, after `; allowed: `, what is allowed.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (number, unit) = parts(text);
        let counted: Option<fn(f64) -> Extent> = match unit.to_lowercase().as_str() {
            "course" | "courses" => Some(Extent::Courses),
            "brick" | "bricks" => Some(Extent::Bricks),
            _ => None,
        };
        match (counted, number.parse()) {
            (Some(counted), Ok(number)) => Ok(counted(number)),
            _ => Length::parse(text).map(Extent::Length).map_err(|message| format!("{message}, courses, bricks")),
        }
    }

    /// The length; none of a number of courses or bricks.
    pub fn length(self) -> Option<f64> {
        match self {
            Extent::Length(length) => Some(length.si()),
            _ => None,
        }
    }
}

impl From<f64> for Extent {
    /// A length [m].
    fn from(si: f64) -> Self {
        Extent::Length(si.into())
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Extent::Length(length) => length.fmt(f),
            Extent::Courses(1.0) => f.write_str("1 course"),
            Extent::Bricks(1.0) => f.write_str("1 brick"),
            Extent::Courses(number) => write!(f, "{} courses", shown(*number)),
            Extent::Bricks(number) => write!(f, "{} bricks", shown(*number)),
        }
    }
}

impl Serialize for Extent {
    /// Courses and bricks as a text that reads back to the same bits.
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Extent::Length(length) => length.serialize(s),
            Extent::Courses(number) => s.collect_str(&format_args!("{number} courses")),
            Extent::Bricks(number) => s.collect_str(&format_args!("{number} bricks")),
        }
    }
}

impl<'de> Deserialize<'de> for Extent {
    fn deserialize<De: Deserializer<'de>>(d: De) -> Result<Self, De::Error> {
        struct Visitor;
        impl de::Visitor<'_> for Visitor {
            type Value = Extent;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a length: a number in m or a text with its unit (\"60 cm\"), or courses or bricks (\"4 courses\", \"2 bricks\")")
            }
            fn visit_f64<E: de::Error>(self, v: f64) -> Result<Extent, E> {
                Ok(v.into())
            }
            fn visit_i64<E: de::Error>(self, v: i64) -> Result<Extent, E> {
                Ok((v as f64).into())
            }
            fn visit_u64<E: de::Error>(self, v: u64) -> Result<Extent, E> {
                Ok((v as f64).into())
            }
            fn visit_str<E: de::Error>(self, v: &str) -> Result<Extent, E> {
                Extent::parse(v).map_err(E::custom)
            }
        }
        d.deserialize_any(Visitor)
    }
}

impl JsonSchema for Extent {
    fn schema_name() -> Cow<'static, str> {
        "extent".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A length: a number in m, or a text with its unit; or a text such as `4 courses` or `2.5 bricks`.",
            "anyOf": [{ "type": "number" }, { "type": "string", "pattern": TEXT_PATTERN }],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_courses_and_bricks_are_told_apart_and_read_back() {
        let read = |json: &str| serde_json::from_str::<Extent>(json).map_err(|e| e.to_string());
        assert_eq!(read("0.6"), Ok(0.6.into()));
        assert_eq!(read("\"60 cm\""), Ok(0.6.into()));
        assert_eq!((read("\"4 courses\""), read("\"1 course\"")), (Ok(Extent::Courses(4.0)), Ok(Extent::Courses(1.0))));
        assert_eq!((read("\"2.5bricks\""), read("\"1 Brick\"")), (Ok(Extent::Bricks(2.5)), Ok(Extent::Bricks(1.0))));
        for extent in [Extent::from(0.1 + 0.2), Extent::Courses(3.0), Extent::Bricks(1.0), Extent::Bricks(0.1 + 0.2)] {
            let json = serde_json::to_string(&extent).expect("written");
            assert_eq!(read(&json), Ok(extent), "{json}");
        }
        assert_eq!(
            (Extent::Courses(1.0).to_string(), Extent::Bricks(2.5).to_string()),
            ("1 course".into(), "2.5 bricks".into())
        );
        let wrong = read("\"3 rows\"").expect_err("no unit");
        assert!(wrong.contains("`rows` is not a unit of length") && wrong.contains("courses, bricks"), "{wrong}");
        assert!(read("\"many bricks\"").is_err());
    }
}
