//! Features of each sample of a joint's motion, on scales that need no units; conditions are made
//! of them.

use super::order::{quantile, ranks};
use crate::dynamics::{EquationsOfMotion, SpatialEquations, SpatialWorkspace};
use crate::model::{Angles, Drive, MeasuredSignal, Model};
use crate::motion::Motion;

/// Half the time over which speed is estimated, s.
const SPEED_REACH_S: f64 = 0.025;
/// Share of high speed below which a joint counts as still.
pub(super) const STILL_SHARE: f64 = 0.05;

/// One sample of one joint. What is unknown is not a number and meets no condition.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SampleFeatures {
    /// Measured angle, rad.
    pub angle_rad: f64,
    /// Speed over the 95th percentile of its magnitude.
    pub speed: f64,
    /// Rank of the speed's magnitude among all samples, 0 to 1.
    pub speed_rank: f64,
    /// Since the joint last turned round, s; infinite before it first does.
    pub since_reversal_s: f64,
    /// How long the joint is still in all, s; 0 while it moves.
    pub still_s: f64,
    /// Rank of the torque's magnitude: of the input where it is a torque, else of gravity.
    pub load_rank: f64,
    /// Whether gravity brakes the motion (1), drives it (-1), or neither (0).
    pub against_gravity: f64,
    /// Rank of the supply, where it varies.
    pub supply_rank: f64,
    /// What the drive is asked for over the most it is asked for: input, or error of a goal angle.
    pub demand: f64,
    /// Since the command last jumped, s; infinite before it first does.
    pub since_jump_s: f64,
    /// Time since the motion began over its duration.
    pub run: f64,
    /// Whether the drives are energised.
    pub energised: bool,
    /// Whether a payload is bolted on.
    pub payload: bool,
    /// Whether the rig stands turned.
    pub turned: bool,
}

/// Features of one joint over all motions, end to end.
pub(super) fn features(model: &Model, motions: &[Motion], joint: usize) -> Vec<SampleFeatures> {
    let collect =
        |of: &dyn Fn(&Motion) -> Vec<f64>| -> Vec<f64> { motions.iter().flat_map(of).collect() };
    let rate_alone = model.log.joints[joint].signal() == MeasuredSignal::Rate;
    let speed = collect(&|m| match &m.velocity_rad_s[joint] {
        Some(rate) if rate_alone => rate.clone(),
        _ => speed_rad_s(&m.time_s, &m.position_rad[joint]),
    });
    let fast = quantile(&speed, 0.95);
    let gravity = collect(&|m| gravity_nm(model, m, joint));
    let load = collect(&|m| load_nm(model, m, joint));
    let demand = collect(&|m| demand(model, m, joint));
    let most = demand.iter().map(|u| u.abs()).fold(0.0, f64::max);
    let supply = collect(&|m| m.supply_v.clone().unwrap_or(vec![f64::NAN; m.len()]));
    let jump = jump_size(motions, joint);
    let (speed_rank, load_rank) = (ranks(&speed, true), ranks(&load, true));
    let supply_rank = ranks(&supply, false);

    let mut all = Vec::with_capacity(speed.len());
    for motion in motions {
        let begin = all.len();
        let shares: Vec<f64> = (begin..begin + motion.len())
            .map(|i| speed[i] / fast)
            .collect();
        let reversal = since(&motion.time_s, &reversals(&shares));
        let jumped = since(&motion.time_s, &jumps(motion, joint, jump));
        let still = still_s(&motion.time_s, &shares);
        for k in 0..motion.len() {
            let i = begin + k;
            let moves = shares[k].abs() > STILL_SHARE;
            all.push(SampleFeatures {
                angle_rad: motion.position_rad[joint][k],
                speed: shares[k],
                speed_rank: speed_rank[i],
                since_reversal_s: reversal[k],
                still_s: still[k],
                load_rank: load_rank[i],
                against_gravity: match gravity[i] * shares[k] {
                    power if moves && power < 0.0 => 1.0,
                    power if moves && power > 0.0 => -1.0,
                    _ => 0.0,
                },
                supply_rank: supply_rank[i],
                demand: demand[i] / most,
                since_jump_s: jumped[k],
                run: (motion.time_s[k] - motion.time_s[0]) / motion.duration_s(),
                energised: motion.torque_on.as_ref().is_none_or(|on| on[k]),
                payload: motion.payload_kg > 0.0,
                turned: motion.turned,
            });
        }
    }
    all
}

/// Slope of a straight line through the samples within 25 ms, at least one to either side.
pub fn speed_rad_s(time_s: &[f64], angle_rad: &[f64]) -> Vec<f64> {
    let last = time_s.len().saturating_sub(1);
    let (mut from, mut to) = (0, 0);
    (0..time_s.len())
        .map(|k| {
            while time_s[k] - time_s[from] > SPEED_REACH_S {
                from += 1;
            }
            while to < last && time_s[to + 1] - time_s[k] <= SPEED_REACH_S {
                to += 1;
            }
            let (first, last) = (from.min(k.saturating_sub(1)), to.max((k + 1).min(last)));
            slope(&time_s[first..=last], &angle_rad[first..=last])
        })
        .collect()
}

fn slope(x: &[f64], y: &[f64]) -> f64 {
    let count = x.len() as f64;
    let (mean_x, mean_y) = (x.iter().sum::<f64>() / count, y.iter().sum::<f64>() / count);
    let (mut xy, mut xx) = (0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        xy += (x - mean_x) * (y - mean_y);
        xx += (x - mean_x).powi(2);
    }
    xy / xx
}

/// Torque of gravity on a joint, N m, by the model's links at the measured angles; payload apart.
fn gravity_nm(model: &Model, motion: &Motion, joint: usize) -> Vec<f64> {
    if let Some(tree) = model.tree() {
        return gravity_in_space(&SpatialEquations::new(&tree), motion, joint);
    }
    if model.slides() {
        return gravity_with_slides(model, motion, joint);
    }
    let zero = model.angle_zero.from_hanging_rad();
    (0..motion.len())
        .map(|k| {
            let (mut angle, mut tip, mut torque) = (zero, 0.0, 0.0);
            for (i, link) in model.links.iter().enumerate() {
                let reading = motion.position_rad[i][k];
                angle = match model.angles {
                    Angles::Absolute => zero + reading,
                    Angles::Relative => angle + reading,
                };
                if i >= joint {
                    torque -= link.mass_kg * model.gravity_m_s2 * (tip + link.com_m * angle.sin());
                    tip += link.length_m * angle.sin();
                }
            }
            torque
        })
        .collect()
}

/// The same of a robot in space.
fn gravity_in_space(tree: &SpatialEquations, motion: &Motion, joint: usize) -> Vec<f64> {
    let mut work = SpatialWorkspace::default();
    let still = vec![0.0; tree.len()];
    let mut torque = still.clone();
    let mut at = |k: usize| {
        let reading: Vec<f64> = motion.position_rad.iter().map(|series| series[k]).collect();
        tree.inverse(
            &mut work,
            [&reading, &still, &still],
            &mut torque,
            |_, _| {},
        );
        -torque[joint]
    };
    (0..motion.len()).map(&mut at).collect()
}

/// The same where joints slide: torques, or forces, N.
fn gravity_with_slides(model: &Model, motion: &Motion, joint: usize) -> Vec<f64> {
    let equations = EquationsOfMotion::new(&model.chain(), 0.0);
    let at = |k: usize| {
        let reading: Vec<f64> = motion.position_rad.iter().map(|series| series[k]).collect();
        -equations.gravity(&model.relative_rad(&reading))[joint]
    };
    (0..motion.len()).map(at).collect()
}

/// The torque a joint is told, or duty in its place; gravity's where it is told neither.
pub(super) fn load_nm(model: &Model, motion: &Motion, joint: usize) -> Vec<f64> {
    match (&model.joints[joint].drive, &motion.input[joint]) {
        (Drive::Torque | Drive::Duty(_), Some(input)) => input.clone(),
        _ => gravity_nm(model, motion, joint),
    }
}

/// The input, or how far a goal angle is away.
fn demand(model: &Model, motion: &Motion, joint: usize) -> Vec<f64> {
    let Some(input) = &motion.input[joint] else {
        return vec![f64::NAN; motion.len()];
    };
    match model.joints[joint].drive {
        Drive::Position { .. } => {
            let pairs = input.iter().zip(&motion.position_rad[joint]);
            pairs.map(|(goal, angle)| goal - angle).collect()
        }
        _ => input.clone(),
    }
}

/// Change of the input from one sample to the next that counts as a jump: a tenth of its range, and
/// three times what all but a tenth of the changes stay below, so that a fast sine has none.
fn jump_size(motions: &[Motion], joint: usize) -> f64 {
    let inputs = || motions.iter().filter_map(|m| m.input[joint].as_ref());
    let steps: Vec<f64> = inputs()
        .flat_map(|u| u.windows(2).map(|pair| pair[1] - pair[0]))
        .collect();
    let high = inputs().flatten().copied().fold(f64::MIN, f64::max);
    let low = inputs().flatten().copied().fold(f64::MAX, f64::min);
    f64::max(0.1 * (high - low), 3.0 * quantile(&steps, 0.9))
}

fn jumps(motion: &Motion, joint: usize, size: f64) -> Vec<usize> {
    let Some(input) = &motion.input[joint] else {
        return Vec::new();
    };
    (1..motion.len())
        .filter(|k| (input[*k] - input[k - 1]).abs() > size)
        .collect()
}

/// Samples at which the speed passes zero on the way from one direction of real motion to the
/// other.
fn reversals(speed: &[f64]) -> Vec<usize> {
    let mut found = Vec::new();
    let (mut direction, mut crossed) = (0.0, 0);
    for k in 0..speed.len() {
        if k > 0 && speed[k] * speed[k - 1] <= 0.0 {
            crossed = k;
        }
        if speed[k].abs() > STILL_SHARE {
            if direction * speed[k] < 0.0 {
                found.push(crossed);
            }
            direction = speed[k].signum();
        }
    }
    found
}

/// Time since the last of these samples.
fn since(time_s: &[f64], events: &[usize]) -> Vec<f64> {
    let mut events = events.iter().peekable();
    let mut last = f64::NEG_INFINITY;
    (0..time_s.len())
        .map(|k| {
            while let Some(event) = events.next_if(|event| **event <= k) {
                last = time_s[*event];
            }
            time_s[k] - last
        })
        .collect()
}

/// Duration of the standstill each sample belongs to.
fn still_s(time_s: &[f64], speed: &[f64]) -> Vec<f64> {
    let mut still = vec![0.0; speed.len()];
    let mut from = 0;
    for k in 0..=speed.len() {
        let still_here = speed.get(k).is_some_and(|s| s.abs() < STILL_SHARE);
        if !still_here {
            if k > from {
                still[from..k].fill(time_s[k - 1] - time_s[from]);
            }
            from = k + 1;
        }
    }
    still
}
