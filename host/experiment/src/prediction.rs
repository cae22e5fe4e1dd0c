//! An experiment as an explanation predicts it, without noise.

use super::candidates::Experiment;
use super::inputs::at_rest;
use super::limits::signal;
use crate::fitting::{FitProblem, Horizon};
use crate::model::{MeasuredSignal, Model};
use crate::motion::Motion;
use crate::sim::{Plant, PlantMemory, predict};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The experiment with what the log would hold of every joint; a joint that logs do not measure
/// has gaps.
pub(super) fn predicted_motion(model: &Model, experiment: &Experiment) -> Motion {
    let motion = experiment.motion.clone();
    let plant = Plant::new(model, &motion);
    let start = at_rest(&plant, &experiment.start_rad);
    let count = motion.len();
    let mut readings = vec![0.0; count * plant.signals()];
    let mut memory = PlantMemory::default();
    predict(
        &plant,
        &motion,
        0..count,
        &start,
        &mut memory,
        &mut readings,
    );
    let mut motion = motion.with_rates(plant.rate_joints());
    let (of_joints, of_rates) = readings.split_at(count * plant.len());
    for (&joint, readings) in plant.rate_joints().iter().zip(of_rates.chunks(count)) {
        motion.rate_rad_s[joint] = Some(readings.to_vec());
    }
    for (joint, readings) in of_joints.chunks(count).enumerate() {
        match signal(model, joint) {
            MeasuredSignal::Angle | MeasuredSignal::Displacement => {
                motion.position_rad[joint] = readings.to_vec();
            }
            MeasuredSignal::Rate => motion.velocity_rad_s[joint] = Some(readings.to_vec()),
            MeasuredSignal::Nothing => {}
        }
    }
    motion
}

/// A prediction as data to be fitted, weighted as `logs` are and cut as they would be.
pub(super) fn as_data(
    model: &Model,
    motion: Motion,
    logs: &FitProblem,
    horizon: Horizon,
    seed: u64,
) -> FitProblem {
    // How long windows may be depends on the noise; what is compared has none.
    let noisy = with_noise(&motion, logs, seed);
    let data = FitProblem::new(model, vec![noisy], horizon).weighted_like(logs);
    data.measured_in(vec![motion])
}

/// White noise as large as that of the logs on everything that is measured.
fn with_noise(motion: &Motion, logs: &FitProblem, seed: u64) -> Motion {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy = motion.clone();
    for (signal, sigma) in logs.sigma.iter().enumerate() {
        // Uniform, of this standard deviation.
        let reach = 3f64.sqrt() * sigma;
        let joint = logs.joint_of(signal);
        let rate = noisy.rate_rad_s.get_mut(joint).and_then(Option::as_mut);
        let readings = match (rate, &mut noisy.velocity_rad_s[joint]) {
            (Some(rate), _) if signal >= logs.joints() => rate,
            (_, Some(rate)) => rate,
            (_, None) => &mut noisy.position_rad[joint],
        };
        for reading in readings {
            *reading += random.random_range(-reach..=reach);
        }
    }
    noisy
}
