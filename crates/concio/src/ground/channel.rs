//! Which component of a file is meant: by its number, by its name, or the first horizontal one.

use crate::InputError;
use crate::case::RecordChannel;
use crate::ground::record::Record;

/// Most components that a message names.
const MOST_NAMED: usize = 12;

/// The place, from 0, of the component that `channel` names. Without it: of the first horizontal one, at the surface where the file has
/// a borehole too; of the first one where none is horizontal.
///
/// # Errors
/// [`InputError`] at the key `channel`, with the components that there are.
pub fn choose(records: &[Record], channel: Option<&RecordChannel>) -> Result<usize, InputError> {
    let Some(channel) = channel else {
        let place = |is: &dyn Fn(&str) -> bool| records.iter().position(|record| is(&record.channel));
        let surface = place(&|label| !is_vertical(label) && !is_deep(label));
        return Ok(surface.or_else(|| place(&|label| !is_vertical(label))).unwrap_or(0));
    };
    let number = match channel {
        RecordChannel::Number(number) => Some(*number),
        RecordChannel::Name(name) => name.trim().parse().ok().filter(|number| (1..=records.len()).contains(number)),
    };
    let found: Vec<usize> = match (number, channel) {
        (Some(number), _) => number.checked_sub(1).filter(|place| *place < records.len()).into_iter().collect(),
        (None, RecordChannel::Name(name)) => named(records, name),
        (None, RecordChannel::Number(_)) => Vec::new(),
    };
    match found[..] {
        [place] => Ok(place),
        [] => Err(InputError::new(format!("the file has no channel {channel}")).key("channel").allowed(names(records))),
        _ => {
            let error = InputError::new(format!("{} channels of the file bear the name {channel}", found.len()));
            Err(error.key("channel").allowed(names(records)).help("take the number"))
        }
    }
}

/// The components of a file, for messages: 1 `N-S`, 2 `E-W`, 3 `U-D`.
pub fn names(records: &[Record]) -> String {
    let name = |(place, record): (usize, &Record)| match record.channel.as_str() {
        "" => (place + 1).to_string(),
        label => format!("{} `{label}`", place + 1),
    };
    match records {
        [one] if one.channel.is_empty() => "1, the only one".into(),
        [one] => format!("1, the only one, `{}`", one.channel),
        few if few.len() <= MOST_NAMED => few.iter().enumerate().map(name).collect::<Vec<_>>().join(", "),
        many => {
            let first: Vec<String> = many.iter().enumerate().take(MOST_NAMED).map(name).collect();
            format!("{}, … {}", first.join(", "), many.len())
        }
    }
}

/// Whether a component is a vertical one by its name: `Up`, `U-D`, `V`, `HNZ`. What stands in brackets is about something else.
pub fn is_vertical(label: &str) -> bool {
    const WORDS: [&str; 14] =
        ["up", "down", "dn", "ud", "u-d", "up-down", "updown", "vert", "vertical", "vrt", "z", "az", "uz", "up-dn"];
    let head = label.split(['(', '[']).next().unwrap_or("");
    let mut words = head.split(|c: char| !c.is_alphanumeric() && c != '-').filter(|word| !word.is_empty());
    words.any(|word| {
        let lower = word.to_lowercase();
        // In lower case these letters are a displacement and a velocity.
        ["U", "V"].contains(&word)
            || WORDS.contains(&lower.as_str())
            || is_seed_vertical(word)
            || is_numbered_vertical(&lower)
    })
}

/// A code of three letters for band, instrument and direction: `HNZ`.
fn is_seed_vertical(word: &str) -> bool {
    let code = word.as_bytes();
    code.len() == 3 && code.iter().all(u8::is_ascii_uppercase) && b"HLNG".contains(&code[1]) && code[2] == b'Z'
}

/// `UD1` and `UD2` of KiK-net.
fn is_numbered_vertical(lower: &str) -> bool {
    lower.strip_prefix("ud").is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit()))
}

fn is_deep(label: &str) -> bool {
    label.contains("(borehole)")
}

/// The components that a name fits: the whole label, else words of it that follow each other.
fn named(records: &[Record], name: &str) -> Vec<usize> {
    let wanted = words(name);
    let whole = |label: &str| words(label).concat() == wanted.concat();
    let part = |label: &str| !wanted.is_empty() && words(label).windows(wanted.len()).any(|some| some == wanted);
    let fitting = |fits: &dyn Fn(&str) -> bool| -> Vec<usize> {
        (0..records.len()).filter(|place| fits(&records[*place].channel)).collect()
    };
    match fitting(&whole) {
        none if none.is_empty() => fitting(&part),
        found => found,
    }
}

/// Words in lower case, without marks inside of them: `N-S` is `ns`.
fn words(text: &str) -> Vec<String> {
    let parts = text.split(|c: char| c.is_whitespace() || ",;:()[]".contains(c));
    let plain =
        |word: &str| word.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect::<String>();
    parts.map(plain).filter(|word| !word.is_empty()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::Format;

    fn records(labels: &[&str]) -> Vec<Record> {
        let record = |label: &&str| Record {
            format: Format::Text,
            dt: 0.01,
            acceleration: vec![0.0; 2],
            displacement: None,
            units: String::new(),
            station: String::new(),
            event: String::new(),
            channel: (*label).into(),
            remarks: Vec::new(),
        };
        labels.iter().map(record).collect()
    }

    #[test]
    fn vertical_components_are_told_by_their_names() {
        for label in [
            "Up    Vertical Accelerometer Axis",
            "CHAN 2: UP",
            "U-D",
            "U",
            "C1 V",
            "HNZ",
            "UD2 (surface)",
            "2: Up (Rcrdr Chan 2)",
            "acc_z",
        ] {
            assert!(is_vertical(label), "{label}");
        }
        for label in
            ["N-S", "CHAN 1: 90 DEG", "u", "v", "HNE", "1: 360 deg (Location: up the hill)", "", "C2 N00E", "NS1"]
        {
            assert!(!is_vertical(label), "{label}");
        }
    }

    #[test]
    fn the_first_horizontal_one_is_taken() {
        let first = |labels: &[&str]| choose(&records(labels), None);
        assert_eq!(first(&["U", "N", "E"]), Ok(1));
        assert_eq!(first(&["", ""]), Ok(0));
        assert_eq!(first(&["HNZ"]), Ok(0));
        assert_eq!(first(&["NS1 (borehole)", "UD1 (borehole)", "UD2 (surface)", "NS2 (surface)"]), Ok(3));
        assert_eq!(first(&["UD1 (borehole)", "NS1 (borehole)"]), Ok(1));
    }

    #[test]
    fn components_are_found_by_number_and_by_words_of_their_names() {
        let file = records(&["1: 360 deg (Rcrdr Chan 1)", "2: Up (Rcrdr Chan 2)", "3: 90 deg (Rcrdr Chan 3)"]);
        let at = |channel: RecordChannel| choose(&file, Some(&channel));
        let name = |name: &str| at(RecordChannel::Name(name.into()));
        assert_eq!(at(RecordChannel::Number(3)), Ok(2));
        assert_eq!((name("up"), name("2"), name("360"), name("90 deg")), (Ok(1), Ok(1), Ok(0), Ok(2)));
        let ambiguous = name("deg").expect_err("two bear it");
        assert!(ambiguous.what.contains("2 channels") && ambiguous.help.is_some(), "{ambiguous}");
        for missing in [at(RecordChannel::Number(4)), at(RecordChannel::Number(0)), name("N-S"), name("-"), name("4")] {
            let error = missing.expect_err("there is none");
            assert!(error.what.contains("no channel") && error.key.as_deref() == Some("channel"), "{error}");
            assert!(error.allowed.is_some_and(|allowed| allowed.contains("2 `2: Up (Rcrdr Chan 2)`")));
        }
        let marks = records(&["N-S", "E-W"]);
        assert_eq!(choose(&marks, Some(&RecordChannel::Name("ew".into()))), Ok(1));
        assert_eq!(choose(&marks, Some(&RecordChannel::Name("E-W".into()))), Ok(1));
    }
}
