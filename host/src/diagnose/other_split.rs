//! Other logs held out, where what is missing shows in fitted ones alone.
//!
//! Which logs judge is the user's choice, or chance. Where several fitted ones show what those held
//! out do not, one of them can prove it: it is held out too.

use super::findings::{Diagnosis, Verdict};
use super::one_sided::shows;
use crate::log::{LogRequest, LogSet, Motion, Split};

/// The logs with one more held out: of the fitted ones that show what is missing, the one that shows
/// least. None where those held out show it too, or fewer than two of the others do; or where a log
/// of several motions is fitted in part.
pub(super) fn one_more_held_out(
    diagnosis: &Diagnosis,
    logs: &LogSet,
    split: &Split,
) -> Option<(LogSet, LogRequest)> {
    let found_nothing = diagnosis.effects.is_empty() && diagnosis.wrong_values.is_empty();
    let is_open = diagnosis.verdict == Verdict::Unexplained && found_nothing;
    if !is_open || !diagnosis.error.held_out {
        return None;
    }
    let motions = split.training.iter().chain(&split.held_out);
    let mut showing: Vec<(f64, &Motion)> = Vec::new();
    for (motion, error) in motions.zip(&diagnosis.motions) {
        match (shows(diagnosis, error), error.held_out) {
            (true, true) => return None,
            (true, false) => showing.push((error.after_rad, motion)),
            _ => {}
        }
    }
    let (_, least) = showing.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let is_from = |log: &LogRequest, motion: &Motion| motion.source.path == log.path;
    let mut logs_showing = showing.iter().map(|(_, motion)| &motion.source.path);
    if logs_showing.all(|path| *path == least.source.path) {
        return None;
    }
    let (held_out, training): (Vec<LogRequest>, Vec<LogRequest>) =
        logs.all().into_iter().partition(|log| {
            let held_out = split.held_out.iter().any(|motion| is_from(log, motion));
            held_out || is_from(log, least)
        });
    let moved = logs
        .training
        .iter()
        .find(|log| is_from(log, least))?
        .clone();
    let in_part = split.training.iter().any(|motion| {
        let from_held_out = split
            .held_out
            .iter()
            .any(|h| h.source.path == motion.source.path);
        from_held_out || moved.rows.is_some() && motion.source.path == moved.path
    });
    (!in_part).then_some((LogSet { training, held_out }, moved))
}
