//! What every hypothesis is fitted to and judged by: the motions cut for the search and for the
//! evaluation, the base model fitted, the candidates.

use super::block_errors::AT_NOISE_FLOOR;
use super::budget::{FEW_SAMPLES, FINISH, planned_steps};
use super::candidates::candidates;
use super::findings::ResidualStructure;
use super::horizon::{longest_useful, search_horizon};
use super::hypothesis::{Evaluation, Hypothesis};
use super::initial_guess::{PredictionChange, changes};
use super::multistart::base_fit;
use super::options::DiagnoseOptions;
use super::progress::{Progress, StepCounter};
use super::residual_structure::residual_structure;
use crate::fitting::{Candidate, FitData, Horizon};
use crate::log::Motion;
use crate::model::Model;
use rayon::prelude::*;

/// Iterations over the evaluation horizon, from what the windows found.
const EVALUATE: usize = 12;
/// The first windows to evaluate over where no model follows a whole motion, s.
const LONGEST_WINDOW_S: f64 = 4.0;

/// What every hypothesis is fitted to and judged by.
pub(super) struct Evaluator<'a> {
    /// Training motions in short windows, to search on.
    pub search: FitData,
    /// Training motions over the evaluation horizon.
    pub training: FitData,
    /// Held-out motions over the evaluation horizon.
    pub held_out: Option<FitData>,
    pub base: Hypothesis,
    pub horizon: Horizon,
    /// Whether the user has chosen it.
    horizon_given: bool,
    /// How long the windows of `search` are.
    pub search_horizon: Horizon,
    pub placebos: Vec<Hypothesis>,
    pub candidates: Vec<Candidate>,
    /// What each start of each candidate changes in the base model's prediction.
    pub changes: Vec<Vec<PredictionChange>>,
    /// The model as it came.
    pub start: Model,
    pub seed: u64,
    /// Most effects named together.
    pub most_effects: usize,
    pub steps: StepCounter<'a>,
}

impl<'a> Evaluator<'a> {
    pub fn new(
        model: &Model,
        training: Vec<Motion>,
        held_out: Vec<Motion>,
        options: &DiagnoseOptions,
        progress: &'a (dyn Fn(Progress) + Sync),
    ) -> Evaluator<'a> {
        let all = [training.as_slice(), held_out.as_slice()].concat();
        let candidates = candidates(model, &all, &options.without);
        // Without motions to judge by, two effects together can't be told from luck.
        let most_effects = match held_out.is_empty() {
            true => 1,
            false => options.most_effects,
        };
        let steps = StepCounter::new(planned_steps(candidates.len(), most_effects), progress);
        let whole = FitData::new(model, training, Horizon::Whole);
        let longest = options.horizon.unwrap_or(Horizon::Whole);
        let few = held_out.is_empty() && whole.samples() < FEW_SAMPLES;
        let search_horizon = search_horizon(&whole, longest, few);
        let search = whole.recut(search_horizon);
        let fitted = base_fit(model, &search, few, options.seed);
        let mut base = Hypothesis::new(Vec::new(), fitted);
        let (horizon, training) = match options.horizon {
            Some(horizon) => (horizon, whole.recut(horizon)),
            None => longest_useful(&base.search.model, &whole, longest),
        };
        let held_out = (!held_out.is_empty())
            .then(|| FitData::new(model, held_out, horizon).weighted_like(&training));
        base.evaluate(&training, held_out.as_ref(), FINISH);
        let changes = every_change(&base, &candidates, &search);
        Evaluator {
            search,
            training,
            held_out,
            base,
            horizon,
            horizon_given: options.horizon.is_some(),
            search_horizon,
            placebos: Vec::new(),
            candidates,
            changes,
            start: model.clone(),
            seed: options.seed,
            most_effects,
            steps,
        }
    }

    /// What a hypothesis leaves to explain: in short windows or over the evaluation horizon,
    /// whichever shows more with certainty.
    ///
    /// A large structure is best seen in windows, over which the simulation can be taken for
    /// linear; a small one shows only over the longer horizon.
    pub fn residual_structure(&self, hypothesis: &Hypothesis) -> Option<ResidualStructure> {
        let held_out = self.held_out.as_ref()?;
        let unseen = held_out.recut(self.search_horizon);
        let short = residual_structure(&hypothesis.search, &self.search, &unseen, self.seed);
        let evaluation = hypothesis.evaluation.as_ref();
        let long = evaluation
            .and_then(|e| residual_structure(&e.fit, &self.training, held_out, self.seed));
        let both = [short, long].into_iter().flatten();
        both.max_by(|a, b| a.explainable_low.total_cmp(&b.explainable_low))
    }

    /// Whether a hypothesis leaves nothing but noise.
    pub fn at_noise_floor(&self, hypothesis: &Hypothesis) -> bool {
        let evaluation = hypothesis.evaluation.as_ref();
        evaluation.is_some_and(Evaluation::is_noise)
    }

    /// Shortens the evaluation horizon while the best hypothesis, which explains every short window
    /// of the training motions, does not follow them over the whole horizon: an arm that sticks a
    /// sample sooner or later takes another way, and no model predicts that from the start of the
    /// run.
    pub fn shorten(&mut self, best: &mut Hypothesis) {
        if !best.follows_windows() {
            return;
        }
        let mut shortened = false;
        loop {
            self.evaluate(best);
            let evaluation = best.evaluation.as_ref();
            let follows = evaluation.is_some_and(|e| e.training.rms() < AT_NOISE_FLOOR);
            let Some(shorter) = self.shorter().filter(|_| !follows) else {
                break;
            };
            shortened = true;
            best.evaluation = None;
            self.horizon = shorter;
            self.training = self.training.recut(shorter);
            self.held_out = self.held_out.as_ref().map(|data| data.recut(shorter));
        }
        if shortened {
            let held_out = self.held_out.as_ref();
            self.base.evaluation = None;
            self.base.evaluate(&self.training, held_out, FINISH);
            for placebo in &mut self.placebos {
                placebo.evaluation = None;
                placebo.evaluate(&self.training, held_out, EVALUATE);
            }
        }
    }

    /// The next shorter evaluation horizon, if it may be chosen and is not the shortest already.
    fn shorter(&self) -> Option<Horizon> {
        let least = self.search_horizon.seconds()?;
        let next = match self.horizon {
            Horizon::Whole => LONGEST_WINDOW_S,
            Horizon::Seconds(seconds) if seconds > least => seconds / 2.0,
            Horizon::Seconds(_) => return None,
        };
        (!self.horizon_given).then_some(Horizon::Seconds(next.min(LONGEST_WINDOW_S).max(least)))
    }

    /// Evaluates a hypothesis over the evaluation horizon.
    pub fn evaluate(&self, hypothesis: &mut Hypothesis) {
        hypothesis.evaluate(&self.training, self.held_out.as_ref(), EVALUATE);
    }

    /// Few samples and nothing held out: simulations are cheap, and a single motion has more false
    /// valleys.
    pub fn small(&self) -> bool {
        self.held_out.is_none() && self.search.samples() < FEW_SAMPLES
    }
}

/// What the starts of each candidate change in the base model's prediction.
pub(super) fn every_change(
    base: &Hypothesis,
    candidates: &[Candidate],
    data: &FitData,
) -> Vec<Vec<PredictionChange>> {
    let candidates = candidates.par_iter();
    candidates
        .map(|&candidate| changes(&base.search, candidate, data))
        .collect()
}
