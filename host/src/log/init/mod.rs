//! Which model does a log start with? Columns and units guessed from names and ranges, links from
//! how it swings; each guess with its reason.

mod columns;
mod log_guess;
mod name;
#[cfg(test)]
mod tests;
mod values;
mod words;
mod write;

pub use log_guess::{ColumnGuess, JointGuess, LogGuess};

use crate::error::{Error, Result};
use crate::log::RawLog;
use crate::model::new_model::{LinkPlan, ModelPlan};
use columns::log_guess;
use serde::Serialize;
use values::{gravity_of_torques, median, rod_length_m, zero_at_rest};

/// Acceleration of gravity where nothing else is said, m/s^2.
const GRAVITY_M_S2: f64 = 9.81;
/// A link of which nothing is known.
const LENGTH_M: f64 = 0.25;
const MASS_KG: f64 = 0.3;
/// A servo of which nothing is known: about a Dynamixel AX-12.
const GAIN_PER_RAD: f64 = 8.0;
const GAIN_S_PER_RAD: f64 = 0.5;
const STALL_TORQUE_NM: f64 = 1.5;
const NO_LOAD_SPEED_RAD_S: f64 = 6.0;

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
}

impl Draft {
    /// Guesses a model from a log's columns; `file` names it, `drive` says what drives the joints
    /// where the user knows.
    ///
    /// # Errors
    /// A log without a time, or without an angle or a speed.
    pub fn of(log: &RawLog, file: &str, drive: Option<&str>) -> Result<Draft> {
        let mut guesses = Vec::new();
        let columns = log_guess(log, file, drive, &mut guesses)?;
        let time_s = columns.time.si(log);
        let evidence = Evidence::of(log, &columns, &time_s);
        let (angle_zero, why) = evidence.zero();
        guesses.push(Guess::new("angle zero", angle_zero, why));
        let (angles, why) = evidence.angles(angle_zero);
        if columns.joints.len() > 1 {
            guesses.push(Guess::new("angles", angles, why));
        }
        let links = evidence.links(&columns, &mut guesses);
        let name = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        let plan = ModelPlan {
            name: name.to_string(),
            angle_zero: angle_zero.to_string(),
            angles: angles.to_string(),
            gravity_m_s2: None,
            links,
        };
        let split_at_gap_s = gap_s(&time_s, &mut guesses);
        Ok(Draft {
            columns,
            plan,
            guesses,
            split_at_gap_s,
        })
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
        self.guesses.push(Guess::new(what, answer, "as you say"));
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

/// The joints' motion in SI.
struct Evidence {
    time_s: Vec<f64>,
    /// Per joint; empty where it is not measured.
    angle_rad: Vec<Vec<f64>>,
    /// Zero and amplitude of gravity's torque on the first joint, where torques tell.
    gravity: Option<(&'static str, f64)>,
    driven: bool,
}

impl Evidence {
    fn of(log: &RawLog, columns: &LogGuess, time_s: &[f64]) -> Self {
        let joints = columns.joints.iter();
        let angles = joints.map(|j| j.position.as_ref().map(|c| c.si(log)).unwrap_or_default());
        let angle_rad: Vec<Vec<f64>> = angles.collect();
        let first = &columns.joints[0];
        let torque = first.input.as_ref().filter(|_| first.drive == "torque");
        Evidence {
            gravity: torque
                .filter(|_| angle_rad.iter().all(|angle| !angle.is_empty()))
                .and_then(|torque| gravity_of_torques(time_s, &angle_rad, &torque.si(log))),
            driven: columns.joints.iter().any(|joint| joint.drive != "passive"),
            time_s: time_s.to_vec(),
            angle_rad,
        }
    }

    fn zero(&self) -> (&'static str, String) {
        let angle = &self.angle_rad[0];
        if angle.is_empty() {
            return ("hanging", "a guess: no angle is measured".to_string());
        }
        if let Some((zero, _)) = self.gravity {
            return (zero, "how torques follow the angles".to_string());
        }
        if self.driven {
            let why = "a guess: driven angles do not tell; `handstand log check` tries the others";
            return ("hanging", why.to_string());
        }
        let rest = median(angle);
        let why = format!("the first joint moves freely around {rest:.2} rad");
        (zero_at_rest(rest), why)
    }

    fn angles(&self, zero: &str) -> (&'static str, String) {
        let rests: Vec<f64> = self.angle_rad.iter().map(|angle| median(angle)).collect();
        let alike = rests.iter().all(|rest| (rest - rests[0]).abs() < 0.5);
        match zero {
            "hanging" => (
                "relative",
                "a guess: hanging links look the same both ways".to_string(),
            ),
            _ if alike => (
                "absolute",
                format!("all angles lie around {:.2} rad", rests[0]),
            ),
            _ => (
                "relative",
                "the outer angles do not lie where the first does".to_string(),
            ),
        }
    }

    fn links(&self, columns: &LogGuess, guesses: &mut Vec<Guess>) -> Vec<LinkPlan> {
        let one_free = columns.joints.len() == 1 && !self.driven;
        let swing = rod_length_m(&self.time_s, &self.angle_rad[0], GRAVITY_M_S2);
        let length = swing.filter(|_| one_free);
        let one = columns.joints.len() == 1;
        let pulled = self.gravity.filter(|_| one).map(|(_, torque_nm)| {
            let mass_kg = torque_nm / (GRAVITY_M_S2 * LENGTH_M / 2.0);
            (1e3 * mass_kg).round() / 1e3
        });
        let pulled = pulled.filter(|mass_kg| (0.01..100.0).contains(mass_kg));
        let mass_kg = pulled.unwrap_or(MASS_KG);
        match length {
            Some(length) => guesses.push(Guess::new(
                "link",
                format!("an even rod of {length:.3} m"),
                "how often it swings; its mass is a guess",
            )),
            None if pulled.is_some() => guesses.push(Guess::new(
                "link",
                format!("an even rod of {LENGTH_M} m and {mass_kg} kg"),
                "gravity's torque; its length is a guess",
            )),
            None => guesses.push(Guess::new(
                if columns.joints.len() == 1 {
                    "link"
                } else {
                    "links"
                },
                format!("even rods of {LENGTH_M} m and {MASS_KG} kg"),
                "a guess: measure them, or let `handstand fit` estimate them",
            )),
        }
        if columns
            .joints
            .iter()
            .any(|joint| ["duty", "position", "speed"].contains(&joint.drive))
        {
            guesses.push(Guess::new(
                "motor",
                format!(
                    "{STALL_TORQUE_NM} N m at standstill, {NO_LOAD_SPEED_RAD_S} rad/s without load"
                ),
                "a guess: its data sheet says",
            ));
        }
        let length_m = length.map_or(LENGTH_M, |length| (1e3 * length).round() / 1e3);
        columns
            .joints
            .iter()
            .map(|joint| link(joint, length_m, mass_kg))
            .collect()
    }
}

fn link(joint: &JointGuess, length_m: f64, mass_kg: f64) -> LinkPlan {
    let motor = ["duty", "position", "speed"].contains(&joint.drive);
    LinkPlan {
        length_m,
        com_m: length_m / 2.0,
        mass_kg,
        inertia_kg_m2: None,
        drive: joint.drive.to_string(),
        gain: match joint.drive {
            "position" => Some(GAIN_PER_RAD),
            "speed" => Some(GAIN_S_PER_RAD),
            _ => None,
        },
        stall_torque_nm: motor.then_some(STALL_TORQUE_NM),
        no_load_speed_rad_s: motor.then_some(NO_LOAD_SPEED_RAD_S),
    }
}
