//! How far the supply may be off.

use crate::study::{Case, Sweep, SweepCard};

/// Supply of drives whose torque was measured at 9.8 V and follows the volts.
#[derive(Debug)]
pub struct Supply;

static CARD: SweepCard = SweepCard {
    id: "supply",
    title: "supply",
    unit: "V",
    meaning: "Supply of drives whose torque was measured at 9.8 V and follows the volts.",
    levels: &[5.0, 6.0, 7.0, 8.0, 9.0, 9.8, 11.0, 12.0, 14.0],
    bounds: (0.1, 100.0),
};

impl Sweep for Supply {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        case.conditions.actuator.supply = level / 9.8;
    }
}
