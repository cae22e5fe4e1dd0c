//! Straight poses in a model's own convention of angles.

use super::{Angles, Model};

/// All links straight up, one angle per joint, rad.
pub fn upright(model: &Model) -> Vec<f64> {
    straight(model, std::f64::consts::PI)
}

/// All links straight down, one angle per joint, rad.
pub fn hanging(model: &Model) -> Vec<f64> {
    straight(model, 0.0)
}

/// All links at an angle from hanging, rad.
fn straight(model: &Model, from_hanging_rad: f64) -> Vec<f64> {
    let first = from_hanging_rad - model.angle_zero.from_hanging_rad();
    let later = match model.angles {
        Angles::Absolute => first,
        Angles::Relative => 0.0,
    };
    (0..model.link_count())
        .map(|joint| if joint == 0 { first } else { later })
        .collect()
}
