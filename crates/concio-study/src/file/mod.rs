//! The study file: TOML (or JSON) with the keys of [`Study`]. Values stand in it as a wall file would say them.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use concio::case::{self, CaseFile, Document};
use concio::{Error, InputError, Result};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::motions::MotionInput;
use analyses::{CracksInput, FirstCrackInput, Ida, Interfaces, Ranking, Sensitivity};

pub mod analyses;

/// A study: a wall, what varies, which combinations are run, what is kept, what is asked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Study {
    /// Free text shown in reports.
    #[serde(default)]
    pub title: String,
    /// The wall file that everything starts from, relative to the study file.
    pub wall: PathBuf,
    /// How the values of the factors are combined; default every value with every other.
    #[serde(default)]
    pub design: Design,
    /// What varies.
    #[serde(default, rename = "vary", skip_serializing_if = "Vec::is_empty")]
    pub factors: Vec<Vary>,
    /// Motions that take the place of the wall file's, one factor more.
    #[serde(default, rename = "motion", skip_serializing_if = "Vec::is_empty")]
    pub motions: Vec<MotionInput>,
    /// Factors on the acceleration (or displacement) of the base's motion, each above 0: one factor more.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scales: Vec<f64>,
    /// What is kept of every run.
    #[serde(default)]
    pub keep: Keep,
    /// Which factors move what was measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensitivity: Option<Sensitivity>,
    /// Every motion at rising intensity, and the fragility.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ida: Option<Ida>,
    /// Asks for the least scale of each motion at which a first joint cracks, instead of the study's own runs.
    #[serde(default, rename = "first-crack", skip_serializing_if = "Option::is_none")]
    pub first_crack: Option<FirstCrackInput>,
    /// Asks how often and in which order joints crack over the runs, and which lines they form.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cracks: Option<CracksInput>,
    /// Asks which joints are critical.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ranking: Option<Ranking>,
    /// Asks which joints to replace by which devices.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub interfaces: Option<Interfaces>,
}

/// How values are combined.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Design {
    /// The way.
    pub kind: DesignKind,
    /// `latin-hypercube`, `random`: number of runs; `morris`: of trajectories; `sobol`: of base points. From 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1))]
    pub runs: Option<usize>,
    /// Seed of everything that is drawn; default 1.
    pub seed: u64,
    /// `morris`: levels of each factor, even, from 4; default 4.
    #[schemars(range(min = 4))]
    pub levels: usize,
}

impl Default for Design {
    fn default() -> Self {
        Design { kind: DesignKind::Grid, runs: None, seed: 1, levels: 4 }
    }
}

/// Ways to combine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DesignKind {
    /// Every value of each factor with every value of the others.
    #[default]
    Grid,
    /// First values together, second values together, …: all factors have equally many.
    List,
    /// Each factor's range in as many layers as there are runs, each layer used once (McKay et al. 1979).
    LatinHypercube,
    /// Independent draws.
    Random,
    /// Trajectories on which one factor changes at a time (Morris 1991).
    Morris,
    /// Two samples and those in which one factor is taken from the other (Saltelli et al. 2010).
    Sobol,
}

/// One thing that varies. Exactly one of `values`, `from` with `to`, `distribution`, `choices` says over what.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Vary {
    /// Heading of its column; default the path.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Key path in the wall file: `joint.friction.static`, `panel[0].courses`, `panel[*].brick.height`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Values that stand there one after the other, from 1 to 10,000.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<Value>,
    /// Lower end of a range: a number, or a text with a unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from: Option<Value>,
    /// Upper end, in the same unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<Value>,
    /// How many values of the range a grid or list takes, ends included; 2 … 10,000.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2))]
    pub count: Option<usize>,
    /// How they lie in the range; default `linear`.
    pub spacing: Spacing,
    /// A distribution instead of a range, for designs that draw.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distribution: Option<Distribution>,
    /// Named alternatives, each with any number of changes: textures, laws, whole walls.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub choices: Vec<Choice>,
    /// Other keys that follow the value of `path` in proportion.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub also: Vec<Follower>,
}

/// How values lie in a range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// At equal distances.
    #[default]
    Linear,
    /// At equal ratios; the range is above 0.
    Log,
}

/// A distribution; which parameters it needs depends on the law, and all have the unit of the key.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Distribution {
    /// The law.
    pub law: DistributionLaw,
    /// `normal`: mean.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<Value>,
    /// `normal`: standard deviation, above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deviation: Option<Value>,
    /// `lognormal`: median, above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub median: Option<Value>,
    /// `lognormal`: standard deviation of the logarithm, above 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dispersion: Option<f64>,
    /// `triangular`: the likeliest value, from `low` to `high`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mode: Option<Value>,
    /// Least value; `uniform`, `log-uniform` and `triangular` need it, the others are cut off there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub low: Option<Value>,
    /// Largest value, likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub high: Option<Value>,
}

/// Laws of distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DistributionLaw {
    /// All values from `low` to `high` alike.
    Uniform,
    /// Their logarithms alike.
    LogUniform,
    /// Bell curve of `mean` and `deviation`.
    Normal,
    /// Bell curve of the logarithm, of `median` and `dispersion`.
    Lognormal,
    /// From `low` up to `mode` and down to `high`.
    Triangular,
}

/// A named alternative.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// Its name in tables and figures.
    pub name: String,
    /// Key paths of the wall file and what stands there; empty for the wall as it is.
    #[serde(default)]
    pub set: Map<String, Value>,
}

/// A key that follows another in proportion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Follower {
    /// Key path in the wall file.
    pub path: String,
    /// Its value over that of the factor.
    pub times: f64,
}

/// What is kept of every run. Its numbers (docs/studies) always are.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Keep {
    /// Values per joint.
    pub joints: Vec<PerJoint>,
    /// Also the whole result of every run, `results/ID.h5`: large.
    pub results: bool,
}

/// What can be kept per joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PerJoint {
    /// Peak |relative displacement| [m].
    Displacement,
    /// Peak |relative velocity| [m/s].
    Velocity,
    /// Peak |relative acceleration| [m/s²].
    Acceleration,
    /// Slip [m].
    Slip,
    /// Widest gap of a head joint [m].
    Opening,
    /// Peak |elastic force| [N].
    Force,
    /// Dissipated energy [J].
    Dissipation,
    /// Time of the first crack [s]; empty where there was none.
    Cracked,
    /// Cracked part at the end, 0 … 1.
    Damage,
}

impl PerJoint {
    /// SI unit; empty for pure numbers.
    pub fn unit(self) -> &'static str {
        match self {
            PerJoint::Displacement | PerJoint::Slip | PerJoint::Opening => "m",
            PerJoint::Velocity => "m/s",
            PerJoint::Acceleration => "m/s²",
            PerJoint::Force => "N",
            PerJoint::Dissipation => "J",
            PerJoint::Cracked => "s",
            PerJoint::Damage => "",
        }
    }
}

/// A study file that was read, its wall file too.
#[derive(Debug, Clone)]
pub struct StudyFile {
    /// What it says.
    pub study: Study,
    /// Where its values stand.
    pub document: Document,
    /// The wall.
    pub wall: CaseFile,
}

impl Study {
    /// What its questions need per joint besides what it says itself.
    fn keep_what_is_asked(&mut self) {
        let default = self.interfaces.as_ref().map(|_| Ranking::default());
        for by in self.ranking.as_ref().or(default.as_ref()).map_or(&[][..], |r| &r.by) {
            if !self.keep.joints.contains(by) {
                self.keep.joints.push(*by);
            }
        }
        if let Some(kind) = self.cracks.as_ref().map(CracksInput::keeps)
            && !self.keep.joints.contains(&kind)
        {
            self.keep.joints.push(kind);
        }
    }
}

/// What stands at `wall`.
const WALL: &str = "a wall file, relative to the study file";

impl StudyFile {
    /// Reads a study file and the wall file that it names.
    ///
    /// # Errors
    /// [`Error::Input`] when either cannot be read, or says what it must not.
    pub fn read(path: &Path) -> Result<Self> {
        Self::of(Document::open(path, "a study file")?)
    }

    /// The same of a document that was read already.
    ///
    /// # Errors
    /// As [`StudyFile::read`].
    pub fn of(document: Document) -> Result<Self> {
        let named = |mut error| {
            if let Error::Input(e) = &mut error
                && e.key.as_deref() == Some("wall")
            {
                e.allowed.get_or_insert_with(|| WALL.into());
            }
            error
        };
        let mut study: Study = document.to().map_err(named)?;
        let given = study.keep.clone();
        study.keep_what_is_asked();
        let path = document.folder().join(&study.wall);
        if !path.is_file() {
            let error = InputError::new(format!("there is no file {}", path.display())).key("wall");
            return Err(document.locate(error.allowed(WALL)).into());
        }
        let wall = case::read(&path)?;
        wall.validate()?;
        let file = StudyFile { study, document, wall };
        file.passed_over(&given)?;
        Ok(file)
    }

    /// Refuses what would be passed over in silence; `keep` is what the file says itself.
    fn passed_over(&self, keep: &Keep) -> Result<()> {
        let study = &self.study;
        let analyses = [(study.first_crack.is_some(), "first-crack"), (study.ida.is_some(), "ida")];
        for (_, analysis) in analyses.into_iter().filter(|(is, _)| *is) {
            let beside = [
                (study.ranking.is_some(), "ranking"),
                (study.interfaces.is_some(), "interfaces"),
                (study.cracks.is_some() && analysis == "ida", "cracks"),
                (study.sensitivity.is_some() && analysis == "first-crack", "sensitivity"),
                (!keep.joints.is_empty(), "keep.joints"),
                (keep.results && analysis == "first-crack", "keep.results"),
                (study.ida.is_some() && analysis == "first-crack", "ida"),
            ];
            if let Some((_, key)) = beside.into_iter().find(|(is, _)| *is) {
                let what = format!("has no meaning beside `[{analysis}]`, which chooses its runs itself");
                let table = key.split('.').next().unwrap_or(key);
                return Err(self.wrong(key, what, &format!("one of `[{analysis}]` and `[{table}]`")));
            }
        }
        let varies = !(study.factors.is_empty() && study.motions.is_empty() && study.scales.is_empty());
        if !varies && !matches!(study.design.kind, DesignKind::Grid | DesignKind::List) {
            let what = "a design that draws has nothing to draw: nothing varies";
            return Err(self.wrong("design", what, "at least one `[[vary]]`, `[[motion]]` or `scales`"));
        }
        let mut seen = HashSet::new();
        for (i, scale) in study.scales.iter().enumerate() {
            if !seen.insert(scale.to_bits()) {
                let what = format!("{scale} stands there twice");
                return Err(self.wrong(&format!("scales[{i}]"), what, "each scale once"));
            }
        }
        let at = study.interfaces.as_ref().map(|i| &i.at);
        let lists = at.map_or([false; 4], |at| {
            [at.kind.is_empty(), at.panel.is_empty(), at.course.is_empty(), at.joints.is_empty()]
        });
        for (key, empty) in ["kind", "panel", "course", "joints"].into_iter().zip(lists) {
            let key = format!("interfaces.at.{key}");
            if empty && self.document.has(&key) {
                return Err(self.wrong(&key, "is empty: it chooses no joint", "at least one, or no such key"));
            }
        }
        if study.scales.is_empty() && self.document.has("scales") {
            return Err(self.wrong("scales", "is empty", "at least one factor above 0, or no `scales`"));
        }
        Ok(())
    }

    /// An error about a key of the study file, with its place.
    pub fn wrong(&self, key: &str, what: impl Into<String>, allowed: &str) -> Error {
        let error = InputError::new(what).key(key);
        self.document.locate(if allowed.is_empty() { error } else { error.allowed(allowed) }).into()
    }

    /// Where the study file says of a key of the wall file that it follows another.
    fn of_follower(&self, key: &str) -> Option<String> {
        let find = |(i, vary): (usize, &Vary)| {
            let follows = |f: &Follower| same_key(&f.path, key);
            vary.also.iter().position(follows).map(|k| format!("vary[{i}].also[{k}].path"))
        };
        self.study.factors.iter().enumerate().find_map(find)
    }

    /// What a wall file has against a value that the study file gives at `key`.
    pub fn of_wall(&self, key: &str, error: Error) -> Error {
        let Error::Input(e) = error else { return error };
        if e.file.as_deref().is_some_and(|f| Some(f) != self.wall.path()) {
            // About another file, a record: that is where it has to be mended.
            let help = self.document.locate(InputError::new("").key(key));
            let line = help.line.map_or(String::new(), |l| format!(", line {l}"));
            return e.help(format!("named in the study file{line}, {key}")).into();
        }
        let key = e.key.as_deref().and_then(|of| self.of_follower(of)).unwrap_or_else(|| key.to_string());
        let what = e.key.as_ref().map_or(e.what.clone(), |k| format!("{k}: {}", e.what));
        let mut moved = InputError::new(what).key(key);
        (moved.allowed, moved.help) = (e.allowed.clone(), e.help.clone());
        self.document.locate(moved).into()
    }
}

/// Whether two key paths are one; `[*]` stands for every number.
fn same_key(a: &str, b: &str) -> bool {
    let steps = |path: &str| path.split(['.', '[']).map(str::to_string).collect::<Vec<_>>();
    let same = |a: &String, b: &String| a == b || (a == "*]" && b.ends_with(']'));
    let (a, b) = (steps(a), steps(b));
    a.len() == b.len() && a.iter().zip(&b).all(|(a, b)| same(a, b))
}

/// The JSON Schema of the study file.
pub fn schema() -> Value {
    schemars::schema_for!(Study).to_value()
}
