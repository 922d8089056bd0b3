//! The serde deserialiser over [`Node`]: errors carry place, key path, the allowed values and a suggestion.

use std::fmt::{self, Display};

use serde::de::{self, DeserializeSeed, EnumAccess, IntoDeserializer, MapAccess, SeqAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, forward_to_deserialize_any};

use super::node::{Entry, Fault, Node, Value};
use crate::InputError;

/// Parts an error text into what is wrong and what is allowed: serde hands custom errors over as text only.
pub(crate) const ALLOWED: &str = "; allowed: ";

/// Said of a key that must be there and is not.
pub(crate) const MISSING: &str = "the key is missing";
/// What is wrong with one that nothing has.
pub(crate) const UNKNOWN: &str = "unknown key";
/// What is allowed where a whole number belongs, as far as its type tells.
pub(crate) const WHOLE: &str = "a whole number from 0";
/// What is allowed where a list belongs.
pub(crate) const LIST: &str = "a list";

/// Builds a `T` from a tree. The error comes with the byte it belongs to.
pub(crate) fn from_node<'de, T: Deserialize<'de>>(node: &'de Node) -> Result<T, Fault> {
    T::deserialize(Cursor { node }).map_err(|e| {
        let Parts { at, path, mut error } = *e.0;
        if !path.is_empty() {
            error.key = Some(joined(&path));
        }
        Fault::new(error, at.unwrap_or(node.at))
    })
}

/// Longest word that another is suggested for [bytes].
const LONGEST_WORD: usize = 100;

/// The closest of `known` to `word`, if it is close: the fewest letters mistyped, then the longer word, since letters
/// are left out more often than added (a plural), then the most alike from the start, then the nearest letters and
/// digits, so that of numbered names the nearest number wins.
pub(crate) fn suggestion<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // To compare two words takes the product of their lengths.
    if word.len() > LONGEST_WORD {
        return None;
    }
    let plain = |text: &str| text.to_lowercase().replace('-', "_");
    let word = plain(word);
    let ranked = known.into_iter().filter(|name| name.len() <= LONGEST_WORD).filter_map(|name| {
        let other = plain(name);
        let mistyped = strsim::damerau_levenshtein(&word, &other);
        let alike = strsim::jaro_winkler(&word, &other);
        let near = alike > 0.8 || (mistyped == 1 && word.len() > 1);
        let apart: u32 = word.chars().zip(other.chars()).map(|(a, b)| u32::from(a).abs_diff(u32::from(b))).sum();
        near.then_some((mistyped, alike, apart, name))
    });
    let best = ranked
        .min_by(|a, b| a.0.cmp(&b.0).then(b.3.len().cmp(&a.3.len())).then(b.1.total_cmp(&a.1)).then(a.2.cmp(&b.2)));
    best.map(|(.., name)| name)
}

/// What to write instead when `text` starts with a number with a decimal comma.
pub(crate) fn decimal_comma(text: &str) -> Option<String> {
    let text = text.trim();
    let (whole, rest) = text.split_once(',')?;
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    let unsigned = whole.strip_prefix(['+', '-']).unwrap_or(whole);
    let is_number = !unsigned.is_empty() && unsigned.bytes().all(|b| b.is_ascii_digit()) && !digits.is_empty();
    is_number.then(|| format!("decimals take a point: write {whole}.{digits}"))
}

pub(crate) fn list(words: &[impl std::fmt::Display]) -> String {
    words.iter().map(|w| format!("`{w}`")).collect::<Vec<_>>().join(", ")
}

/// A step of a key path; paths are built from the inside out.
#[derive(Debug)]
enum Step {
    Key(String),
    Index(usize),
}

fn joined(path: &[Step]) -> String {
    let mut text = String::new();
    for step in path.iter().rev() {
        match step {
            Step::Key(key) if text.is_empty() => text.push_str(key),
            Step::Key(key) => text.push_str(&format!(".{key}")),
            Step::Index(index) => text.push_str(&format!("[{index}]")),
        }
    }
    text
}

/// Boxed: results are returned through every level of the tree.
#[derive(Debug)]
struct Failure(Box<Parts>);

#[derive(Debug)]
struct Parts {
    at: Option<usize>,
    path: Vec<Step>,
    error: InputError,
}

impl Failure {
    fn new(error: InputError) -> Self {
        Failure(Box::new(Parts { at: None, path: Vec::new(), error }))
    }
    fn keyed(error: InputError, key: &str) -> Self {
        let mut failure = Failure::new(error);
        failure.0.path.push(Step::Key(key.to_string()));
        failure
    }
    fn at(mut self, byte: usize) -> Self {
        self.0.at.get_or_insert(byte);
        self
    }
    fn with_decimal_comma(mut self, text: &str) -> Self {
        if self.0.error.help.is_none() {
            self.0.error.help = decimal_comma(text);
        }
        self
    }
    fn within(mut self, step: Step) -> Self {
        self.0.path.push(step);
        self
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0.error)
    }
}

impl std::error::Error for Failure {}

fn found(unexpected: Unexpected<'_>) -> String {
    match unexpected {
        Unexpected::Map => "a table".into(),
        Unexpected::Seq => "a list".into(),
        Unexpected::Bool(b) => format!("`{b}`"),
        Unexpected::Unsigned(i) => format!("the number {i}"),
        Unexpected::Signed(i) => format!("the number {i}"),
        Unexpected::Float(v) => format!("the number {}", crate::quantity::shown(v)),
        Unexpected::Str(s) => format!("the text \"{s}\""),
        Unexpected::Unit => "null".into(),
        other => other.to_string(),
    }
}

impl de::Error for Failure {
    fn custom<T: Display>(message: T) -> Self {
        let text = message.to_string();
        Failure::new(match text.split_once(ALLOWED) {
            Some((what, allowed)) => InputError::new(what).allowed(allowed),
            None => InputError::new(text),
        })
    }
    fn invalid_type(unexpected: Unexpected<'_>, expected: &dyn de::Expected) -> Self {
        Failure::new(InputError::new(format!("{} cannot stand here", found(unexpected))).allowed(expected.to_string()))
    }
    fn invalid_value(unexpected: Unexpected<'_>, expected: &dyn de::Expected) -> Self {
        Self::invalid_type(unexpected, expected)
    }
    fn invalid_length(length: usize, expected: &dyn de::Expected) -> Self {
        Failure::new(InputError::new(format!("the list has {length} values")).allowed(expected.to_string()))
    }
    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Self {
        let error = InputError::new(format!("`{variant}` is not known here")).allowed(list(expected));
        Failure::new(match suggestion(variant, expected.iter().copied()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error,
        })
    }
    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Self {
        let error = InputError::new(UNKNOWN).allowed(list(expected));
        Failure::keyed(
            match suggestion(field, expected.iter().copied()) {
                Some(near) => error.help(format!("did you mean `{near}`?")),
                None => error,
            },
            field,
        )
    }
    fn missing_field(field: &'static str) -> Self {
        Failure::keyed(InputError::new(MISSING), field)
    }
    fn duplicate_field(field: &'static str) -> Self {
        Failure::keyed(InputError::new("the key is given twice"), field)
    }
}

/// A node being read.
#[derive(Clone, Copy)]
struct Cursor<'de> {
    node: &'de Node,
}

impl<'de> Cursor<'de> {
    fn unexpected(self) -> Unexpected<'de> {
        match &self.node.value {
            Value::Null => Unexpected::Unit,
            Value::Bool(b) => Unexpected::Bool(*b),
            Value::Int(i) => i64::try_from(*i).map_or(Unexpected::Float(*i as f64), Unexpected::Signed),
            Value::Float(v) => Unexpected::Float(*v),
            Value::Text(s) => Unexpected::Str(s),
            Value::Date(_) => Unexpected::Other("a date"),
            Value::List(_) => Unexpected::Seq,
            Value::Table(_) => Unexpected::Map,
        }
    }
    fn refuse(self, wanted: &str) -> Failure {
        <Failure as de::Error>::invalid_type(self.unexpected(), &wanted).at(self.node.at)
    }
    /// A whole number; `4.0` is one too, as it is in JSON Schema.
    fn whole(self) -> Option<i128> {
        match self.node.value {
            Value::Int(i) => Some(i),
            Value::Float(v) if v.fract() == 0.0 && v.abs() < 9e15 => Some(v as i128),
            _ => None,
        }
    }
    fn visit<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match &self.node.value {
            Value::Null => visitor.visit_unit(),
            Value::Bool(b) => visitor.visit_bool(*b),
            Value::Int(i) => match (i64::try_from(*i), u64::try_from(*i)) {
                (Ok(v), _) => visitor.visit_i64(v),
                (_, Ok(v)) => visitor.visit_u64(v),
                _ => visitor.visit_f64(*i as f64),
            },
            Value::Float(v) => visitor.visit_f64(*v),
            Value::Text(s) => visitor.visit_borrowed_str(s),
            Value::Date(_) => Err(<Failure as de::Error>::invalid_type(self.unexpected(), &visitor)),
            Value::List(items) => visitor.visit_seq(Items { items: items.iter().enumerate() }),
            Value::Table(entries) => visitor.visit_map(Entries { entries: entries.iter(), value: None }),
        }
    }
}

impl<'de> Deserializer<'de> for Cursor<'de> {
    type Error = Failure;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        self.visit(visitor).map_err(|e: Failure| match &self.node.value {
            Value::Text(text) => e.at(self.node.at).with_decimal_comma(text),
            _ => e.at(self.node.at),
        })
    }
    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_some(self)
    }
    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_newtype_struct(self)
    }
    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match self.whole().map(u64::try_from) {
            Some(Ok(v)) => visitor.visit_u64(v).map_err(|e: Failure| e.at(self.node.at)),
            _ => Err(self.refuse(WHOLE)),
        }
    }
    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        self.deserialize_u64(visitor)
    }
    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match self.node.value {
            Value::Int(i) => visitor.visit_f64(i as f64),
            Value::Float(v) => visitor.visit_f64(v),
            _ => Err(self.refuse("a number without a unit")),
        }
        .map_err(|e: Failure| e.at(self.node.at))
    }
    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match self.node.value {
            Value::Bool(b) => visitor.visit_bool(b).map_err(|e: Failure| e.at(self.node.at)),
            _ => Err(self.refuse("true or false")),
        }
    }
    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match &self.node.value {
            Value::Text(s) => visitor.visit_borrowed_str(s).map_err(|e: Failure| e.at(self.node.at)),
            _ => Err(self.refuse("a text in quotes")),
        }
    }
    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        self.deserialize_str(visitor)
    }
    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match self.node.value {
            Value::List(_) => self.deserialize_any(visitor),
            Value::Table(_) => Err(self.refuse("a list; in TOML, tables in a list stand under [[two brackets]]")),
            _ => Err(self.refuse(LIST)),
        }
    }
    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Failure> {
        match &self.node.value {
            Value::List(items) if items.len() == length => self.deserialize_any(visitor),
            Value::List(items) => {
                let wanted = format!("a list of {length} values");
                Err(<Failure as de::Error>::invalid_length(items.len(), &wanted.as_str()).at(self.node.at))
            }
            _ => Err(self.refuse(&format!("a list of {length} values"))),
        }
    }
    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        match self.node.value {
            Value::Table(_) => self.deserialize_any(visitor),
            _ => Err(self.refuse("a table")),
        }
    }
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        match self.node.value {
            Value::Table(_) => self.deserialize_any(visitor),
            _ => Err(self.refuse(&format!("a table with keys of {}", list(fields)))),
        }
    }
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        match &self.node.value {
            Value::Text(s) => visitor.visit_enum(Variant { text: s }).map_err(|e: Failure| e.at(self.node.at)),
            _ => Err(self.refuse(&list(variants))),
        }
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u8 u16 u128 f32 char bytes byte_buf unit unit_struct tuple_struct identifier ignored_any
    }
}

struct Items<'de> {
    items: std::iter::Enumerate<std::slice::Iter<'de, Node>>,
}

impl<'de> SeqAccess<'de> for Items<'de> {
    type Error = Failure;
    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Failure> {
        self.items
            .next()
            .map(|(index, node)| seed.deserialize(Cursor { node }).map_err(|e| e.within(Step::Index(index))))
            .transpose()
    }
    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len())
    }
}

struct Entries<'de> {
    entries: std::slice::Iter<'de, Entry>,
    value: Option<&'de Entry>,
}

impl<'de> MapAccess<'de> for Entries<'de> {
    type Error = Failure;
    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Failure> {
        self.value = self.entries.next();
        self.value
            .map(|entry| seed.deserialize(entry.key.as_str().into_deserializer()).map_err(|e: Failure| e.at(entry.at)))
            .transpose()
    }
    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Failure> {
        let entry = self.value.take().ok_or_else(|| <Failure as de::Error>::custom("a value before its key"))?;
        seed.deserialize(Cursor { node: &entry.node })
            .map_err(|e| e.at(entry.node.at).within(Step::Key(entry.key.clone())))
    }
}

/// The name of a unit variant.
struct Variant<'de> {
    text: &'de str,
}

impl<'de> EnumAccess<'de> for Variant<'de> {
    type Error = Failure;
    type Variant = UnitOnly;
    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, UnitOnly), Failure> {
        let name: de::value::StrDeserializer<'_, Failure> = self.text.into_deserializer();
        Ok((seed.deserialize(name)?, UnitOnly))
    }
}

/// The wall file's enums have no data; forms with data are tables and read by hand (`forms`).
struct UnitOnly;

impl<'de> de::VariantAccess<'de> for UnitOnly {
    type Error = Failure;
    fn unit_variant(self) -> Result<(), Failure> {
        Ok(())
    }
    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, _: T) -> Result<T::Value, Failure> {
        Err(de::Error::invalid_type(Unexpected::UnitVariant, &"a table"))
    }
    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Failure> {
        Err(de::Error::invalid_type(Unexpected::UnitVariant, &"a table"))
    }
    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], _: V) -> Result<V::Value, Failure> {
        Err(de::Error::invalid_type(Unexpected::UnitVariant, &"a table"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_word_is_suggested() {
        for (word, known, near) in [
            ("coures", &["course", "courses", "bricks"][..], Some("courses")),
            ("corses", &["course", "courses"], Some("courses")),
            ("brick", &["bricks", "brick"], Some("brick")),
            ("stiff", &["stiffness", "law"], Some("stiffness")),
            ("p1c9b1", &["p1c1b1", "p1c5b1", "p1c6b1", "p1c2b9"], Some("p1c6b1")),
            ("otu", &["out", "fresh"], Some("out")),
            ("x", &["y", "law"], None),
            ("zebra", &["law", "stiffness"], None),
        ] {
            assert_eq!(suggestion(word, known.iter().copied()), near, "{word}");
        }
    }

    #[test]
    fn decimal_commas() {
        assert_eq!(decimal_comma(" 0,6 g").as_deref(), Some("decimals take a point: write 0.6"));
        for other in ["0.6", "a,6", "1, 2", ",5", "0,x"] {
            assert_eq!(decimal_comma(other), None, "{other}");
        }
    }
}
