//! What of a log a guessed model leaves unused, and why; and what looks wrong with its header.

use super::Guess;
use super::log_guess::LogGuess;
use super::name::{NameGuess, Role, names_an_angle, says_current};
use super::values::stands_still;
use crate::RawLog;
use crate::output::shortened;

/// Names that are listed; the rest are counted.
const LISTED: usize = 24;

/// Names in quotes, the first of many.
pub fn quoted<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    let listed = names.iter().take(LISTED);
    let listed: Vec<String> = listed
        .map(|name| format!("{:?}", shortened(name)))
        .collect();
    let listed = listed.join(", ");
    match names.len().saturating_sub(LISTED) {
        0 => listed,
        more => format!("{listed} and {more} more"),
    }
}

/// Says what is wrong with the file and its header: a torn file, variables that hold no numbers,
/// names that stand there twice.
pub fn say_file(log: &RawLog, guess: &LogGuess, said: &mut Vec<Guess>) {
    for (what, remedy) in log.remarks() {
        said.push(Guess::new("file", what, remedy));
    }
    for name in guess.names() {
        let same = log.names.iter().filter(|other| *other == name).count();
        if same > 1 {
            said.push(Guess::new(
                "twice",
                format!(
                    "{same} columns are called {:?}: the first is taken",
                    shortened(name)
                ),
                "rename the others: no log is read in which a name means two columns",
            ));
        }
    }
}

/// Says which columns are not used.
pub fn say_unused(log: &RawLog, names: &[NameGuess], guess: &LogGuess, said: &mut Vec<Guess>) {
    let used = guess.names();
    // Of a column that is not taken for its coding that was said.
    let is_said = |name: &str| {
        let coded = format!("column {:?} not taken", shortened(name));
        said.iter().any(|guess| guess.guess.starts_with(&coded))
    };
    let unused: Vec<usize> = (0..log.names.len())
        .filter(|index| !used.contains(&log.names[*index].as_str()))
        .filter(|index| !is_said(&log.names[*index]))
        .collect();
    let is_angle = |index: &&usize| {
        let name = &log.names[**index];
        names_an_angle(name)
            && matches!(names[**index].role, None | Some(Role::Position))
            && !stands_still(&log.columns[**index])
    };
    let angles: Vec<usize> = unused.iter().filter(is_angle).copied().collect();
    let listed = |indices: &[usize]| quoted(indices.iter().map(|i| log.names[*i].as_str()));
    if !angles.is_empty() {
        said.push(Guess::new(
            "another angle",
            format!("{}: not taken", listed(&angles)),
            "its name tells no joint beside those taken; of one, name it such as q2_rad",
        ));
    }
    let words: Vec<usize> = (0..log.names.len())
        .filter(|index| log.words.get(*index).is_some_and(Option::is_some))
        .filter(|index| unused.contains(index) && stands_still(&log.columns[*index]))
        .collect();
    if !words.is_empty() {
        let why = "it holds words, not numbers";
        said.push(Guess::new("not used", listed(&words), why));
    }
    let rest: Vec<usize> = unused
        .into_iter()
        .filter(|index| !angles.contains(index) && !words.contains(index))
        .collect();
    if !rest.is_empty() {
        let why = "another value is more direct, or none needs it";
        said.push(Guess::new("not used", listed(&rest), why));
    }
    let current = log.names.iter().find(|name| says_current(name));
    let free = guess.joints.iter().all(|joint| joint.input.is_none());
    if let Some(name) = current.filter(|_| free) {
        let guess = format!("no column; {:?} is a current", shortened(name));
        let remedy = "drive = \"torque\" takes it as input = { column, unit = \"A\", \
                      torque_constant_nm_a }";
        said.push(Guess::new("input", guess, remedy));
    }
    if names.iter().any(|name| name.role == Some(Role::Payload)) {
        let remedy = "payload = { column, unit, at_m } says where it is bolted";
        said.push(Guess::new("payload", "not used", remedy));
    }
}
