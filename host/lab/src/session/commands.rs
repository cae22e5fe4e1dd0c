//! The command lines that do what was done, to be typed in the session's folder.

use super::ChosenBounds;
use super::data::model_file;
use super::saved::{SavedLog, SavedSession};
use crate::diagnose::{quoted, quoted_logs};
use crate::fitting::Horizon;
use crate::log::LogRequest;
use std::path::Path;

impl SavedSession {
    /// Its logs in a role, as words of a command.
    fn log_words(&self, held_out: bool) -> String {
        let logs = self.logs.iter().filter(|log| log.held_out == held_out);
        let request = |log: &SavedLog| LogRequest {
            path: Path::new("logs").join(&log.file),
            rows: log.rows,
        };
        quoted_logs(&logs.map(request).collect::<Vec<_>>())
    }

    /// Logs to learn from; those to judge by where there are no others.
    fn training_words(&self) -> String {
        let training = self.log_words(false);
        if training.is_empty() {
            self.log_words(true)
        } else {
            training
        }
    }

    fn judging_words(&self, horizon: Option<Horizon>) -> String {
        let mut words = String::new();
        let held_out = self.log_words(true);
        if !held_out.is_empty() && !self.log_words(false).is_empty() {
            words += &format!(" --holdout {held_out}");
        }
        words + &horizon_words(horizon)
    }

    /// `handstand compare` of the steps that lead to the present one.
    pub fn compare_command(&self) -> String {
        let horizon = horizon_words(Some(self.horizon()));
        let all = [self.training_words(), self.log_words(true)];
        let all = if self.log_words(false).is_empty() {
            all[0].clone()
        } else {
            all.join(" ").trim().to_string()
        };
        let others: String = (1..=self.current)
            .map(|step| format!(" --model {}", model_file(step).display()))
            .collect();
        format!("handstand compare model-0.toml {all}{others}{horizon}")
    }

    /// `handstand diagnose` of the present step.
    pub fn diagnose_command(&self) -> String {
        format!(
            "handstand diagnose {} {}{}",
            model_file(self.current).display(),
            self.training_words(),
            self.judging_words(self.window.by_hand())
        )
    }

    /// `handstand add` to the present step.
    pub fn add_command(&self, effects: &[String]) -> String {
        let effects: Vec<String> = effects.iter().map(|effect| quoted(effect)).collect();
        format!(
            "handstand add {} {} --fit {}{} -o {}",
            model_file(self.current).display(),
            effects.join(" "),
            self.training_words(),
            self.judging_words(Some(self.horizon())),
            model_file(self.current + 1).display()
        )
    }

    /// `handstand discover` of the present step.
    pub fn discover_command(&self) -> String {
        format!(
            "handstand discover {} {}{} -o {}",
            model_file(self.current).display(),
            self.training_words(),
            self.judging_words(self.window.by_hand()),
            model_file(self.current + 1).display()
        )
    }

    /// `handstand fit` of values of the present step, within bounds.
    pub fn fit_command(&self, values: &[String], bounds: &[ChosenBounds]) -> String {
        let free = values
            .iter()
            .map(|path| format!(" --free {}", quoted(path)));
        let bounds = bounds.iter().filter_map(|own| {
            let (low, high) = own.ends()?;
            let asked = format!("{}={low}..{high}", own.path);
            Some(format!(" --bounds {}", quoted(&asked)))
        });
        let free: String = free.chain(bounds).collect();
        format!(
            "handstand fit {} {}{free}{} -o {}",
            model_file(self.current).display(),
            self.training_words(),
            self.judging_words(Some(self.horizon())),
            model_file(self.current + 1).display()
        )
    }

    /// `handstand gains` of the present step.
    pub fn gains_command(&self) -> String {
        format!("handstand gains {}", model_file(self.current).display())
    }
}

/// The option that asks for a horizon.
fn horizon_words(horizon: Option<Horizon>) -> String {
    match horizon {
        Some(Horizon::Seconds(seconds)) => format!(" --horizon {seconds}"),
        Some(Horizon::Whole) => " --horizon whole".into(),
        None => String::new(),
    }
}
