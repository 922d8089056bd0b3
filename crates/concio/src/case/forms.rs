//! Keys that take a word or a table: `set`, `load.beam`, `load.top` (a number or a table), `motion.base`, `motion.top`, `baseline`; and `channel`, a number or a name.
//! Serde's own enum forms would read differently from the documented ones, hence by hand; each writes what it reads.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{self, IntoDeserializer, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::*;

/// What a form is made of: a word, or a table read as `Table`.
trait Form: Sized {
    type Table: for<'a> Deserialize<'a>;
    /// Said when the value is neither.
    const WANTED: &'static str;
    fn from_word<E: de::Error>(word: &str) -> Result<Self, E>;
    fn from_table<E: de::Error>(table: Self::Table) -> Result<Self, E>;
}

struct FormVisitor<F>(PhantomData<F>);

impl<'de, F: Form> Visitor<'de> for FormVisitor<F> {
    type Value = F;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(F::WANTED)
    }
    fn visit_str<E: de::Error>(self, word: &str) -> Result<F, E> {
        F::from_word(word)
    }
    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<F, A::Error> {
        F::from_table(F::Table::deserialize(MapAccessDeserializer::new(map))?)
    }
}

macro_rules! read_as_form {
    ($($name:ty),+) => {$(
        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
                d.deserialize_any(FormVisitor(PhantomData))
            }
        }
    )+};
}
read_as_form!(ParameterSet, Beam, Signal, Baseline, StopAt);

/// The schema of a form: one of some words, or the table `T`.
fn word_or_table<T: JsonSchema>(generator: &mut SchemaGenerator, about: &str, words: &[&str]) -> Schema {
    let table = generator.subschema_for::<T>();
    json_schema!({ "description": about, "anyOf": [{ "type": "string", "enum": words }, table] })
}

/// A parameter set with its place in the printed ranges.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SetTable {
    /// `report`, `p1`, `p2`, `p3` or `p4`.
    name: SetName,
    /// Where in the printed ranges the values are taken: 0 the lower end, 1 the upper. 0 … 1, default 0.5.
    #[serde(default = "half")]
    #[schemars(range(min = 0.0, max = 1.0))]
    at: f64,
}

fn half() -> f64 {
    0.5
}

impl Form for ParameterSet {
    type Table = SetTable;
    const WANTED: &'static str = "\"report\", \"p1\", \"p2\", \"p3\", \"p4\" or { name = \"p1\", at = 0.5 }";
    fn from_word<E: de::Error>(word: &str) -> Result<Self, E> {
        let name: StrDeserializer<'_, E> = word.into_deserializer();
        Ok(ParameterSet { name: SetName::deserialize(name)?, at: half() })
    }
    fn from_table<E: de::Error>(table: SetTable) -> Result<Self, E> {
        Ok(ParameterSet { name: table.name, at: table.at })
    }
}

impl Serialize for ParameterSet {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        SetTable { name: self.name, at: self.at }.serialize(s)
    }
}

impl JsonSchema for ParameterSet {
    fn schema_name() -> Cow<'static, str> {
        "ParameterSet".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let about =
            "A named parameter set of the research report, at the middle of its printed ranges or where `at` says.";
        word_or_table::<SetTable>(generator, about, &["report", "p1", "p2", "p3", "p4"])
    }
}

/// A rigid beam with mass.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct BeamTable {
    /// Mass of the beam and of the floor that moves with it [kg], above 0.
    mass: Mass,
}

impl Form for Beam {
    type Table = BeamTable;
    const WANTED: &'static str = "\"free\", \"driven\", \"tied\" or { mass = \"1000 kg\" }";
    fn from_word<E: de::Error>(word: &str) -> Result<Self, E> {
        match word {
            "free" => Ok(Beam::Free),
            "driven" => Ok(Beam::Driven),
            "tied" => Ok(Beam::Tied),
            _ => Err(E::unknown_variant(word, &["free", "driven", "tied", "{ mass = \"1000 kg\" }"])),
        }
    }
    fn from_table<E: de::Error>(table: BeamTable) -> Result<Self, E> {
        Ok(Beam::Mass(table.mass))
    }
}

impl Serialize for Beam {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            Beam::Free => s.serialize_str("free"),
            Beam::Driven => s.serialize_str("driven"),
            Beam::Tied => s.serialize_str("tied"),
            Beam::Mass(mass) => BeamTable { mass: *mass }.serialize(s),
        }
    }
}

impl JsonSchema for Beam {
    fn schema_name() -> Cow<'static, str> {
        "Beam".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let about = "The top beam: `free` (the load only), `driven` (by motion.top), `tied` (moves with the base), \
                     or a rigid beam with mass.";
        word_or_table::<BeamTable>(generator, about, &["free", "driven", "tied"])
    }
}

/// A load on the top as a whole.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct TopTable {
    /// All of it [N], from 0.
    force: Force,
}

impl<'de> Deserialize<'de> for TopLoad {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct OfLoad;
        impl<'de> Visitor<'de> for OfLoad {
            type Value = TopLoad;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(
                    "a load per length of brick, such as \"40 kN/m\" or a number in N/m, or { force = \"150 kN\" }",
                )
            }
            fn visit_f64<E: de::Error>(self, q: f64) -> Result<TopLoad, E> {
                Ok(q.into())
            }
            fn visit_i64<E: de::Error>(self, q: i64) -> Result<TopLoad, E> {
                Ok((q as f64).into())
            }
            fn visit_u64<E: de::Error>(self, q: u64) -> Result<TopLoad, E> {
                Ok((q as f64).into())
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<TopLoad, E> {
                let per_length = ForcePerLength::parse(text);
                per_length.map(TopLoad::PerLength).map_err(|message| match Force::parse(text) {
                    Ok(_) => E::custom(format!("{text:?} is a force: a load in all is {{ force = {text:?} }}, per length it has units such as kN/m")),
                    Err(_) => E::custom(message),
                })
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<TopLoad, A::Error> {
                TopTable::deserialize(MapAccessDeserializer::new(map)).map(|table| TopLoad::Force(table.force))
            }
        }
        d.deserialize_any(OfLoad)
    }
}

impl Serialize for TopLoad {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match *self {
            TopLoad::PerLength(q) => q.serialize(s),
            TopLoad::Force(force) => TopTable { force }.serialize(s),
        }
    }
}

impl JsonSchema for TopLoad {
    fn schema_name() -> Cow<'static, str> {
        "TopLoad".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let per_length = generator.subschema_for::<ForcePerLength>();
        let whole = generator.subschema_for::<TopTable>();
        json_schema!({ "description": "Vertical load on the top: per length of brick, or all of it.", "anyOf": [per_length, whole] })
    }
}

/// What ends a run.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct StopTable {
    /// How long after a collapse [s], from 0.
    collapse: Time,
}

impl Form for StopAt {
    type Table = StopTable;
    const WANTED: &'static str = "\"collapse\" or { collapse = \"0.5 s\" }";
    fn from_word<E: de::Error>(word: &str) -> Result<Self, E> {
        match word {
            "collapse" => Ok(StopAt::Collapse(Time::from_si(StopAt::AFTER_COLLAPSE))),
            _ => Err(E::unknown_variant(word, &["collapse", "{ collapse = \"0.5 s\" }"])),
        }
    }
    fn from_table<E: de::Error>(table: StopTable) -> Result<Self, E> {
        Ok(StopAt::Collapse(table.collapse))
    }
}

impl Serialize for StopAt {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        let StopAt::Collapse(collapse) = *self;
        StopTable { collapse }.serialize(s)
    }
}

impl JsonSchema for StopAt {
    fn schema_name() -> Cow<'static, str> {
        "StopAt".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let about = "What ends a run before its motion does: the wall's collapse. `collapse` ends the run 2 s after it, a table after the time given.";
        word_or_table::<StopTable>(generator, about, &["collapse"])
    }
}

/// Baseline correction by one of two ways.
#[derive(Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct BaselineTable {
    /// Degree of the least-squares polynomial that is subtracted from the acceleration, 0 … 6.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 6))]
    polynomial: Option<usize>,
    /// Corner of a Butterworth high-pass, forward and backward, above 0 and below the Nyquist frequency.
    #[serde(alias = "high-pass", skip_serializing_if = "Option::is_none")]
    high_pass: Option<Frequency>,
    /// Order of the high-pass, 1 … 8; default 4.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 8))]
    order: Option<usize>,
}

impl Form for Baseline {
    type Table = BaselineTable;
    const WANTED: &'static str = "\"none\", { polynomial = 2 } or { high_pass = \"0.1 Hz\", order = 4 }";
    fn from_word<E: de::Error>(word: &str) -> Result<Self, E> {
        match word {
            "none" => Ok(Baseline::None),
            _ => {
                Err(E::unknown_variant(word, &["none", "{ polynomial = 2 }", "{ high_pass = \"0.1 Hz\", order = 4 }"]))
            }
        }
    }
    fn from_table<E: de::Error>(table: BaselineTable) -> Result<Self, E> {
        match (table.polynomial, table.high_pass, table.order) {
            (Some(degree), None, None) => Ok(Baseline::Polynomial(degree)),
            (None, Some(corner), order) => Ok(Baseline::HighPass { corner, order: order.unwrap_or(4) }),
            _ => Err(refused("a baseline correction is either a polynomial or a high-pass", Self::WANTED)),
        }
    }
}

fn refused<E: de::Error>(what: &str, allowed: &str) -> E {
    E::custom(format_args!("{what}{}{allowed}", super::de::ALLOWED))
}

impl Serialize for Baseline {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match *self {
            Baseline::None => s.serialize_str("none"),
            Baseline::Polynomial(degree) => {
                BaselineTable { polynomial: Some(degree), ..Default::default() }.serialize(s)
            }
            Baseline::HighPass { corner, order } => {
                BaselineTable { high_pass: Some(corner), order: Some(order), ..Default::default() }.serialize(s)
            }
        }
    }
}

impl JsonSchema for Baseline {
    fn schema_name() -> Cow<'static, str> {
        "Baseline".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        word_or_table::<BaselineTable>(generator, "Baseline correction of a record; default `none`.", &["none"])
    }
}

/// A motion: exactly one of `record`, `sine`, `ramp`, `tilt`, `path`, `pulse`, `sweep`, `synthetic`; the other keys belong
/// to `record`.
#[derive(Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
struct SignalTable {
    /// A file with an accelerogram or a displacement history, relative to the wall file; its format is found from
    /// its content.
    #[serde(skip_serializing_if = "Option::is_none")]
    record: Option<PathBuf>,
    /// With `record`: which component of a file with several; default the first horizontal one.
    channel: Option<RecordChannel>,
    /// With `record`: factor on the values; default 1.
    scale: Option<f64>,
    /// With `record`: scale to this peak acceleration, above 0, instead of `scale`.
    pga: Option<Acceleration>,
    /// With `record`: keep this interval, `[from, to]` [s]; it starts at t = 0 then.
    trim: Option<[Time; 2]>,
    /// With `record`: play it backwards, the last sample first; default false.
    reverse: Option<bool>,
    /// With `record`: new sample interval [s], above 0.
    resample: Option<Time>,
    /// With `record`: baseline correction; default none.
    baseline: Option<Baseline>,
    /// With `record`: what the values of a CSV/TXT file are; default acceleration.
    quantity: Option<HistoryQuantity>,
    /// With `record`: unit of the values of a CSV/TXT file that does not name one.
    units: Option<String>,
    /// With `record`: sample interval of a CSV/TXT file without a time column that does not name one [s], above 0.
    dt: Option<Time>,
    /// With `record`: how the values stand in a CSV/TXT file, `columns` or `rows`; default columns.
    layout: Option<HistoryLayout>,
    /// A sine.
    #[serde(skip_serializing_if = "Option::is_none")]
    sine: Option<Sine>,
    /// A ramp of the displacement.
    #[serde(skip_serializing_if = "Option::is_none")]
    ramp: Option<Ramp>,
    /// An acceleration that grows linearly and stays.
    #[serde(skip_serializing_if = "Option::is_none")]
    tilt: Option<Tilt>,
    /// A displacement that goes from place to place at one speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    path: Option<DisplacementPath>,
    /// A pulse of the acceleration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pulse: Option<Pulse>,
    /// A swept sine.
    #[serde(skip_serializing_if = "Option::is_none")]
    sweep: Option<Sweep>,
    /// A seeded spectrum-compatible accelerogram.
    #[serde(skip_serializing_if = "Option::is_none")]
    synthetic: Option<Synthetic>,
}

impl SignalTable {
    /// The first key given that only a record takes.
    fn record_key(&self) -> Option<&'static str> {
        let given = [
            ("channel", self.channel.is_some()),
            ("scale", self.scale.is_some()),
            ("pga", self.pga.is_some()),
            ("trim", self.trim.is_some()),
            ("reverse", self.reverse.is_some()),
            ("resample", self.resample.is_some()),
            ("baseline", self.baseline.is_some()),
            ("quantity", self.quantity.is_some()),
            ("units", self.units.is_some()),
            ("dt", self.dt.is_some()),
            ("layout", self.layout.is_some()),
        ];
        given.into_iter().find(|(_, given)| *given).map(|(key, _)| key)
    }
}

impl Form for Signal {
    type Table = SignalTable;
    const WANTED: &'static str =
        "\"none\" or a table with exactly one of record, sine, ramp, tilt, path, pulse, sweep, synthetic";
    fn from_word<E: de::Error>(word: &str) -> Result<Self, E> {
        match word {
            "none" => Ok(Signal::None),
            _ => Err(refused(
                &format!("`{word}` is not a motion; a file is given as {{ record = \"{word}\" }}"),
                Self::WANTED,
            )),
        }
    }
    fn from_table<E: de::Error>(table: SignalTable) -> Result<Self, E> {
        let beside = table.record_key();
        let given = [
            table.sine.map(Signal::Sine),
            table.ramp.map(Signal::Ramp),
            table.tilt.map(Signal::Tilt),
            table.path.map(Signal::Path),
            table.pulse.map(Signal::Pulse),
            table.sweep.map(Signal::Sweep),
            table.synthetic.map(Signal::Synthetic),
            table.record.map(|record| {
                Signal::Record(RecordInput {
                    record,
                    channel: table.channel,
                    scale: table.scale,
                    pga: table.pga,
                    trim: table.trim,
                    reverse: table.reverse.unwrap_or_default(),
                    resample: table.resample,
                    baseline: table.baseline.unwrap_or_default(),
                    quantity: table.quantity.unwrap_or_default(),
                    units: table.units,
                    dt: table.dt,
                    layout: table.layout,
                })
            }),
        ];
        let mut given = given.into_iter().flatten();
        match (given.next(), given.next(), beside) {
            (Some(signal @ Signal::Record(_)), None, _) | (Some(signal), None, None) => Ok(signal),
            (Some(_), None, Some(key)) => Err(refused(&format!("`{key}` goes with `record` only"), Self::WANTED)),
            (Some(_), Some(_), _) => Err(refused("more than one motion is given", Self::WANTED)),
            (None, ..) => Err(refused("no motion is given", Self::WANTED)),
        }
    }
}

impl Serialize for Signal {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        fn tagged<S: Serializer>(s: S, key: &'static str, value: &impl Serialize) -> Result<S::Ok, S::Error> {
            s.collect_map([(key, value)])
        }
        match self {
            Signal::None => s.serialize_str("none"),
            Signal::Record(record) => record.serialize(s),
            Signal::Sine(v) => tagged(s, "sine", v),
            Signal::Ramp(v) => tagged(s, "ramp", v),
            Signal::Tilt(v) => tagged(s, "tilt", v),
            Signal::Path(v) => tagged(s, "path", v),
            Signal::Pulse(v) => tagged(s, "pulse", v),
            Signal::Sweep(v) => tagged(s, "sweep", v),
            Signal::Synthetic(v) => tagged(s, "synthetic", v),
        }
    }
}

impl JsonSchema for Signal {
    fn schema_name() -> Cow<'static, str> {
        "Signal".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let about = "A motion: `none` (at rest), a record from a file, or an analytic signal.";
        word_or_table::<SignalTable>(generator, about, &["none"])
    }
}

/// A number from 1 or a name.
struct ChannelVisitor;

impl Visitor<'_> for ChannelVisitor {
    type Value = RecordChannel;
    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the number of a component, from 1, or its name in quotes")
    }
    fn visit_u64<E: de::Error>(self, number: u64) -> Result<RecordChannel, E> {
        usize::try_from(number)
            .map(RecordChannel::Number)
            .map_err(|_| E::invalid_value(de::Unexpected::Unsigned(number), &self))
    }
    fn visit_i64<E: de::Error>(self, number: i64) -> Result<RecordChannel, E> {
        match u64::try_from(number) {
            Ok(number) => self.visit_u64(number),
            Err(_) => Err(E::invalid_value(de::Unexpected::Signed(number), &self)),
        }
    }
    /// `2.0` is a whole number too, as it is in JSON Schema.
    fn visit_f64<E: de::Error>(self, number: f64) -> Result<RecordChannel, E> {
        if number.fract() == 0.0 && (0.0..9e15).contains(&number) {
            self.visit_u64(number as u64)
        } else {
            Err(E::invalid_value(de::Unexpected::Float(number), &self))
        }
    }
    fn visit_str<E: de::Error>(self, name: &str) -> Result<RecordChannel, E> {
        Ok(RecordChannel::Name(name.into()))
    }
}

impl<'de> Deserialize<'de> for RecordChannel {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        d.deserialize_any(ChannelVisitor)
    }
}

impl Serialize for RecordChannel {
    fn serialize<S: Serializer>(&self, s: S) -> Result<S::Ok, S::Error> {
        match self {
            RecordChannel::Number(number) => number.serialize(s),
            RecordChannel::Name(name) => name.serialize(s),
        }
    }
}

impl JsonSchema for RecordChannel {
    fn schema_name() -> Cow<'static, str> {
        "RecordChannel".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let about =
            "A component of a record: its place in the file from 1, or its name there, of which a word is enough.";
        let kinds =
            [json_schema!({ "type": "integer", "minimum": 1 }), json_schema!({ "type": "string", "minLength": 1 })];
        json_schema!({ "description": about, "anyOf": kinds })
    }
}

impl fmt::Display for RecordChannel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RecordChannel::Number(number) => write!(f, "{number}"),
            RecordChannel::Name(name) => write!(f, "`{name}`"),
        }
    }
}

/// A record path as text; paths of a wall file are text already.
pub(super) fn path_as_text<S: Serializer>(path: &Path, s: S) -> Result<S::Ok, S::Error> {
    s.serialize_str(&path.to_string_lossy())
}
