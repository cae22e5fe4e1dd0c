//! How errors of the state grow along a motion, and so how long the model may run uncorrected.
//!
//! A small error of a window's start state grows where the motion is unstable or chaotic, until it
//! swamps what the model's own errors do. How fast is a property of the motion: the growth is taken
//! along the measured states, from one to the next, and not along a simulation, which may have left
//! the motion long before (Lyapunov growth: Benettin et al. 1980, Meccanica 15, 9).

use super::assumed::AssumedStates;
use super::horizon::{Horizon, Window};
use super::window_start::WindowStart;
use crate::model::Model;
use crate::motion::Motion;
use crate::sim::{Plant, PlantMemory, StartState, predict};
use nalgebra::DMatrix;

/// Growth of a small start error beyond which a run says little about the model.
const MOST_GROWTH: f64 = 30.0;
/// From one state to the next, s.
const STEP_S: f64 = 0.05;
/// Step of the differences, rad and rad/s: as large as start errors are. A smaller one takes the
/// moment at which friction lets go, which integration steps round, for the motion.
const DIFFERENCE: f64 = 1e-3;
/// A window is no shorter than this, s, nor than so many samples.
const LEAST_S: f64 = 0.1;
const LEAST_SAMPLES: usize = 8;

/// The longest windows of a motion in which no start error grows more than thirty times; the whole
/// motion where none does. `sigma` as in [`super::FitProblem`].
pub(super) fn stable_horizon(
    model: &Model,
    sigma: &[f64],
    assumed: &AssumedStates,
    motion: &Motion,
) -> Horizon {
    Growth::along(model, sigma, assumed, motion).longest()
}

/// Transition matrices along a motion.
struct Growth {
    duration_s: f64,
    least_s: f64,
    /// From each state to the next: change of the relative angles and speeds per change of them.
    steps: Vec<DMatrix<f64>>,
}

impl Growth {
    fn along(model: &Model, sigma: &[f64], assumed: &AssumedStates, motion: &Motion) -> Growth {
        let plant = Plant::new(model, motion);
        let duration_s = motion.duration_s();
        let spacing_s = duration_s / motion.len().max(2) as f64;
        let most = motion.len().saturating_sub(1).max(1);
        let pieces = ((duration_s / STEP_S).ceil() as usize).clamp(1, most);
        let edge = |piece: usize| piece * motion.len().saturating_sub(1) / pieces;
        let transition = |piece: usize| {
            let samples = edge(piece)..(edge(piece + 1) + 1).min(motion.len());
            let window = Window { motion: 0, samples };
            let start = WindowStart::guess(motion, sigma, assumed, &window).start(&plant);
            transition(&plant, motion, &window, &start)
        };
        Growth {
            duration_s,
            least_s: LEAST_S.max(LEAST_SAMPLES as f64 * spacing_s),
            steps: (0..pieces).map(transition).collect(),
        }
    }

    /// The longest windows whose growth stays below the limit.
    fn longest(&self) -> Horizon {
        let mut pieces = 1;
        loop {
            let seconds = self.duration_s / pieces as f64;
            if pieces > 1 && seconds < self.least_s {
                return Horizon::Seconds(self.least_s.min(self.duration_s));
            }
            if self.most(pieces) <= MOST_GROWTH {
                return match pieces {
                    1 => Horizon::Whole,
                    _ => Horizon::Seconds(seconds),
                };
            }
            pieces += pieces.div_ceil(4);
        }
    }

    /// Most growth of an angle's error in any of so many windows.
    fn most(&self, pieces: usize) -> f64 {
        let joints = self.steps.first().map_or(0, |step| step.nrows() / 2);
        let edge = |piece: usize| piece * self.steps.len() / pieces;
        let mut most: f64 = 0.0;
        for piece in 0..pieces {
            let mut product = DMatrix::identity(2 * joints, 2 * joints);
            for step in &self.steps[edge(piece)..edge(piece + 1)] {
                product = step * product;
                let angles = product.view((0, 0), (joints, joints));
                let columns = angles.column_iter().map(|column| column.norm());
                let largest = columns.fold(0.0, f64::max);
                if !largest.is_finite() {
                    return f64::INFINITY;
                }
                most = most.max(largest);
            }
        }
        most
    }
}

/// How the state at a window's end follows the one at its start.
fn transition(plant: &Plant, motion: &Motion, window: &Window, start: &StartState) -> DMatrix<f64> {
    let joints = plant.len();
    let mut readings = vec![0.0; plant.signals() * window.samples.len()];
    let mut end = |moved: Option<usize>| {
        let mut from = start.clone();
        match moved {
            Some(i) if i < joints => from.angle_rad[i] += DIFFERENCE,
            Some(i) => from.speed_rad_s[i - joints] += DIFFERENCE,
            None => {}
        }
        let (samples, mut memory) = (window.samples.clone(), PlantMemory::default());
        let to = predict(plant, motion, samples, &from, &mut memory, &mut readings);
        [to.angle_rad, to.speed_rad_s].concat()
    };
    let base = end(None);
    let columns: Vec<Vec<f64>> = (0..2 * joints).map(|i| end(Some(i))).collect();
    DMatrix::from_fn(2 * joints, 2 * joints, |row, column| {
        (columns[column][row] - base[row]) / DIFFERENCE
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::MotionSource;
    use std::path::Path;

    /// A free pendulum at these angles, read at 100 Hz without noise.
    fn horizon(zero: &str, angle_rad: impl Fn(f64) -> f64) -> Horizon {
        let text = format!(
            "[rig]\nname = \"p\"\nangle_zero = \"{zero}\"\n\
             [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 1e-4\n\
             [[joint]]\ndrive = \"passive\"\n[log]\ntime = {{ column = \"t\", unit = \"s\" }}\n\
             [[log.joint]]\nposition = {{ column = \"q\", unit = \"rad\" }}\n"
        );
        let model = Model::parse(&text, Path::new("p.toml")).unwrap();
        let time_s: Vec<f64> = (0..500).map(|k| 0.01 * f64::from(k)).collect();
        let motion = Motion {
            name: String::new(),
            source: MotionSource {
                path: "p.csv".into(),
                sha256: String::new(),
                lines: (0, 0),
            },
            position_rad: vec![time_s.iter().map(|t| angle_rad(*t)).collect()],
            velocity_rad_s: vec![None],
            rate_rad_s: Vec::new(),
            input: vec![None],
            supply_v: None,
            torque_on: None,
            payload_kg: 0.0,
            turned: false,
            time_s,
        };
        stable_horizon(&model, &[1e-4], &vec![None], &motion)
    }

    #[test]
    fn a_swing_runs_freely_and_a_balance_does_not() {
        assert_eq!(
            horizon("hanging", |t| 0.3 * (9.5 * t).cos()),
            Horizon::Whole
        );
        // Upright an error grows by exp(9.6 t): thirty times in 0.43 s.
        let Horizon::Seconds(seconds) = horizon("upright", |t| 0.01 * (3.0 * t).sin()) else {
            panic!("an unstable motion runs freely");
        };
        assert!((0.25..0.5).contains(&seconds), "{seconds}");
    }
}
