//! One attempt: a set of effects added to the base model, everything refitted, judged on held-out motions.

use super::candidate::Candidate;
use super::score::{AT_FLOOR, Score};
use crate::fitting::{Data, Fit, FitOptions, fit, intervals, settle};

/// A fitted set of effects.
///
/// It is searched on short windows, where the squared error has few false valleys, and judged over the longest
/// useful horizon, where small effects show most.
#[derive(Debug, Clone)]
pub(super) struct Trial {
    /// The effects added to the base, in the order they were added.
    pub set: Vec<Candidate>,
    /// The fit on short windows.
    pub search: Fit,
    /// Its mean squared weighted residual.
    pub search_mean: f64,
    /// The fit over the judging horizon, once it has come that far.
    pub judged: Option<Judged>,
}

/// A trial over the judging horizon.
#[derive(Debug, Clone)]
pub(super) struct Judged {
    pub fit: Fit,
    pub training: Score,
    pub held_out: Option<Score>,
    /// Whether every added effect differs from nothing by more than its interval.
    pub significant: bool,
}

impl Trial {
    /// Effects added, fitted on short windows.
    pub fn new(set: Vec<Candidate>, search: Fit) -> Trial {
        Trial {
            set,
            search_mean: search.residuals.cost() / search.residuals.count().max(1) as f64,
            search,
            judged: None,
        }
    }

    /// Number of values the added effects bring.
    pub fn added_values(&self) -> usize {
        self.set
            .iter()
            .map(|c| c.effect.info().parameters.len())
            .sum()
    }

    /// Names of the set, joined.
    pub fn name(&self) -> String {
        self.set
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join(" + ")
    }

    /// Whether this trial adds the same effects as that set.
    pub fn adds(&self, set: &[Candidate]) -> bool {
        self.set.len() == set.len() && set.iter().all(|c| self.set.contains(c))
    }

    /// Adds an effect at these values and refits everything on short windows, for at most `iterations`.
    pub fn with(
        &self,
        candidate: Candidate,
        values: &[f64],
        data: &Data,
        iterations: usize,
    ) -> Trial {
        let mut model = self.search.model.clone();
        model.effects.push(candidate.instance(values));
        let mut free = self.search.free.clone();
        free.extend(candidate.paths());
        let mut set = self.set.clone();
        set.push(candidate);
        let options = FitOptions {
            iterations,
            rough: true,
            ..FitOptions::default()
        };
        Trial::new(
            set,
            fit(&model, &free, data, Some(&self.search.nodes), options),
        )
    }

    /// Whether nothing but noise is left in the short windows it was searched on.
    pub fn follows_windows(&self) -> bool {
        self.search_mean.sqrt() < AT_FLOOR
    }

    /// Goes on fitting where an earlier, short fit stopped.
    pub fn look_again(&mut self, data: &Data, iterations: usize) {
        self.resume(data, iterations, true);
    }

    /// The same, and takes the derivatives there.
    pub fn finish(&mut self, data: &Data, iterations: usize) {
        self.resume(data, iterations, false);
    }

    fn resume(&mut self, data: &Data, iterations: usize, rough: bool) {
        let options = FitOptions {
            iterations,
            rough,
            ..FitOptions::default()
        };
        let search = self.search.resume(data, options);
        self.search_mean = search.residuals.cost() / search.residuals.count().max(1) as f64;
        self.search = search;
    }

    /// This trial less one of its effects, at the values it has; not refitted.
    pub fn without(&self, leaving: usize, base: &Trial) -> Trial {
        let out = self.set[leaving];
        let mut rest = self.clone();
        rest.set.remove(leaving);
        rest.judged = None;
        rest.search
            .model
            .effects
            .retain(|e| !(e.effect == out.effect && e.joint == out.joint));
        rest.search.free = base.search.free.clone();
        rest.search
            .free
            .extend(rest.set.iter().flat_map(|c| c.paths().collect::<Vec<_>>()));
        rest
    }

    /// Fits again from the present values.
    pub fn refit(&mut self, data: &Data, iterations: usize) {
        let options = FitOptions {
            iterations,
            ..FitOptions::default()
        };
        let (model, free, nodes) = (&self.search.model, &self.search.free, &self.search.nodes);
        let search = fit(model, free, data, Some(nodes), options);
        *self = Trial::new(std::mem::take(&mut self.set), search);
    }

    /// Refits over the judging horizon from the values found, and judges them on held-out motions.
    pub fn judge(&mut self, training: &Data, held_out: Option<&Data>, iterations: usize) {
        if self.judged.is_none() {
            let options = FitOptions {
                iterations,
                ..FitOptions::default()
            };
            // Start states carry over where the windows are the same.
            let nodes = (self.search.nodes.len() == training.windows.len())
                .then_some(&self.search.nodes[..]);
            let fit = fit(
                &self.search.model,
                &self.search.free,
                training,
                nodes,
                options,
            );
            self.judged = Some(Judged {
                // One effect alone is judged by the error; only among several may one be idle.
                significant: self.set.len() < 2 || significant(&self.set, &fit, training),
                training: Score::of(&fit, training),
                held_out: held_out.map(|data| Score::of(&settle(&fit.model, data), data)),
                fit,
            });
        }
    }

    /// The blocks that decide: held-out ones where there are any. `None` before it was judged.
    pub fn deciding(&self) -> Option<&Score> {
        let judged = self.judged.as_ref()?;
        Some(judged.held_out.as_ref().unwrap_or(&judged.training))
    }

    /// Mean squared weighted error where it counts; infinite before it was judged.
    pub fn deciding_mean(&self) -> f64 {
        self.deciding().map_or(f64::INFINITY, Score::mean)
    }

    /// Root-mean-square error where it counts, rad; infinite before it was judged.
    pub fn deciding_rms_rad(&self) -> f64 {
        self.deciding().map_or(f64::INFINITY, Score::rms_rad)
    }

    /// Root-mean-square error on the training motions, rad: over the judging horizon where it came that far.
    pub fn training_rms_rad(&self, search: &Data) -> f64 {
        match &self.judged {
            Some(judged) => judged.training.rms_rad(),
            None => Score::of(&self.search, search).rms_rad(),
        }
    }

    /// All blocks.
    pub fn pooled(&self) -> Option<Score> {
        let judged = self.judged.as_ref()?;
        Some(match &judged.held_out {
            Some(held_out) => Score::joined(&[&judged.training, held_out]),
            None => judged.training.clone(),
        })
    }

    /// The fit that counts: over the judging horizon where there is one.
    pub fn fit(&self) -> &Fit {
        self.judged
            .as_ref()
            .map_or(&self.search, |judged| &judged.fit)
    }

    /// Whether an added effect has a value at the edge of the possible: it vanishes there, or stands in for another.
    pub fn rests_on_bound(&self) -> bool {
        let on_bound = self.fit().on_bound();
        let added = on_bound.len() - self.added_values();
        on_bound[added..].contains(&true)
    }
}

/// Whether every effect of the set, the last ones freed, has a value whose interval leaves out where it vanishes.
fn significant(set: &[Candidate], fit: &Fit, data: &Data) -> bool {
    let Some((intervals, _)) = intervals(fit, data) else {
        return set.is_empty();
    };
    let added: usize = set.iter().map(|c| c.effect.info().parameters.len()).sum();
    let mut own = intervals[intervals.len() - added..].iter();
    let mut all = true;
    for candidate in set {
        let parameters = candidate.effect.info().parameters;
        let present = parameters
            .iter()
            .zip(&mut own)
            .filter(|(parameter, interval)| {
                parameter.off.is_some_and(|off| {
                    interval.low > off || interval.high < off.min(parameter.bounds.1)
                })
            });
        all &= present.count() > 0;
    }
    all
}
