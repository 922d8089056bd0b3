//! Other values in a wall file, by key path: what a study varies.

use serde_json::Value as Json;

use super::node::{Entry, Fault, Node, Value};
use crate::InputError;

/// Most steps of a key path: wall files are nested less deeply, and every step is a level of the tree.
const MOST_STEPS: usize = 64;

/// A step of a key path.
enum Step<'a> {
    Key(&'a str),
    Index(usize),
    All,
}

/// Puts `value` where `path` leads; tables on the way are made.
pub(super) fn set(tree: &mut Node, path: &str, value: &Json) -> Result<(), Fault> {
    let steps = steps(path).map_err(|error| Fault::new(error.key(path), tree.at))?;
    put(tree, &steps, value).map_err(|(what, at)| {
        let allowed = "a key path of the wall file, such as `joint.friction.static` or `panel[0].courses`";
        Fault::new(InputError::new(what).key(path).allowed(allowed), at)
    })
}

fn steps(path: &str) -> Result<Vec<Step<'_>>, InputError> {
    let wrong = || {
        let error = InputError::new("is not a key path");
        error.allowed("keys with points between them, places in lists in brackets: `panel[0].brick.length`")
    };
    let mut steps = Vec::new();
    for part in path.split('.') {
        let (key, mut rest) = part.split_at(part.find('[').unwrap_or(part.len()));
        if key.is_empty() || !key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-') {
            return Err(wrong());
        }
        steps.push(Step::Key(key));
        while let Some((index, after)) = rest.strip_prefix('[').and_then(|r| r.split_once(']')) {
            steps.push(if index == "*" { Step::All } else { Step::Index(index.parse().map_err(|_| wrong())?) });
            rest = after;
        }
        if !rest.is_empty() {
            return Err(wrong());
        }
        if steps.len() > MOST_STEPS {
            return Err(InputError::new("leads too deep").allowed(format!("a key path of up to {MOST_STEPS} steps")));
        }
    }
    Ok(steps)
}

/// What is wrong, and where.
type Wrong = (String, usize);

fn put(node: &mut Node, steps: &[Step<'_>], value: &Json) -> Result<(), Wrong> {
    let at = node.at;
    let Some((step, rest)) = steps.split_first() else {
        *node = of_json(value, at);
        return Ok(());
    };
    match (step, &mut node.value) {
        (Step::Key(key), Value::Table(entries)) => {
            let place = match entries.iter().position(|e| e.key == *key) {
                Some(place) => place,
                None => {
                    let node = Node { at, value: Value::Table(Vec::new()) };
                    entries.push(Entry { key: key.to_string(), at, node });
                    entries.len() - 1
                }
            };
            put(&mut entries[place].node, rest, value)
        }
        // A word that stands for a table, such as `beam = "free"`, gives way to the table.
        (Step::Key(_), Value::Text(_)) => {
            node.value = Value::Table(Vec::new());
            put(node, steps, value)
        }
        (Step::Key(key), _) => Err((format!("there is no `{key}`: what stands before it is no table"), at)),
        (Step::Index(index), Value::List(items)) => {
            let most = items.len();
            let item = items.get_mut(*index);
            let item = item.ok_or_else(|| (format!("the list has {most} elements, from 0, and no [{index}]"), at))?;
            put(item, rest, value)
        }
        (Step::All, Value::List(items)) => items.iter_mut().try_for_each(|item| put(item, rest, value)),
        (Step::Index(_) | Step::All, Value::Table(entries)) if entries.is_empty() => {
            Err(("there is no such list in the wall file".into(), at))
        }
        (Step::Index(_) | Step::All, _) => Err(("brackets stand behind a list, and this is none".into(), at)),
    }
}

/// A value without its place.
pub(super) fn to_json(node: &Node) -> Json {
    match &node.value {
        Value::Null => Json::Null,
        Value::Bool(b) => Json::Bool(*b),
        Value::Int(whole) => match (i64::try_from(*whole), u64::try_from(*whole)) {
            (Ok(whole), _) => whole.into(),
            (_, Ok(whole)) => whole.into(),
            // No key takes as much.
            _ => (*whole as f64).into(),
        },
        Value::Float(number) => (*number).into(),
        Value::Text(text) | Value::Date(text) => text.as_str().into(),
        Value::List(items) => items.iter().map(to_json).collect(),
        Value::Table(entries) => entries.iter().map(|e| (e.key.clone(), to_json(&e.node))).collect(),
    }
}

/// A value that stands at `at`.
fn of_json(value: &Json, at: usize) -> Node {
    let value = match value {
        Json::Null => Value::Null,
        Json::Bool(b) => Value::Bool(*b),
        Json::Number(n) => match n.as_i128() {
            Some(whole) => Value::Int(whole),
            None => Value::Float(n.as_f64().unwrap_or(f64::NAN)),
        },
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(items) => Value::List(items.iter().map(|item| of_json(item, at)).collect()),
        Json::Object(entries) => {
            let entry = |(key, value): (&String, &Json)| Entry { key: key.clone(), at, node: of_json(value, at) };
            Value::Table(entries.iter().map(entry).collect())
        }
    };
    Node { at, value }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::case::{Syntax, from_str};

    const WALL: &str = "
model = \"shear\"
set = \"report\"
[[panel]]
bond = \"running\"
courses = 6
bricks = 4
[[panel]]
bond = \"running\"
courses = 6
bricks = 3
[load]
beam = \"free\"
[motion]
duration = 1
base = { sine = { acceleration = \"0.3 g\", frequency = 3 } }
";

    fn changed(path: &str, value: serde_json::Value) -> crate::Result<crate::case::CaseFile> {
        from_str(WALL, Syntax::Toml, None)?.changed(&[(path.to_string(), value)])
    }

    #[test]
    fn values_given_made_and_of_every_element() -> crate::Result<()> {
        assert_eq!(changed("panel[1].bricks", json!(9))?.case.panels[1].bricks, Some(9));
        let all = changed("panel[*].courses", json!(3))?;
        assert!(all.case.panels.iter().all(|p| p.courses == Some(3)));
        // Not in the file: the parameter set no longer fills it in, but still fills in the rest of its table.
        let friction = changed("joint.friction.static", json!(0.8))?.case.joint.friction;
        assert_eq!((friction.static_, friction.beta), (0.8, 100.0));
        assert!(
            matches!(changed("load.beam.mass", json!("2 t"))?.case.load.beam, crate::case::Beam::Mass(m) if m.si() == 2000.0)
        );
        assert_eq!(changed("set", json!("p1"))?.case.set.map(|s| s.name), Some(crate::case::SetName::P1));
        Ok(())
    }

    #[test]
    fn what_is_given_is_the_same_wall_again_and_leaves_out_the_rest() -> crate::Result<()> {
        let changed = changed("joint.friction.static", json!(0.8))?;
        let given = changed.given();
        assert_eq!(given["joint"], json!({ "friction": { "static": 0.8 } }));
        assert_eq!(given["panel"][1], json!({ "bond": "running", "courses": 6, "bricks": 3 }));
        assert_eq!(from_str(&given.to_string(), Syntax::Json, None)?.case, changed.case);
        Ok(())
    }

    #[test]
    fn paths_that_lead_nowhere() {
        for (path, says) in [
            ("panel[2].bricks", "2 elements"),
            ("panel.bricks", "no table"),
            ("joint.change[0].friction.static", "no such list"),
            ("joint.frction.static", "unknown key"),
            ("panel[x].bricks", "is not a key path"),
            ("", "is not a key path"),
            ("motion..base", "is not a key path"),
            ("motion.duration[0]", "this is none"),
            (&vec!["a"; 55_000].join("."), "up to 64 steps"),
            (&format!("a{}", "[0]".repeat(55_000)), "up to 64 steps"),
        ] {
            match changed(path, json!(1)) {
                Err(e) => assert!(e.to_string().contains(says), "{path}: {e}"),
                Ok(_) => panic!("{path} was taken"),
            }
        }
    }
}
