//! Motions take turns: where the fitted ones leave only noise and others, held out, do not, what is
//! missing shows in the latter alone. Some of them are then learned from, and another proves it;
//! where there is no other, all are learned from and nothing is claimed that one motion alone
//! shows.

use super::evaluator::Evaluator;
use super::hypothesis::Evaluation;
use super::verdict::MOST_NOMINAL;
use crate::motion::{Motion, Split};

/// Share of the motions that show something which prove it, where there are several.
const PROVING: f64 = 1.0 / 3.0;

/// Another split, in which what only motions held out show can be learned.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Turn {
    pub split: Split,
    /// Names of the motions that alone show it, where none of them is left to prove it.
    pub shows_alone: Vec<String>,
}

/// The splits to try, the best first; none where the fitted motions show something, too. Without
/// `may_prove` none that holds out other motions than before.
pub(super) fn turns(evaluator: &Evaluator, split: &Split, may_prove: bool) -> Vec<Turn> {
    let Some(evaluation) = &evaluator.base.evaluation else {
        return Vec::new();
    };
    if shows_something(evaluation) {
        return Vec::new();
    }
    let held_out = evaluation.held_out.as_ref();
    let means = held_out.map(|errors| errors.motion_means());
    let shown: Vec<bool> = means.iter().flatten().map(is_shown).collect();
    splits(split, &shown, may_prove)
}

/// Whether a fitted motion shows something beyond noise.
pub(super) fn shows_something(evaluation: &Evaluation) -> bool {
    let fitted = evaluation.training.motion_means();
    fitted.iter().any(is_shown)
}

fn is_shown(mean: &f64) -> bool {
    mean.sqrt() > MOST_NOMINAL
}

/// The same where these of the motions held out show something.
fn splits(split: &Split, shown: &[bool], may_prove: bool) -> Vec<Turn> {
    let marked = || split.held_out.iter().zip(shown);
    let showing: Vec<&Motion> = marked().filter_map(|(m, s)| s.then_some(m)).collect();
    if showing.is_empty() {
        return Vec::new();
    }
    let mut turns = Vec::new();
    if showing.len() > 1 && may_prove {
        let proving = (PROVING * showing.len() as f64).ceil() as usize;
        let (learned, proving) = showing.split_at(showing.len() - proving);
        let others = marked().filter_map(|(m, s)| (!s).then_some(m));
        turns.push(Turn {
            split: Split {
                training: (split.training.iter().chain(learned.iter().copied()))
                    .cloned()
                    .collect(),
                held_out: proving.iter().copied().chain(others).cloned().collect(),
            },
            shows_alone: Vec::new(),
        });
    }
    turns.push(Turn {
        split: Split {
            training: [split.training.as_slice(), &split.held_out].concat(),
            held_out: Vec::new(),
        },
        shows_alone: showing.iter().map(|motion| motion.name.clone()).collect(),
    });
    turns
}

#[cfg(test)]
mod tests;
