//! The command lines that follow a proposal, with the files' names.

use crate::diagnose::{quoted, quoted_logs};
use crate::fitting::Horizon;
use crate::log::{LogRequest, LogSet};
use std::path::Path;

/// Stands for the new log where the motion has no file to be named after.
const NEW_LOG: &str = "NEW_LOG";

/// What the commands that follow a proposal name: files, and the options that were given.
#[derive(Debug, Clone, Copy)]
pub struct FollowUp<'a> {
    /// Model file.
    pub model: &'a Path,
    /// Logs that there are.
    pub logs: &'a LogSet,
    /// File that the motion was written to.
    pub motion: Option<&'a Path>,
    /// Whether `handstand replay` plays it.
    pub replayable: bool,
    /// Values that were named to be tightened: they are fitted, not diagnosed.
    pub values: &'a [String],
    /// Effects left out of the candidates.
    pub without: &'a [String],
    /// Values that are known to be right.
    pub known: &'a [String],
    /// Whether the log is trusted.
    pub trust_log: bool,
    /// How long models run, where that was asked for.
    pub horizon: Option<Horizon>,
}

impl FollowUp<'_> {
    /// The log of the motion: `next_log.csv` beside `next.csv`.
    pub fn new_log(&self) -> String {
        let Some(motion) = self.motion else {
            return NEW_LOG.to_string();
        };
        let stem = motion.file_stem().unwrap_or_default().to_string_lossy();
        let log = motion.with_file_name(format!("{stem}_log.csv"));
        quoted(&log.to_string_lossy())
    }

    /// Plays the motion and records it; none where no file holds it or `replay` does not play it.
    pub fn replay(&self) -> Option<String> {
        let motion = self.motion.filter(|_| self.replayable)?;
        let (motion, log) = (quoted(&motion.to_string_lossy()), self.new_log());
        Some(format!("handstand replay {motion} --record {log}"))
    }

    /// Learns from all logs and the new one.
    pub fn again(&self) -> String {
        let new_log = format!(" {}", self.new_log());
        match self.values {
            [] => self.diagnose(&new_log, self.known),
            values => {
                let options = self.each("--free", values) + &self.holdout() + &self.horizon();
                let files = self.files(&new_log);
                format!("handstand fit {files}{options} -o better.toml")
            }
        }
    }

    /// Diagnoses the logs there are with one more value known to be right.
    pub fn with_known(&self, path: &str) -> String {
        let known = [self.known, &[path.to_string()]].concat();
        self.diagnose("", &known)
    }

    fn diagnose(&self, new_log: &str, known: &[String]) -> String {
        let options = [
            self.holdout(),
            self.each("--without", self.without),
            self.each("--known", known),
            if self.trust_log { " --trust-log" } else { "" }.to_string(),
            self.horizon(),
        ];
        format!(
            "handstand diagnose {}{}",
            self.files(new_log),
            options.concat()
        )
    }

    fn files(&self, new_log: &str) -> String {
        let model = quoted(&self.model.to_string_lossy());
        format!("{model} {}{new_log}", quoted_logs(&self.logs.training))
    }

    fn holdout(&self) -> String {
        let held_out: &[LogRequest] = &self.logs.held_out;
        match held_out {
            [] => String::new(),
            logs => format!(" --holdout {}", quoted_logs(logs)),
        }
    }

    fn horizon(&self) -> String {
        match self.horizon {
            None => String::new(),
            Some(Horizon::Whole) => " --horizon whole".to_string(),
            Some(Horizon::Seconds(seconds)) => format!(" --horizon {seconds}"),
        }
    }

    fn each(&self, option: &str, values: &[String]) -> String {
        let each = values
            .iter()
            .map(|value| format!(" {option} {}", quoted(value)));
        each.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn logs(held_out: &[&str]) -> LogSet {
        let whole = |names: &[&str]| names.iter().map(LogRequest::whole).collect();
        LogSet {
            training: whole(&["a.csv", "my b.csv"]),
            held_out: whole(held_out),
        }
    }

    fn follow_up(logs: &LogSet) -> FollowUp<'_> {
        FollowUp {
            model: Path::new("arm.toml"),
            logs,
            motion: Some(Path::new("out/next.csv")),
            replayable: true,
            values: &[],
            without: &[],
            known: &[],
            trust_log: false,
            horizon: None,
        }
    }

    #[test]
    fn the_commands_are_complete() {
        let logs = logs(&["c.csv"]);
        let plain = follow_up(&logs);
        assert_eq!(
            plain.replay().unwrap(),
            "handstand replay out/next.csv --record out/next_log.csv"
        );
        assert_eq!(
            plain.again(),
            "handstand diagnose arm.toml a.csv 'my b.csv' out/next_log.csv --holdout c.csv"
        );
        let (without, known) = (["delay".to_string()], ["link1.mass_kg".to_string()]);
        let all = FollowUp {
            without: &without,
            known: &known,
            trust_log: true,
            horizon: Some(Horizon::Seconds(0.5)),
            ..plain
        };
        assert_eq!(
            all.with_known("link1.com_m"),
            "handstand diagnose arm.toml a.csv 'my b.csv' --holdout c.csv --without delay \
             --known link1.mass_kg --known link1.com_m --trust-log --horizon 0.5"
        );
    }

    #[test]
    fn named_values_are_fitted() {
        let (logs, values) = (logs(&[]), ["link1.mass_kg".to_string()]);
        let named = FollowUp {
            motion: None,
            values: &values,
            horizon: Some(Horizon::Whole),
            ..follow_up(&logs)
        };
        assert_eq!(named.replay(), None);
        assert_eq!(
            named.again(),
            "handstand fit arm.toml a.csv 'my b.csv' NEW_LOG --free link1.mass_kg --horizon whole \
             -o better.toml"
        );
    }
}
