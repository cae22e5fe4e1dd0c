//! A diagnosis from beginning to end: one search, or two, and what the verdict rests on.
//!
//! Where a search explains nothing a second one spares no candidate. Of what is found, the values
//! are fitted as exactly as they are stated, and placebos, other motions held out and explanations
//! with the same predictions are looked for.

use super::budget::{STRUCTURE_STEPS, steps_up_to};
use super::conclusion::conclude;
use super::consistency::OwnFits;
use super::evaluator::{Evaluator, Reach, every_change};
use super::explanation::{Explanation, Tried, VerdictEvidence};
use super::findings::Diagnosis;
use super::hypothesis::Hypothesis;
use super::options::DiagnoseOptions;
use super::progress::STRUCTURE;
use super::stability::folds;
use crate::effects::{CONTROLS, PLACEBO};
use crate::fitting::{Candidate, Progress, stated_from};
use crate::log::Motion;
use crate::model::Model;

/// A placebo that gains this share of what the chosen set does on the short windows, both in
/// factors of the error, is evaluated: half of the share that would make it rank.
const RANKING: f64 = 0.25;

/// Searches for the effects a model is missing.
///
/// `training` motions are fitted; `held_out` motions decide. Without held-out motions the training
/// motions decide, and the diagnosis says so.
pub fn diagnose(
    model: &Model,
    training: Vec<Motion>,
    held_out: Vec<Motion>,
    options: &DiagnoseOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Diagnosis {
    let mut model = model.clone();
    model.free.retain(|path| !options.known.contains(path));
    let searched = |reach| {
        let (training, held_out) = (training.clone(), held_out.clone());
        let evaluator = Evaluator::new(&model, training, held_out, options, reach, progress);
        Searched::by(evaluator)
    };
    let mut found = searched(Reach::Promising);
    if !found.is_explained() && found.evaluator.most_effects > 1 {
        let further = searched(Reach::Everything);
        if further.is_explained() {
            found = further;
        }
    }
    let Searched {
        evaluator,
        mut tried,
    } = found;
    let own_fits = evaluator.tell_motions_apart(&mut tried);
    evaluator.settle(&mut tried);
    let explanation = tried.explanation(&evaluator);
    let equivalents = evaluator.equivalents(explanation, &tried.hypotheses);
    let mut evidence = VerdictEvidence {
        evaluator: &evaluator,
        tried: &tried,
        explanation,
        equivalents: &equivalents,
        placebos: match explanation {
            Explanation::Effects(chosen) => evaluator.try_placebos(chosen),
            _ => Vec::new(),
        },
        residual_structure: None,
        per_motion_reduction: None,
        folds: Vec::new(),
        seed: options.seed,
    };
    evidence.residual_structure = evaluator.residual_structure(evidence.chosen());
    if !matches!(evidence.explanation, Explanation::Given(_)) {
        evidence.folds = folds(&evaluator, evidence.reference(), evidence.chosen());
    }
    evidence.per_motion_reduction = own_fits
        .as_ref()
        .and_then(|own| own.reduction(evidence.chosen()));
    let diagnosis = conclude(&evidence);
    evaluator.steps.step(STRUCTURE_STEPS);
    diagnosis
}

/// A search that was done, and what it tried.
pub(super) struct Searched<'a> {
    evaluator: Evaluator<'a>,
    tried: Tried,
}

impl<'a> Searched<'a> {
    pub fn by(mut evaluator: Evaluator<'a>) -> Self {
        let (best, hypotheses) = evaluator.search();
        let all = steps_up_to(evaluator.most_effects, evaluator.candidates.len());
        evaluator.steps.begin(STRUCTURE, all);
        let least = best.as_ref().unwrap_or(&evaluator.base).search_mean;
        let tried = Tried {
            values: evaluator.try_values(Some(least)),
            values_refitted: evaluator.try_values_refitted(Some(least)),
            hypotheses,
            best,
        };
        Searched { evaluator, tried }
    }

    /// Whether what it found leaves nothing to explain.
    pub fn is_explained(&self) -> bool {
        match self.tried.explanation(&self.evaluator) {
            Explanation::Effects(set) => self.evaluator.is_explained_by(set),
            other => self.evaluator.at_noise_floor(other.hypothesis()),
        }
    }
}

impl Evaluator<'_> {
    /// Fits of the explanation to each motion by itself. Where values that one motion found suit
    /// all of them better than those found for all, the best set takes these.
    fn tell_motions_apart(&self, tried: &mut Tried) -> Option<OwnFits> {
        let explanation = tried.explanation(self);
        let own = OwnFits::of(explanation.hypothesis(), &self.training)?;
        if let Explanation::Effects(best) = explanation
            && let Some(fit) = own.fit_to_all(best, &self.training)
        {
            let mut best = best.clone();
            best.judge(fit, &self.training, self.held_out.as_ref());
            tried.best = Some(best);
        }
        Some(own)
    }

    /// Fits the best set, where it is the explanation, as exactly as its values are stated, from
    /// the values of the given model too.
    fn settle(&self, tried: &mut Tried) {
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
