//! A log of a robot whose URDF or MJCF file is there: which columns are of which joint, in which
//! unit.

mod draft;
mod matching;
mod units;

pub use draft::{RobotDraft, RobotRequest};
pub use units::LerobotUnit;

use super::columns::log_guess;
use super::dataset::joint_of;
use super::log_guess::{ColumnGuess, JointGuess};
use super::{Guess, gap_s, write};
use crate::RawLog;
use crate::error::{Error, Place, Result};
use crate::lerobot::{COUNT_RAD, Calibration, MotorCalibration};
use crate::model::import::{JointPlan, LogPlan, MovingJoint, ServoFigures};
use matching::{LogJoint, MatchedBy, matched, quoted};
use units::{AngleUnits, Pair, is_lerobot};

/// What is known of a log beside itself.
#[derive(Debug, Clone, Copy)]
struct RobotLog<'a> {
    /// The robot's joints that move.
    pub joints: &'a [MovingJoint],
    /// Joints of the robot with what the log calls them, where the names do not tell.
    pub mapped: &'a [(String, String)],
    /// What per cent are of.
    pub calibration: Option<&'a Calibration>,
    /// In what angles are written, where the user knows.
    pub unit: Option<LerobotUnit>,
    /// Which input drives the joints, where the user knows.
    pub drive: Option<&'a str>,
}

/// The columns of a robot's joints in a log, matched by names, and what was guessed of them;
/// `file` names the log.
///
/// A joint of the robot is the log's joint of the same name; else the one whose name differs in
/// signs and capitals alone; else the one that has words before or behind it, as
/// `main_shoulder_pan`.
///
/// # Errors
/// As [`super::Draft::of`]; joints that no name means, or several; a data set without names; a
/// calibration of another robot, and values that its unit does not have.
fn robot_log(log: &RawLog, file: &str, ask: &RobotLog) -> Result<(LogPlan, Vec<Guess>)> {
    let mut said = Vec::new();
    let guess = log_guess(log, file, ask.drive, &mut said)?;
    let is_lerobot = is_lerobot(&guess);
    // A table whose owner says in what LeRobot's code wrote it is one of its data sets by then.
    let is_calibrated = is_lerobot || ask.unit.is_some() || ask.calibration.is_some();
    let own: Vec<LogJoint> = guess
        .joints
        .iter()
        .map(|joint| log_joint(log, joint, is_lerobot))
        .collect();
    let names: Vec<&str> = ask.joints.iter().map(|joint| joint.name.as_str()).collect();
    let found = matched(&names, &own, ask.mapped, file).map_err(|error| unnamed(log, error))?;
    let pairs = ask.joints.iter().zip(&found);
    let pairs: Vec<Pair> = pairs
        .map(|(joint, (index, _))| (joint, &guess.joints[*index], &own[*index]))
        .collect();
    say_matched(&pairs, &found, &own, &mut said);
    let units = if is_calibrated {
        // Said of each, and now of all.
        let (angle, input) = ("angle of joint ", "input of joint ");
        said.retain(|guess| !guess.what.starts_with(angle) && !guess.what.starts_with(input));
        Some(AngleUnits::of(log, file, ask, &pairs, &mut said)?)
    } else {
        None
    };
    let mut joints = Vec::with_capacity(pairs.len());
    for (index, pair) in pairs.iter().enumerate() {
        let columns = match &units {
            Some(units) => units.columns(index, *pair)?,
            None => columns_of(None, pair.1, pair.0),
        };
        joints.push(JointPlan {
            columns,
            drive: pair.1.drive,
            servo: ServoFigures::guessed(pair.1.drive),
        });
    }
    say_drives(&pairs, &mut said);
    let gap_s = gap_s(&guess.time.si(log), &mut said);
    let plan = LogPlan {
        name: None,
        comments: said.iter().map(comment).collect(),
        head: write::log_head(&guess, gap_s),
        joints,
    };
    Ok((plan, said))
}

fn comment(guess: &Guess) -> String {
    format!("{}: {} ({})", guess.what, guess.guess, guess.why)
}

/// A joint of the log by its names.
fn log_joint(log: &RawLog, joint: &JointGuess, is_lerobot: bool) -> LogJoint {
    let measured = joint.position.as_ref().or(joint.velocity.as_ref());
    let column = measured.map_or(String::new(), |column| column.name.clone());
    let called = log
        .dataset
        .as_ref()
        .and_then(|facts| facts.name_of(&column));
    let bare = column.strip_suffix(".position").map(str::to_string);
    let (name, is_left_over) = match (called, bare) {
        (Some(called), _) => (joint_of(called).to_string(), false),
        // A number in a list says nothing of which joint is meant.
        (None, _) if is_lerobot => (column.clone(), false),
        (None, Some(bare)) => (bare, false),
        (None, None) => (joint.name.clone(), true),
    };
    LogJoint {
        shown: called.map_or_else(|| column.clone(), str::to_string),
        name,
        column,
        is_left_over,
    }
}

/// An error of names in a data set that has none says so.
fn unnamed(log: &RawLog, error: Error) -> Error {
    let dataset = log.dataset.as_ref();
    let Some((facts, why)) = dataset.and_then(|facts| Some((facts, facts.unnamed.as_ref()?)))
    else {
        return error;
    };
    let remedy = format!(
        "{}; or write the names into it",
        error.remedy().unwrap_or_default()
    );
    Error::data(Place::file(&facts.info), format!("{why}: {error}"), remedy)
}

fn say_matched(
    pairs: &[Pair],
    found: &[(usize, MatchedBy)],
    own: &[LogJoint],
    said: &mut Vec<Guess>,
) {
    for ((joint, _, name), (_, by)) in pairs.iter().zip(found) {
        let why = match by {
            MatchedBy::Mapping => "as you say",
            MatchedBy::Name => continue,
            MatchedBy::Words => "a guess: its name has the same words",
        };
        let what = format!("joint {}", joint.name);
        said.push(Guess::new(what, name.shown.clone(), why));
    }
    let others = (0..own.len()).filter(|index| !found.iter().any(|(taken, _)| taken == index));
    let others: Vec<&str> = others.map(|index| own[index].shown.as_str()).collect();
    if !others.is_empty() {
        let why = "no joint of the robot that moves has such a name";
        said.push(Guess::new("not taken", quoted(others), why));
    }
}

/// Says which drives are guesses: those that the robot's file does not have.
fn say_drives(pairs: &[Pair], said: &mut Vec<Guess>) {
    let other = pairs
        .iter()
        .filter(|(joint, own, _)| joint.drive != own.drive);
    let other: Vec<_> = other.collect();
    let of = |drives: &[&str]| {
        let own = other
            .iter()
            .filter(|(_, own, _)| drives.contains(&own.drive));
        let names: Vec<&str> = own.map(|(joint, ..)| joint.name.as_str()).collect();
        (!names.is_empty()).then(|| quoted(names))
    };
    if let Some(names) = of(&["position", "speed", "duty"]) {
        let figures = format!("of {names}: {}", ServoFigures::guessed("position"));
        let why = "a guess: its data sheet says, or `handstand fit` estimates them";
        said.push(Guess::new("motors", figures, why));
    }
    if let Some(names) = of(&["passive"]) {
        let why = "the log holds no input of theirs that changes";
        said.push(Guess::new("passive", names, why));
    }
}

/// The lines of a joint's `[[log.joint]]`; of a servo's angle the step is known.
fn columns_of(motor: Option<MotorCalibration>, own: &JointGuess, joint: &MovingJoint) -> String {
    let of_slide = |column: &ColumnGuess| {
        let unit = match column.unit {
            "rad" => "m",
            "rad/s" => "m/s",
            "N m" => "N",
            other => other,
        };
        let unit = if joint.slides { unit } else { column.unit };
        ColumnGuess {
            unit,
            ..column.clone()
        }
        .toml()
    };
    let mut text = String::new();
    let input = own.input.as_ref().filter(|_| own.drive != "passive");
    let all = [
        ("position", own.position.as_ref()),
        ("velocity", own.velocity.as_ref()),
        ("input", input),
    ];
    for (key, column) in all {
        let Some(column) = column else { continue };
        let mut column = of_slide(column);
        if let (Some(_), "position", Some(open)) = (motor, key, column.strip_suffix(" }")) {
            column = format!("{open}, resolution_rad = {COUNT_RAD:?} }}");
        }
        text += &format!("{key} = {column}\n");
    }
    text
}
