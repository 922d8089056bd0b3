//! Wall and study files that went wrong: examples of the project, spoilt by a generator with a seed.

use std::fs;
use std::path::{Path, PathBuf};

use concio::dice::Dice;

/// What stands in the place of a value.
const VALUES: [&str; 30] = [
    "0",
    "1",
    "-1",
    "2.5",
    "1e18",
    "-1e18",
    "1e-18",
    "1e300",
    "1e-300",
    "nan",
    "inf",
    "-inf",
    "1000000",
    "100000",
    "4294967296",
    "9223372036854775807",
    "170141183460469231731687303715884105727",
    "true",
    "\"\"",
    "\"x\"",
    "\"1e99 m\"",
    "\"-5 mm\"",
    "\"0 s\"",
    "\"1e-15 s\"",
    "\"1e9 s\"",
    "[]",
    "[[1, 2], [3]]",
    "{}",
    "{ a = 1 }",
    "1979-05-27",
];

/// How many of them are numbers.
const NUMBERS: usize = 17;

/// Files of a folder of examples, in the order of their names; paths in them lead where they did.
pub fn examples(folder: &str) -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(folder);
    let mut paths: Vec<PathBuf> = fs::read_dir(&folder).expect("examples").map(|e| e.expect("a file").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    let rooted = |text: String| {
        let root =
            |key: &str, text: &str| text.replace(&format!("{key} = \""), &format!("{key} = \"{}/", folder.display()));
        root("record", &root("wall", &text))
    };
    paths.iter().map(|path| rooted(fs::read_to_string(path).expect("an example"))).collect()
}

/// One to three things that may happen to a file.
pub fn mutant(text: &str, dice: &mut Dice) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=dice.below(3) {
        bytes = match String::from_utf8(bytes) {
            Ok(text) => changed(&text, dice),
            Err(broken) => broken.into_bytes(),
        };
    }
    bytes
}

fn changed(text: &str, dice: &mut Dice) -> Vec<u8> {
    let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
    // Of comments nothing comes.
    let said: Vec<usize> =
        (0..lines.len()).filter(|&i| !lines[i].trim().is_empty() && !lines[i].starts_with('#')).collect();
    if said.is_empty() {
        return text.into();
    }
    let [a, b] = [(); 2].map(|()| said[dice.below(said.len())]);
    match dice.below(16) {
        0 => drop(lines.remove(a)),
        1 => lines.insert(b, lines[a].clone()),
        2 => lines.swap(a, b),
        3 => {
            let many = vec![lines[a].clone(); dice.below(2000)];
            lines.splice(a..a, many);
        }
        4 => {
            if let [Some((key, _)), Some((_, value))] = [a, b].map(|i| lines[i].split_once('=')) {
                lines[a] = format!("{key}={value}");
            }
        }
        5 => {
            if let Some((key, _)) = lines[a].split_once('=') {
                lines[a] = format!("{key}= {}", VALUES[dice.below(VALUES.len())]);
            }
        }
        6 => {
            let mut bytes = text.as_bytes().to_vec();
            let at = dice.below(bytes.len());
            bytes[at] ^= 1 << dice.below(8);
            return bytes;
        }
        7 => return text.as_bytes()[..dice.below(text.len())].to_vec(),
        _ => lines[a] = with_another_number(&lines[a], dice),
    }
    (lines.join("\n") + "\n").into_bytes()
}

/// One of the numbers in a line becomes another, its unit stays.
fn with_another_number(line: &str, dice: &mut Dice) -> String {
    let mut numbers: Vec<std::ops::Range<usize>> = Vec::new();
    for (i, c) in line.char_indices().filter(|(_, c)| c.is_ascii_digit() || *c == '.') {
        match numbers.last_mut() {
            Some(last) if last.end == i => last.end = i + c.len_utf8(),
            _ => numbers.push(i..i + c.len_utf8()),
        }
    }
    match numbers.get(dice.below(numbers.len())) {
        Some(place) => {
            let number = line[place.clone()].parse::<f64>().unwrap_or(1.0);
            let another = match dice.below(3) {
                // Some that a wall may have.
                0 => (number * [0.1, 0.5, 2.0, 10.0][dice.below(4)]).to_string(),
                1 => (1 + dice.below(3000)).to_string(),
                _ => VALUES[dice.below(NUMBERS)].to_string(),
            };
            format!("{}{another}{}", &line[..place.start], &line[place.end..])
        }
        None => line.into(),
    }
}
