//! How wide the drives' dead zone may be.

use crate::study::{Case, Sweep, SweepCard};

/// Share of the full torque up to which a command does nothing; the paper measured 7 to 10 %.
#[derive(Debug)]
pub struct DeadZone;

static CARD: SweepCard = SweepCard {
    id: "dead-zone",
    title: "dead zone",
    unit: "%",
    meaning: "Share of the full torque up to which a command does nothing; the paper measured 7 to 10 %.",
    levels: &[0.0, 0.5, 1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0],
    bounds: (0.0, 99.0),
};

impl Sweep for DeadZone {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        case.conditions.actuator.dead_zone = level / 100.0;
    }
}
