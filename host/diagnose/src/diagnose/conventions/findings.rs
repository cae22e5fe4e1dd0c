//! Faults as findings of a log check: what was found, the remedy, and the proof.

use super::correction::{Correction, LogColumn};
use super::leave_out::{LeaveOut, Unusable};
use super::search::LogFault;
use super::trial::Trial;
use crate::error::{Place, Result};
use crate::log::{LogFinding, Proof, Severity};
use crate::model::edit::{changed_lines, set_reading};
use crate::model::{Angles, Dimension, JointColumns, MeasuredSignal, Model, Unit};
use crate::motion::Motion;
use std::path::Path;

/// A model's file: its path, for messages, and its text.
#[derive(Debug, Clone, Copy)]
pub struct ModelFile<'a> {
    /// Where it lies.
    pub path: &'a Path,
    /// What it holds.
    pub text: &'a str,
}

/// A fault of the model file, mended before the next one was looked for; `model` is what it was
/// found in.
pub(super) fn finding(found: &LogFault, model: &Model, file: ModelFile) -> Result<LogFinding> {
    let trial = &found.trial;
    let mut corrections = vec![lines(&trial.correction, model, file)?];
    for rival in &found.rivals {
        corrections.push(lines(&rival.correction, model, file)?);
    }
    let doubt = doubt(trial, model);
    let mut remedy = corrections.join("; or, which lowers the error as far, ");
    if let Some(doubt) = doubt {
        remedy = format!("{}: only if you know it, {remedy}", doubt.words());
    }
    Ok(LogFinding {
        kind: kind(&trial.correction),
        severity: if doubt.is_some() || trial.correction.is_continuous() {
            Severity::Warn
        } else {
            Severity::Refuse
        },
        place: Some(Place::file(file.path)),
        what: format!("{}; {}", what(found, model), proof(trial, model)),
        remedy,
        proof: Some(Proof {
            before_rad: trial.before_rad,
            after_rad: trial.after_rad,
            before_share: trial.before,
            after_share: trial.after,
        }),
    })
}

/// Why a simulation of the model can only hint at how a log is written.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Doubt {
    /// Its values are guesses.
    Guessed,
    /// It is far from the log with the correction, too.
    FarOff,
    /// It shows in one joint, and all together hardly gain.
    OneJoint,
}

/// A share of the motion that a model near a log leaves unexplained at most.
const NEAR: f64 = 0.3;

/// All joints hardly gain where more than this share of the error stays.
const HARDLY: f64 = 0.8;

impl Doubt {
    fn words(self) -> &'static str {
        match self {
            Doubt::Guessed => "the model's values are guesses, which cannot tell",
            Doubt::FarOff => "the model is far from the log either way, so this is a hint",
            Doubt::OneJoint => "the joints together hardly gain, so this is a hint",
        }
    }
}

/// A sign, a unit or a drive is wrong or right, and a zero or a shift may be the rig's own, where
/// the model can tell.
fn doubt(trial: &Trial, model: &Model) -> Option<Doubt> {
    // Samples seconds apart need no model to be doubted.
    match &trial.correction {
        Correction::Unit(columns) if columns.iter().any(|(q, _)| *q == LogColumn::Time) => None,
        _ if model.guessed => Some(Doubt::Guessed),
        _ if trial.after > NEAR => Some(Doubt::FarOff),
        _ if trial.own.is_some() && trial.after > HARDLY * trial.before => Some(Doubt::OneJoint),
        _ => None,
    }
}

fn kind(correction: &Correction) -> &'static str {
    match correction {
        Correction::Reverse(_) => "sign",
        Correction::AngleZero(_) | Correction::Offset(..) => "zero",
        Correction::Unit(columns) if columns.iter().any(|(q, _)| *q == LogColumn::Time) => {
            "time_unit"
        }
        Correction::Unit(_) => "unit",
        Correction::Angles(_) => "angles",
        Correction::Drive(..) => "drive",
        Correction::Shift(..) => "time_shift",
    }
}

fn name(quantity: LogColumn, model: &Model) -> String {
    let names: Vec<&str> = quantity
        .columns(model)
        .iter()
        .map(|c| c.name.as_str())
        .collect();
    names.join(" and ")
}

fn names(columns: &[LogColumn], model: &Model) -> String {
    let names: Vec<String> = columns.iter().map(|column| name(*column, model)).collect();
    names.join(" and ")
}

/// "elbow.position and elbow.goal are 0.523 rad off (30.0 deg, 29.1 to 30.8 deg)": the last is the
/// 95 % interval, where there is one.
fn zero_off(columns: &[LogColumn], off: f64, interval: Option<[f64; 2]>, model: &Model) -> String {
    let are = if columns.len() > 1 { "are" } else { "is" };
    let first = columns.first().and_then(|column| column.column(model));
    let slides = first.is_some_and(|column| column.unit.dimension == Dimension::Length);
    let (si, unit, of_si) = if slides {
        ("m", "mm", 1e3)
    } else {
        ("rad", "deg", 1f64.to_degrees())
    };
    let interval = interval.map_or(String::new(), |[low, high]| {
        format!(
            ", 95 % interval {:.1} to {:.1} {unit}",
            of_si * low,
            of_si * high
        )
    });
    let names = names(columns, model);
    format!(
        "{names} {are} {off:.3} {si} off ({:.1} {unit}{interval})",
        of_si * off
    )
}

fn what(found: &LogFault, model: &Model) -> String {
    match &found.trial.correction {
        Correction::Reverse(columns) => {
            let count = if columns.len() > 1 { "count" } else { "counts" };
            format!("{} {count} the other way round", names(columns, model))
        }
        Correction::AngleZero(zero) => {
            let place = zero.name();
            format!("the angles are zero where the first link is {place}")
        }
        Correction::Offset(columns, added) => {
            let interval = found.zero.map(|zero| zero.interval.map(|added| -added));
            zero_off(
                columns,
                -added,
                interval.map(|[low, high]| [high, low]),
                model,
            )
        }
        Correction::Unit(columns) => {
            let each = columns
                .iter()
                .map(|(column, unit)| written_in(*column, unit, model));
            each.collect::<Vec<_>>().join(", ")
        }
        Correction::Angles(angles) => {
            let from = match angles {
                Angles::Relative => "the link before",
                Angles::Absolute => "the world",
            };
            format!("each angle is measured from {from}")
        }
        Correction::Drive(joint, drive, unit) => {
            let input = name(LogColumn::Input(*joint), model);
            let meaning = match drive.name() {
                "torque" => "a torque",
                "duty" => "a share of the full voltage",
                "position" => "a goal angle",
                _ => "a goal speed",
            };
            let joint = joint + 1;
            format!(
                "{input} is {meaning} in {}, so joint {joint} is another drive",
                unit.name
            )
        }
        Correction::Shift(quantity, shift_s) => {
            let when = if *shift_s > 0.0 { "later" } else { "earlier" };
            let ms = 1e3 * shift_s.abs();
            format!(
                "{} was taken {ms:.0} ms {when} than its rows say",
                name(*quantity, model)
            )
        }
    }
}

/// In which unit a column is written, and in which the model says it is.
fn written_in(quantity: LogColumn, unit: &Unit, model: &Model) -> String {
    let declared = quantity
        .column(model)
        .map_or("?", |column| column.unit.name);
    let ticks = match unit.name {
        "ticks" if unit.dimension == Dimension::Length => {
            format!(" of {:.0} a metre", 1.0 / unit.si)
        }
        "ticks" => format!(" of {:.0} a turn", std::f64::consts::TAU / unit.si),
        _ => String::new(),
    };
    let name = name(quantity, model);
    format!(
        "{name} is written in {}{ticks}, not in {declared}",
        unit.name
    )
}

/// "as given the model leaves 83 % of the motion unexplained, 512 mrad; so read, 4 %, 21 mrad".
fn proof(trial: &Trial, model: &Model) -> String {
    let milli = milli(model);
    format!(
        "as given the model leaves {} of the motion unexplained ({} {milli}), with the remedy {} \
         ({} {milli})",
        percent(trial.before),
        mrad(trial.before_rad),
        percent(trial.after),
        mrad(trial.after_rad),
    )
}

/// The unit of errors of all joints together: mm where all slide.
fn milli(model: &Model) -> &'static str {
    let signals: Vec<MeasuredSignal> = model.log.joints.iter().map(JointColumns::signal).collect();
    MeasuredSignal::pooled(&signals).milli()
}

fn percent(share: f64) -> String {
    if share >= 0.095 {
        format!("{:.0} %", 100.0 * share)
    } else {
        format!("{:.1} %", 100.0 * share)
    }
}

fn mrad(rad: f64) -> String {
    crate::output::number::mrad_in_column(rad)
}

/// The lines of the model file that a correction changes: `arm.toml:13: position = { .. }`.
fn lines(correction: &Correction, model: &Model, file: ModelFile) -> Result<String> {
    let old = Model::parse(file.text, file.path)?;
    // What was mended before is in `model`, and so in the lines.
    let text = set_reading(file.text, file.path, &old, &correction.applied(model))?;
    let changed = changed_lines(file.text, &text)
        .into_iter()
        .map(|(number, line)| {
            let place = Place {
                line: number,
                ..Place::file(file.path)
            };
            format!("write in {place}: {line}")
        });
    Ok(changed.collect::<Vec<_>>().join(", "))
}

/// A motion with the log it came from, and its first data row there.
pub(super) struct Origin {
    pub log: String,
    pub first_row: usize,
}

/// Most rows ranges that a remedy names.
const MOST_RANGES: usize = 5;

/// What cannot be used, with the rows that can.
pub(super) fn unusable(
    left_out: &LeaveOut,
    model: &Model,
    motions: &[Motion],
    origins: &[Origin],
) -> LogFinding {
    let name = name(left_out.column, model);
    let motion = left_out.runs.first().map_or(0, |(motion, _)| *motion);
    let (longest_s, count) = (left_out.longest_s, left_out.runs.len());
    let lower = left_out.after < left_out.before;
    let what = match left_out.why {
        Unusable::Stalled => format!("{name} does not change for {longest_s:.1} s"),
        Unusable::Clipped => {
            format!("{name} sits at a limit {count} times, up to {longest_s:.2} s")
        }
        Unusable::HeldByHand => format!(
            "the rig stands still for {longest_s:.2} s where it would fall, with nothing driving \
             it: a hand holds it"
        ),
    };
    let milli = milli(model);
    let proof = format!(
        "with those rows the model leaves {} of the motion unexplained ({} {milli}), without {} \
         ({} {milli})",
        percent(left_out.before),
        mrad(left_out.before_rad),
        percent(left_out.after),
        mrad(left_out.after_rad),
    );
    let kept = kept(left_out, motions, origins);
    LogFinding {
        kind: match left_out.why {
            Unusable::Stalled => "stalled",
            Unusable::Clipped => "clipped",
            Unusable::HeldByHand => "by_hand",
        },
        // What a hand does no effect explains, and every effect is bent to it.
        severity: match left_out.why {
            Unusable::HeldByHand => Severity::Refuse,
            Unusable::Stalled | Unusable::Clipped => Severity::Warn,
        },
        place: motions
            .get(motion)
            .map(|motion| Place::file(&motion.source.path)),
        what: match lower {
            _ if left_out.why == Unusable::HeldByHand => what,
            true => format!("{what}; {proof}"),
            false => format!("{what}; the model is at rest there too, so they teach nothing"),
        },
        remedy: match kept.as_slice() {
            [] => "record again: no rows are left".to_string(),
            kept => format!("leave the rows out: name the log as {}", kept.join(" ")),
        },
        proof: lower.then_some(Proof {
            before_rad: left_out.before_rad,
            after_rad: left_out.after_rad,
            before_share: left_out.before,
            after_share: left_out.after,
        }),
    }
}

/// The longest ranges of rows without the samples to be left out, as log arguments.
fn kept(left_out: &LeaveOut, motions: &[Motion], origins: &[Origin]) -> Vec<String> {
    let mut ranges: Vec<(usize, usize, usize)> = Vec::new();
    for (index, (motion, origin)) in motions.iter().zip(origins).enumerate() {
        let mut runs = left_out.runs.iter().filter(|(m, _)| *m == index).peekable();
        if runs.peek().is_none() {
            continue;
        }
        let mut from = 0;
        let ends = [(index, motion.len()..motion.len())];
        for (_, run) in runs.chain(&ends) {
            if run.start >= from + crate::log::LEAST_ROWS {
                ranges.push((
                    index,
                    origin.first_row + from,
                    origin.first_row + run.start - 1,
                ));
            }
            from = run.end;
        }
    }
    ranges.sort_by_key(|(_, from, to)| std::cmp::Reverse(to - from));
    ranges.truncate(MOST_RANGES);
    ranges.sort();
    let named = ranges
        .into_iter()
        .map(|(index, from, to)| format!("{}:{from}-{to}", origins[index].log));
    named.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_joints_that_slide_are_in_mm() {
        let rig = |axis: &str, unit: &str| {
            let text = format!(
                "[rig]\nname = \"a\"\nangle_zero = \"hanging\"\n[[link]]\ncom_m = 0.1\nmass_kg = 0.2\n\
                 inertia_kg_m2 = 1e-3\n[[joint]]\ndrive = \"torque\"\n{axis}[log]\n\
                 time = {{ column = \"t\", unit = \"s\" }}\n[[log.joint]]\n\
                 position = {{ column = \"x\", unit = \"{unit}\" }}\n\
                 input = {{ column = \"u\", unit = \"{}\" }}\n",
                if unit == "m" { "N" } else { "N m" }
            );
            Model::parse(&text, Path::new("a.toml")).unwrap()
        };
        assert_eq!(
            milli(&rig(
                "axis = \"slide\"\nslide_rad = 1.5707963267948966\n",
                "m"
            )),
            "mm"
        );
        assert_eq!(milli(&rig("", "rad")), "mrad");
    }
}
