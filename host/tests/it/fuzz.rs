//! Good logs, models and arguments, mutated: the program refuses or runs, and never panics.

use crate::common::{Bench, MODEL};
use rand::seq::IndexedRandom as _;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// Mutated files of each kind.
const CASES: u64 = 30;
/// What may be written in place of a part of a file.
const SCRAPS: &[&str] = &[
    "",
    "0",
    "-1",
    "1e308",
    "-1e308",
    "1e-320",
    "NaN",
    "inf",
    "999999999999999999999",
    "\"",
    "'",
    ",",
    ",,,",
    "\n",
    "\r\n",
    "\n\n",
    "\0",
    "\u{feff}",
    "é",
    "[",
    "]]",
    "{}",
    "=",
    "#",
    "true",
    "[[joint]]\n",
    "[[effect]]\nkind = \"delay\"\n",
    "time_s",
    "drive",
];

/// The text with one to four places changed.
fn mutated(text: &str, random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..random.random_range(1..=4) {
        let from = random.random_range(0..=bytes.len());
        let to = (from + random.random_range(0..12)).min(bytes.len());
        match random.random_range(0..5) {
            0 => drop(bytes.drain(from..to)),
            1 => bytes.truncate(from.max(8)),
            2 => {
                let copy = bytes[from..to].to_vec();
                bytes.splice(from..from, copy);
            }
            3 if from < bytes.len() => bytes[from] = random.random(),
            _ => {
                let scrap = SCRAPS.choose(random).unwrap();
                bytes.splice(from..to, scrap.bytes());
            }
        }
    }
    bytes
}

/// The text with a number changed to another one.
fn renumbered(text: &str, random: &mut ChaCha8Rng) -> Vec<u8> {
    let starts: Vec<usize> = text
        .char_indices()
        .filter(|(at, c)| {
            c.is_ascii_digit()
                && !text[..*at].ends_with(|c: char| c.is_ascii_alphanumeric() || c == '.')
        })
        .map(|(at, _)| at)
        .collect();
    let from = *starts.choose(random).unwrap();
    let length = text[from..]
        .find(|c: char| !(c.is_ascii_digit() || c == '.' || c == 'e'))
        .unwrap_or(text.len() - from);
    let new = [
        "0", "1", "-3.5", "1e9", "1e-9", "-1e300", "5e-324", "nan", "inf", "100000",
    ]
    .choose(random)
    .unwrap();
    format!("{}{new}{}", &text[..from], &text[from + length..]).into_bytes()
}

fn survives(bench: &Bench, line: &str, case: u64) {
    let ran = bench.run(line);
    assert!(
        matches!(ran.code, Some(0..=3)),
        "case {case}: {line}: {ran:?}"
    );
    assert!(
        !ran.stderr.contains("panicked"),
        "case {case}: {line}: {ran:?}"
    );
}

#[test]
fn mutated_logs_are_refused_or_used() {
    let bench = Bench::new();
    let log: String = bench
        .get("a.csv")
        .lines()
        .take(150)
        .map(|line| format!("{line}\n"))
        .collect();
    for case in 0..CASES {
        let mut random = ChaCha8Rng::seed_from_u64(case);
        let bad = match case % 2 {
            0 => mutated(&log, &mut random),
            _ => renumbered(&log, &mut random),
        };
        bench.put("bad.csv", bad);
        survives(&bench, "log check model.toml bad.csv", case);
        survives(&bench, "compare model.toml bad.csv --json", case);
        survives(
            &bench,
            "fit model.toml bad.csv --free link1.com_m -o new.toml --force",
            case,
        );
        survives(
            &bench,
            "add model.toml viscous --fit bad.csv -o new.toml --force",
            case,
        );
    }
}

#[test]
fn mutated_models_are_refused_or_used() {
    let bench = Bench::new();
    let log: String = bench
        .get("a.csv")
        .lines()
        .take(60)
        .map(|line| format!("{line}\n"))
        .collect();
    bench.put("short.csv", log);
    for case in 0..CASES {
        let mut random = ChaCha8Rng::seed_from_u64(1000 + case);
        let bad = match case % 2 {
            0 => mutated(MODEL, &mut random),
            _ => renumbered(MODEL, &mut random),
        };
        bench.put("bad.toml", bad);
        survives(&bench, "log check bad.toml short.csv", case);
        survives(&bench, "compare bad.toml short.csv", case);
        survives(
            &bench,
            "fit bad.toml short.csv --free link1.com_m -o new.toml --force",
            case,
        );
    }
}

#[test]
fn mutated_number_lists_are_refused_or_used() {
    let bench = Bench::new();
    bench.put(
        "handstand.toml",
        include_str!("../../models/handstand.toml"),
    );
    let lists = [
        ("--q", "100,100,100,1,1,1"),
        ("--r", "1,2.5"),
        ("--pose", "1.57,0,0"),
        ("--range", "0.5,0.5,0.5,10,10,10"),
        ("--limit", "2,2"),
    ];
    for case in 0..CASES {
        let mut random = ChaCha8Rng::seed_from_u64(2000 + case);
        let (option, list) = lists[case as usize % lists.len()];
        let bad = match case % 2 {
            0 => mutated(list, &mut random),
            _ => renumbered(list, &mut random),
        };
        // The words of a line are parted by spaces, and no argument can hold a zero.
        let bad: String = String::from_utf8_lossy(&bad)
            .chars()
            .filter(|c| !c.is_whitespace() && *c != '\0')
            .collect();
        survives(
            &bench,
            &format!("gains handstand.toml {option}={bad} --quiet"),
            case,
        );
    }
}
