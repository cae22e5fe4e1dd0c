//! Over how long a run candidates are sought, and over how long they are judged.

use crate::fitting::{FitData, Horizon, fit_start_states};
use crate::log::Motion;
use crate::model::Model;

/// Windows to search on, s.
const SEARCH_S: f64 = 1.0;

/// Short windows to search on: a second, or what holds forty samples; never longer than the plant
/// is stable. Few samples are searched from many starts instead, over the horizon that counts.
pub(super) fn search_horizon(whole: &FitData, longest: Horizon, few: bool) -> Horizon {
    let samples: usize = whole.motions.iter().map(Motion::len).sum();
    let seconds: f64 = whole.motions.iter().map(Motion::duration_s).sum();
    if few {
        return longest;
    }
    let wanted = SEARCH_S.max(40.0 * seconds / samples.max(1) as f64);
    Horizon::Seconds(
        longest
            .seconds()
            .map_or(wanted, |stable| stable.min(wanted)),
    )
}

/// The longest windows over which the base model, as fitted on short ones, still follows the
/// measurement: longer ones show more of a small effect, but where the simulation has lost the
/// motion altogether they show nothing.
pub(super) fn longest_useful(
    model: &Model,
    whole: &FitData,
    longest: Horizon,
) -> (Horizon, FitData) {
    let mut horizon = longest;
    let mut seconds = longest.seconds().unwrap_or_else(|| whole.longest_s());
    loop {
        let data = whole.recut(horizon);
        let mean = fit_start_states(model, &data).residuals.mean_square();
        if mean <= (0.25 * spread(&data)).powi(2) || seconds <= 1.0 {
            return (horizon, data);
        }
        seconds = (seconds / 2.0).clamp(1.0, 4.0);
        horizon = Horizon::Seconds(seconds);
    }
}

/// Root-mean-square deviation of the measured positions from their mean, in units of sigma.
fn spread(data: &FitData) -> f64 {
    let (mut sum, mut count) = (0.0, 0usize);
    for motion in &data.motions {
        for (position, sigma) in motion.position_rad.iter().zip(&data.sigma_rad) {
            let mean = position.iter().sum::<f64>() / position.len() as f64;
            sum += position
                .iter()
                .map(|p| ((p - mean) / sigma).powi(2))
                .sum::<f64>();
            count += position.len();
        }
    }
    (sum / count.max(1) as f64).sqrt()
}
