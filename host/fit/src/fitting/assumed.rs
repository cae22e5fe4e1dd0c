//! States of joints whose angle no column holds, guessed so that a fit can begin near them.
//!
//! A rate is integrated from the angle, and less the bias, at which the model explains the log
//! best; a joint of which
//! nothing is measured moves as the model does that begins hanging at rest. Each window's start
//! state is then fitted within wide limits around the guess.

use super::horizon::Window;
use super::residual::{weighted, worst};
use super::window_start::WindowStart;
use crate::model::{MeasuredSignal, Model, hanging};
use crate::motion::Motion;
use crate::sim::{Plant, PlantMemory, predict};
use std::f64::consts::TAU;

/// Angles tried in a turn for the one at which a rate begins.
const TRIED: usize = 16;
/// Windows in which they are tried, s: short enough that a wrong one does not run away.
const WINDOW_S: f64 = 0.4;
/// Drifts of an integrated rate that are tried, rad/s, in how many rounds the best is refined, and
/// by which share it must lower the squared error to be believed.
const DRIFTS_RAD_S: [f64; 4] = [0.05, -0.05, 0.1, -0.1];
const DRIFT_ROUNDS: usize = 8;
const DRIFT_CLEAR: f64 = 0.9;
/// Standard deviation of a guessed angle, rad, and of a guessed speed, rad/s.
const ANGLE_DEVIATION_RAD: f64 = 0.3;
const SPEED_DEVIATION_RAD_S: f64 = 2.0;

/// One joint's guess along a motion, in the log's convention.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct AssumedJoint {
    /// Per sample, rad.
    pub angle_rad: Vec<f64>,
    /// Per sample, rad/s; a measured rate where there is one, its gaps filled.
    pub speed_rad_s: Vec<f64>,
    /// Standard deviation of the angle, rad.
    pub angle_deviation_rad: f64,
    /// Standard deviation of the speed, rad/s; none where it is measured.
    pub speed_deviation_rad_s: Option<f64>,
}

/// Per joint; none where its angle is measured.
pub(super) type AssumedStates = Vec<Option<AssumedJoint>>;

/// Guesses for one motion. `signals` and `sigma` as in [`super::FitProblem`].
pub(super) fn assumed(
    model: &Model,
    signals: &[MeasuredSignal],
    sigma: &[f64],
    motion: &Motion,
) -> AssumedStates {
    let rest = hanging(model);
    let signals = &signals[..model.link_count().min(signals.len())];
    let joint = |(joint, signal): (usize, &MeasuredSignal)| match signal {
        MeasuredSignal::Angle | MeasuredSignal::Displacement => None,
        MeasuredSignal::Rate => Some(integrated(motion, joint, rest[joint])),
        MeasuredSignal::Nothing => Some(AssumedJoint {
            angle_rad: vec![rest[joint]; motion.len()],
            speed_rad_s: vec![0.0; motion.len()],
            angle_deviation_rad: ANGLE_DEVIATION_RAD,
            speed_deviation_rad_s: Some(SPEED_DEVIATION_RAD_S),
        }),
    };
    let mut states: AssumedStates = signals.iter().enumerate().map(joint).collect();
    if signals.contains(&MeasuredSignal::Nothing) {
        let whole = Window {
            motion: 0,
            samples: 0..motion.len(),
        };
        run_free(model, sigma, motion, &whole, &mut states);
    }
    for joint in (0..signals.len()).filter(|j| signals[*j] == MeasuredSignal::Rate) {
        let cost = |states: &AssumedStates, most| cost(model, signals, sigma, motion, states, most);
        states = anchored(&states, motion, joint, &cost);
    }
    states
}

/// The states with one joint's angle begun where the model explains the log best, and freed of the
/// drift that a rate with a bias is integrated to, where the model then explains it clearly better.
fn anchored(
    states: &AssumedStates,
    motion: &Motion,
    joint: usize,
    cost: &dyn Fn(&AssumedStates, f64) -> f64,
) -> AssumedStates {
    let moved = |[begin_rad, drift_rad_s]: [f64; 2]| {
        let turned = turned(states, joint, begin_rad);
        straightened(turned, motion, joint, drift_rad_s)
    };
    let best = |tried: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut best: Option<(f64, [f64; 2])> = None;
        for at in tried {
            let least = best.map_or(f64::INFINITY, |(least, _)| least);
            let own = cost(&moved(at), least);
            if best.is_none() || own < least {
                best = Some((own, at));
            }
        }
        best
    };
    let turns = |drift_rad_s: f64| {
        (0..TRIED).map(move |turn| [turn as f64 / TRIED as f64 * TAU, drift_rad_s])
    };
    let Some((plain_cost, plain)) = best(&mut turns(0.0)) else {
        return states.clone();
    };
    let Some((mut least, mut at)) = best(&mut DRIFTS_RAD_S.into_iter().flat_map(turns)) else {
        return moved(plain);
    };
    let mut reach = [TAU / TRIED as f64, DRIFTS_RAD_S[0]];
    for _ in 0..DRIFT_ROUNDS {
        reach = reach.map(|reach| 0.5 * reach);
        let around = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        let near = around.map(|to| [at[0] + to[0] * reach[0], at[1] + to[1] * reach[1]]);
        if let Some((own, to)) = best(&mut near.into_iter()).filter(|(own, _)| *own < least) {
            (least, at) = (own, to);
        }
    }
    if least < DRIFT_CLEAR * plain_cost {
        moved(at)
    } else {
        moved(plain)
    }
}

/// The states with one joint's angle turned on evenly, by nothing in the middle of the motion.
fn straightened(
    mut states: AssumedStates,
    motion: &Motion,
    joint: usize,
    by_rad_s: f64,
) -> AssumedStates {
    let middle_s = motion.time_s[0] + 0.5 * motion.duration_s();
    if let Some(own) = &mut states[joint] {
        for (angle, time_s) in own.angle_rad.iter_mut().zip(&motion.time_s) {
            *angle += by_rad_s * (time_s - middle_s);
        }
    }
    states
}

/// A rate integrated from `begin_rad`, between samples by the trapezoid rule.
fn integrated(motion: &Motion, joint: usize, begin_rad: f64) -> AssumedJoint {
    let speed_rad_s = match &motion.velocity_rad_s[joint] {
        Some(rate) => joined(&motion.time_s, rate),
        None => vec![0.0; motion.len()],
    };
    let mut angle = begin_rad;
    let angle_rad = (0..motion.len()).map(|k| {
        if k > 0 {
            let step_s = motion.time_s[k] - motion.time_s[k - 1];
            angle += 0.5 * (speed_rad_s[k] + speed_rad_s[k - 1]) * step_s;
        }
        angle
    });
    AssumedJoint {
        angle_rad: angle_rad.collect(),
        speed_rad_s,
        angle_deviation_rad: ANGLE_DEVIATION_RAD,
        speed_deviation_rad_s: None,
    }
}

/// The series with its gaps joined by lines; at the ends by the nearest value.
fn joined(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    let known: Vec<usize> = (0..values.len())
        .filter(|k| values[*k].is_finite())
        .collect();
    let between = |k: usize| {
        let next = known.partition_point(|at| *at < k);
        match (next.checked_sub(1).map(|i| known[i]), known.get(next)) {
            (_, Some(&b)) if b == k => values[k],
            (Some(a), Some(&b)) => {
                let share = (time_s[k] - time_s[a]) / (time_s[b] - time_s[a]);
                values[a] + share * (values[b] - values[a])
            }
            (Some(a), None) => values[a],
            (None, Some(&b)) => values[b],
            (None, None) => 0.0,
        }
    };
    (0..values.len()).map(between).collect()
}

/// The states with one joint turned on by an angle.
fn turned(states: &AssumedStates, joint: usize, by_rad: f64) -> AssumedStates {
    let mut states = states.clone();
    if let Some(own) = &mut states[joint] {
        own.angle_rad.iter_mut().for_each(|angle| *angle += by_rad);
    }
    states
}

/// Squared weighted errors of the model in short windows that begin at these states; of those that
/// leave more than `most`, no more than that they do.
fn cost(
    model: &Model,
    signals: &[MeasuredSignal],
    sigma: &[f64],
    motion: &Motion,
    states: &AssumedStates,
    most: f64,
) -> f64 {
    let plant = Plant::new(model, motion);
    let pieces = (motion.duration_s() / WINDOW_S).round().max(1.0) as usize;
    let pieces = pieces.min((motion.len() / 5).max(1));
    let edge = |piece: usize| piece * motion.len() / pieces;
    let mut sum = 0.0;
    for piece in 0..pieces {
        if sum > most {
            break;
        }
        let window = Window {
            motion: 0,
            samples: edge(piece)..edge(piece + 1),
        };
        let samples = window.samples.clone();
        let mut values = vec![0.0; samples.len() * plant.signals()];
        let start = WindowStart::guess(motion, sigma, states, &window).start(&plant);
        let mut memory = PlantMemory::default();
        predict(
            &plant,
            motion,
            samples.clone(),
            &start,
            &mut memory,
            &mut values,
        );
        let parts = values.chunks(samples.len()).zip(signals);
        for (joint, (part, signal)) in parts.enumerate() {
            let measured = &motion.measured(joint, *signal)[samples.clone()];
            for (value, measured) in part.iter().zip(measured) {
                // A few windows that run away decide nothing.
                let most = 0.1 * worst(*signal, sigma[joint]);
                sum += weighted(*measured, *value, sigma[joint], most).powi(2);
            }
        }
    }
    sum
}

/// Puts the motion of the model itself, which begins at rest, in place of what was not measured.
fn run_free(
    model: &Model,
    sigma: &[f64],
    motion: &Motion,
    whole: &Window,
    states: &mut AssumedStates,
) {
    let plant = Plant::new(model, motion);
    let mut start = WindowStart::guess(motion, sigma, states, whole).start(&plant);
    let mut memory = PlantMemory::default();
    let mut readings = vec![0.0; 2 * plant.signals()];
    for k in 0..motion.len() {
        for (joint, state) in states.iter_mut().enumerate() {
            let unknown = state.as_mut().filter(|s| s.speed_deviation_rad_s.is_some());
            if let Some(state) = unknown {
                let (angle, speed) = plant.reading(joint, &start);
                if !(angle.is_finite() && speed.is_finite()) {
                    return;
                }
                (state.angle_rad[k], state.speed_rad_s[k]) = (angle, speed);
            }
        }
        if k + 1 < motion.len() {
            let stretch = k..k + 2;
            start = predict(&plant, motion, stretch, &start, &mut memory, &mut readings);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::joined;

    #[test]
    fn gaps_are_joined_by_lines() {
        let nan = f64::NAN;
        let time = [0.0, 1.0, 2.0, 4.0, 5.0];
        assert_eq!(
            joined(&time, &[nan, 1.0, nan, 4.0, nan]),
            [1.0, 1.0, 2.0, 4.0, 4.0]
        );
        assert_eq!(joined(&time[..2], &[nan, nan]), [0.0, 0.0]);
    }
}
