//! The search: every candidate alone, then pairs and swaps around the best, then larger sets while they pay.
//!
//! A forward-greedy search stops where no single effect helps although two together would; so sets grow from
//! several leads, not one, and members of the best set are swapped.

use super::candidate::{Candidate, candidates};
use super::findings::Diagnosis;
use super::remainder::remainder;
use super::score::{AT_FLOOR, Score, fall};
use super::trial::{Opening, Trial, openings};
use super::verdict::{Case, conclude};
use crate::effects::{CONTROLS, SHAM};
use crate::identify::{Data, Fit, FitOptions, Horizon, Projector, fit, longest_stable, settle};
use crate::log::Motion;
use crate::model::{EffectInstance, Model, ParameterPath};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// How to diagnose.
#[derive(Debug, Clone)]
pub struct DiagnoseOptions {
    /// Seed of the bootstrap.
    pub seed: u64,
    /// Effects left out of the library.
    pub without: Vec<String>,
    /// Window length; chosen from the data when absent.
    pub horizon: Option<Horizon>,
    /// Most effects named together.
    pub most_effects: usize,
}

impl Default for DiagnoseOptions {
    fn default() -> Self {
        DiagnoseOptions {
            seed: 0,
            without: Vec::new(),
            horizon: None,
            most_effects: 3,
        }
    }
}

/// How far a diagnosis has come.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// Steps done.
    pub done: usize,
    /// Steps in all, as far as known.
    pub total: usize,
    /// What is being done.
    pub what: String,
}

/// Iterations of a first look at a candidate.
const LOOK: usize = 3;
/// Iterations of a finalist.
const FINISH: usize = 25;
/// Iterations over the judging horizon, from what the windows found.
const JUDGE: usize = 12;
/// Fewer training samples than this are few.
const SMALL: usize = 1500;
/// Random starts of each candidate on few samples, and their iterations.
const RESTARTS: usize = 100;
const RESTART_ITERATIONS: usize = 30;
/// Windows to search on, s.
const SEARCH_S: f64 = 1.0;
/// Finalists of each size.
const FINALISTS: usize = 6;
/// Sets from which larger ones grow.
const LEADS: usize = 5;
/// Partners tried for each lead.
const PARTNERS: usize = 5;

/// Searches for the effects a model is missing.
///
/// `training` motions are fitted; `held_out` motions decide. Without held-out motions the training motions
/// decide, and the diagnosis says so.
pub fn diagnose(
    model: &Model,
    training: Vec<Motion>,
    held_out: Vec<Motion>,
    options: &DiagnoseOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Diagnosis {
    let bench = Bench::new(model, training, held_out, options);
    let report = |done: usize, what: &str| {
        progress(Progress {
            done,
            total: 5,
            what: what.to_string(),
        });
    };
    report(0, "every effect alone");
    let mut sizes = vec![bench.singles()];
    let mut best = bench.accepted(&bench.base, &sizes[0]).cloned();
    report(1, "pairs and swaps");
    // Without motions to judge by, two effects together can't be told from luck.
    let most_effects = if bench.held_out.is_some() {
        options.most_effects
    } else {
        1
    };
    for size in 2..=most_effects {
        if best.as_ref().is_some_and(|b| bench.at_floor(b)) {
            break;
        }
        let leads = &sizes[size - 2];
        let larger = bench.grow(leads);
        if larger.is_empty() {
            break;
        }
        let reference = best.as_ref().unwrap_or(&bench.base);
        let better = bench.accepted(reference, &larger).cloned();
        sizes.push(larger);
        report(size, "larger sets");
        match better {
            Some(better) => best = Some(better),
            // Nothing gained by one more: two more may still, but only from a start without any.
            None if best.is_some() || size > 2 => break,
            None => {}
        }
    }
    report(3, "what remains");
    let chosen = best.as_ref().unwrap_or(&bench.base);
    let unseen = bench
        .held_out
        .as_ref()
        .map(|data| data.recut(bench.search_horizon));
    let left = remainder(&chosen.search, &bench.search, unseen.as_ref(), options.seed);
    report(4, "the verdict");
    conclude(&Case {
        bench: &bench,
        trials: sizes.into_iter().flatten().collect(),
        best,
        remainder: left,
        seed: options.seed,
    })
}

/// What every trial is measured with.
#[derive(Debug)]
pub(super) struct Bench {
    /// Training motions in short windows, to search on.
    pub search: Data,
    /// Training motions over the judging horizon.
    pub training: Data,
    /// Held-out motions over the judging horizon.
    pub held_out: Option<Data>,
    pub base: Trial,
    pub horizon: Horizon,
    search_horizon: Horizon,
    pub shams: Vec<Trial>,
    candidates: Vec<Candidate>,
    /// The model as it came.
    start: Model,
    seed: u64,
}

impl Bench {
    fn new(
        model: &Model,
        training: Vec<Motion>,
        held_out: Vec<Motion>,
        options: &DiagnoseOptions,
    ) -> Bench {
        let mut all = training.clone();
        all.extend(held_out.iter().cloned());
        let candidates = candidates(model, &all, &options.without);
        let whole = Data::new(model, training, Horizon::Whole);
        let longest = options
            .horizon
            .unwrap_or_else(|| longest_stable(model, &whole));
        let few = held_out.is_empty() && whole.samples() < SMALL;
        let search_horizon = search_horizon(&whole, longest, few);
        let search = whole.recut(search_horizon);
        let mut base = Trial::new(Vec::new(), base_fit(model, &search, few, options.seed));
        let (horizon, training) = match options.horizon {
            Some(horizon) => (horizon, whole.recut(horizon)),
            None => longest_useful(&base.search.model, &whole, longest),
        };
        let held_out = (!held_out.is_empty()).then(|| Data {
            sigma_rad: training.sigma_rad.clone(),
            ..Data::new(model, held_out, horizon)
        });
        base.judge(&training, held_out.as_ref(), FINISH);
        let mut bench = Bench {
            search,
            training,
            held_out,
            base,
            horizon,
            search_horizon,
            shams: Vec::new(),
            candidates,
            start: model.clone(),
            seed: options.seed,
        };
        bench.shams = bench.try_shams(model.link_count());
        bench
    }

    /// Whether a trial leaves nothing but noise.
    pub fn at_floor(&self, trial: &Trial) -> bool {
        trial.judged.as_ref().is_some_and(|judged| {
            judged.training.rms() < AT_FLOOR
                && judged
                    .held_out
                    .as_ref()
                    .is_none_or(|score| score.rms() < AT_FLOOR)
        })
    }

    fn judge(&self, trial: &mut Trial) {
        trial.judge(&self.training, self.held_out.as_ref(), JUDGE);
    }

    fn try_shams(&self, joints: usize) -> Vec<Trial> {
        let shams: Vec<Candidate> = CONTROLS
            .iter()
            .filter(|effect| effect.card().id == SHAM)
            .flat_map(|&effect| {
                (0..joints).map(move |joint| Candidate {
                    effect,
                    joint: Some(joint),
                })
            })
            .collect();
        self.first_look(&self.base, &shams, 1)
            .into_iter()
            .map(|mut trial| {
                self.judge(&mut trial);
                trial
            })
            .collect()
    }

    fn singles(&self) -> Vec<Trial> {
        let starts = if self.small() { 6 } else { 2 };
        let trials = self.first_look(&self.base, &self.candidates, starts);
        self.finals(trials)
    }

    /// Short fits of candidates on top of a trial, each from its `openings` best starts; the better one counts.
    fn first_look(&self, from: &Trial, candidates: &[Candidate], starts: usize) -> Vec<Trial> {
        let off = Projector::new(&from.search);
        candidates
            .par_iter()
            .filter(|candidate| !from.set.contains(candidate))
            .filter_map(|&candidate| {
                let found = openings(&from.search, &off, candidate, &self.search);
                self.best_of(from, &found[..starts.min(found.len())])
            })
            .collect()
    }

    fn best_of(&self, from: &Trial, openings: &[Opening]) -> Option<Trial> {
        let looks = openings
            .iter()
            .map(|o| from.with(o.candidate, &o.values, &self.search, LOOK));
        let restarts = openings
            .first()
            .filter(|_| self.small())
            .map(|o| self.restarted(from, o))
            .into_iter()
            .flatten();
        looks
            .chain(restarts)
            .min_by(|a, b| a.search_mean.total_cmp(&b.search_mean))
    }

    /// Few samples and nothing held out: simulations are cheap, and a single motion has more false valleys.
    fn small(&self) -> bool {
        self.held_out.is_none() && self.search.samples() < SMALL
    }

    /// Fits from random values around the model's own and the opening's.
    fn restarted(&self, from: &Trial, opening: &Opening) -> Vec<Trial> {
        let mut random = ChaCha8Rng::seed_from_u64(self.seed);
        (0..RESTARTS)
            .map(|_| {
                let mut model = self.start.clone();
                for candidate in &from.set {
                    let known = from.search.model.effects.iter();
                    let same = |e: &&EffectInstance| {
                        e.effect == candidate.effect && e.joint == candidate.joint
                    };
                    model.effects.extend(known.filter(same).cloned());
                }
                model
                    .effects
                    .push(opening.candidate.instance(&opening.values));
                let mut free = from.search.free.clone();
                free.extend(opening.candidate.paths());
                scatter(&mut model, &free, &mut random);
                let options = FitOptions {
                    iterations: RESTART_ITERATIONS,
                    ..FitOptions::default()
                };
                let mut set = from.set.clone();
                set.push(opening.candidate);
                Trial::new(set, fit(&model, &free, &self.search, None, options))
            })
            .collect()
    }

    /// Sorts trials by training error, takes the best to the end and judges them.
    fn finals(&self, mut trials: Vec<Trial>) -> Vec<Trial> {
        let by_error = |a: &Trial, b: &Trial| a.search_mean.total_cmp(&b.search_mean);
        trials.sort_by(by_error);
        // Halving: many get a second look, few go to the end.
        let heats = [(3 * FINALISTS, LOOK), (FINALISTS, FINISH)];
        for (places, iterations) in heats {
            let places = places.min(trials.len());
            trials[..places]
                .par_iter_mut()
                .for_each(|trial| trial.finish(&self.search, iterations));
            trials.sort_by(by_error);
        }
        let finalists = FINALISTS.min(trials.len());
        trials[..finalists]
            .par_iter_mut()
            .for_each(|trial| self.judge(trial));
        trials
    }

    /// Larger sets: partners for each lead, chosen by what they would gain, then swaps in the best.
    fn grow(&self, leads: &[Trial]) -> Vec<Trial> {
        let mut tried: Vec<Trial> = Vec::new();
        for lead in leads.iter().take(LEADS) {
            let wanted = self.partners(lead, &tried);
            let found: Vec<Trial> = wanted
                .par_iter()
                .map(|o| lead.with(o.candidate, &o.values, &self.search, LOOK))
                .collect();
            tried.extend(found);
        }
        let finals = self.finals(tried);
        self.swapped(finals)
    }

    /// The most promising openings on top of a trial that make a set not yet tried.
    fn partners(&self, lead: &Trial, tried: &[Trial]) -> Vec<Opening> {
        let off = Projector::new(&lead.search);
        let mut openings: Vec<Opening> = self
            .candidates
            .par_iter()
            .filter(|candidate| !lead.set.contains(candidate))
            .filter(|candidate| {
                let mut set = lead.set.clone();
                set.push(**candidate);
                !tried.iter().any(|trial| trial.adds(&set))
            })
            .filter_map(|&candidate| {
                openings(&lead.search, &off, candidate, &self.search)
                    .into_iter()
                    .next()
            })
            .collect();
        openings.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        openings.truncate(PARTNERS);
        openings
    }

    /// Tries to replace each older member of the best set: what led may no longer be needed.
    fn swapped(&self, mut trials: Vec<Trial>) -> Vec<Trial> {
        let Some(best) = trials.first().cloned() else {
            return trials;
        };
        for leaving in 0..best.set.len().saturating_sub(1) {
            let kept: Vec<Candidate> = (0..best.set.len())
                .filter(|&i| i != leaving)
                .map(|i| best.set[i])
                .collect();
            let mut rest = best.without(leaving, &self.base);
            rest.refit(&self.search, LOOK);
            let wanted: Vec<Opening> = self
                .partners(&rest, &trials)
                .into_iter()
                .filter(|o| !kept.contains(&o.candidate))
                .take(2)
                .collect();
            let found: Vec<Trial> = wanted
                .par_iter()
                .map(|o| rest.with(o.candidate, &o.values, &self.search, LOOK))
                .collect();
            trials.extend(found);
        }
        self.finals(trials)
    }

    /// The best trial that is surely and usefully better than `reference` where it counts.
    ///
    /// Among trials that nothing tells apart, the one with the fewest values.
    fn accepted<'a>(&self, reference: &Trial, trials: &'a [Trial]) -> Option<&'a Trial> {
        let worthy: Vec<(&Trial, f64)> = trials
            .iter()
            .filter(|trial| self.pays(reference, trial))
            .filter_map(|trial| Some((trial, trial.pooled()?.mean())))
            .collect();
        let (best, least) = *worthy.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        worthy
            .iter()
            .filter(|(trial, mean)| {
                !self.clearly_worse(trial, best, reference) && *mean <= 1.1 * least
            })
            .min_by(|a, b| {
                a.0.added_values()
                    .cmp(&b.0.added_values())
                    .then(a.1.total_cmp(&b.1))
            })
            .map(|(trial, _)| *trial)
    }

    /// Whether a larger set earns its place against a smaller one.
    pub fn pays(&self, reference: &Trial, trial: &Trial) -> bool {
        let (Some(before), Some(after)) = (reference.deciding(), trial.deciding()) else {
            return false;
        };
        let (low, _) = fall(before, after, self.seed);
        let practical = if self.held_out.is_some() { 0.03 } else { 0.10 };
        let significant = trial
            .judged
            .as_ref()
            .is_some_and(|judged| judged.significant);
        significant
            && !trial.rests_on_bound()
            && low > practical
            && self.bic_change(reference, trial) < -10.0
    }

    /// Whether the data tell that `trial` is worse than `best`; `reference` is what both improve on.
    ///
    /// At the noise floor a sure difference counts however small. Above it, something else is missing too and
    /// bends every candidate, so a difference decides nothing that is smaller than what remains unexplained and
    /// than a tenth of what was gained.
    pub fn clearly_worse(&self, trial: &Trial, best: &Trial, reference: &Trial) -> bool {
        let (Some(worse), Some(better), Some(start)) =
            (trial.pooled(), best.pooled(), reference.pooled())
        else {
            return true;
        };
        let sure = super::score::surely_worse(&worse, &better, self.seed);
        if self.at_floor(best) {
            return sure;
        }
        let gained = (start.mean() - better.mean()).max(0.0);
        let unexplained = better.mean() - 1.0;
        sure && worse.mean() - better.mean() > unexplained.min(0.1 * gained)
    }

    /// Change of the Bayesian information criterion on the training motions; correlated residuals count fewer.
    pub fn bic_change(&self, reference: &Trial, trial: &Trial) -> f64 {
        let values = trial.search.free.len() as f64 - reference.search.free.len() as f64;
        let (n, ratio) = match (&reference.judged, &trial.judged) {
            (Some(before), Some(after)) => (
                effective_samples(&after.training, &after.fit),
                after.training.mean() / before.training.mean(),
            ),
            _ => {
                let score = Score::of(&trial.search, &self.search);
                (
                    effective_samples(&score, &trial.search),
                    trial.search_mean / reference.search_mean,
                )
            }
        };
        n * ratio.ln() + values * n.max(2.0).ln()
    }
}

/// Multiplies every free value that can't be negative by a random factor up to about three either way.
fn scatter(model: &mut Model, free: &[ParameterPath], random: &mut ChaCha8Rng) {
    for path in free {
        let (low, high) = path.bounds(model);
        let factor = random.random_range(-1.2f64..1.2).exp();
        if let Some(value) = path.get(model).filter(|_| low >= 0.0) {
            let known = path.set(model, (value * factor).clamp(low, high));
            debug_assert!(known, "a free parameter is one of the model's");
        }
    }
}

/// Short windows to search on: a second, or what holds forty samples; never longer than the plant is stable.
/// Few samples are searched from many starts instead, over the horizon that counts.
fn search_horizon(whole: &Data, longest: Horizon, few: bool) -> Horizon {
    let samples: usize = whole.motions.iter().map(Motion::len).sum();
    let seconds: f64 = whole.motions.iter().map(Motion::duration_s).sum();
    if few {
        return longest;
    }
    let wanted = SEARCH_S.max(40.0 * seconds / samples.max(1) as f64);
    match longest {
        Horizon::Seconds(stable) => Horizon::Seconds(stable.min(wanted)),
        Horizon::Whole => Horizon::Seconds(wanted),
    }
}

/// Samples that count as independent: fewer, the more neighbouring residuals agree.
fn effective_samples(score: &Score, fit: &Fit) -> f64 {
    let (mut product, mut square) = (0.0, 1e-300);
    for window in &fit.residuals.windows {
        for pair in window.windows(2) {
            product += pair[0] * pair[1];
            square += pair[0] * pair[0];
        }
    }
    let correlation = (product / square).clamp(0.0, 0.999);
    let n = score.counts.iter().sum::<usize>() as f64;
    (n * (1.0 - correlation) / (1.0 + correlation))
        .max(2.0 * score.sums.len() as f64)
        .min(n)
}

/// The base model fitted; from many starts on few samples.
fn base_fit(model: &Model, data: &Data, few: bool, seed: u64) -> Fit {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let starts = if few { RESTARTS } else { 0 };
    let scattered = (0..starts).map(|_| {
        let mut start = model.clone();
        scatter(&mut start, &model.free, &mut random);
        start
    });
    let models: Vec<Model> = std::iter::once(model.clone()).chain(scattered).collect();
    let fits: Vec<Fit> = models
        .par_iter()
        .map(|start| fit(start, &model.free, data, None, FitOptions::default()))
        .collect();
    let mut best = 0;
    for (k, candidate) in fits.iter().enumerate() {
        if candidate.residuals.cost() < fits[best].residuals.cost() {
            best = k;
        }
    }
    fits[best].clone()
}

/// The longest windows over which the base model, as fitted on short ones, still follows the measurement: longer
/// ones show more of a small effect, but where the simulation has lost the motion altogether they show nothing.
fn longest_useful(model: &Model, whole: &Data, longest: Horizon) -> (Horizon, Data) {
    let mut horizon = longest;
    let mut seconds = match longest {
        Horizon::Seconds(stable) => stable,
        Horizon::Whole => whole
            .motions
            .iter()
            .map(Motion::duration_s)
            .fold(0.0, f64::max),
    };
    loop {
        let data = whole.recut(horizon);
        let settled = settle(model, &data);
        let mean = settled.residuals.cost() / settled.residuals.count().max(1) as f64;
        if mean <= (0.25 * spread(&data)).powi(2) || seconds <= 1.0 {
            return (horizon, data);
        }
        seconds = (seconds / 2.0).clamp(1.0, 4.0);
        horizon = Horizon::Seconds(seconds);
    }
}

/// Root-mean-square deviation of the measured positions from their mean, in units of sigma.
fn spread(data: &Data) -> f64 {
    let (mut sum, mut count) = (0.0, 0usize);
    for motion in &data.motions {
        for (position, sigma) in motion.position_rad.iter().zip(&data.sigma_rad) {
            let mean = position.iter().sum::<f64>() / position.len() as f64;
            sum += position
                .iter()
                .map(|p| ((p - mean) / sigma).powi(2))
                .sum::<f64>();
            count += position.len();
        }
    }
    (sum / count.max(1) as f64).sqrt()
}
