//! Straight poses in a model's own convention of angles.

use super::{Angles, Joint, Model};

/// The pose that is held where none is asked for: all links straight up; of a robot in space every
/// joint at 0, or in the middle of its range where that does not hold 0. One angle per joint, rad,
/// or m where it slides.
pub fn default_pose(model: &Model) -> Vec<f64> {
    if !model.is_in_space() {
        return upright(model);
    }
    let at = |joint: usize| match model.range(joint) {
        Some((low, high)) if !(low..=high).contains(&0.0) => f64::midpoint(low, high),
        _ => 0.0,
    };
    (0..model.link_count()).map(at).collect()
}

/// All links straight up, one angle per joint, rad; of a robot in space, which knows no such pose,
/// every joint at 0.
pub fn upright(model: &Model) -> Vec<f64> {
    straight(model, std::f64::consts::PI)
}

/// All links straight down, one angle per joint, rad; of a robot in space every joint at 0.
pub fn hanging(model: &Model) -> Vec<f64> {
    straight(model, 0.0)
}

impl Model {
    /// Angles in the model's own convention as relative ones, the first from hanging, rad.
    pub fn relative_rad(&self, pose_rad: &[f64]) -> Vec<f64> {
        let mut before = -self.angle_zero.from_hanging_rad();
        let angle = |(joint, &angle): (usize, &f64)| match self.angles {
            Angles::Relative => angle + self.zero_rad(joint),
            Angles::Absolute => angle - std::mem::replace(&mut before, angle),
        };
        pose_rad.iter().enumerate().map(angle).collect()
    }

    /// Relative angles, the first from hanging, in the model's own convention, rad: undoes
    /// [`Model::relative_rad`].
    pub fn convention_rad(&self, relative_rad: &[f64]) -> Vec<f64> {
        let mut sum = -self.angle_zero.from_hanging_rad();
        let angle = |(joint, &angle): (usize, &f64)| {
            sum += angle;
            match self.angles {
                Angles::Relative => angle - self.zero_rad(joint),
                Angles::Absolute => sum,
            }
        };
        relative_rad.iter().enumerate().map(angle).collect()
    }
}

/// All links that turn at an angle from hanging, rad, and joints that slide at 0.
fn straight(model: &Model, from_hanging_rad: f64) -> Vec<f64> {
    if model.is_in_space() {
        return vec![0.0; model.link_count()];
    }
    if model.angles == Angles::Absolute {
        let first = from_hanging_rad - model.angle_zero.from_hanging_rad();
        return vec![first; model.link_count()];
    }
    let mut before = 0.0;
    let joints = model.joints.iter().enumerate();
    let angle = |(joint, own): (usize, &Joint)| match own.slide {
        Some(slide) => {
            before += slide.link_rad;
            0.0
        }
        None => {
            let turn = from_hanging_rad - before;
            before = from_hanging_rad;
            turn - model.zero_rad(joint)
        }
    };
    joints.map(angle).collect()
}
