//! An experiment as an explanation predicts it, without noise.

use super::candidates::Experiment;
use super::inputs::at_rest;
use super::limits::signal;
use crate::fitting::{FitData, Horizon};
use crate::log::Motion;
use crate::model::{MeasuredSignal, Model};
use crate::sim::{Memory, Plant, predict};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The experiment with what the log would hold of every joint; a joint that logs do not measure
/// has gaps.
pub(super) fn predicted_motion(model: &Model, experiment: &Experiment) -> Motion {
    let mut motion = experiment.motion.clone();
    let plant = Plant::new(model, &motion);
    let start = at_rest(&plant, &experiment.start_rad);
    let count = motion.len();
    let mut readings = vec![0.0; count * model.link_count()];
    let mut memory = Memory::default();
    predict(
        &plant,
        &motion,
        0..count,
        &start,
        &mut memory,
        &mut readings,
    );
    for (joint, readings) in readings.chunks(count).enumerate() {
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
    logs: &FitData,
    horizon: Horizon,
    seed: u64,
) -> FitData {
    // How long windows may be depends on the noise; what is compared has none.
    let noisy = with_noise(&motion, logs, seed);
    let mut data = FitData::new(model, vec![noisy], horizon).weighted_like(logs);
    data.motions = vec![motion];
    data
}

/// White noise as large as that of the logs on everything that is measured.
fn with_noise(motion: &Motion, logs: &FitData, seed: u64) -> Motion {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noisy = motion.clone();
    for (joint, sigma) in logs.sigma.iter().enumerate() {
        // Uniform, of this standard deviation.
        let reach = 3f64.sqrt() * sigma;
        let readings = match &mut noisy.velocity_rad_s[joint] {
            Some(rate) => rate,
            None => &mut noisy.position_rad[joint],
        };
        for reading in readings {
            *reading += random.random_range(-reach..=reach);
        }
    }
    noisy
}
