//! How weak the drives may be.

use crate::study::{Case, Sweep, SweepCard};

/// Largest torque of a drive; the paper's saturate at 2 N m.
#[derive(Debug)]
pub struct Saturation;

static CARD: SweepCard = SweepCard {
    id: "saturation",
    title: "largest torque",
    unit: "N m",
    meaning: "Largest torque of a drive; the paper's saturate at 2 N m.",
    levels: &[f64::INFINITY, 10.0, 5.0, 3.0, 2.0, 1.5, 1.0, 0.7, 0.5, 0.3],
    bounds: (0.01, f64::INFINITY),
};

impl Sweep for Saturation {
    fn card(&self) -> &'static SweepCard {
        &CARD
    }

    fn set(&self, level: f64, case: &mut Case) {
        let actuator = &mut case.conditions.actuator;
        actuator.saturates = level.is_finite();
        if actuator.saturates {
            actuator.full_torque_nm = level;
        }
    }

    fn label(&self, level: f64) -> String {
        match level.is_finite() {
            true => crate::number::given(level),
            false => "no limit".to_string(),
        }
    }
}
