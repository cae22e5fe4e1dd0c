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

impl Model {
    /// Angles in the model's own convention as relative ones, the first from hanging, rad.
    pub fn relative_rad(&self, pose_rad: &[f64]) -> Vec<f64> {
        let zero = self.angle_zero.from_hanging_rad();
        let mut before = -zero;
        let angle = |(joint, &angle): (usize, &f64)| match self.angles {
            Angles::Relative if joint == 0 => angle + zero,
            Angles::Relative => angle,
            Angles::Absolute => angle - std::mem::replace(&mut before, angle),
        };
        pose_rad.iter().enumerate().map(angle).collect()
    }

    /// Relative angles, the first from hanging, in the model's own convention, rad: undoes
    /// [`Model::relative_rad`].
    pub fn convention_rad(&self, relative_rad: &[f64]) -> Vec<f64> {
        let zero = self.angle_zero.from_hanging_rad();
        let mut sum = -zero;
        let angle = |(joint, &angle): (usize, &f64)| {
            sum += angle;
            match self.angles {
                Angles::Relative if joint == 0 => angle - zero,
                Angles::Relative => angle,
                Angles::Absolute => sum,
            }
        };
        relative_rad.iter().enumerate().map(angle).collect()
    }
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
