//! Smart interfaces: what a study file says of the joints that devices may replace, and what is to become of the wall.

use std::path::Path;

use concio::assign::select;
use concio::case::Beam;
use concio::quantity::shown;
use concio::wall::{End, Joint, Wall};
use concio::{Error, Result, graph, pattern};
use serde_json::{Map, Value};

use crate::file::analyses::{Goal, Interfaces, ObjectiveInput, Over, ParameterInput, Target};
use crate::file::{Spacing, StudyFile};
use crate::measures::Row;
use crate::placement::Places;
use crate::plan::Plan;
use crate::search::Design;
use crate::values::{Changes, amount, few, written};

/// Devices to choose from, and parameters of one.
const MOST_DEVICES: usize = 100;

/// Generations from which on a search learns from what it has seen.
const GENERATIONS: usize = 10;
/// Part of a range, in its spacing, at whose ends a parameter is at its bound.
const AT_BOUND: f64 = 0.01;
/// Runs that a first crack takes, some less, some more.
const SEARCHING: usize = 12;

impl Target {
    /// Its value in a run; none where the run has none, and of `first_cracking`, which takes several runs.
    pub fn of(self, row: &Row) -> Option<f64> {
        match self {
            Target::FirstCracking => None,
            Target::DissipatedEnergy => {
                let of = |name| row.number(name);
                Some(of("friction_energy")? + of("damping_energy")? + of("device_energy")?)
            }
            other => row.number(other.name()),
        }
    }
}

/// An objective with its direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Objective {
    /// What is measured.
    pub target: Target,
    /// How motions are taken together.
    pub over: Over,
    /// Whether it is to be large.
    pub large: bool,
}

impl Objective {
    /// The value over some motions, infinitely bad where one is missing.
    pub fn over(&self, values: &[f64]) -> f64 {
        if values.is_empty() || values.iter().any(|v| v.is_nan()) {
            return if self.large { f64::NEG_INFINITY } else { f64::INFINITY };
        }
        match (self.over, self.large) {
            (Over::Mean, _) => values.iter().sum::<f64>() / values.len() as f64,
            (Over::Worst, true) => values.iter().copied().fold(f64::INFINITY, f64::min),
            (Over::Worst, false) => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// The value with the sign that makes it small where it is good.
    pub fn cost(&self, value: f64) -> f64 {
        if self.large { -value } else { value }
    }

    /// `mean peak drift`.
    pub fn title(&self) -> String {
        let over = match self.over {
            Over::Mean => "mean",
            Over::Worst => "worst",
        };
        format!("{over} {}", self.target.title())
    }
}

/// A device ready to be put in.
#[derive(Debug, Clone, PartialEq)]
pub struct Device {
    /// Its name.
    pub name: String,
    change: Map<String, Value>,
    /// Its free parameters.
    pub parameters: Vec<Parameter>,
}

/// A free parameter with its bounds.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Key path.
    pub path: String,
    /// Unit of the values; empty for none.
    pub unit: String,
    ends: [f64; 2],
    log: bool,
    also: Vec<(String, f64)>,
}

impl Parameter {
    /// The last key of its path.
    fn key(&self) -> &str {
        self.path.rsplit('.').next().unwrap_or(&self.path)
    }

    /// The value at a share of the range, 0 … 1, to four digits: designs are to be written down.
    pub fn value(&self, share: f64) -> f64 {
        let [low, high] = self.ends;
        let exact = if self.log { low * (high / low).powf(share) } else { low + share * (high - low) };
        format!("{exact:.3e}").parse::<f64>().unwrap_or(exact).clamp(low, high)
    }
}

impl Device {
    /// The change of a wall file that gives this device, its parameters at `shares`, to the joints `names`.
    pub fn change(&self, shares: &[f64], names: &[&str]) -> Value {
        let mut change = Value::Object(self.change.clone());
        for (parameter, share) in self.parameters.iter().zip(shares) {
            let value = parameter.value(*share);
            put(&mut change, &parameter.path, written(value, &parameter.unit));
            for (path, times) in &parameter.also {
                put(&mut change, path, written(value * times, &parameter.unit));
            }
        }
        put(&mut change, "at.joints", names.iter().map(|n| Value::String((*n).to_string())).collect());
        change
    }

    /// Its parameters that lie within a hundredth of their range of an end: `damping is at its upper bound, 100 kN s/m`.
    pub fn at_bounds(&self, shares: &[f64]) -> Vec<String> {
        let one = |(p, share): (&Parameter, &f64)| {
            let (which, end) = match *share {
                share if share <= AT_BOUND => ("lower", p.ends[0]),
                share if share >= 1.0 - AT_BOUND => ("upper", p.ends[1]),
                _ => return None,
            };
            let unit = if p.unit.is_empty() { String::new() } else { format!(" {}", p.unit) };
            Some(format!("{} is at its {which} bound, {end}{unit}", p.key()))
        };
        self.parameters.iter().zip(shares).filter_map(one).collect()
    }

    /// Its parameters in words: `damping = 12000 N s/m`.
    pub fn label(&self, shares: &[f64]) -> String {
        let one = |(p, share): (&Parameter, &f64)| {
            let unit = if p.unit.is_empty() { String::new() } else { format!(" {}", p.unit) };
            format!("{} = {}{unit}", p.key(), p.value(*share))
        };
        self.parameters.iter().zip(shares).map(one).collect::<Vec<_>>().join(", ")
    }
}

/// Puts a value where a path of keys leads; tables on the way are made.
fn put(tree: &mut Value, path: &str, value: Value) {
    match (tree, path.split_once('.')) {
        (Value::Object(map), None) => drop(map.insert(path.to_string(), value)),
        (Value::Object(map), Some((key, rest))) => {
            let inner = map.entry(key).or_insert_with(|| Value::Object(Map::new()));
            if !inner.is_object() {
                *inner = Value::Object(Map::new());
            }
            put(inner, rest, value);
        }
        _ => {}
    }
}

/// One run of the plan as a test of designs.
#[derive(Debug, Clone)]
pub struct Scene {
    /// Its name: the values of the factors.
    pub name: String,
    /// Whether the search does not see it.
    pub held_out: bool,
    /// What it changes of the wall file.
    pub changes: Changes,
    /// How much stronger the base moves.
    pub scale: f64,
    /// The joint changes that the wall has without devices.
    pub laws: Vec<Value>,
}

/// What a study asks of interfaces, all of it checked.
#[derive(Debug, Clone)]
pub struct Question {
    /// The study's words.
    pub input: Interfaces,
    /// Objectives.
    pub objectives: Vec<Objective>,
    /// Devices.
    pub devices: Vec<Device>,
    /// The wall and all its joints, their names in the same order.
    pub wall: Wall,
    /// Its joints.
    pub joints: Vec<Joint>,
    /// Their names.
    pub names: Vec<String>,
    /// Places of the eligible joints among all.
    pub eligible: Vec<usize>,
    /// Where devices may go; weights are all 1 until ranks are known.
    pub places: Places,
    /// The runs of the plan.
    pub scenes: Vec<Scene>,
}

impl Question {
    /// Names of the joints of a design.
    pub fn names(&self, design: &Design) -> Vec<&str> {
        design.joints.iter().map(|&e| self.names[self.eligible[e]].as_str()).collect()
    }

    /// Whether two designs are one: the same device in the same joints, its parameters equal in all digits that are used.
    pub fn is_same(&self, a: &Design, b: &Design) -> bool {
        let values = |d: &Design| -> Vec<f64> {
            self.devices[d.device].parameters.iter().zip(&d.shares).map(|(p, share)| p.value(*share)).collect()
        };
        a.device == b.device && a.joints == b.joints && values(a) == values(b)
    }

    /// The scenes of the search, or the held-out ones.
    pub fn of(&self, held_out: bool) -> Vec<usize> {
        (0..self.scenes.len()).filter(|&s| self.scenes[s].held_out == held_out).collect()
    }

    /// Generations of every device that the runs allow.
    pub fn generations(&self) -> usize {
        self.input.runs / self.generation()
    }

    /// Runs of one generation of every device.
    fn generation(&self) -> usize {
        self.runs_each() * self.of(false).len() * self.input.population * self.devices.len()
    }

    /// What is to be known of a search that is too short to learn from what it sees.
    pub fn too_few(&self) -> Option<String> {
        let generations = self.generations();
        (generations < GENERATIONS).then(|| {
            format!(
                "interfaces.runs = {} are {generations} {} of {} designs of each device, and a search of fewer than {GENERATIONS} is hardly more than random \
                 draws: {GENERATIONS} generations take {} runs",
                self.input.runs,
                if generations == 1 { "generation" } else { "generations" },
                self.input.population,
                GENERATIONS * self.generation()
            )
        })
    }

    /// Runs that the value of a design under one scene takes.
    pub fn runs_each(&self) -> usize {
        let cracking = self.objectives.iter().any(|o| o.target == Target::FirstCracking);
        let plain = self.objectives.iter().any(|o| o.target != Target::FirstCracking);
        usize::from(plain) + if cracking { SEARCHING } else { 0 }
    }
}

/// What the plan's study asks of interfaces. Not to be called where it asks nothing.
///
/// # Errors
/// [`concio::Error::Input`] with the line: what contradicts itself, is out of range, or does not fit the wall.
pub fn question(plan: &Plan) -> Result<Question> {
    let file = &plan.file;
    let Some(input) = file.study.interfaces.clone() else {
        return Err(file.wrong("interfaces", "the study does not ask for it", "a table `interfaces`"));
    };
    ranges(file, &input)?;
    let objectives = objectives(plan, &input)?;
    let devices = devices(file, &input)?;
    let scenes = scenes(plan)?;
    let (wall, joints, names) = wall_of(plan)?;
    let eligible = select(&input.at, &wall, &joints).map_err(|e| place(file, "interfaces.at", e.into()))?;
    let most = most(file, &input, joints.len(), eligible.len())?;
    let places = Places { most, neighbours: neighbours(&joints, &eligible), weights: vec![1.0; eligible.len()] };
    let question = Question { input, objectives, devices, wall, joints, names, eligible, places, scenes };
    budget(file, &question)?;
    try_devices(plan, &question)?;
    Ok(question)
}

fn place(file: &StudyFile, key: &str, error: Error) -> Error {
    match error {
        Error::Input(e) => file.document.locate(concio::InputError { key: Some(key.into()), ..*e }).into(),
        other => other,
    }
}

fn ranges(file: &StudyFile, input: &Interfaces) -> Result<()> {
    let wrong = |key: &str, value: &dyn std::fmt::Display, allowed: &str| {
        Err(file.wrong(&format!("interfaces.{key}"), format!("{value} is out of range"), allowed))
    };
    for (key, value, [low, high]) in [
        ("population", input.population, [4, 1000]),
        ("draws", input.draws, [1, 10_000]),
        ("copies", input.copies, [4, 1000]),
        ("finalists", input.finalists, [1, 100]),
    ] {
        if !(low..=high).contains(&value) {
            return wrong(key, &value, &format!("{low} to {high}"));
        }
    }
    if !(input.perturbation > 0.0 && input.perturbation <= 0.01) {
        return wrong("perturbation", &shown(input.perturbation), "above 0 and up to 0.01");
    }
    let [low, high] = input.crack_scales;
    if !(low > 0.0 && low < high && high.is_finite()) {
        let what = format!("[{}, {}] is no range of scales", shown(low), shown(high));
        return Err(file.wrong("interfaces.crack_scales", what, "two numbers above 0, rising"));
    }
    if !(input.crack_within > 0.0 && input.crack_within < 1.0) {
        return wrong("crack_within", &shown(input.crack_within), "above 0 and below 1");
    }
    Ok(())
}

fn most(file: &StudyFile, input: &Interfaces, joints: usize, eligible: usize) -> Result<usize> {
    let (key, most, what) = match (input.count, input.share) {
        (Some(count), None) => ("interfaces.count", count, count.to_string()),
        (None, Some(share)) if share > 0.0 && share <= 1.0 => {
            // 0.29 of 100 is 29, whatever its binary digits say.
            let count = (share * joints as f64 + 1e-9) as usize;
            ("interfaces.share", count, format!("{} of {joints} joints, which is {count},", shown(share)))
        }
        (None, Some(share)) => {
            return Err(file.wrong(
                "interfaces.share",
                format!("{} is out of range", shown(share)),
                "above 0 and up to 1",
            ));
        }
        (None, None) => {
            let what = "nothing says how many joints may be replaced";
            return Err(file.wrong("interfaces", what, "`count`, from 1, or `share`, above 0 and up to 1"));
        }
        (Some(_), Some(_)) => {
            let what = "`count` and `share` contradict each other";
            return Err(file.wrong("interfaces.share", what, "one of them"));
        }
    };
    if (1..=eligible).contains(&most) {
        return Ok(most);
    }
    Err(file.wrong(key, format!("{what} is out of range"), &format!("1 to {eligible}, the number of eligible joints")))
}

fn objectives(plan: &Plan, input: &Interfaces) -> Result<Vec<Objective>> {
    let file = &plan.file;
    if !(1..=2).contains(&input.objectives.len()) {
        let what = format!("{} objectives", input.objectives.len());
        return Err(file.wrong("interfaces.objective", what, "one `[[interfaces.objective]]`, or two"));
    }
    let of = |o: &ObjectiveInput| Objective {
        target: o.measure,
        over: o.over,
        large: match o.goal {
            Some(goal) => goal == Goal::Maximise,
            None => matches!(o.measure, Target::DissipatedEnergy | Target::FirstCracking),
        },
    };
    let all: Vec<Objective> = input.objectives.iter().map(of).collect();
    if let [a, b] = all[..]
        && a.target == b.target
    {
        let name = a.target.name();
        let what = match (a.large == b.large, a.over == b.over) {
            (false, _) => {
                format!("`{name}` cannot be minimised and maximised at once: the objectives contradict each other")
            }
            (true, true) => format!("`{name}` is the objective twice"),
            (true, false) => return Ok(all),
        };
        return Err(file.wrong("interfaces.objective[1].measure", what, "an objective of its own, or one objective"));
    }
    let joint = &file.wall.case.joint;
    if joint.bond.is_none()
        && joint.changes.iter().all(|c| c.bond.is_none())
        && let Some(i) = all.iter().position(|o| o.target == Target::FirstCracking)
    {
        let what = "no joint of this wall is bonded: nothing can crack";
        let allowed = "a wall file with `joint.bond`, or another measure";
        return Err(file.wrong(&format!("interfaces.objective[{i}].measure"), what, allowed));
    }
    Ok(all)
}

fn devices(file: &StudyFile, input: &Interfaces) -> Result<Vec<Device>> {
    if input.devices.is_empty() {
        return Err(file.wrong("interfaces.device", "there is none", "one or more `[[interfaces.device]]`"));
    }
    few(input.devices.len(), MOST_DEVICES, |what, allowed| file.wrong("interfaces.device", what, allowed))?;
    let mut devices: Vec<Device> = Vec::new();
    for (i, given) in input.devices.iter().enumerate() {
        let key = format!("interfaces.device[{i}]");
        if devices.iter().any(|d| d.name == given.name) {
            return Err(file.wrong(&format!("{key}.name"), "two devices have this name", "names that differ"));
        }
        if given.change.contains_key("at") {
            let what = "`at` is what the search chooses";
            return Err(file.wrong(&format!("{key}.change.at"), what, "the eligible joints in `interfaces.at`"));
        }
        let key_of = format!("{key}.parameter");
        few(given.parameters.len(), MOST_DEVICES, |what, allowed| file.wrong(&key_of, what, allowed))?;
        let parameter = |(k, p): (usize, &ParameterInput)| parameter(file, &format!("{key}.parameter[{k}]"), p);
        let parameters = given.parameters.iter().enumerate().map(parameter).collect::<Result<Vec<_>>>()?;
        if let Some(k) = (1..parameters.len()).find(|&k| parameters[..k].iter().any(|p| p.path == parameters[k].path)) {
            return Err(file.wrong(&format!("{key}.parameter[{k}].path"), "is varied twice", "paths that differ"));
        }
        devices.push(Device { name: given.name.clone(), change: given.change.clone(), parameters });
    }
    Ok(devices)
}

fn parameter(file: &StudyFile, key: &str, given: &ParameterInput) -> Result<Parameter> {
    let end = |name: &str, value: &Value| {
        let no_number =
            || file.wrong(&format!("{key}.{name}"), format!("{value} is no number"), "a number, or a text with a unit");
        amount(value).ok_or_else(no_number)
    };
    let (low, unit) = end("from", &given.from)?;
    let (high, other) = end("to", &given.to)?;
    if unit != other {
        return Err(file.wrong(&format!("{key}.to"), "its unit is not that of `from`", "one unit"));
    }
    if !(low < high) {
        let what =
            format!("the bounds are reversed or equal: {} does not lie above `from`, {}", shown(high), shown(low));
        return Err(file.wrong(&format!("{key}.to"), what, "above `from`"));
    }
    let log = given.spacing == Spacing::Log;
    if log && low <= 0.0 {
        return Err(file.wrong(&format!("{key}.from"), format!("{} has no logarithm", shown(low)), "above 0"));
    }
    let also = given.also.iter().map(|f| (f.path.clone(), f.times)).collect();
    Ok(Parameter { path: given.path.clone(), unit, ends: [low, high], log, also })
}

/// Every run of the plan.
fn scenes(plan: &Plan) -> Result<Vec<Scene>> {
    let motions = &plan.file.study.motions;
    if !motions.is_empty() && motions.iter().all(|m| m.held_out) {
        let what = "every motion is held out: the search has none to search with";
        return Err(plan.file.wrong("motion[0].held_out", what, "at least one motion without `held_out = true`"));
    }
    let scene = |number: usize| {
        let (changes, scale) = plan.setting(number);
        let case = plan.case(number)?;
        let laws = case.joint.changes.iter().map(serde_json::to_value).collect::<serde_json::Result<_>>();
        let laws = laws.map_err(|e| plan.file.wrong("interfaces", e.to_string(), ""))?;
        let text = |v: Value| v.as_str().map_or_else(|| v.to_string(), str::to_string);
        let labels: Vec<String> = plan.labels(number).into_iter().map(text).collect();
        let name = if labels.is_empty() { "motion of the wall file".to_string() } else { labels.join(", ") };
        let held_out = plan.motion(number).is_some_and(|m| motions[m].held_out);
        Ok(Scene { name, held_out, changes, scale, laws })
    };
    let scenes = (0..plan.points.len()).map(scene).collect::<Result<Vec<Scene>>>()?;
    if scenes.iter().all(|scene| scene.held_out) {
        let what = "every run of the design has a motion that is held out: the search has none to search with";
        return Err(plan.file.wrong("design", what, "a design whose runs have other motions too"));
    }
    Ok(scenes)
}

/// The wall, which has to be the same in all runs.
fn wall_of(plan: &Plan) -> Result<(Wall, Vec<Joint>, Vec<String>)> {
    let mut first: Option<(Wall, Vec<Joint>, Vec<String>)> = None;
    for number in 0..plan.points.len() {
        let case = plan.case(number)?;
        let wall = pattern::lay(&case)?;
        let joints = graph::joints(&wall, case.load.beam != Beam::Free);
        let names: Vec<String> = joints.iter().map(|j| graph::name(&wall, j)).collect();
        match &first {
            Some((_, _, known)) if *known != names => {
                let what = "the runs have different joints: a placement means nothing in all of them";
                let key = plan.file.study.factors.first().map_or("interfaces", |_| "vary[0]");
                return Err(plan.file.wrong(key, what, "factors that leave blocks and beam as they are"));
            }
            Some(_) => {}
            None => first = Some((wall, joints, names)),
        }
    }
    first.ok_or_else(|| plan.file.wrong("interfaces", "the study has no run", "at least one"))
}

/// Per eligible joint, the others that share a block with it.
fn neighbours(joints: &[Joint], eligible: &[usize]) -> Vec<Vec<usize>> {
    let blocks = |e: usize| {
        let joint = &joints[e];
        let b = if let End::Block(b) = joint.b { Some(b) } else { None };
        [Some(joint.a), b]
    };
    let touch = |e: usize, f: usize| blocks(e).iter().flatten().any(|b| blocks(f).contains(&Some(*b)));
    let near = |i: usize| (0..eligible.len()).filter(|&k| k != i && touch(eligible[i], eligible[k])).collect();
    (0..eligible.len()).map(near).collect()
}

fn budget(file: &StudyFile, question: &Question) -> Result<()> {
    let each = question.runs_each() * question.of(false).len();
    let least = question.generation();
    if question.input.runs < least {
        let what = format!("{} runs are less than one generation", question.input.runs);
        let allowed = format!(
            "from {least}: {} designs of {} devices, {each} runs each",
            question.input.population,
            question.devices.len()
        );
        return Err(file.wrong("interfaces.runs", what, &allowed));
    }
    Ok(())
}

/// Every device at its bounds in all eligible joints.
fn try_devices(plan: &Plan, question: &Question) -> Result<()> {
    let names: Vec<&str> = question.eligible.iter().map(|&e| question.names[e].as_str()).collect();
    for (i, device) in question.devices.iter().enumerate() {
        for share in [0.0, 1.0] {
            let shares = vec![share; device.parameters.len()];
            let mut changes = question.scenes[0].changes.clone();
            changes.push(("joint.change".into(), with(&question.scenes[0], device.change(&shares, &names))));
            let key = format!("interfaces.device[{i}].change");
            let case = plan.changed(&changes, 1.0).map_err(|e| plan.file.of_wall(&key, e))?;
            concio::run::prepare_case(case, Path::new("")).map_err(|e| plan.file.of_wall(&key, e))?;
        }
    }
    Ok(())
}

/// The joint changes of a scene and one more.
pub fn with(scene: &Scene, change: Value) -> Value {
    Value::Array(scene.laws.iter().cloned().chain([change]).collect())
}
