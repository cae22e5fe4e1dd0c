//! Over how long a run candidates are sought, and over how long they are judged.

use super::block_errors::{gain, paired};
use super::budget::{EVALUATE, FAR_BEHIND, FINISH, HOPELESS};
use super::evaluator::Evaluator;
use super::hypothesis::Hypothesis;
use super::strategy::Strategy;
use super::verdict::FAR_OFF;
use crate::fitting::{FitOptions, FitProblem, Horizon};
use crate::motion::Motion;
use rayon::prelude::*;

/// Longest windows to judge over, s, beside whole motions.
const LADDER_S: [f64; 4] = [4.0, 1.0, 0.5, 0.25];
/// Hypotheses whose gain decides which of them.
const LEADERS: usize = 3;

/// The most that leading hypotheses gain at a horizon.
struct MostGained {
    /// Log-likelihood over the base model.
    gain: f64,
    /// Whether one of them leaves nothing but noise.
    at_noise_floor: bool,
    /// Whether one of them leaves no more than noise excuses.
    is_followed: bool,
}

impl Evaluator<'_> {
    /// Chooses the horizon at which the leading hypotheses gain the most over the base model, where
    /// the user has not chosen one, and evaluates the base there.
    ///
    /// Over a long run a small effect shows more; where a run is lost for other reasons, because
    /// something else is missing or an arm sticks a sample sooner or later, a long run shows
    /// nothing. The gain of log-likelihood on the motions that decide weighs one against the other.
    pub fn choose_horizon(&mut self, leaders: &[Hypothesis]) {
        let horizons = self.horizons();
        let is_free = !self.horizon_given && self.does(Strategy::ChosenHorizon);
        if !is_free || horizons.len() == 1 || self.at_noise_floor(&self.base) {
            return;
        }
        let whole = self.most_gained(leaders, Horizon::Whole);
        // No shorter run shows more than one that leaves nothing but noise; nor, where
        // many candidates make a horizon costly, is one looked for beside a run that is not lost.
        if whole.at_noise_floor || self.has_many_candidates() && whole.is_followed {
            return;
        }
        let shorter = horizons[1..].par_iter();
        let shorter = shorter.map(|&horizon| self.most_gained(leaders, horizon).gain);
        let gains: Vec<f64> = std::iter::once(whole.gain)
            .chain(shorter.collect::<Vec<_>>())
            .collect();
        let mut best = 0;
        for (index, gain) in gains.iter().enumerate() {
            // A shorter horizon must gain something; where nothing is missing none does.
            if *gain > gains[best].max(0.0) {
                best = index;
            }
        }
        if best > 0 {
            self.recut(horizons[best]);
        }
    }

    /// Chooses the longest horizon over which a leading set leaves nothing but noise, longer than
    /// the one that was chosen for single effects. All that were evaluated are evaluated again over
    /// it.
    ///
    /// Single effects that lose a long run say nothing of sets that follow it; and the more windows
    /// there are, the more begin where the samples around them tell the start state badly: in a
    /// play, or where a joint just breaks away.
    pub fn settle_horizon(&mut self, sizes: &mut [Vec<Hypothesis>]) {
        if self.horizon_given || !self.does(Strategy::LongerHorizon) {
            return;
        }
        let all = sizes.iter().flatten();
        // What leaves more than six times the noise over shorter runs is not fitted over longer
        // ones: it takes long, and leaves more than noise there, too.
        let leaders = all.filter(|h| h.evaluation.is_some() && h.deciding_mean() <= HOPELESS);
        let mut leaders: Vec<Hypothesis> = leaders.cloned().collect();
        leaders.sort_by(|a, b| a.deciding_mean().total_cmp(&b.deciding_mean()));
        leaders.truncate(LEADERS);
        if !leaders.is_empty() {
            self.lengthen_horizon(leaders, sizes);
        }
    }

    /// Goes over to the longest of the longer horizons that one of the leaders follows, from the
    /// values it had.
    fn lengthen_horizon(&mut self, mut leaders: Vec<Hypothesis>, sizes: &mut [Vec<Hypothesis>]) {
        let horizons = self.horizons();
        let now = horizons.iter().position(|h| *h == self.horizon);
        let mut followed = None;
        let mut before = self.training.clone();
        for &horizon in horizons[..now.unwrap_or(0)].iter().rev() {
            let (training, held_out) = self.cut(horizon);
            leaders.par_iter_mut().for_each(|leader| {
                leader.run_longer(&before, &training, held_out.as_ref());
            });
            if leaders.iter().any(|leader| self.at_noise_floor(leader)) {
                followed = Some(horizon);
            }
            before = training;
        }
        if let Some(horizon) = followed {
            let before = self.training.clone();
            self.judge_over(horizon, sizes, |hypothesis, training, held_out| {
                hypothesis.run_longer(&before, training, held_out);
            });
        }
    }

    /// The horizons to choose from, the longest first.
    fn horizons(&self) -> Vec<Horizon> {
        let longest = self.training.recut(Horizon::Whole).longest_window_s();
        let ladder = LADDER_S.into_iter().filter(|seconds| *seconds < longest);
        let held_out = self.held_out.iter().flat_map(|data| &data.motions);
        let motions: Vec<&Motion> = self.training.motions.iter().chain(held_out).collect();
        // What is printed as `--horizon` must be taken as such.
        let allowed = |horizon: &Horizon| horizon.check(&self.start, motions.clone()).is_ok();
        std::iter::once(Horizon::Whole)
            .chain(ladder.map(Horizon::Seconds).filter(allowed))
            .collect()
    }

    /// The motions to learn from and those held out, cut to a horizon.
    fn cut(&self, horizon: Horizon) -> (FitProblem, Option<FitProblem>) {
        let held_out = self.held_out.as_ref().map(|data| data.recut(horizon));
        (self.training.recut(horizon), held_out)
    }

    /// What the best of the leaders gains over the base model at a horizon.
    fn most_gained(&self, leaders: &[Hypothesis], horizon: Horizon) -> MostGained {
        let (training, held_out) = self.cut(horizon);
        let evaluated = |hypothesis: &Hypothesis| {
            let mut hypothesis = hypothesis.clone();
            hypothesis.evaluation = None;
            let options = FitOptions::iterations(EVALUATE).rough();
            hypothesis.evaluate(&self.search, &training, held_out.as_ref(), options);
            hypothesis
        };
        let base = evaluated(&self.base);
        let limit = FAR_BEHIND * leaders.first().map_or(0.0, |first| first.search_mean);
        let leading = leaders.iter().take_while(|l| l.search_mean <= limit);
        let leading: Vec<&Hypothesis> = leading.take(LEADERS).collect();
        let leaders: Vec<Hypothesis> = leading.into_par_iter().map(evaluated).collect();
        let gained =
            |leader: &Hypothesis| gain(&paired(base.deciding()?, leader.deciding()?)).into();
        let gains = leaders.iter().filter_map(gained);
        MostGained {
            gain: gains.fold(f64::NEG_INFINITY, f64::max),
            at_noise_floor: leaders.iter().any(|leader| self.at_noise_floor(leader)),
            is_followed: leaders.iter().any(is_followed),
        }
    }

    /// Judges over another horizon what was not evaluated yet.
    pub(super) fn recut(&mut self, horizon: Horizon) {
        self.judge_over(horizon, &mut [], |_, _, _| ());
    }

    /// Judges over another horizon; `again` evaluates over its motions all that were evaluated over
    /// the one before. Where that is ended all stays as it was.
    fn judge_over(
        &mut self,
        horizon: Horizon,
        sizes: &mut [Vec<Hypothesis>],
        again: impl Fn(&mut Hypothesis, &FitProblem, Option<&FitProblem>) + Sync,
    ) {
        let (training, held_out) = self.cut(horizon);
        let models = [&self.base, &self.given].map(|hypothesis| {
            let mut hypothesis = hypothesis.clone();
            hypothesis.evaluation = None;
            let options = FitOptions::iterations(FINISH);
            hypothesis.evaluate(&self.search, &training, held_out.as_ref(), options);
            hypothesis
        });
        let all = sizes.iter_mut().flatten();
        let mut evaluated: Vec<&mut Hypothesis> = all.filter(|h| h.evaluation.is_some()).collect();
        let afresh = evaluated.par_iter().map(|hypothesis| {
            let mut hypothesis = Hypothesis::clone(hypothesis);
            again(&mut hypothesis, &training, held_out.as_ref());
            hypothesis
        });
        let afresh: Vec<Hypothesis> = afresh.collect();
        for (known, afresh) in evaluated.iter_mut().zip(afresh) {
            **known = afresh;
        }
        [self.base, self.given] = models;
        (self.horizon, self.training, self.held_out) = (horizon, training, held_out);
        self.show_best(sizes);
    }
}

/// Whether a hypothesis leaves no more than noise excuses over the runs that it is judged by.
fn is_followed(hypothesis: &Hypothesis) -> bool {
    hypothesis.deciding_mean() <= FAR_OFF
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::{Motions, bench};
    use crate::diagnose::search::tests::recorded;
    use crate::fitting::search_horizons;

    /// The motions of an arm, of whose samples one of so many is left.
    fn thinned(one_of: usize) -> FitProblem {
        let mut bench = bench(Motions::Arm, 1, &["viscous"]).unwrap();
        for log in &mut bench.logs {
            let is_row = |line: &str| line.starts_with(|first: char| first.is_ascii_digit());
            let mut row = 0;
            let kept = log.csv.lines().filter(|line| {
                row += usize::from(is_row(line));
                !is_row(line) || row % one_of == 1 % one_of
            });
            log.csv = kept.map(|line| format!("{line}\n")).collect();
        }
        let (model, training, _) = recorded(&bench);
        FitProblem::new(&model, training, Horizon::Whole)
    }

    #[test]
    fn windows_of_the_search_hold_forty_samples_and_are_no_longer_than_wanted() {
        let seconds = |horizons: Vec<Horizon>| -> Vec<Option<f64>> {
            let rounded = |seconds: f64| (100.0 * seconds).round() / 100.0;
            horizons
                .iter()
                .map(|horizon| horizon.seconds().map(rounded))
                .collect()
        };
        let dense = thinned(1);
        let all = search_horizons(&dense, Horizon::Whole, false);
        assert_eq!(seconds(all), [Some(1.0), Some(0.5), Some(0.4)]);
        let shorter = search_horizons(&dense, Horizon::Seconds(0.7), false);
        assert_eq!(seconds(shorter), [Some(0.7), Some(0.5), Some(0.4)]);
        let sparse = seconds(search_horizons(&thinned(10), Horizon::Whole, false));
        assert_eq!(sparse.len(), 1);
        assert!((3.9..4.1).contains(&sparse[0].unwrap()), "{sparse:?}");
        let few = search_horizons(&dense, Horizon::Whole, true);
        assert_eq!(few, [Horizon::Whole]);
    }
}
