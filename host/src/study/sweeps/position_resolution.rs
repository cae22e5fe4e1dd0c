//! How coarse the encoders may be.

use crate::study::{Case, Sweep, SweepCard};

/// Smallest step of an angle; the AX-12 has 300 / 1024 = 0.293 deg.
#[derive(Debug)]
pub struct PositionResolution;

static CARD: SweepCard = SweepCard {
    id: "position-resolution",
    title: "position resolution",
    unit: "deg",
    meaning: "Smallest step of an angle; the AX-12 has 300 / 1024 = 0.293 deg.",
    levels: &[0.0, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.293, 0.5, 1.0],
    bounds: (0.0, 45.0),
};

impl Sweep for PositionResolution {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        case.conditions.sensor.position_resolution_rad = level.to_radians();
    }
}
