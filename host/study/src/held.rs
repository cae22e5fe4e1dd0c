//! Robots that friction holds: they stay without any command, and prove nothing of a controller.

use crate::sim::closed_loop::{Controller, Job, Measurement, Outcome, run_jobs};

/// Commands nothing.
#[derive(Debug)]
struct Uncommanded;

impl Controller for Uncommanded {
    fn control(&self, _memory: &mut [f64], _measured: Measurement<'_>, command: &mut [f64]) {
        command.fill(0.0);
    }
}

/// Does the jobs on this thread; outcomes in their order. A robot that stays as well when it is not
/// commanded does not count as stabilised.
pub(super) fn run_unheld(jobs: Vec<Job<'_>>) -> Vec<Outcome> {
    let mut outcomes = run_jobs(jobs.clone());
    // Where torques are constant between commands nothing can hold an upright robot.
    let may_hold =
        |place: &usize| outcomes[*place].stabilised && !jobs[*place].closed.plant.is_dense();
    let places: Vec<usize> = (0..jobs.len()).filter(may_hold).collect();
    let uncommanded = places.iter().map(|place| Job {
        controller: &Uncommanded,
        ..jobs[*place].clone()
    });
    let uncommanded = run_jobs(uncommanded);
    for (place, alone) in places.into_iter().zip(uncommanded) {
        outcomes[place].held = alone.stabilised;
        outcomes[place].stabilised = !alone.stabilised;
    }
    outcomes
}
