//! From a wall file to a [`Case`]: text → tree → parameter set → structs.

use std::borrow::Cow;
use std::path::Path;

use super::document::{self, Document};
use super::node::{Entry, Fault, Node, Syntax, Value};
use super::{Case, DeviceLaw, ModelKind, ParameterSet, change, de, plausible, sets, validate};
use crate::warning::Warning;
use crate::{Error, InputError, Result};

/// A wall file that was read: the case, and where each of its keys stands.
#[derive(Debug, Clone)]
pub struct CaseFile {
    /// What the file says, with parameter set and defaults filled in.
    pub case: Case,
    document: Document,
}

impl CaseFile {
    /// The file it came from.
    pub fn path(&self) -> Option<&Path> {
        self.document.path()
    }
    /// Its text.
    pub fn text(&self) -> &str {
        self.document.text()
    }
    /// The folder that record paths are relative to: the file's own, or the working directory.
    pub fn folder(&self) -> &Path {
        self.path().and_then(Path::parent).unwrap_or(Path::new(""))
    }
    /// The same wall with other values: each change is a key path (`joint.friction.static`, `panel[0].courses`; `[*]` for
    /// every element of a list) and what stands there instead, as a wall file would say it. Keys that the file leaves out
    /// are added; the parameter set fills in what is still missing.
    ///
    /// # Errors
    /// [`Error::Input`] for a path that leads nowhere, a key or value that the wall file does not know. The result is not
    /// validated yet.
    pub fn changed(&self, changes: &[(String, serde_json::Value)]) -> Result<CaseFile> {
        let mut document = self.document.clone();
        for (path, value) in changes {
            change::set(&mut document.tree, path, value).map_err(|fault| self.document.source.place_fault(fault))?;
        }
        resolve(document)
    }
    /// What the file says itself, with what was [`CaseFile::changed`], as a wall file in JSON: without defaults and what a parameter set
    /// fills in.
    pub fn given(&self) -> serde_json::Value {
        change::to_json(&self.document.tree)
    }
    /// Adds file, line and column to an error about a key of this case; a key that the file leaves out stands
    /// where its nearest table does. Errors that name a line already, and others than input errors, stay as they are.
    pub fn locate(&self, error: Error) -> Error {
        match error {
            Error::Input(e) => self.place(*e).into(),
            other => other,
        }
    }
    fn place(&self, error: InputError) -> InputError {
        self.document.locate(error)
    }
    /// Everything [`validate::findings`] has against the case, with file, line and column.
    pub fn findings(&self) -> Vec<InputError> {
        validate::findings(&self.case).into_iter().map(|e| self.place(e)).collect()
    }
    /// The first of [`CaseFile::findings`] as an error.
    pub fn validate(&self) -> Result<()> {
        self.findings().into_iter().next().map_or(Ok(()), |e| Err(e.into()))
    }
    /// One sentence for each peak acceleration or specific weight whose unit, or that it has none, shows that it was hardly meant so:
    /// `pga = 0.3`. Beside the doubts that [`crate::run::prepare`] has of the values alone, which do not know
    /// whether there was a unit.
    pub fn unit_doubts(&self) -> Vec<Warning> {
        self.unit_doubts_with(&[])
    }
    /// The same of the wall that some changes make ([`CaseFile::changed`]); those that lead nowhere are passed over.
    pub fn unit_doubts_with(&self, changes: &[(String, serde_json::Value)]) -> Vec<Warning> {
        let key = |path: &str| plausible::WITH_UNITS.contains(&path.split(['.', '[']).next().unwrap_or(path));
        let changes: Vec<_> = changes.iter().filter(|(path, _)| key(path)).collect();
        // Walls given block by block are large: they are copied only to be changed.
        if changes.is_empty() {
            return plausible::by_units(&self.document.tree);
        }
        let mut tree = self.document.tree.part(&plausible::WITH_UNITS);
        for (path, value) in changes {
            // Where it leads nowhere, the wall says so.
            let _ = change::set(&mut tree, path, value);
        }
        plausible::by_units(&tree)
    }
    /// Line from 1 of what a doubt begins with the key of ([`plausible::doubts`]); none for other sentences.
    pub fn line_of(&self, doubt: &str) -> Option<usize> {
        let key = doubt
            .split(' ')
            .next()
            .map(|word| word.trim_end_matches(':'))
            .filter(|word| word.contains('.') && !word.ends_with('.'))?;
        super::describe(key)?;
        self.place(InputError::new("").key(key)).line
    }
}

/// Reads a wall file. The case is not validated yet ([`CaseFile::validate`]).
///
/// # Errors
/// [`Error::Input`] when the file cannot be read, is no UTF-8, no TOML or JSON, or its keys and values are not
/// those of the wall file.
pub fn read(path: &Path) -> Result<CaseFile> {
    resolve(Document::open(path, "a wall file").map_err(starter)?)
}

/// Reads a wall file from its text; `file` is named in errors and is what record paths are relative to.
///
/// # Errors
/// As [`read`].
pub fn from_str(text: &str, syntax: Syntax, file: Option<&Path>) -> Result<CaseFile> {
    resolve(Document::parse(text, syntax, file).map_err(starter)?)
}

/// Where to begin, said of an empty file.
fn starter(error: Error) -> Error {
    match error {
        Error::Input(e) if e.what == document::EMPTY => e.help("`concio new` writes a starter file").into(),
        other => other,
    }
}

/// The built-in wall: a dry brick panel of six courses under a heavy floor, shaken by a synthetic record.
///
/// # Errors
/// None in a released version: a test reads it.
pub fn example() -> Result<CaseFile> {
    from_str(include_str!("builtin.toml"), Syntax::Toml, None)
}

fn resolve(document: Document) -> Result<CaseFile> {
    let placed = |fault: Fault| document.source.place_fault(fault);
    // Only what a parameter set or preset fills in takes a tree of its own: walls given block by block are large.
    let mut tree = Cow::Borrowed(&document.tree);
    if let Some(node) = tree.get("set") {
        let set: ParameterSet = de::from_node(node).map_err(|mut fault| {
            fault.error.key = Some(fault.error.key.map_or("set".to_string(), |k| format!("set.{k}")));
            placed(fault)
        })?;
        if let Some(error) = validate::parameter_set(&set) {
            return Err(placed(Fault::new(error, node.at)));
        }
        sets::fill(tree.to_mut(), &set).map_err(placed)?;
    }
    preset(&mut tree).map_err(placed)?;
    follow(&mut tree);
    require(&tree).map_err(placed)?;
    let case = de::from_node(&tree).map_err(|fault| placed(described(fault, &tree)))?;
    Ok(CaseFile { case, document })
}

/// Adds to a missing key what belongs there, and to a number of courses under the key of their list the other key.
fn described(mut fault: Fault, tree: &Node) -> Fault {
    let e = &mut fault.error;
    if e.help.is_none() && e.what.starts_with("the number") && e.key.as_ref().is_some_and(|k| k.ends_with("].course")) {
        e.help = Some("did you mean `courses`?".into());
    }
    if e.what == de::UNKNOWN
        && let Some((device, _)) = e.key.as_deref().and_then(|key| key.rsplit_once('.'))
        && device.ends_with(".device")
        && let Some(law) = tree.below(device).and_then(|d| d.get("law")).and_then(Node::text)
        && let Some(law) = DeviceLaw::named(law)
    {
        e.allowed = Some(format!("`law`, and of law `{}` {}", law.name(), validate::device_keys(law)));
    }
    if e.allowed.as_deref() == Some(de::WHOLE)
        && let Some(range) = e.key.as_ref().and_then(|key| super::schema::whole(&super::schema(), key))
    {
        e.allowed = Some(range);
    }
    if e.allowed.as_deref() == Some(de::LIST)
        && let Some(words) = e.key.as_ref().and_then(|key| super::templates::choices(&format!("{key}[0]")))
    {
        e.allowed = Some(format!("{} of {}", de::LIST, de::list(&words)));
    }
    if e.what == de::MISSING && e.help.is_none() {
        e.help = e.key.as_deref().and_then(|key| misspelt(tree, key));
    }
    if e.what == de::MISSING
        && let Some(springs) = e.key.as_deref().and_then(|key| springs_of_starter(tree, key))
    {
        e.allowed = Some(format!("a law with its numbers, such as `{springs}`"));
        e.help.get_or_insert_with(|| where_joints_are(tree).into());
    }
    if e.what == de::MISSING && e.allowed.is_none() {
        let words = |key: &str| super::templates::choices(key).map(|words| de::list(&words));
        let told = |key: &str| super::describe(key).map(|text| text.trim_end_matches('.').to_string());
        // Inside of other tables a table mostly stands on the line of its key.
        let table = |key: &str| super::templates::table(key).filter(|_| !key.contains('.'));
        e.allowed = e.key.as_deref().and_then(|key| words(key).or_else(|| told(key)));
        if let (Some(allowed), Some(table)) = (&mut e.allowed, e.key.as_deref().and_then(table)) {
            *allowed = format!("a table `{table}`: {allowed}");
        }
    }
    fault
}

/// Asks whether a key beside the missing one, unknown itself, is that key with a typing error.
fn misspelt(tree: &Node, missing: &str) -> Option<String> {
    let name = missing.rsplit_once('.').map_or(missing, |(_, name)| name);
    entry_like(tree, missing).map(|near| format!("is `{}` meant to be `{name}`?", near.key))
}

/// The entry of such a key.
fn entry_like<'t>(tree: &'t Node, missing: &str) -> Option<&'t Entry> {
    let (above, name) = missing.rsplit_once('.').map_or(("", missing), |(above, name)| (above, name));
    let table = tree.below(above)?;
    let Value::Table(entries) = &table.value else { return None };
    let path = |key: &str| if above.is_empty() { key.to_string() } else { format!("{above}.{key}") };
    let unknown = entries.iter().map(|e| e.key.as_str()).filter(|k| super::describe(&path(k)).is_none());
    let near = de::suggestion(name, unknown)?;
    entries.iter().find(|e| e.key == near)
}

/// Writes out what `friction.preset` stands for.
fn preset(tree: &mut Cow<Node>) -> std::result::Result<(), Fault> {
    let given = tree.get("joint").and_then(|j| j.get("friction")).and_then(|f| f.get("preset"));
    if given.and_then(Node::text) != Some("report") {
        return Ok(());
    }
    let Some(friction) = tree.to_mut().get_mut("joint").and_then(|j| j.get_mut("friction")) else { return Ok(()) };
    for (key, word) in [("on", "all"), ("normal_force", "overburden")] {
        friction.fill(key, Value::Text(word.to_string()));
        let Some(given) = friction.get(key) else { continue };
        if let Some(other) = given.text()
            && other != word
        {
            let error = InputError::new(format!("`{other}` contradicts `preset = \"report\"`"));
            let error = error.key(format!("joint.friction.{key}")).allowed(format!("`{word}`, or no preset"));
            return Err(Fault::new(error, given.at));
        }
    }
    Ok(())
}

/// Coulomb's own law has one coefficient: writes out the other, where a file gives it nowhere.
fn follow(tree: &mut Cow<Node>) {
    let Some(joint) = tree.get("joint") else { return };
    let lacks = |table: &Node| table.get("friction").is_some_and(|f| f.has("static") && !f.has("dynamic"));
    let changes = match joint.get("change").map(|node| &node.value) {
        Some(Value::List(changes)) => changes.as_slice(),
        _ => &[],
    };
    if !lacks(joint) && !changes.iter().any(lacks) {
        return;
    }
    let Some(joint) = tree.to_mut().get_mut("joint") else { return };
    let law = |friction: &Node| friction.get("law").and_then(Node::text).map(str::to_string);
    let common = joint.get("friction");
    let (usual, given) = (common.and_then(law), common.is_some_and(|f| f.has("dynamic")));
    let fill = |friction: &mut Node, usual: Option<&str>| {
        let of = law(friction);
        if of.as_deref().or(usual) == Some("coulomb")
            && let Some(value) = friction.get("static").map(|node| node.value.clone())
        {
            friction.fill("dynamic", value);
        }
    };
    if let Some(friction) = joint.get_mut("friction") {
        fill(friction, None);
    }
    // Where one is given, keys that a change does not give stay as they are: it may be of the same joints.
    let mut given = given;
    if let Some(Value::List(changes)) = joint.get_mut("change").map(|node| &mut node.value) {
        for friction in changes.iter_mut().filter_map(|change| change.get_mut("friction")) {
            given |= friction.has("dynamic");
            if !given {
                fill(friction, usual.as_deref());
            }
        }
    }
}

/// Keys that a law needs. Left to their defaults, a stiffness or a friction coefficient would silently be 0.
fn require(tree: &Node) -> std::result::Result<(), Fault> {
    let Some(joint) = tree.get("joint") else { return missing_joint(tree) };
    for kind in ["bed", "head", "base", "top", "connection"] {
        let Some(spring) = joint.get(kind) else { continue };
        let law = spring.get("law").and_then(Node::text).unwrap_or_default();
        if ["elastic", "no-tension"].contains(&law) && !spring.has("stiffness") {
            let error = InputError::new(format!("the key is missing: law `{law}` needs it"));
            let mut error = error.key(format!("joint.{kind}.stiffness")).allowed("from 0 N/m");
            error.help = misspelt(tree, &format!("joint.{kind}.stiffness"));
            return Err(Fault::new(error, spring.at));
        }
    }
    let Some(friction) = joint.get("friction") else { return Ok(()) };
    let law = friction.get("law").and_then(Node::text).unwrap_or_default();
    if ["stribeck", "stribeck-stick", "coulomb"].contains(&law) {
        for key in ["static", "dynamic"] {
            if !friction.has(key) && (key, law) != ("dynamic", "coulomb") {
                let error = InputError::new(format!("the key is missing: law `{law}` needs it"));
                let mut error = error.key(format!("joint.friction.{key}")).allowed("from 0");
                error.help = misspelt(tree, &format!("joint.friction.{key}"));
                return Err(Fault::new(error, friction.at));
            }
        }
    }
    Ok(())
}

fn model_of(tree: &Node) -> ModelKind {
    match tree.get("model").and_then(Node::text) {
        Some("planar") => ModelKind::Planar,
        Some("rocking") => ModelKind::Rocking,
        _ => ModelKind::Shear,
    }
}

/// What the starter file of this model has at `joint.bed` or `joint.head`; none for other keys.
fn springs_of_starter(tree: &Node, key: &str) -> Option<&'static str> {
    let kind = key.strip_prefix("joint.").filter(|kind| ["bed", "head"].contains(kind))?;
    let line = super::starter(model_of(tree)).lines().find(|line| line.starts_with(&format!("{kind} = ")))?;
    line.find('}').map(|end| &line[..=end])
}

/// Sets are of the shear model's mortar.
fn where_joints_are(tree: &Node) -> &'static str {
    match model_of(tree) {
        ModelKind::Planar => "`concio new --model planar` writes a file with all that joints need",
        ModelKind::Rocking => "`concio new --model rocking` writes a file with all that joints need",
        ModelKind::Shear => "a parameter set such as `set = \"report\"` has all that joints need",
    }
}

/// Says where the joints may come from, which serde's own message cannot know.
fn missing_joint(tree: &Node) -> std::result::Result<(), Fault> {
    match tree.value {
        Value::Table(_) if tree.has("panel") => {
            let error = InputError::new("the key is missing").key("joint");
            let error = error.allowed("a table `[joint]` with the laws of bed and head joints");
            let help = misspelt(tree, "joint").unwrap_or_else(|| where_joints_are(tree).into());
            Err(Fault::new(error.help(help), entry_like(tree, "joint").map_or(tree.at, |near| near.at)))
        }
        _ => Ok(()),
    }
}

/// The case as JSON in a fixed order of keys: what the hash of a run's inputs is taken of. Reads back
/// ([`from_str`]) as an equal case.
///
/// # Panics
/// Never: serialisation fails only on maps without text keys and on values that refuse it; a case has neither.
pub fn canonical_json(case: &Case) -> String {
    serde_json::to_string(case).expect("a case has only tables with text keys, and no value refuses serialisation")
}
