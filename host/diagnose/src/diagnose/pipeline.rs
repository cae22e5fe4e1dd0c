//! A diagnosis from beginning to end: one search, or two, and what the verdict rests on.
//!
//! Where a search explains nothing in windows that the model loses, a second one in others spares
//! no candidate. Of what is found, the values are fitted as exactly as they are stated, and
//! placebos, other motions held out and explanations with the same predictions are looked for.

use super::budget::JUDGING_STEPS;
use super::conclusion::conclude;
use super::consistency::OwnFits;
use super::evaluator::{Evaluator, Reach, every_change};
use super::explanation::{Explanation, SearchOutcome, VerdictEvidence};
use super::findings::{Diagnosis, SearchEnded};
use super::hypothesis::Hypothesis;
use super::options::DiagnoseOptions;
use super::progress::{Course, Stage};
use super::search::SearchResults;
use super::stability::folds;
use super::strategy::Strategy;
use super::turns::{Turn, turns};
use super::verdict::MOST_NOMINAL;
use crate::effects::{CONTROLS, PLACEBO};
use crate::fitting::{Candidate, Progress, stated_from};
use crate::model::Model;
use crate::motion::{Motion, Split};

/// A placebo that gains this share of what the chosen set does on the short windows, both in
/// factors of the error, is evaluated: half of the share that would make it rank.
const RANKING: f64 = 0.25;

/// Searches for the effects a model is missing.
///
/// `training` motions are fitted; `held_out` motions decide. Without held-out motions the training
/// motions decide, and the diagnosis says so. Where those held out alone show something they are
/// learned from, too: [`Diagnosis::motions`] says which were held out in the end.
///
/// Where its time is over, or [`StopSwitch::accept`](crate::fitting::StopSwitch::accept) asks for
/// it, the best so far is judged; the diagnosis says what was left out. By
/// [`StopSwitch::abandon`](crate::fitting::StopSwitch::abandon) it unwinds with
/// [`Abandoned`](crate::fitting::Abandoned).
pub fn diagnose(
    model: &Model,
    training: Vec<Motion>,
    held_out: Vec<Motion>,
    options: &DiagnoseOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Diagnosis {
    let course = Course::new(options, progress);
    let split = Split { training, held_out };
    diagnose_on(&course, model, &split, true, options).0
}

/// The same of motions to fit and motions held out, on a course whose clock runs already, and the
/// split that it rests on in the end. Other motions are held out than those that are only where it
/// `may_split` them.
pub(super) fn diagnose_on(
    course: &Course,
    model: &Model,
    split: &Split,
    may_split: bool,
    options: &DiagnoseOptions,
) -> (Diagnosis, Split) {
    let mut model = model.clone();
    model.free.retain(|path| !options.known.contains(path));
    let evaluator_of = |split: &Split, reach| {
        let (training, held_out) = (split.training.clone(), split.held_out.clone());
        Evaluator::new(&model, training, held_out, options, reach, course.clone())
    };
    let evaluator = |reach| evaluator_of(split, reach);
    let mut found = FinishedSearch::by(evaluator(Reach::Promising));
    let takes_turns = found.evaluator.does(Strategy::Turns);
    if takes_turns && found.ended == SearchEnded::Complete && !found.is_explained() {
        for turn in turns(&found.evaluator, split, may_split) {
            let turned = course
                .halt
                .until(|| evaluator_of(&turn.split, Reach::Promising));
            match turned.map(FinishedSearch::by) {
                Ok(turned) if turned.explains_all() => {
                    let Turn { split, shows_alone } = turn;
                    let turned = FinishedSearch {
                        shows_alone,
                        ..turned
                    };
                    return (turned.judged(options.seed), split);
                }
                Ok(turned) if turned.left_out.is_empty() => {}
                _ => {
                    found.end_early(TURNS);
                    break;
                }
            }
        }
    }
    if found.may_go_on() {
        // The first one's evaluator stands, whatever becomes of this one.
        let further = course.halt.until(|| evaluator(Reach::Everything));
        found.take(further.map(FinishedSearch::by).ok());
    }
    (found.judged(options.seed), split.clone())
}

/// A search that was done, and what it tried.
pub(super) struct FinishedSearch<'a> {
    evaluator: Evaluator<'a>,
    tried: SearchOutcome,
    ended: SearchEnded,
    /// What it did not try because it was ended.
    left_out: Vec<String>,
    /// Motions that alone show what it found, where none proves it.
    shows_alone: Vec<String>,
}

impl<'a> FinishedSearch<'a> {
    pub fn by(mut evaluator: Evaluator<'a>) -> Self {
        let course = evaluator.course.clone();
        course.keep_time();
        let mut found = SearchResults::at_start();
        let halted = course.halt.until(|| evaluator.search(&mut found)).is_err();
        let mut left_out = Vec::new();
        if halted {
            evaluator.keep_evaluated(&mut found);
            left_out = found.not_tried(evaluator.most_effects);
        }
        FinishedSearch {
            ended: match (halted, found.is_tolerated) {
                (true, _) if course.is_accepted() => SearchEnded::Stopped,
                (true, _) => SearchEnded::Time,
                (false, true) => SearchEnded::Tolerance,
                (false, false) => SearchEnded::Complete,
            },
            tried: SearchOutcome {
                values: found.values,
                values_refitted: found.values_refitted,
                hypotheses: found.sizes.into_iter().flatten().collect(),
                best: found.best,
            },
            evaluator,
            left_out,
            shows_alone: Vec::new(),
        }
    }

    /// Whether what it found leaves nothing to explain.
    pub fn is_explained(&self) -> bool {
        match self.tried.explanation(&self.evaluator) {
            Explanation::Effects(set) => self.evaluator.is_explained_by(set),
            other => self.evaluator.at_noise_floor(other.hypothesis()),
        }
    }

    /// Whether something beyond the model as given leaves nothing to explain in any motion.
    fn explains_all(&self) -> bool {
        let explanation = self.tried.explanation(&self.evaluator);
        let is_found = !matches!(explanation, Explanation::Given(_));
        let evaluation = explanation.hypothesis().evaluation.as_ref();
        let errors = evaluation.map(|e| [Some(&e.training), e.held_out.as_ref()]);
        let mut errors = errors.into_iter().flatten().flatten();
        let is_noise = errors.all(|errors| errors.worst_motion().sqrt() <= MOST_NOMINAL);
        is_found && self.ended == SearchEnded::Complete && self.is_explained() && is_noise
    }

    /// Notes that a part of it was not done, or not to its end.
    fn end_early(&mut self, part: &str) {
        self.ended = if self.evaluator.course.is_accepted() {
            SearchEnded::Stopped
        } else {
            SearchEnded::Time
        };
        self.left_out.push(part.to_string());
    }

    /// Whether a second search follows. Where this one was ended, it is left out.
    fn may_go_on(&mut self) -> bool {
        let is_needed = self.ended != SearchEnded::Tolerance
            && self.evaluator.most_effects > 1
            && !self.evaluator.tries_all
            && self.evaluator.does(Strategy::SecondSearch)
            && !self.is_explained();
        let was_ended = !self.left_out.is_empty();
        if is_needed && was_ended {
            self.left_out.push(SECOND.to_string());
        }
        is_needed && !was_ended
    }

    /// Takes what the second search found in place of what this one did where it explains all;
    /// `None` where it was ended before it began.
    fn take(&mut self, further: Option<FinishedSearch<'a>>) {
        match further {
            Some(further) if further.is_explained() => *self = further,
            Some(further) if further.ended == SearchEnded::Complete => {}
            Some(further) if further.ended == SearchEnded::Tolerance => *self = further,
            ended => {
                let part = if ended.is_some() { "part of " } else { "" };
                self.end_early(&format!("{part}{SECOND}"));
            }
        }
    }

    /// The diagnosis that what was found allows.
    fn judged(self, seed: u64) -> Diagnosis {
        let FinishedSearch {
            evaluator,
            mut tried,
            ended,
            left_out,
            shows_alone,
        } = self;
        let course = evaluator.course.clone();
        course.begin(Stage::Judging, evaluator.round(), JUDGING_STEPS);
        let mut judging = course.judging(!left_out.is_empty());
        let own_fits = judging.part("the fit of each motion by itself", 0.25, || {
            let explanation = tried.explanation(&evaluator);
            OwnFits::of(explanation.hypothesis(), &evaluator.training)
        });
        judging.part("the values to their last digit", 0.35, || {
            evaluator.settle(&mut tried)
        });
        let explanation = tried.explanation(&evaluator);
        let mut evidence = VerdictEvidence {
            evaluator: &evaluator,
            tried: &tried,
            explanation,
            equivalents: Vec::new(),
            placebos: Vec::new(),
            residual_structure: None,
            per_motion_reduction: None,
            folds: Vec::new(),
            seed,
            ended,
            left_out,
            shows_alone,
        };
        course.step(1);
        let structure = judging.part("the structure of what is left", 0.4, || {
            evaluator.residual_structure(evidence.chosen())
        });
        evidence.residual_structure = structure.flatten();
        course.step(1);
        if let Explanation::Effects(chosen) = explanation {
            let placebos = judging.part("placebos", 0.4, || evaluator.try_placebos(chosen));
            evidence.placebos = placebos.unwrap_or_default();
        }
        course.step(1);
        if !matches!(explanation, Explanation::Given(_)) {
            let folds = judging.part("other motions held out", 0.4, || {
                folds(&evaluator, evidence.reference(), evidence.chosen())
            });
            evidence.folds = folds.unwrap_or_default();
        }
        course.step(1);
        let equivalents = judging.part("explanations with the same predictions", 0.5, || {
            evaluator.equivalents(explanation, &tried.hypotheses)
        });
        evidence.equivalents = equivalents.unwrap_or_default();
        evidence.per_motion_reduction = own_fits
            .flatten()
            .as_ref()
            .and_then(|own| own.reduction(evidence.chosen()));
        evidence.left_out.extend(judging.take_left_out());
        course.step(1);
        let diagnosis = conclude(&evidence, &mut judging);
        course.step(JUDGING_STEPS);
        diagnosis
    }
}

/// The search that spares no candidate, in words.
const SECOND: &str = "the second search";
/// The searches that learn from motions held out, in words.
const TURNS: &str = "what motions held out alone show";

impl Evaluator<'_> {
    /// Fits the best set, where it is the explanation, as exactly as its values are stated, from
    /// the values of the given model too.
    fn settle(&self, tried: &mut SearchOutcome) {
        if let Explanation::Effects(best) = tried.explanation(self) {
            let mut best = best.clone();
            let found = best.fit().clone();
            let added = found.model.effects[self.start.effects.len()..].iter();
            let mut given = self.start.clone();
            given.effects.extend(added.cloned());
            let settled = stated_from(found, &given, &self.training);
            best.judge(settled, &self.training, self.held_out.as_ref());
            tried.best = Some(best);
        }
    }

    /// A placebo regressor at each joint, fitted and evaluated like a candidate; those that gain
    /// next to nothing on the short windows are not evaluated.
    pub(super) fn try_placebos(&self, chosen: &Hypothesis) -> Vec<Hypothesis> {
        let placebo = CONTROLS.iter().filter(|e| e.info().id == PLACEBO);
        let at_joints = |&effect| {
            let joints = (0..self.start.link_count()).map(Some);
            joints.map(move |joint| Candidate { effect, joint })
        };
        let placebos: Vec<Candidate> = placebo.flat_map(at_joints).collect();
        let changes = every_change(&self.base, &placebos, &self.search);
        let mut placebos = self.first_look(&self.base, &changes, 1);
        let gain = |h: &Hypothesis| (self.base.search_mean / h.search_mean).ln();
        placebos.retain(|placebo| gain(placebo) > RANKING * gain(chosen));
        for placebo in &mut placebos {
            self.evaluate(placebo);
        }
        placebos
    }
}
