//! What the check says of a spoiled log, and what that is worth.

use super::rig::Rig;
use super::spoiling::Spoiling;
use handstand::diagnose::conventions::{
    LeaveOut, LogColumn, Unusable, leave_out, search, unexplained,
};
use serde::Serialize;
use std::time::Instant;

/// A spoiling that raises the error by less cannot be seen by any simulation.
const SEEN: f64 = 1.25;

/// What an answer is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Answer {
    /// The right remedy, alone or among those that lower the error as far.
    Right,
    /// Another remedy.
    Other,
    /// No remedy.
    Missed,
    /// No remedy, and the model does as well on the spoiled log as on the log itself: a mirrored
    /// pendulum, the sign of an input that is zero.
    Unseen,
}

/// One spoiled log judged.
#[derive(Debug, Clone, Serialize)]
pub struct Outcome {
    /// The log.
    pub log: String,
    /// The kind of spoiling; none for the log as it is.
    pub spoiling: Option<&'static str>,
    /// Which joint, or which column: for people.
    pub detail: String,
    /// What that is worth.
    pub answer: Answer,
    /// What the check proposes, for people.
    pub said: Vec<String>,
    /// Share of the motion that is unexplained without spoiling, and with it, where no remedy was
    /// given.
    pub unexplained: [Option<f64>; 2],
    /// How long the check took, s.
    pub seconds: f64,
}

/// Judges the log as it is: everything said is an alarm, but for a run that failed.
pub fn unspoiled(rig: &Rig) -> Outcome {
    let begun = Instant::now();
    let found = search(&rig.model, &rig.motions);
    let left_out = leave_out(&rig.model, &rig.motions);
    let alarms = left_out
        .iter()
        .filter(|l| !(rig.failed_run && l.why == Unusable::Stalled));
    let quiet = found.is_empty() && alarms.count() == 0;
    Outcome {
        log: rig.name.clone(),
        spoiling: None,
        detail: String::new(),
        answer: if quiet { Answer::Right } else { Answer::Other },
        said: said(&found, &left_out),
        unexplained: [None, None],
        seconds: begun.elapsed().as_secs_f64(),
    }
}

/// Spoils the rig's log and judges it.
pub fn judge(rig: &Rig, spoiling: Spoiling) -> Outcome {
    let spoiled = spoiling.applied(rig);
    let begun = Instant::now();
    let found = search(&spoiled.model, &spoiled.motions);
    let left_out = leave_out(&spoiled.model, &spoiled.motions);
    let seconds = begun.elapsed().as_secs_f64();
    let trials = found
        .iter()
        .flat_map(|f| std::iter::once(&f.trial).chain(&f.rivals));
    let right = trials
        .clone()
        .any(|trial| spoiling.mended_by(&trial.correction, rig, &spoiled))
        || left_out
            .iter()
            .any(|left_out| leaves_out(spoiling, left_out));
    let mut shares = [None, None];
    let answer = match right {
        true => Answer::Right,
        false if !found.is_empty() => Answer::Other,
        // Units of time and joints that stand still can always be seen.
        false if matches!(spoiling, Spoiling::Milliseconds | Spoiling::Stalled) => Answer::Missed,
        false => {
            shares[0] = unexplained(&rig.model, &rig.motions);
            shares[1] = unexplained(&spoiled.model, &spoiled.motions);
            match shares {
                [Some(before), Some(after)] if after < SEEN * before => Answer::Unseen,
                [_, None] => Answer::Unseen,
                _ => Answer::Missed,
            }
        }
    };
    Outcome {
        log: rig.name.clone(),
        spoiling: Some(spoiling.kind()),
        detail: format!("{spoiling:?}"),
        answer,
        said: said(&found, &left_out),
        unexplained: shares,
        seconds,
    }
}

fn leaves_out(spoiling: Spoiling, left_out: &LeaveOut) -> bool {
    match spoiling {
        Spoiling::Stalled => left_out.why == Unusable::Stalled,
        Spoiling::Clipped(joint) => {
            left_out.why == Unusable::Clipped && left_out.column == LogColumn::Input(joint)
        }
        _ => false,
    }
}

pub(crate) fn said(
    found: &[handstand::diagnose::conventions::LogFault],
    left_out: &[LeaveOut],
) -> Vec<String> {
    let trials = found
        .iter()
        .flat_map(|f| std::iter::once(&f.trial).chain(&f.rivals));
    let trials = trials.map(|t| {
        let (ratio, before, after, better) = (t.ratio(), t.before, t.after, t.better);
        format!(
            "{:?}: {before:.3} -> {after:.3} ({ratio:.2}, better {better:.2})",
            t.correction
        )
    });
    let left_out = left_out.iter().map(|l| {
        format!(
            "{:?} {:?}: {:.3} -> {:.3}, {} runs",
            l.why,
            l.column,
            l.before,
            l.after,
            l.runs.len()
        )
    });
    trials.chain(left_out).collect()
}
