//! How late torques may come.

use crate::study::{Case, Sweep, SweepCard};

/// Time from a sample to the torque it asks for; the design counts on what the study says.
#[derive(Debug)]
pub struct Delay;

static CARD: SweepCard = SweepCard {
    id: "delay",
    title: "delay",
    unit: "ms",
    meaning: "Time from a sample to the torque it asks for; the design counts on what the study says.",
    levels: &[
        0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0, 20.0, 30.0,
    ],
    bounds: (0.0, 1000.0),
};

impl Sweep for Delay {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        let period_s = case.conditions.clock.period_s;
        case.conditions.actuator.delay_periods = 1e-3 * level / period_s;
    }
}
