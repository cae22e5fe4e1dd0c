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
/// Sets from which larger ones grow, beside the one that leaves least where it counts.
pub(super) const BEAM: usize = 5;
/// Partners tried for each set of the beam.
pub(super) const PARTNERS: usize = 5;
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
const FIRST_LOOK_STEPS: usize = 2;
/// The finals of one size.
const FINALS_STEPS: usize = SECOND_LOOKS + FINALISTS * (1 + EVALUATION_STEPS);
/// The placebos and the residual structure.
pub(super) const STRUCTURE_STEPS: usize = 15;

/// Steps until sets of `size` are done.
pub(super) fn steps_up_to(size: usize, candidates: usize) -> usize {
    let larger = (BEAM + 1) * PARTNERS + 2 * FINALS_STEPS;
    BASE_STEPS + FIRST_LOOK_STEPS * candidates + FINALS_STEPS + (size.max(1) - 1) * larger
}

/// Steps of a diagnosis with so many candidates, when it does not end early.
pub(super) fn planned_steps(candidates: usize, most_effects: usize) -> usize {
    steps_up_to(most_effects, candidates) + STRUCTURE_STEPS
}
