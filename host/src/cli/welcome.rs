//! `handstand` alone: what it answers, and where to begin.
//!
//! `--json` prints `question` and `begin`, a list of `command` and `what`.

use super::{Console, ExitStatus};
use handstand::Result;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// What the program answers.
const QUESTION: &str = "Why does my model not match my log?";

const ANSWER: &str = "\
Handstand compares a model of an arm, a pendulum or a chain of links with logs
of its motion, names the physical effect that the model lacks (friction,
backlash, delay, ..) and fits it. It also synthesises gains that balance it.";

/// Where to begin: a heading, then commands to paste and what each is for.
type Start = (&'static str, &'static [(&'static str, &'static str)]);

const STARTS: [Start; 3] = [
    (
        "See it work, no data needed:",
        &[
            ("handstand demo", "find a hidden effect of a virtual arm"),
            ("handstand lab", "the same in a browser, with examples"),
        ],
    ),
    (
        "With your own logs (CSV, MCAP, rosbag2, MAT, ..; here a.csv, b.csv, c.csv):",
        &[
            ("handstand init a.csv -o arm.toml", "a model to start from"),
            (
                "handstand log check arm.toml a.csv b.csv c.csv",
                "are they fit for use?",
            ),
            (
                "handstand diagnose arm.toml a.csv b.csv --holdout c.csv",
                "what is missing?",
            ),
        ],
    ),
    (
        "Look up:",
        &[
            (
                "handstand effects friction",
                "effects, by what people call them",
            ),
            ("handstand help", "all commands"),
            ("handstand help diagnose", "one of them"),
        ],
    ),
];

/// Prints where to begin.
pub fn run(console: &Console) -> Result<ExitStatus> {
    console.result(&data(), text)?;
    Ok(ExitStatus::Done)
}

fn data() -> Value {
    let commands = STARTS.iter().flat_map(|(_, commands)| commands.iter());
    let begin = commands.map(|(command, what)| json!({ "command": command, "what": what }));
    json!({ "question": QUESTION, "begin": begin.collect::<Vec<_>>() })
}

fn text() -> String {
    let mut text = format!("{QUESTION}\n\n{ANSWER}\n");
    for (heading, commands) in STARTS {
        let width = commands.iter().map(|(command, _)| command.len()).max();
        let width = width.unwrap_or_default();
        let _ = writeln!(text, "\n{heading}");
        for (command, what) in commands {
            let _ = writeln!(text, "  {command:width$}  {what}");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser as _;

    #[test]
    fn it_fits_a_small_terminal() {
        let text = text();
        assert!(text.lines().count() <= 24, "{text}");
        for line in text.lines() {
            assert!(line.chars().count() <= 80, "{line}");
        }
    }

    #[test]
    fn every_command_that_it_names_can_be_pasted() {
        for (command, _) in STARTS.iter().flat_map(|(_, commands)| commands.iter()) {
            if let Err(error) = super::super::Cli::try_parse_from(command.split(' ')) {
                let kind = error.kind();
                assert_eq!(
                    kind,
                    clap::error::ErrorKind::DisplayHelp,
                    "{command}: {error}"
                );
            }
        }
    }
}
