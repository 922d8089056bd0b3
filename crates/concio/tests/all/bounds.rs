//! Every bound that the schema of the wall file documents is the one that its error names.

use concio::case::{Syntax, from_str, schema};
use concio::{Error, InputError};
use serde_json::Value;

/// Walls that have most of the tables between them.
const WALLS: [&str; 3] = [
    r#"
model = "shear"
[[panel]]
bond = "running"
courses = 6
bricks = 6
brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }
mortar = { bed = 0.01, head = 0.01 }
opening = [{ x = "2 bricks", y = 0, width = "2 bricks", height = "2 courses", lintel = { height = "1 course", bearing = 0.1 } }]
[joint]
damping_ratio = 0.05
bed = { law = "elastic", stiffness = 5.4e7 }
head = { law = "no-tension", stiffness = 5.4e7, rigidity = 1000 }
base = { law = "elastic", stiffness = 5.4e7 }
top = { law = "elastic", stiffness = 5.4e7 }
connection = { law = "rigid", stiffness = 5.4e7, restitution = 0.5 }
friction = { law = "stribeck", static = 0.6, dynamic = 0.42, slip_velocity = 0.001 }
bond = { tensile_strength = 1e5, cohesion = 1e5 }
[[joint.change]]
at = { kind = ["bed"] }
spring = { stiffness = 1e7 }
friction = { static = 0.7, dynamic = 0.5 }
bond = { cohesion = 2e5 }
[load]
top = 1e4
beam = { mass = 1e3 }
[motion]
duration = 1
base = { record = "a.at2", baseline = { high_pass = 0.1, order = 4 } }
[solver]
tolerance = 1e-2
[output]
interval = 0.01
"#,
    r#"
model = "planar"
[[panel]]
bond = "irregular"
courses = 3
random = { seed = 1, width = 2, length = [0.2, 0.25], height = [0.05, 0.06], stagger = 0 }
brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }
[[panel]]
bond = "irregular"
course = [{ height = 0.1, bricks = [0.25, 0.25] }]
brick = { length = 0.25, height = 0.1, thickness = 0.12, specific_weight = 18e3 }
[[tie]]
from = "base"
to = "p1c1b1"
stiffness = 1e6
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.6 }
[[joint.change]]
at = { kind = ["bed"] }
device = { law = "viscous", damping = 1e3 }
[load]
beam = "driven"
[motion]
duration = 1
stop_at = { collapse = 1 }
base = { sine = { amplitude = 0.001, frequency = 2 } }
top = { path = { displacements = [0.01], speed = 0.001 } }
[solver]
step = 0.001
"#,
    r#"
model = "planar"
[[panel]]
bond = "arch"
arch = { span = 2, rise = 1, thickness = 0.3, voussoirs = 9 }
brick = { length = 0.25, height = 0.055, thickness = 0.12, specific_weight = 18e3 }
[joint]
bed = { law = "rigid" }
head = { law = "rigid" }
friction = { law = "coulomb", static = 0.6 }
[out_of_plane]
strength = 2e6
leaves = [0.06, 0.06]
[[out_of_plane.floor]]
z = 1
load = 1e4
[[out_of_plane.anchor]]
z = 1
yield_force = 1e4
[[out_of_plane.side_wall]]
x = 0.1
thickness = 0.3
corner = { load = 1e3 }
[out_of_plane.gable]
height = 1
[out_of_plane.strip]
from = 0.5
thrust = 1e4
[out_of_plane.site]
damage = { ground_acceleration = 1, amplification = 2.4, corner_period = 0.3 }
life_safety = { periods = [0, 1], accelerations = [1, 2] }
collapse = { ground_acceleration = 2, soil_factor = 1.2, amplification = 2.4, corner_period = 0.3 }
[out_of_plane.building]
height = 6
storeys = 2
[[out_of_plane.floor_spectrum]]
z = 3
periods = [0, 1]
accelerations = [1, 2]
[motion]
duration = 1
base = { synthetic = { seed = 1, pga = 1, duration = 5 } }
vertical = { pulse = { shape = "ricker", acceleration = 1, duration = 0.3 } }
"#,
];

/// A bound as the documentation words it, and a number that breaks it.
#[derive(Debug, Clone, PartialEq)]
struct Bound {
    words: String,
    beyond: f64,
}

/// The first bound of a description.
fn bound(about: &str) -> Option<Bound> {
    let words: Vec<&str> = about.split_whitespace().collect();
    let number = |word: &str| {
        let plain = word.trim_end_matches(['.', ',', ';', ':']).replace(',', "");
        plain.parse::<f64>().ok().map(|v| (v, word.trim_end_matches(['.', ',', ';', ':']).to_string()))
    };
    words.windows(3).find_map(|w| match (w[0].to_lowercase().as_str(), w[1]) {
        ("above", _) => number(w[1]).map(|(v, text)| Bound { words: format!("above {text}"), beyond: v }),
        ("from", _) => number(w[1]).map(|(v, text)| Bound { words: format!("from {text}"), beyond: v - 1.0 }),
        (_, "…") => {
            let ((_, low), (high, top)) = (number(w[0])?, number(w[2])?);
            Some(Bound { words: format!("{low} … {top}"), beyond: high + 1.0 })
        }
        _ => None,
    })
}

fn referred<'a>(root: &'a Value, at: &'a Value) -> &'a Value {
    match at.get("$ref").and_then(Value::as_str).and_then(|name| name.strip_prefix("#/$defs/")) {
        Some(name) => &root["$defs"][name],
        None => at,
    }
}

/// Keys of numbers and quantities, with what is said of them.
fn keys(root: &Value, at: &Value, path: &str, found: &mut Vec<(String, String)>) {
    let about = at.get("description").and_then(Value::as_str).unwrap_or_default().to_string();
    let of = referred(root, at);
    for option in of.get("anyOf").and_then(Value::as_array).into_iter().flatten() {
        if option.get("type").is_some_and(|t| t == "number") {
            found.push((path.into(), about.clone()));
        } else {
            let option = referred(root, option);
            let number = |o: &Value| o.get("type").is_some_and(|t| t == "number");
            let quantity = option.get("anyOf").and_then(Value::as_array).is_some_and(|o| o.iter().any(number));
            if quantity {
                found.push((path.into(), about.clone()));
            } else {
                properties(root, option, path, found);
            }
        }
    }
    if of.get("type").is_some_and(|t| t == "integer" || t == "number") {
        found.push((path.into(), about));
    }
    properties(root, of, path, found);
    if let Some(items) = of.get("items") {
        keys(root, items, &format!("{path}[0]"), found);
    }
}

fn properties(root: &Value, of: &Value, path: &str, found: &mut Vec<(String, String)>) {
    for (name, below) in of.get("properties").and_then(Value::as_object).into_iter().flatten() {
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        keys(root, below, &path, found);
    }
}

/// What is said against a value at a key of a wall.
fn said(wall: &str, key: &str, value: f64) -> Option<Vec<InputError>> {
    let file = from_str(wall, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
    let value = if value.fract() == 0.0 { Value::from(value as i64) } else { Value::from(value) };
    match file.changed(&[(key.to_string(), value)]) {
        Ok(changed) => Some(changed.findings()),
        Err(Error::Input(error)) => Some(vec![*error]),
        Err(_) => None,
    }
}

#[test]
fn every_documented_bound_is_that_of_its_error() {
    for wall in WALLS {
        let file = from_str(wall, Syntax::Toml, None).unwrap_or_else(|e| panic!("{e}"));
        assert!(file.findings().is_empty(), "{:?}", file.findings());
    }
    let schema = schema();
    let mut all = Vec::new();
    keys(&schema, &schema, "", &mut all);
    all.sort();
    all.dedup();
    let (mut held, mut wrong) = (Vec::new(), Vec::new());
    for (key, about) in &all {
        let Some(bound) = bound(about) else { continue };
        // A key that a wall has no table for, or that does not go with its other keys, is refused for that.
        let of_key = WALLS.iter().find_map(|wall| {
            let error = said(wall, key, bound.beyond)?.into_iter().find(|e| e.key.as_deref() == Some(key))?;
            (error.what.contains("out of range") || error.what.contains("cannot stand here")).then_some(error)
        });
        let Some(error) = of_key else { continue };
        let allowed = error.allowed.clone().unwrap_or_default();
        if allowed.contains(&bound.words) {
            held.push(key)
        } else {
            wrong.push(format!("{key}: `{}` is documented, and `{error}` said", bound.words))
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(held.len() >= 60, "only {} of {} keys: {held:?}", held.len(), all.len());
}

/// The least whole number that is said to be allowed is allowed, as far as the key alone goes.
#[test]
fn whole_numbers_start_where_it_is_said() {
    let schema = schema();
    let mut all = Vec::new();
    keys(&schema, &schema, "", &mut all);
    let mut compared = 0;
    for (key, _) in &all {
        for wall in WALLS {
            let Some(error) =
                said(wall, key, -1.0).and_then(|e| e.into_iter().find(|e| e.key.as_deref() == Some(key.as_str())))
            else {
                continue;
            };
            let allowed = error.allowed.clone().unwrap_or_default();
            let Some(rest) = allowed.strip_prefix("a whole number") else { continue };
            let least: String =
                rest.chars().skip_while(|c| !c.is_ascii_digit()).take_while(char::is_ascii_digit).collect();
            let least: f64 = least.parse().unwrap_or_else(|_| panic!("{error}"));
            let out = |value: f64| {
                let said = said(wall, key, value).unwrap_or_default();
                said.iter().any(|e| e.key.as_deref() == Some(key.as_str()) && e.what.contains("out of range"))
            };
            assert!(!out(least), "{key}: {least} is refused, and `{error}` said");
            compared += 1;
        }
    }
    assert!(compared >= 6, "{compared}");
}
