//! What every trial is measured with: the motions cut for the search and for the judgement, the base model fitted,
//! the candidates.

use super::candidate::{Candidate, candidates};
use super::findings::Remainder;
use super::horizon::{longest_useful, search_horizon};
use super::opening::{Change, changes};
use super::options::DiagnoseOptions;
use super::progress::{Progress, Steps};
use super::remainder::remainder;
use super::restart::{FEW, base_fit};
use super::score::AT_FLOOR;
use super::search::planned_steps;
use super::trial::Trial;
use crate::effects::{CONTROLS, SHAM};
use crate::fitting::{Data, Horizon, longest_stable};
use crate::log::Motion;
use crate::model::Model;
use rayon::prelude::*;

/// Iterations of a finalist.
pub(super) const FINISH: usize = 25;
/// Iterations over the judging horizon, from what the windows found.
const JUDGE: usize = 12;
/// The first windows to judge over where no model follows a whole motion, s.
const LONGEST_WINDOW_S: f64 = 4.0;

/// What every trial is measured with.
pub(super) struct Bench<'a> {
    /// Training motions in short windows, to search on.
    pub search: Data,
    /// Training motions over the judging horizon.
    pub training: Data,
    /// Held-out motions over the judging horizon.
    pub held_out: Option<Data>,
    pub base: Trial,
    pub horizon: Horizon,
    /// Whether the user has chosen it.
    told_horizon: bool,
    /// How long the windows of `search` are.
    pub search_horizon: Horizon,
    pub shams: Vec<Trial>,
    pub candidates: Vec<Candidate>,
    /// What each start of each candidate changes in the base model's prediction.
    pub changes: Vec<Vec<Change>>,
    /// The model as it came.
    pub start: Model,
    pub seed: u64,
    /// Most effects named together.
    pub most_effects: usize,
    pub steps: Steps<'a>,
}

impl<'a> Bench<'a> {
    pub fn new(
        model: &Model,
        training: Vec<Motion>,
        held_out: Vec<Motion>,
        options: &DiagnoseOptions,
        progress: &'a (dyn Fn(Progress) + Sync),
    ) -> Bench<'a> {
        let mut all = training.clone();
        all.extend(held_out.iter().cloned());
        let candidates = candidates(model, &all, &options.without);
        // Without motions to judge by, two effects together can't be told from luck.
        let most_effects = if held_out.is_empty() {
            1
        } else {
            options.most_effects
        };
        let steps = Steps::new(planned_steps(candidates.len(), most_effects), progress);
        let whole = Data::new(model, training, Horizon::Whole);
        let longest = options
            .horizon
            .unwrap_or_else(|| longest_stable(model, &whole));
        let few = held_out.is_empty() && whole.samples() < FEW;
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
        let changes = every_change(&base, &candidates, &search);
        let mut bench = Bench {
            search,
            training,
            held_out,
            base,
            horizon,
            told_horizon: options.horizon.is_some(),
            search_horizon,
            shams: Vec::new(),
            candidates,
            changes,
            start: model.clone(),
            seed: options.seed,
            most_effects,
            steps,
        };
        bench.shams = bench.try_shams(model.link_count());
        bench
    }

    /// What a trial leaves to explain: in short windows or over the judging horizon, whichever surely shows more.
    ///
    /// A large remainder is best told in windows, over which the simulation can be taken for linear; a small one
    /// shows only over the longer horizon.
    pub fn remainder(&self, trial: &Trial) -> Option<Remainder> {
        let held_out = self.held_out.as_ref()?;
        let unseen = held_out.recut(self.search_horizon);
        let short = remainder(&trial.search, &self.search, &unseen, self.seed);
        let judged = trial.judged.as_ref();
        let long =
            judged.and_then(|judged| remainder(&judged.fit, &self.training, held_out, self.seed));
        [short, long]
            .into_iter()
            .flatten()
            .max_by(|a, b| a.explainable_low.total_cmp(&b.explainable_low))
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

    /// Shortens the judging horizon while the best trial, which explains every short window of the training motions,
    /// does not follow them over the whole horizon: an arm that sticks a sample sooner or later takes another way, and
    /// no model foretells that from the start of the run.
    pub fn shorten(&mut self, best: &mut Trial) {
        if !best.follows_windows() {
            return;
        }
        let mut shortened = false;
        loop {
            self.judge(best);
            let follows = best
                .judged
                .as_ref()
                .is_some_and(|judged| judged.training.rms() < AT_FLOOR);
            let Some(shorter) = self.shorter().filter(|_| !follows) else {
                break;
            };
            shortened = true;
            best.judged = None;
            self.horizon = shorter;
            self.training = self.training.recut(shorter);
            self.held_out = self.held_out.as_ref().map(|data| data.recut(shorter));
        }
        if shortened {
            self.base.judged = None;
            let held_out = self.held_out.as_ref();
            self.base.judge(&self.training, held_out, FINISH);
            for sham in &mut self.shams {
                sham.judged = None;
                sham.judge(&self.training, held_out, JUDGE);
            }
        }
    }

    /// The next shorter judging horizon, if it may be chosen and is not the shortest already.
    fn shorter(&self) -> Option<Horizon> {
        let Horizon::Seconds(least) = self.search_horizon else {
            return None;
        };
        let next = match self.horizon {
            Horizon::Whole => LONGEST_WINDOW_S,
            Horizon::Seconds(seconds) if seconds > least => seconds / 2.0,
            Horizon::Seconds(_) => return None,
        };
        (!self.told_horizon).then_some(Horizon::Seconds(next.min(LONGEST_WINDOW_S).max(least)))
    }

    /// Judges a trial over the judging horizon.
    pub fn judge(&self, trial: &mut Trial) {
        trial.judge(&self.training, self.held_out.as_ref(), JUDGE);
    }

    /// Few samples and nothing held out: simulations are cheap, and a single motion has more false valleys.
    pub fn small(&self) -> bool {
        self.held_out.is_none() && self.search.samples() < FEW
    }

    fn try_shams(&self, joints: usize) -> Vec<Trial> {
        let shams: Vec<Candidate> = CONTROLS
            .iter()
            .filter(|effect| effect.info().id == SHAM)
            .flat_map(|&effect| {
                (0..joints).map(move |joint| Candidate {
                    effect,
                    joint: Some(joint),
                })
            })
            .collect();
        let changes = every_change(&self.base, &shams, &self.search);
        self.first_look(&self.base, &changes, 1)
            .into_iter()
            .map(|mut trial| {
                self.judge(&mut trial);
                trial
            })
            .collect()
    }
}

/// What the starts of each candidate change in the base model's prediction.
fn every_change(base: &Trial, candidates: &[Candidate], data: &Data) -> Vec<Vec<Change>> {
    candidates
        .par_iter()
        .map(|&candidate| changes(&base.search, candidate, data))
        .collect()
}
