//! Where the fit of effects that are added starts: as a diagnosis does, from what each changes in
//! the prediction of the model fitted without it, and from every start value that it has.

use super::candidate::Candidate;
use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::horizon::Horizon;
use super::initial_guess::{ProjectedResidual, Sizes, changes};
use super::search_windows::{is_followed, search_horizons};
use super::solve::fit;
use super::staged::{LONGER_S, Stages};
use super::ways::{End, Route, directly, lowest};
use crate::model::{EffectInstance, Model, ParameterPath};
use rayon::prelude::*;
use std::cell::OnceCell;

/// Iterations that tell a promising start from a hopeless one.
const SCREENING: FitOptions = FitOptions {
    rough: true,
    glance: false,
    iterations: 8,
    tolerance: 1e-3,
};
/// Iterations of the most promising starts of an effect, and how many these are.
const PROMISING: FitOptions = FitOptions {
    iterations: 25,
    tolerance: 1e-5,
    rough: false,
    glance: false,
};
const GUESSES: usize = 2;
/// Ways to a fit with the effects.
const WAYS: usize = 6;

/// Effects to be added to a model, and what their values are fitted to.
pub(super) struct AddedEffects<'a> {
    pub model: &'a Model,
    pub candidates: &'a [Candidate],
    /// What is free: the model's own values, then the effects'.
    pub free: &'a [ParameterPath],
    pub data: &'a FitProblem,
    /// Values of the effects, and of what is free beside them, that are to be improved on; none of
    /// effects that nothing is known of.
    pub start: &'a [(ParameterPath, f64)],
}

/// A fit in windows, and these.
struct InWindows {
    fit: Fit,
    windows: FitProblem,
}

/// A way that a fit may be found; none where windows are too short for it.
type Way<'a> = Box<dyn FnMut() -> Option<End> + 'a>;

impl AddedEffects<'_> {
    /// Steps of progress at most: the start values and the ways.
    pub fn steps(&self) -> usize {
        let starts = self.candidates.iter().map(|c| c.starts().len());
        starts.sum::<usize>() + WAYS + usize::from(!self.start.is_empty())
    }

    /// The best fit with the effects; none worse than `base`, the best one without them, as far as
    /// the effects have values at which they vanish. `step` is called after each step.
    pub fn fitted(&self, base: &Fit, horizon: Horizon, step: &dyn Fn()) -> Fit {
        let without = self.in_windows(horizon);
        let guessed = InWindows {
            fit: self.by_change(&without.fit, &without.windows),
            windows: without.windows,
        };
        let found = self.by_ways(&guessed, step);
        if found.residuals.cost() < base.residuals.cost() {
            found
        } else {
            self.beside(base, found)
        }
    }

    /// The lowest of the fits that lead from those in windows, as guessed there and from every
    /// start, and from the values of the model as given.
    fn by_ways(&self, guessed: &InWindows, step: &dyn Fn()) -> Fit {
        let started = OnceCell::new();
        let started = || {
            started.get_or_init(|| InWindows {
                fit: self.best_of_starts(&guessed.windows, step),
                windows: guessed.windows.clone(),
            })
        };
        let given = self.with_given_values(&guessed.fit.model);
        let mut of_given = Stages::from(&given, self.free, self.data).ends();
        let direct = || (Route::Direct, directly(&given, self.free, self.data));
        let short = |from: &InWindows| (Route::Short, self.end_of(from, &[]));
        let longer = |from: &InWindows| (Route::Longer, self.end_of(from, LONGER_S));
        // First, so that what is found never leaves more than the start.
        let known = self.started().map(|start| {
            let way = move || Some((Route::Direct, directly(&start, self.free, self.data)));
            Box::new(way) as Way
        });
        let ways: [Way; WAYS] = [
            Box::new(|| Some(short(guessed))),
            Box::new(|| Some(direct())),
            Box::new(|| Some(longer(guessed))),
            Box::new(|| of_given.next()),
            Box::new(|| Some(short(started()))),
            Box::new(|| Some(longer(started()))),
        ];
        let mut ways: Vec<Way> = known.into_iter().chain(ways).collect();
        let found = lowest(ways.iter_mut().filter_map(|way| {
            let found = way();
            step();
            found
        }));
        found.unwrap_or_else(|| direct().1)
    }

    /// A fit that starts beside `base`, the effects small or absent, where that leaves less than
    /// what was found: in long windows the valleys of short ones may be false.
    fn beside(&self, base: &Fit, found: Fit) -> Fit {
        let small = self.by_change(base, self.data);
        let absent = self.switched_off(base, &found.model);
        least(vec![small, absent]).map_or(found.clone(), |beside| {
            if beside.residuals.cost() < found.residuals.cost() {
                beside
            } else {
                found
            }
        })
    }

    /// The model without the effects in the first windows that it follows.
    fn in_windows(&self, horizon: Horizon) -> InWindows {
        let fitted = |horizon: Horizon| {
            let windows = self.data.recut(horizon);
            let options = FitOptions::default();
            let fit = fit(self.model, &self.model.free, &windows, None, options);
            InWindows { fit, windows }
        };
        let horizons = search_horizons(self.data, horizon, false);
        let mut first = fitted(horizons[0]);
        for &horizon in &horizons[1..] {
            if is_followed(&first.fit, &first.windows) {
                break;
            }
            first = fitted(horizon);
        }
        first
    }

    /// The effects on top of a fit, one after the other, each from the starts that what it changes
    /// in the prediction makes most of the residual with.
    fn by_change(&self, base: &Fit, data: &FitProblem) -> Fit {
        let mut found = base.clone();
        for candidate in self.candidates {
            let changes = changes(&found, *candidate, Sizes::Both, data);
            let guesses = ProjectedResidual::new(&found).guesses(&changes);
            let added = new_paths(candidate, &found.free);
            let fits = guesses.par_iter().take(GUESSES).map(|guess| {
                let mut model = found.model.clone();
                model.effects.push(candidate.instance(&guess.values));
                found.with_free(&model, &added, data, PROMISING)
            });
            let fits: Vec<Fit> = fits.collect();
            found = least(fits).unwrap_or_else(|| self.one_more(&found, *candidate, data));
        }
        found
    }

    /// An effect at the first of its start values, where what it changes tells nothing.
    fn one_more(&self, found: &Fit, candidate: Candidate, data: &FitProblem) -> Fit {
        let mut model = found.model.clone();
        let start = candidate.starts().swap_remove(0);
        model.effects.push(candidate.instance(&start));
        let added = new_paths(&candidate, &found.free);
        found.with_free(&model, &added, data, PROMISING)
    }

    /// The effects added to the model as it was given, one after the other, each from the best of
    /// all its start values.
    fn best_of_starts(&self, windows: &FitProblem, step: &dyn Fn()) -> Fit {
        let (mut model, mut free) = (self.model.clone(), self.model.free.clone());
        for candidate in self.candidates {
            free.extend(
                candidate
                    .paths()
                    .filter(|path| !self.model.free.contains(path)),
            );
            let starts = candidate.starts().into_iter().map(|start| {
                let mut started = model.clone();
                started.effects.push(candidate.instance(&start));
                let found = fit(&started, &free, windows, None, SCREENING);
                step();
                found
            });
            if let Some(best) = least(starts.collect()) {
                model = best.model;
            }
        }
        fit(&model, &free, windows, None, PROMISING)
    }

    /// The fit that longer windows, of these lengths, lead to from a fit in short ones.
    fn end_of(&self, short: &InWindows, lengths_s: &[f64]) -> Fit {
        let mut stages = Stages::after(&short.fit, &short.windows, self.free, self.data);
        stages.through(lengths_s);
        stages.end(FitOptions::default())
    }

    /// The model with the effects at their known values, where all are known.
    fn started(&self) -> Option<Model> {
        let known = |path: &ParameterPath| {
            let mut own = self.start.iter().filter(|(known, _)| known == path);
            own.next().map(|(_, value)| *value)
        };
        let mut model = self.model.clone();
        for candidate in self.candidates {
            let values: Option<Vec<f64>> = candidate.paths().map(|path| known(&path)).collect();
            model.effects.push(candidate.instance(&values?));
        }
        for (path, value) in self
            .start
            .iter()
            .filter(|(path, _)| self.free.contains(path))
        {
            let (low, high) = path.bounds(&model);
            let _ = path.set(&mut model, value.clamp(low, high));
        }
        Some(model)
    }

    /// The model as it was given, with the effects as they are in another.
    fn with_given_values(&self, found: &Model) -> Model {
        let is_added =
            |effect: &&EffectInstance| self.candidates.iter().any(|candidate| candidate.is(effect));
        let mut model = self.model.clone();
        model
            .effects
            .extend(found.effects.iter().filter(is_added).cloned());
        model
    }

    /// From the best fit without the effects, these being where they vanish; what shapes them as in
    /// another model.
    fn switched_off(&self, base: &Fit, shape: &Model) -> Fit {
        let mut model = base.model.clone();
        for candidate in self.candidates {
            let parameters = candidate.parameters().iter().zip(candidate.paths());
            let values = parameters.map(|(parameter, path)| match parameter.off {
                Some(off) => off.clamp(parameter.bounds.0, parameter.bounds.1),
                None => path.get(shape).unwrap_or(parameter.starts[0]),
            });
            let values: Vec<f64> = values.collect();
            model.effects.push(candidate.instance(&values));
        }
        let window_starts = Some(&base.window_starts[..]);
        fit(
            &model,
            self.free,
            self.data,
            window_starts,
            FitOptions::default(),
        )
    }
}

/// Addresses of an effect's values that are not free yet.
fn new_paths(candidate: &Candidate, free: &[ParameterPath]) -> Vec<ParameterPath> {
    candidate
        .paths()
        .filter(|path| !free.contains(path))
        .collect()
}

/// The fit that leaves least.
fn least(fits: Vec<Fit>) -> Option<Fit> {
    let cost = |fit: &Fit| fit.residuals.cost();
    fits.into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))
}
