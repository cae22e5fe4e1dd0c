//! Several runs in the lanes of one integration.
//!
//! Each lane goes its own way from event to event; those that need the same number of steps next
//! take them together. A run comes out the same, bit for bit, whatever runs beside it.
//!
//! Rests on it, and on the wider registers of `multiversion`, in `cargo xtask peers`: "closed-loop
//! run of 5 s, rigid: numba".

use super::Outcome;
use super::equations::{Absolute, Equations};
use super::run::{Run, RunStep};
use crate::dynamics::{Dense, Lanes};
use std::array::from_fn;

/// Lanes: two registers' worth where a register holds two numbers.
const WIDTH: usize = 4;

/// Finishes all runs; outcomes in their order.
pub(super) fn finish(runs: Vec<Run<'_>>) -> Vec<Outcome> {
    match runs.first().map(|run| &run.closed.plant.equations) {
        Some(Equations::One(_)) => in_lanes(runs, |it| match it {
            Equations::One(dense) => Some(dense),
            _ => None,
        }),
        Some(Equations::Two(_)) => in_lanes(runs, |it| match it {
            Equations::Two(dense) => Some(dense),
            _ => None,
        }),
        Some(Equations::Three(_)) => in_lanes(runs, |it| match it {
            Equations::Three(dense) => Some(dense),
            _ => None,
        }),
        Some(Equations::Four(_)) => in_lanes(runs, |it| match it {
            Equations::Four(dense) => Some(dense),
            _ => None,
        }),
        Some(Equations::General) | None => alone(runs),
    }
}

fn alone(runs: Vec<Run<'_>>) -> Vec<Outcome> {
    runs.into_iter().map(|run| run.finish(|_| ())).collect()
}

/// A run in its lane.
struct LaneRun<'a, const N: usize> {
    index: usize,
    run: Run<'a>,
    dense: &'a Dense<N>,
    /// Steps it needs next, and their length, s.
    steps: usize,
    step_s: f64,
}

impl<const N: usize> LaneRun<'_, N> {
    /// To the next span; the outcome if there is none.
    #[inline]
    fn next(&mut self) -> Option<Outcome> {
        match self.run.next(&mut |_| ()) {
            RunStep::Over(outcome) => Some(outcome),
            RunStep::Span(span_s) => {
                (self.steps, self.step_s) = self.run.closed.plant.steps(span_s);
                None
            }
        }
    }
}

/// Finishes runs of `N` links, whose dense equations are `of` those of their plants.
fn in_lanes<'a, const N: usize>(
    runs: Vec<Run<'a>>,
    of: fn(&Equations) -> Option<&Dense<N>>,
) -> Vec<Outcome> {
    let dense = |run: &Run<'a>| of(&run.closed.plant.equations);
    let mut outcomes = vec![None; runs.len()];
    if runs.len() < 2 || runs.iter().any(|run| dense(run).is_none()) {
        return alone(runs);
    }
    let mut waiting = runs.into_iter().enumerate().filter_map(|(index, run)| {
        let dense = dense(&run)?;
        Some(LaneRun {
            index,
            run,
            dense,
            steps: 0,
            step_s: 0.0,
        })
    });
    let mut lanes: [Option<LaneRun<'a, N>>; WIDTH] = from_fn(|_| None);
    let mut packed = None;
    loop {
        for lane in &mut lanes {
            while lane.is_none() {
                let Some(mut active) = waiting.next() else {
                    break;
                };
                packed = None;
                match active.next() {
                    Some(outcome) => outcomes[active.index] = Some(outcome),
                    None => *lane = Some(active),
                }
            }
        }
        let Some(first) = lanes.iter().flatten().min_by_key(|active| active.steps) else {
            break;
        };
        let steps = first.steps;
        let packed = packed.get_or_insert_with(|| {
            // An empty lane goes along with another's numbers, for nothing.
            Dense::beside(from_fn(|lane| {
                lanes[lane]
                    .as_ref()
                    .map_or(first.dense, |active| active.dense)
            }))
        });
        let states = stepped(&lanes, packed, steps);
        for (lane, state) in lanes.iter_mut().zip(&states) {
            let Some(active) = lane.as_mut().filter(|active| active.steps == steps) else {
                continue;
            };
            active
                .run
                .closed
                .plant
                .relative(state, &mut active.run.body);
            if let Some(outcome) = active.next() {
                outcomes[active.index] = Some(outcome);
                *lane = None;
            }
        }
    }
    outcomes.into_iter().flatten().collect()
}

/// States of all lanes after `steps` steps.
#[inline]
fn stepped<const N: usize>(
    lanes: &[Option<LaneRun<'_, N>>; WIDTH],
    packed: &Dense<N, Lanes<WIDTH>>,
    steps: usize,
) -> [Absolute<N>; WIDTH] {
    let mut states = [Absolute::default(); WIDTH];
    let mut step_s = [0.0; WIDTH];
    for ((lane, state), step_s) in lanes.iter().zip(&mut states).zip(&mut step_s) {
        if let Some(active) = lane {
            *state = active.run.closed.plant.absolute(&active.run.body);
            *step_s = active.step_s;
        }
    }
    advance(packed, &mut states, step_s, steps);
    states
}

/// All lanes on by `steps` steps. Wider registers give the same bits: no product is fused with a
/// sum.
#[multiversion::multiversion(targets("x86_64+avx2"))]
fn advance<const N: usize>(
    dense: &Dense<N, Lanes<WIDTH>>,
    states: &mut [Absolute<N>; WIDTH],
    step_s: [f64; WIDTH],
    steps: usize,
) {
    let row = |of: fn(&Absolute<N>) -> &[f64; N]| -> [Lanes<WIDTH>; N] {
        from_fn(|i| Lanes(from_fn(|lane| of(&states[lane])[i])))
    };
    let mut angle = row(|state| &state.angle_rad);
    let mut speed = row(|state| &state.speed_rad_s);
    let load = row(|state| &state.load_nm);
    dense.advance(&mut angle, &mut speed, &load, Lanes(step_s), steps);
    for i in 0..N {
        for (lane, state) in states.iter_mut().enumerate() {
            state.angle_rad[i] = angle[i].0[lane];
            state.speed_rad_s[i] = speed[i].0[lane];
        }
    }
}
