//! A set of effects added to the base model, everything refitted and evaluated on held-out motions.

use super::block_errors::{AT_NOISE_FLOOR, BlockErrors};
use super::budget::{EVALUATE, FINISH};
use crate::fitting::{
    Candidate, Fit, FitOptions, FitProblem, choose_by_other_motions, fit, fit_start_states,
    intervals, intervals_of, polish,
};
use crate::model::{EffectInstance, Model, ParameterPath};
use std::cmp::Ordering;

/// A fitted set of effects.
///
/// It is searched on short windows, where the squared error has few false valleys, and evaluated
/// over the longest useful horizon, where small effects show most.
#[derive(Debug, Clone)]
pub(super) struct Hypothesis {
    /// The effects added to the base, in the order they were added.
    pub set: Vec<Candidate>,
    /// The values of the given model that are wrong, where that is the hypothesis: refitted alone,
    /// or along with those that are free.
    pub values: Vec<ParameterPath>,
    /// The fit on short windows.
    pub search: Fit,
    /// Its mean squared weighted residual.
    pub search_mean: f64,
    /// The fit over the evaluation horizon, once it has come that far.
    pub evaluation: Option<Evaluation>,
}

/// A hypothesis over the evaluation horizon.
#[derive(Debug, Clone)]
pub(super) struct Evaluation {
    pub fit: Fit,
    pub training: BlockErrors,
    pub held_out: Option<BlockErrors>,
    /// Whether every added effect differs from nothing by more than its interval; one alone,
    /// whether the motions say anything of its values.
    pub significant: bool,
}

impl Evaluation {
    /// The blocks that decide: held-out ones where there are any.
    pub fn deciding(&self) -> &BlockErrors {
        self.held_out.as_ref().unwrap_or(&self.training)
    }

    /// Whether it leaves nothing but noise, on the motions fitted and on those held out.
    pub fn is_noise(&self) -> bool {
        self.training.is_noise() && self.held_out.as_ref().is_none_or(BlockErrors::is_noise)
    }
}

impl Hypothesis {
    /// Effects added, fitted on short windows.
    pub fn new(set: Vec<Candidate>, search: Fit) -> Hypothesis {
        Hypothesis {
            set,
            values: Vec::new(),
            search_mean: search.residuals.mean_square(),
            search,
            evaluation: None,
        }
    }

    /// Orders hypotheses by their error on the short windows, smallest first.
    pub fn by_error(a: &Hypothesis, b: &Hypothesis) -> Ordering {
        a.search_mean.total_cmp(&b.search_mean)
    }

    /// Orders hypotheses by the values they need, then those of the file before effects, then by
    /// their error.
    pub fn by_simplicity(a: &Hypothesis, b: &Hypothesis) -> Ordering {
        let needs = |h: &Hypothesis| (h.values.len() + h.added_values(), h.set.len());
        let needs = needs(a).cmp(&needs(b));
        needs.then(a.deciding_mean().total_cmp(&b.deciding_mean()))
    }

    /// Number of values the added effects bring.
    pub fn added_values(&self) -> usize {
        self.set.iter().map(|c| c.parameters().len()).sum()
    }

    /// Names of the set, or of the value.
    pub fn names(&self) -> Vec<String> {
        let values = self.values.iter().map(ToString::to_string);
        values
            .chain(self.set.iter().map(ToString::to_string))
            .collect()
    }

    /// Whether this hypothesis adds the same effects as that set.
    pub fn adds(&self, set: &[Candidate]) -> bool {
        self.set.len() == set.len() && set.iter().all(|c| self.set.contains(c))
    }

    /// Whether this hypothesis is that one and more: no other explanation.
    pub fn extends(&self, other: &Hypothesis) -> bool {
        other.set.iter().all(|effect| self.set.contains(effect))
            && other.values.iter().all(|path| self.values.contains(path))
    }

    /// The set with one more effect.
    pub fn set_with(&self, candidate: Candidate) -> Vec<Candidate> {
        let mut set = self.set.clone();
        set.push(candidate);
        set
    }

    /// Adds an effect at these values and refits everything on short windows.
    pub fn with(
        &self,
        candidate: Candidate,
        values: &[f64],
        data: &FitProblem,
        options: FitOptions,
    ) -> Hypothesis {
        let mut model = self.search.model.clone();
        model.effects.push(candidate.instance(values));
        let paths: Vec<ParameterPath> = candidate.paths().collect();
        let search = self.search.with_free(&model, &paths, data, options);
        Hypothesis::new(self.set_with(candidate), search)
    }

    /// Whether nothing but noise is left in the short windows it was searched on.
    pub fn follows_windows(&self) -> bool {
        self.search_mean.sqrt() < AT_NOISE_FLOOR
    }

    /// Goes on fitting where an earlier, short fit stopped.
    pub fn resume(&mut self, data: &FitProblem, options: FitOptions) {
        self.search = self.search.resume(data, options);
        self.search_mean = self.search.residuals.mean_square();
    }

    /// Takes the best of these fits of its set in its place, if one is better.
    pub fn improve(&mut self, others: Vec<Hypothesis>) {
        let best = others.into_iter().min_by(Hypothesis::by_error);
        if let Some(best) = best.filter(|best| best.search_mean < self.search_mean) {
            *self = best;
        }
    }

    /// This hypothesis less one of its effects, refitted from the values it has.
    pub fn without(
        &self,
        leaving: usize,
        base: &Hypothesis,
        data: &FitProblem,
        iterations: usize,
    ) -> Hypothesis {
        let mut set = self.set.clone();
        let out = set.remove(leaving);
        let mut model = self.search.model.clone();
        model.effects.retain(|instance| !out.is(instance));
        let mut free = base.search.free.clone();
        free.extend(set.iter().flat_map(|c| c.paths().collect::<Vec<_>>()));
        let (window_starts, options) = (
            &self.search.window_starts,
            FitOptions::iterations(iterations),
        );
        Hypothesis::new(set, fit(&model, &free, data, Some(window_starts), options))
    }

    /// Refits over the evaluation horizon from the values and start states found on the short
    /// windows, and predicts the held-out motions.
    pub fn evaluate(
        &mut self,
        short: &FitProblem,
        training: &FitProblem,
        held_out: Option<&FitProblem>,
        options: FitOptions,
    ) {
        if self.evaluation.is_some() {
            return;
        }
        let search = &self.search;
        let window_starts = training.window_starts_from(short, &search.window_starts);
        let mut fit = fit(
            &search.model,
            &search.free,
            training,
            Some(&window_starts),
            options,
        );
        // What is only compared may do so on a stair and in steps that are too long.
        if !options.rough {
            fit = polish(fit, training, options);
            self.search_in_steps(fit.model.step_s, short);
        }
        self.judge(fit, training, held_out);
    }

    /// Evaluates it over longer windows, from the values and start states found in those `before`;
    /// nothing where it was not evaluated.
    pub fn run_longer(
        &mut self,
        before: &FitProblem,
        training: &FitProblem,
        held_out: Option<&FitProblem>,
    ) {
        let Some(evaluation) = &self.evaluation else {
            return;
        };
        let found = &evaluation.fit;
        let window_starts = training.window_starts_from(before, &found.window_starts);
        let options = FitOptions::iterations(EVALUATE);
        let fit = fit(
            &found.model,
            &found.free,
            training,
            Some(&window_starts),
            options,
        );
        self.judge(polish(fit, training, options), training, held_out);
    }

    /// Takes steps of this length on the short windows too: what goes on from there should not
    /// explain what longer steps get wrong.
    fn search_in_steps(&mut self, step_s: f64, short: &FitProblem) {
        if self.search.model.step_s == step_s {
            return;
        }
        let model = Model {
            step_s,
            ..self.search.model.clone()
        };
        let (window_starts, options) = (&self.search.window_starts, FitOptions::iterations(FINISH));
        self.search = fit(
            &model,
            &self.search.free,
            short,
            Some(window_starts),
            options,
        );
        self.search_mean = self.search.residuals.mean_square();
    }

    /// Takes a fit over the evaluation horizon, and predicts the held-out motions with it.
    pub fn judge(&mut self, mut fit: Fit, training: &FitProblem, held_out: Option<&FitProblem>) {
        let of_training = BlockErrors::of(&fit.residuals, training);
        if let Some(others) = held_out.filter(|_| of_training.is_noise()) {
            fit = choose_by_other_motions(fit, training, others);
        }
        let held_out = held_out
            .map(|data| BlockErrors::of(&fit_start_states(&fit.model, data).residuals, data));
        self.evaluation = Some(Evaluation {
            // One effect alone is judged by the error; only among several may one be idle.
            significant: match self.set.as_slice() {
                [alone] => determined(alone, &fit, training),
                set => significant(set, &fit, training),
            },
            training: of_training,
            held_out,
            fit,
        });
    }

    /// The blocks that decide; `None` before it was evaluated.
    pub fn deciding(&self) -> Option<&BlockErrors> {
        self.evaluation.as_ref().map(Evaluation::deciding)
    }

    /// Mean squared weighted error where it counts; infinite before it was evaluated.
    pub fn deciding_mean(&self) -> f64 {
        self.deciding().map_or(f64::INFINITY, BlockErrors::mean)
    }

    /// Root-mean-square error where it counts, rad; infinite before it was evaluated.
    pub fn deciding_rms_rad(&self) -> f64 {
        self.deciding().map_or(f64::INFINITY, BlockErrors::rms_rad)
    }

    /// Root-mean-square error on the training motions, rad: over the evaluation horizon where it
    /// came that far.
    pub fn training_rms_rad(&self, search: &FitProblem) -> f64 {
        match &self.evaluation {
            Some(evaluation) => evaluation.training.rms_rad(),
            None => BlockErrors::of(&self.search.residuals, search).rms_rad(),
        }
    }

    /// All blocks.
    pub fn pooled(&self) -> Option<BlockErrors> {
        let evaluation = self.evaluation.as_ref()?;
        let mut pooled = evaluation.training.clone();
        pooled.extend(evaluation.held_out.as_ref());
        Some(pooled)
    }

    /// The fit that counts: over the evaluation horizon where there is one.
    pub fn fit(&self) -> &Fit {
        self.evaluation.as_ref().map_or(&self.search, |e| &e.fit)
    }

    /// Whether the interval of a value of an added effect reaches from bound to bound.
    pub fn spans_bounds(&self, training: &FitProblem) -> bool {
        let fit = self.fit();
        let Some((intervals, _)) = intervals(fit, training) else {
            return false;
        };
        let first = intervals.len() - self.added_values();
        let mut own = fit.free[first..].iter().zip(&intervals[first..]);
        own.any(|(path, interval)| {
            let (low, high) = path.bounds(&fit.model);
            low.is_finite() && high.is_finite() && interval.low <= low && interval.high >= high
        })
    }

    /// An effect of the set as it is fitted.
    pub fn added_effect(&self, place: usize) -> &EffectInstance {
        let effects = &self.fit().model.effects;
        &effects[effects.len() - self.set.len() + place]
    }

    /// The places in the set of effects with a value at the edge of the possible.
    pub fn effects_on_bound(&self) -> Vec<usize> {
        let on_bound = self.fit().on_bound();
        let mut first = on_bound.len() - self.added_values();
        let mut is_on_bound = |effect: &Candidate| {
            let own = first..first + effect.parameters().len();
            first = own.end;
            on_bound[own].contains(&true)
        };
        let places = 0..self.set.len();
        places
            .filter(|place| is_on_bound(&self.set[*place]))
            .collect()
    }

    /// Whether an added effect has a value at the edge of the possible: it vanishes there, or
    /// stands in for another.
    pub fn rests_on_bound(&self) -> bool {
        let on_bound = self.fit().on_bound();
        let own = self.values.len() + self.added_values();
        on_bound[on_bound.len() - own..].contains(&true)
    }
}

/// Whether the interval of any value of an effect, the last one freed, is narrower than what the
/// value may be at all.
fn determined(effect: &Candidate, fit: &Fit, data: &FitProblem) -> bool {
    let parameters = effect.parameters();
    let Some((intervals, _)) = intervals(fit, data) else {
        return true;
    };
    let own = &intervals[intervals.len() - parameters.len()..];
    let mut own = parameters.iter().zip(own);
    own.any(|(parameter, interval)| {
        let (low, high) = parameter.bounds;
        interval.low > low || interval.high < high
    })
}

/// Whether every effect of the set, the last ones freed, has a value whose interval leaves out
/// where it vanishes. The values that only shape the effect are held: where it vanishes they say
/// nothing, and where motions do not reach as far as they tell, all values of the effect may grow
/// together.
fn significant(set: &[Candidate], fit: &Fit, data: &FitProblem) -> bool {
    let added: usize = set.iter().map(|c| c.parameters().len()).sum();
    let mut first = fit.free.len() - added;
    set.iter().all(|candidate| {
        let parameters = candidate.parameters();
        let own = |place: usize| place.checked_sub(first).and_then(|own| parameters.get(own));
        let is_shape = |place: usize| own(place).is_some_and(|parameter| parameter.off.is_none());
        let all = 0..fit.free.len();
        let places: Vec<usize> = all.filter(|place| !is_shape(*place)).collect();
        let intervals = intervals_of(&places, fit, data).map(|(intervals, _)| intervals);
        let mut known = places.iter().zip(intervals.unwrap_or_default());
        let present = known.any(|(place, interval)| {
            own(*place).is_some_and(|parameter| {
                parameter.off.is_some_and(|off| {
                    interval.low > off || interval.high < off.min(parameter.bounds.1)
                })
            })
        });
        first += parameters.len();
        present
    })
}
