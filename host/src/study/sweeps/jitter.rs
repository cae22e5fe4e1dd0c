//! How irregular samples may be.

use crate::study::{Case, Sweep, SweepCard};

/// Largest share of the period by which a sample comes early or late.
#[derive(Debug)]
pub struct Jitter;

static CARD: SweepCard = SweepCard {
    id: "jitter",
    title: "jitter",
    unit: "%",
    meaning: "Largest share of the period by which a sample comes early or late.",
    levels: &[0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0],
    bounds: (0.0, 45.0),
};

impl Sweep for Jitter {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        case.conditions.clock.jitter = level / 100.0;
    }
}
