//! What every hypothesis is fitted to and judged by: the motions cut for the search and for the
//! evaluation, the base model fitted, the candidates.

use super::budget::{BASE_STEPS, EVALUATE, FAR_BEHIND, FEW_SAMPLES, FINISH, HOPELESS, LOOK, MANY};
use super::candidates::candidates;
use super::findings::ResidualStructure;
use super::hypothesis::{Evaluation, Hypothesis};
use super::measured_value::is_ruled_out;
use super::multistart::base_fit;
use super::options::DiagnoseOptions;
use super::progress::{Course, Round, Stage};
use super::residual_structure::residual_structure;
use super::strategy::Strategy;
use super::turns::shows_something;
use super::values::as_given;
use crate::fitting::{
    BestSoFar, Candidate, Fit, FitOptions, FitProblem, Horizon, PredictionChange, Sizes, changes,
    coarsened, enough_to_search, is_followed, search_horizons,
};
use crate::model::{MeasuredSignal, Model, ParameterPath};
use crate::motion::Motion;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// How far a search reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// Windows of a second; to larger sets the candidates that promise most, and every one where
    /// the base model follows these windows, and fitted motions show what is missing.
    Promising,
    /// Windows that the base model follows; to larger sets every candidate.
    Everything,
}

impl Reach {
    /// Which search it is, before it is known whether it is the only one.
    fn round(self) -> Round {
        match self {
            Reach::Promising => Round::First,
            Reach::Everything => Round::Second,
        }
    }
}

/// What every hypothesis is fitted to and judged by.
pub(super) struct Evaluator<'a> {
    /// Training motions in short windows, to search on.
    pub search: FitProblem,
    /// Training motions over the evaluation horizon.
    pub training: FitProblem,
    /// Held-out motions over the evaluation horizon.
    pub held_out: Option<FitProblem>,
    /// The model as it came.
    pub given: Hypothesis,
    /// The model with its free values refitted.
    pub base: Hypothesis,
    pub horizon: Horizon,
    /// Whether the user has chosen it.
    pub horizon_given: bool,
    /// How long the windows of `search` are.
    pub search_horizon: Horizon,
    pub candidates: Vec<Candidate>,
    /// What each start of each candidate changes in the base model's prediction.
    pub changes: Vec<Vec<PredictionChange>>,
    /// The model as it came, in the steps that it is searched with.
    pub start: Model,
    /// Integration step of its file, s.
    pub file_step_s: f64,
    /// Values of it that are right.
    pub known: Vec<ParameterPath>,
    pub seed: u64,
    /// Error that is good enough, rad.
    pub tolerance_rad: Option<f64>,
    /// Most effects named together.
    pub most_effects: usize,
    pub reach: Reach,
    /// Parts of the search that are left out.
    pub skipped: Vec<Strategy>,
    /// Whether pairs are tried with every candidate: no other search comes after this one.
    pub tries_all: bool,
    pub course: Course<'a>,
    /// What was evaluated since the search last kept what it found, and the best of all.
    evaluated: Mutex<Evaluated>,
}

/// What was evaluated in a search.
#[derive(Default)]
struct Evaluated {
    lately: Vec<Hypothesis>,
    best: Option<Hypothesis>,
}

impl<'a> Evaluator<'a> {
    pub fn new(
        model: &Model,
        training: Vec<Motion>,
        held_out: Vec<Motion>,
        options: &DiagnoseOptions,
        reach: Reach,
        course: Course<'a>,
    ) -> Evaluator<'a> {
        let all = [training.as_slice(), held_out.as_slice()].concat();
        let mut candidates = candidates(model, &all, &options.without);
        candidates.retain(|candidate| !is_ruled_out(candidate, &options.known, model));
        // Without motions to judge by, two effects together can't be told from luck.
        let most_effects = if held_out.is_empty() {
            1
        } else {
            options.most_effects
        };
        course.begin(Stage::Base, reach.round(), BASE_STEPS);
        let whole = FitProblem::new(model, training, Horizon::Whole).halted_by(&course.halt);
        let longest = options.horizon.unwrap_or(Horizon::Whole);
        let few = held_out.is_empty() && whole.samples() < FEW_SAMPLES;
        let file_step_s = model.step_s;
        let mut horizons = search_horizons(&whole, longest, few);
        let is_only = horizons.len() == 1;
        if reach == Reach::Promising {
            horizons.truncate(1);
        }
        let start = SearchStart::new(model, &whole, &horizons, few, options.seed);
        let (search_horizon, search) = (start.horizon, start.data);
        let is_followed = is_only || is_followed(&start.fit, &search);
        let model = &start.model;
        let mut base = Hypothesis::new(Vec::new(), start.fit);
        let training = whole.recut(longest);
        let held_out = (!held_out.is_empty())
            .then(|| FitProblem::new(model, held_out, longest).weighted_like(&training))
            .map(|held_out| held_out.halted_by(&course.halt));
        base.evaluate(
            &search,
            &training,
            held_out.as_ref(),
            FitOptions::iterations(FINISH),
        );
        let mut given = as_given(model, &search);
        given.evaluate(
            &search,
            &training,
            held_out.as_ref(),
            FitOptions::iterations(FINISH),
        );
        let changes = every_change(&base, &candidates, &search);
        let may_go_on = !options.skipped.contains(&Strategy::SecondSearch);
        // Where the fitted motions show nothing, others are learned from first.
        let shows = base.evaluation.as_ref().is_some_and(shows_something);
        let tries_all = reach == Reach::Everything || may_go_on && is_followed && shows;
        Evaluator {
            search,
            training,
            held_out,
            given,
            base,
            tolerance_rad: options.tolerance_rad,
            horizon: longest,
            horizon_given: options.horizon.is_some(),
            search_horizon,
            candidates,
            changes,
            start: model.clone(),
            file_step_s,
            known: options.known.clone(),
            seed: options.seed,
            most_effects,
            reach,
            skipped: options.skipped.clone(),
            tries_all,
            course,
            evaluated: Mutex::default(),
        }
    }

    /// Whether a part of the search is done.
    pub fn does(&self, strategy: Strategy) -> bool {
        !self.skipped.contains(&strategy)
    }

    /// Which search this is.
    pub fn round(&self) -> Round {
        if self.tries_all && self.reach == Reach::Promising {
            Round::Only
        } else {
            self.reach.round()
        }
    }

    /// Takes note of what was evaluated for the search.
    fn note(&self, hypothesis: &Hypothesis) {
        let runs = hypothesis.fit().simulations * self.training.motions.len();
        self.course.evaluated(runs);
        self.lock_evaluated().lately.push(hypothesis.clone());
        self.show(hypothesis);
    }

    /// Shows a hypothesis where it is the best so far.
    fn show(&self, hypothesis: &Hypothesis) {
        let mut evaluated = self.lock_evaluated();
        let reference = evaluated.best.as_ref().unwrap_or(&self.base);
        let is_lower = hypothesis.deciding_mean() < reference.deciding_mean();
        if is_lower && self.improves(reference, hypothesis) {
            self.course.found(BestSoFar {
                names: hypothesis.names(),
                before_rad: self.given.deciding_rms_rad(),
                error_rad: hypothesis.deciding_rms_rad(),
                floor_rad: self.training.floor(),
                quantity: MeasuredSignal::pooled(&self.training.signals),
            });
            evaluated.best = Some(hypothesis.clone());
        }
    }

    /// Shows the best of these, whatever was shown over another horizon.
    pub fn show_best(&self, tried: &[Vec<Hypothesis>]) {
        self.lock_evaluated().best = None;
        self.course.forget();
        for hypothesis in tried.iter().flatten() {
            self.show(hypothesis);
        }
    }

    /// What was evaluated since the last call: what the search has not kept, where it was ended.
    pub fn take_evaluated(&self) -> Vec<Hypothesis> {
        std::mem::take(&mut self.lock_evaluated().lately)
    }

    fn lock_evaluated(&self) -> std::sync::MutexGuard<'_, Evaluated> {
        self.evaluated
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
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

    /// Evaluates a hypothesis that the search has found.
    pub fn evaluate_found(&self, hypothesis: &mut Hypothesis) {
        self.evaluate(hypothesis);
        self.note(hypothesis);
    }

    /// Evaluates a hypothesis over the evaluation horizon.
    pub fn evaluate(&self, hypothesis: &mut Hypothesis) {
        hypothesis.evaluate(
            &self.search,
            &self.training,
            self.held_out.as_ref(),
            FitOptions::iterations(EVALUATE),
        );
    }

    /// Evaluates hypotheses fitted to the end on short windows, the best first; what is far behind
    /// them, or behind the least squared error of others, gets a look. Calls `done` after each.
    pub fn evaluate_all(
        &self,
        hypotheses: &mut [Hypothesis],
        least: Option<f64>,
        done: impl Fn() + Sync,
    ) {
        let best = hypotheses.iter().map(|h| h.search_mean);
        let far = FAR_BEHIND * best.chain(least).fold(f64::INFINITY, f64::min);
        hypotheses.par_iter_mut().for_each(|hypothesis| {
            let options = if hypothesis.search_mean > far {
                FitOptions::iterations(LOOK).rough()
            } else {
                FitOptions::iterations(EVALUATE)
            };
            hypothesis.evaluate(
                &self.search,
                &self.training,
                self.held_out.as_ref(),
                options,
            );
            self.note(hypothesis);
            done();
        });
    }

    /// The squared error above which a hypothesis is hopeless beside the best of these, or beside
    /// the least squared error of others; infinite where simulations are cheap.
    pub fn limit<'h>(
        &self,
        hypotheses: impl Iterator<Item = &'h Hypothesis>,
        least: Option<f64>,
    ) -> f64 {
        let means = hypotheses.map(|hypothesis| hypothesis.search_mean);
        if self.small() {
            f64::INFINITY
        } else {
            HOPELESS * means.chain(least).fold(f64::INFINITY, f64::min)
        }
    }

    /// How many of the hypotheses, sorted by their error, are not hopeless.
    pub fn promising(&self, sorted: &[Hypothesis], least: Option<f64>) -> usize {
        let limit = self.limit(sorted.iter().take(1), least);
        let promising = sorted.iter().take_while(|h| h.search_mean <= limit);
        promising.count()
    }

    /// Whether there are more candidates than three joints have, of which most act where nothing is
    /// missing.
    pub fn has_many_candidates(&self) -> bool {
        self.candidates.len() > MANY
    }

    /// Few samples and nothing held out: simulations are cheap, and a single motion has more false
    /// valleys.
    pub fn small(&self) -> bool {
        self.held_out.is_none() && self.search.samples() < FEW_SAMPLES
    }
}

/// Where the search starts: the windows that the fitted base model follows.
struct SearchStart {
    horizon: Horizon,
    data: FitProblem,
    /// The model in the steps that it is searched with.
    model: Model,
    fit: Fit,
}

impl SearchStart {
    /// Over the first of these horizons that the model follows, or the last; at least one.
    fn new(model: &Model, whole: &FitProblem, horizons: &[Horizon], few: bool, seed: u64) -> Self {
        let start = |horizon: Horizon| {
            let data = whole.recut(horizon);
            let model = coarsened(model, &data);
            let data = enough_to_search(data, &model);
            let fit = base_fit(&model, &data, few, seed);
            SearchStart {
                horizon,
                data,
                model,
                fit,
            }
        };
        let mut first = start(horizons[0]);
        for &horizon in &horizons[1..] {
            if is_followed(&first.fit, &first.data) {
                break;
            }
            first = start(horizon);
        }
        first
    }
}

/// What the starts of each candidate change in the base model's prediction.
pub(super) fn every_change(
    base: &Hypothesis,
    candidates: &[Candidate],
    data: &FitProblem,
) -> Vec<Vec<PredictionChange>> {
    let candidates = candidates.par_iter();
    candidates
        .map(|&candidate| changes(&base.search, candidate, Sizes::Both, data))
        .collect()
}
