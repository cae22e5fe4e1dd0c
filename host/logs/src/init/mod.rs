//! Which model does a log start with? Columns and units guessed from names and ranges, links from
//! how it swings; each guess with its reason.

mod bench;
mod coding;
mod columns;
mod counts;
mod dataset;
mod estimated;
mod evidence;
mod inputs;
mod log_guess;
mod name;
mod origin;
mod robot;
mod segment;
#[cfg(test)]
mod tests;
mod times;
mod unused;
mod values;
mod words;
mod write;

pub use log_guess::{ColumnGuess, JointGuess, LogGuess};
pub use name::{Role, name_guess};
pub use origin::{DraftValue, Estimate, Origin};
pub use robot::{LerobotUnit, RobotDraft, RobotRequest};

use crate::RawLog;
use crate::error::{Error, Result};
use crate::model::new_model::{ModelPlan, model_toml};
use crate::model::{EffectInstance, Unit};
use columns::log_guess;
use evidence::Evidence;
use serde::Serialize;
use values::{median, time_unit};

/// The values of a log's time column in s, its unit guessed from its steps.
pub fn time_si(log: &RawLog, time: usize) -> Vec<f64> {
    let column = &log.columns[time];
    let unit = if log.iso[time] {
        "s"
    } else {
        time_unit(column)
    };
    let factor = Unit::named(unit, None).map_or(1.0, |unit| unit.si);
    column.iter().map(|value| factor * value).collect()
}

/// Something that a log does not say, and what was taken for it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Guess {
    /// What was asked.
    pub what: String,
    /// The answer.
    pub guess: String,
    /// What it rests on.
    pub why: String,
}

impl Guess {
    fn new(what: impl Into<String>, guess: impl Into<String>, why: impl Into<String>) -> Self {
        Guess {
            what: what.into(),
            guess: guess.into(),
            why: why.into(),
        }
    }
}

/// A model to start from.
#[derive(Debug, Clone, PartialEq)]
pub struct Draft {
    /// The log's columns.
    pub columns: LogGuess,
    /// The rig's figures; may be changed before it is written.
    pub plan: ModelPlan,
    /// What was guessed.
    pub guesses: Vec<Guess>,
    /// A motion ends where time jumps by more, s.
    pub split_at_gap_s: Option<f64>,
    /// Friction that a log tells of.
    pub friction: Vec<EffectInstance>,
    /// Addresses of the values that a log determines, once that is known.
    pub free: Option<Vec<String>>,
    /// Values that a fit to the log gave.
    pub estimates: Vec<Estimate>,
}

impl Draft {
    /// Guesses a model from a log's columns; `file` names it, `drive` says what drives the joints
    /// where the user knows.
    ///
    /// # Errors
    /// A log without a time, or without an angle or a speed.
    pub fn of(log: &RawLog, file: &str, drive: Option<&str>) -> Result<Draft> {
        let mut guesses = Vec::new();
        let mut columns = log_guess(log, file, drive, &mut guesses)?;
        let time_s = columns.time.si(log);
        let evidence = Evidence::of(log, &columns, &time_s);
        let (angle_zero, why) = evidence.zero();
        guesses.push(Guess::new("angle zero", angle_zero, why));
        evidence.offsets(angle_zero, &mut columns, &mut guesses);
        let (angles, why) = evidence.angles(angle_zero);
        if columns.joints.len() > 1 {
            guesses.push(Guess::new("angles", angles, why));
        }
        let links = match log.bench.filter(|_| columns.joints.len() == 1) {
            Some(bench) => bench::links(bench, &mut columns, &mut guesses),
            None => evidence.links(&columns, &mut guesses),
        };
        let name = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        let plan = ModelPlan {
            name: name.to_string(),
            angle_zero: angle_zero.to_string(),
            angles: angles.to_string(),
            gravity_m_s2: None,
            guessed: true,
            links,
        };
        let split_at_gap_s = gap_s(&time_s, &mut guesses);
        Ok(Draft {
            columns,
            plan,
            guesses,
            split_at_gap_s,
            friction: Vec::new(),
            free: None,
            estimates: Vec::new(),
        })
    }

    /// Whether some joint has an input that a drive of this name takes; a passive one takes none.
    pub fn has_input_of(&self, drive: &str) -> bool {
        let mut joints = self.columns.joints.iter();
        joints.any(|joint| joint.drive == drive)
    }

    /// A model file of these figures, whose `[log]` is as guessed; `head` are comments.
    ///
    /// # Errors
    /// Figures that make no model, or another number of joints than the log has.
    pub fn toml_of(&self, plan: &ModelPlan, head: &str) -> Result<String> {
        let (joints, links) = (self.columns.joints.len(), plan.links.len());
        if joints != links {
            return Err(Error::usage(
                format!("the log has columns of {joints} joints, the model {links} links"),
                "give a link per joint",
            ));
        }
        let drives: Vec<&str> = plan.links.iter().map(|link| link.drive.as_str()).collect();
        model_toml(plan, head, &write::log_table(self, &drives))
    }

    /// Takes an answer of the user's: `name`, `angle zero` or `angles`.
    ///
    /// # Errors
    /// An answer that is none of those possible.
    pub fn set(&mut self, what: &str, answer: &str) -> Result<()> {
        let (place, possible): (_, &[&str]) = match what {
            "name" => (&mut self.plan.name, &[]),
            "angle zero" => (
                &mut self.plan.angle_zero,
                &["hanging", "upright", "horizontal"],
            ),
            _ => (&mut self.plan.angles, &["relative", "absolute"]),
        };
        if !possible.is_empty() && !possible.contains(&answer) {
            let remedy = format!("answer {}", possible.join(", "));
            return Err(Error::usage(
                format!("{what}: '{answer}' is not known"),
                remedy,
            ));
        }
        *place = answer.to_string();
        self.said(what, answer);
        Ok(())
    }

    /// Takes the links' `length`, m, or `mass`, kg: one for each, or one for all.
    ///
    /// # Errors
    /// As many numbers as there are no links, or one that is not above 0.
    pub fn set_links(&mut self, what: &str, values: &[f64]) -> Result<()> {
        let count = self.plan.links.len();
        let fits = values.len() == 1 || values.len() == count;
        if !fits || !values.iter().all(|value| value.is_finite() && *value > 0.0) {
            return Err(Error::usage(
                format!("{what}: {} numbers for {count} links", values.len()),
                "give one number above 0 for each link, or one for all",
            ));
        }
        for (link, value) in self.plan.links.iter_mut().zip(values.iter().cycle()) {
            match what {
                "mass" => link.mass_kg = *value,
                _ => (link.length_m, link.com_m) = (*value, value / 2.0),
            }
        }
        let values: Vec<String> = values.iter().map(f64::to_string).collect();
        self.said(what, &values.join(", "));
        Ok(())
    }

    /// Notes an answer in place of a guess.
    fn said(&mut self, what: &str, answer: &str) {
        self.guesses.retain(|guess| guess.what != what);
        self.guesses
            .push(Guess::new(what, answer, estimated::AS_YOU_SAY));
    }

    /// The model file.
    ///
    /// # Errors
    /// Figures that make no model.
    pub fn toml(&self) -> Result<String> {
        write::toml(self)
    }
}

/// A gap at which motions are cut, if steps differ so much that there are gaps.
fn gap_s(time_s: &[f64], guesses: &mut Vec<Guess>) -> Option<f64> {
    let steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let forward: Vec<f64> = steps.iter().copied().filter(|step| *step > 0.0).collect();
    let step = median(&forward);
    let longest = forward.into_iter().fold(0.0, f64::max);
    if step <= 0.0 || longest <= 50.0 * step {
        return None;
    }
    let gap_s = 20.0 * step;
    let gap_s = format!("{gap_s:.2e}").parse().unwrap_or(gap_s);
    let why = format!("rows are mostly {step:.4} s apart, at most {longest:.4} s");
    guesses.push(Guess::new(
        "gaps",
        format!("a motion ends at {gap_s} s"),
        why,
    ));
    Some(gap_s)
}
