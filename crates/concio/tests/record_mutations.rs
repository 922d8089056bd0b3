//! Damaged record files, made by a seeded generator over all formats: each is read or refused with its place, without a panic and within
//! bounds of memory. Alone in its program, because it counts what the whole program asks for.

use std::path::Path;

use concio::ground::MOST_SAMPLES;
use concio::ground::formats::parse;
use concio::ground::record::{INTERVAL_RANGE, TextOptions};
use peak_alloc::PeakAlloc;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Most that is asked for while a file of some 30 kB is read [bytes].
const MOST: usize = 64 << 20;

/// Names and texts of the small files of all formats, in their order.
fn files() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/records");
    let read = |entry: std::io::Result<std::fs::DirEntry>| {
        let entry = entry.unwrap();
        (entry.file_name().into_string().unwrap(), std::fs::read_to_string(entry.path()).unwrap())
    };
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(read).collect();
    files.retain(|(name, _)| !name.starts_with('.'));
    files.sort();
    files
}

struct Dice(ChaCha8Rng);

impl Dice {
    fn below(&mut self, bound: usize) -> usize {
        (self.0.next_u64() % bound.max(1) as u64) as usize
    }
}

/// One kind of damage.
fn damaged(text: &str, kind: usize, dice: &mut Dice) -> Vec<u8> {
    let mut lines: Vec<String> = text.split_inclusive('\n').map(str::to_owned).collect();
    let line = dice.below(lines.len());
    let joined = |lines: Vec<String>| lines.concat().into_bytes();
    match kind {
        // Bytes turned over, anywhere.
        0 => {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..=dice.below(20) {
                let at = dice.below(bytes.len());
                bytes[at] ^= 1 << dice.below(8);
            }
            bytes
        }
        1 => {
            lines.remove(line);
            joined(lines)
        }
        2 => {
            let copy = lines[line].clone();
            lines.insert(dice.below(lines.len()), copy);
            joined(lines)
        }
        3 => text.as_bytes()[..dice.below(text.len())].to_vec(),
        // Another number in the place of one.
        4 => {
            let numbers =
                ["-1", "0", "1e308", "999999999999999999", "-99999", "nan", "1e-320", "0.0", "********", "4294967296"];
            let digits = lines[line].find(|c: char| c.is_ascii_digit());
            if let Some(start) = digits {
                let end =
                    lines[line][start..].find(|c: char| !c.is_ascii_digit()).map_or(lines[line].len(), |n| start + n);
                lines[line].replace_range(start..end, numbers[dice.below(numbers.len())]);
            }
            joined(lines)
        }
        // A huge count or interval in a header.
        5 => {
            let head = dice.below(lines.len().min(50));
            let huge = ["99999999", "1e18", "0", "-5", "18446744073709551616"][dice.below(5)];
            let words: Vec<&str> = lines[head].split(' ').collect();
            let place = dice.below(words.len());
            let changed: Vec<&str> =
                words.iter().enumerate().map(|(k, word)| if k == place { huge } else { *word }).collect();
            lines[head] = changed.join(" ");
            joined(lines)
        }
        // The middle of one file behind the beginning of itself.
        6 => {
            let [a, b] = [dice.below(text.len()), dice.below(text.len())];
            [&text.as_bytes()[..a], &text.as_bytes()[b..]].concat()
        }
        // A line without its end, or with everything behind it.
        _ => {
            lines[line] = lines[line].trim_end().to_owned();
            joined(lines)
        }
    }
}

#[test]
fn damaged_files_are_read_or_refused_with_their_place() {
    let files = files();
    let mut dice = Dice(ChaCha8Rng::seed_from_u64(35));
    let (mut read, mut refused) = (0, 0);
    // Each format suffers each kind of damage: 26 files, 8 kinds, twice.
    for round in 0..2 {
        for (name, text) in &files {
            for kind in 0..8 {
                let bytes = damaged(text, kind, &mut dice);
                let options = TextOptions {
                    dt: (round == 1).then_some(0.01),
                    units: (round == 1).then(|| "gal".into()),
                    ..TextOptions::default()
                };
                MEMORY.reset_peak_usage();
                let before = MEMORY.current_usage();
                match parse(&bytes, Path::new("file"), &options) {
                    Ok(records) => {
                        read += 1;
                        assert!(!records.is_empty());
                        for record in &records {
                            assert!((2..=MOST_SAMPLES).contains(&record.npts()));
                            assert!(record.acceleration.iter().all(|a| a.is_finite()));
                            assert!((INTERVAL_RANGE[0]..=INTERVAL_RANGE[1]).contains(&record.dt));
                        }
                    }
                    Err(concio::Error::Input(error)) => {
                        refused += 1;
                        assert!(error.file.is_some() && !error.what.is_empty(), "{}, {kind}: {error}", name);
                        let known = error.what.contains("(read as ");
                        assert!(!known || error.line.is_some(), "{}, {kind}: {error}", name);
                    }
                    Err(other) => panic!("{}, {kind}: {other}", name),
                }
                let asked = MEMORY.peak_usage().saturating_sub(before);
                assert!(asked < MOST, "{}, {kind}: {asked} bytes", name);
            }
        }
    }
    println!("{read} read, {refused} refused");
    assert_eq!(read + refused, 2 * 8 * files.len());
    assert!(read + refused >= 200 && refused > read);
}
