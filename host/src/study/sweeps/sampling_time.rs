//! How seldom the controller may be called.

use crate::study::{Case, Sweep, SweepCard};

/// Period of the controller, which is designed anew for each.
#[derive(Debug)]
pub struct SamplingTime;

static CARD: SweepCard = SweepCard {
    id: "sampling-time",
    title: "sampling time",
    unit: "ms",
    meaning: "Period of the controller, which is designed anew for each.",
    levels: &[
        1.0, 2.0, 5.0, 8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0,
    ],
    bounds: (0.1, 1000.0),
};

impl Sweep for SamplingTime {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        case.conditions.clock.period_s = 1e-3 * level;
    }
}
