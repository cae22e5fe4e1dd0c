//! How much a diagnosis tries, and how many steps of progress that takes.

/// Iterations of a first look at a candidate.
pub(super) const LOOK: usize = 4;
/// Iterations of a finalist.
pub(super) const FINISH: usize = 25;
/// Iterations over the evaluation horizon, from what the windows found.
pub(super) const EVALUATE: usize = 12;
/// A hypothesis whose squared error on the windows, fitted to the end, is so many times the best
/// one's is only looked at over the evaluation horizon.
pub(super) const FAR_BEHIND: f64 = 9.0;
/// A hypothesis whose squared error on the windows is so many times the best one's, six times the
/// error, is taken no further.
pub(super) const HOPELESS: f64 = 36.0;
/// Finalists of each size.
pub(super) const FINALISTS: usize = 6;
/// Hypotheses that get a second look.
pub(super) const SECOND_LOOKS: usize = 3 * FINALISTS;
/// Sets from which larger ones grow.
pub(super) const BEAM: usize = 5;
/// Partners tried for each set of the beam.
pub(super) const PARTNERS: usize = 5;
/// Candidates simulated on top of a set, to choose its partners from.
pub(super) const SIMULATED: usize = 40;
/// More candidates than three joints have: most act where nothing is missing.
pub(super) const MANY: usize = 120;
/// Fewer training samples than this are few.
pub(super) const FEW_SAMPLES: usize = 1500;
/// Random starts of each candidate where samples are few, at most, and their iterations.
pub(super) const STARTS: usize = 100;
/// Samples times random starts of one candidate, at most.
pub(super) const START_SAMPLES: usize = 20_000;
pub(super) const START_ITERATIONS: usize = 30;
/// Iterations that a fit from each start value gets where a law jumps, and how many go on.
pub(super) const RESTART_LOOK: usize = 8;
pub(super) const RESTARTS: usize = 2;

/// Steps of progress are short fits. To evaluate a hypothesis takes as long as so many:
pub(super) const EVALUATION_STEPS: usize = 2;
/// The base model, likewise.
pub(super) const BASE_STEPS: usize = 5;
/// A candidate's glance and look.
pub(super) const FIRST_LOOK_STEPS: usize = 2;
/// The values of the model file: glances and the finals.
pub(super) const VALUE_STEPS: usize = 2 * FINALISTS * EVALUATION_STEPS;
/// The finals of one size.
const FINALS_STEPS: usize = SECOND_LOOKS + FINALISTS * (1 + EVALUATION_STEPS);
/// Taking the best of every size apart.
const PRUNING_STEPS: usize = 5 * EVALUATION_STEPS;

/// Steps of sets of one effect.
pub(super) fn singles_steps(candidates: usize) -> usize {
    FIRST_LOOK_STEPS * candidates + FINALS_STEPS
}

/// Steps of the sets of a size: partners of the beam; a look at so many candidates beside each of
/// the leading sets, where all are tried.
pub(super) fn larger_steps(candidates: Option<usize>) -> usize {
    let beside = candidates.map_or(0, |count| 2 * FIRST_LOOK_STEPS * count + FINALS_STEPS);
    BEAM * PARTNERS + FINALS_STEPS + beside + PRUNING_STEPS
}
/// Steps of the judging: its parts.
pub(super) const JUDGING_STEPS: usize = 8;
