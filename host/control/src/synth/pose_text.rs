//! Poses as people write them: `upright`, an angle for every joint, or some joints by name.

use super::error::DesignError;
use crate::model::suggest::suggest;
use crate::model::{JointNames, Model, default_pose, upright};
use std::str::FromStr;

/// A pose as it is asked for; angles are the model's own, rad, of slides m.
#[derive(Debug, Clone, PartialEq)]
pub enum PoseText {
    /// All links straight up.
    Upright,
    /// An angle for every joint.
    Angles(Vec<f64>),
    /// Angles of these joints, by name or number from 1; the others are as in
    /// [`default_pose`].
    Named(Vec<(String, f64)>),
}

impl FromStr for PoseText {
    type Err = String;

    fn from_str(text: &str) -> Result<PoseText, String> {
        if text.trim() == "upright" {
            return Ok(PoseText::Upright);
        }
        let number = |text: &str| text.trim().parse::<f64>().ok();
        let parts = || text.split(',').map(str::trim);
        let found = if text.contains('=') {
            let named = parts().map(|part| {
                let (name, angle) = part.rsplit_once('=')?;
                Some((name.trim().to_string(), number(angle)?))
            });
            named.collect::<Option<_>>().map(PoseText::Named)
        } else {
            parts()
                .map(number)
                .collect::<Option<_>>()
                .map(PoseText::Angles)
        };
        found.ok_or_else(|| {
            "give an angle per joint in rad between commas, or some by name (`elbow=0.3`), or \
             `upright`"
                .to_string()
        })
    }
}

impl PoseText {
    /// The pose of a model: an angle for every joint in the model's own convention, rad, of slides
    /// m.
    ///
    /// # Errors
    /// Joints that are not there or twice, and upright of a robot in space; another number of
    /// angles than of joints, angles that are no numbers or beyond a range of the robot's file.
    pub fn resolve(&self, model: &Model) -> Result<Vec<f64>, DesignError> {
        let pose_rad = match self {
            PoseText::Upright if model.is_in_space() => {
                return Err(DesignError::request(
                    format!(
                        "`{}` is a robot in space, and upright is a pose of planar chains",
                        model.name
                    ),
                    "give the angles of its file, by joint: `--pose shoulder=0.3,elbow=-0.5`",
                ));
            }
            PoseText::Upright => upright(model),
            PoseText::Angles(angles) => angles.clone(),
            PoseText::Named(named) => named_pose(model, named)?,
        };
        check_pose(model, &pose_rad)?;
        Ok(pose_rad)
    }

    /// The joints, counted from 0, whose angles it leaves to [`default_pose`].
    pub fn left_open(&self, model: &Model) -> Vec<usize> {
        let PoseText::Named(named) = self else {
            return Vec::new();
        };
        let given: Vec<usize> = named
            .iter()
            .filter_map(|(name, _)| joint(model, name))
            .collect();
        (0..model.link_count())
            .filter(|joint| !given.contains(joint))
            .collect()
    }
}

fn named_pose(model: &Model, named: &[(String, f64)]) -> Result<Vec<f64>, DesignError> {
    let mut pose_rad = default_pose(model);
    let mut given = vec![false; pose_rad.len()];
    for (name, angle) in named {
        let joint = joint(model, name).ok_or_else(|| {
            DesignError::request(
                format!("`{}` has no joint `{name}`", model.name),
                suggest(name, &labels(model)),
            )
        })?;
        if std::mem::replace(&mut given[joint], true) {
            return Err(DesignError::request(
                format!("the pose gives joint {name} twice"),
                "give it once",
            ));
        }
        pose_rad[joint] = *angle;
    }
    Ok(pose_rad)
}

/// The joint of this name or number, counted from 0.
fn joint(model: &Model, name: &str) -> Option<usize> {
    let numbered = || {
        let number = name.parse::<usize>().ok()?.checked_sub(1)?;
        (number < model.link_count()).then_some(number)
    };
    model.joint_named(name).or_else(numbered)
}

/// What each joint is called.
fn labels(model: &Model) -> Vec<String> {
    let names = JointNames::of(model);
    (0..model.link_count())
        .map(|joint| names.label(joint))
        .collect()
}

/// One angle per joint, all of them numbers and within the ranges of the robot's file.
///
/// # Errors
/// What is not so.
pub(super) fn check_pose(model: &Model, pose_rad: &[f64]) -> Result<(), DesignError> {
    if pose_rad.len() != model.link_count() {
        let joints = labels(model);
        return Err(DesignError::request(
            format!(
                "the pose has {} angles, the model {} joints",
                pose_rad.len(),
                joints.len()
            ),
            format!(
                "give one angle per joint, in this order: {}; or some by name, as `{}=0.3`",
                joints.join(", "),
                joints.last().map_or("1", String::as_str)
            ),
        ));
    }
    if let Some(angle) = pose_rad.iter().find(|angle| !angle.is_finite()) {
        return Err(DesignError::request(
            format!("the pose has an angle of {angle}"),
            "give angles in rad",
        ));
    }
    for (joint, angle) in pose_rad.iter().enumerate() {
        if let Some((low, high)) = model.range(joint)
            && !(low..=high).contains(angle)
        {
            let name = JointNames::of(model).label(joint);
            let unit = model.joints[joint].units()[0];
            return Err(DesignError::request(
                format!(
                    "the pose has joint {name} at {angle} {unit}, beyond its range from {low} to \
                     {high} {unit} in the robot's file"
                ),
                "choose an angle within",
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_read_in_three_ways() {
        let read = |text: &str| text.parse::<PoseText>();
        assert_eq!(read("upright"), Ok(PoseText::Upright));
        assert_eq!(read("0.3, -1"), Ok(PoseText::Angles(vec![0.3, -1.0])));
        let named = vec![("elbow".to_string(), 0.3), ("left arm".to_string(), -1.0)];
        assert_eq!(read("elbow=0.3, left arm = -1"), Ok(PoseText::Named(named)));
        for text in ["", "0.3,", "elbow", "elbow=", "elbow=0.3,1", "elbow=x"] {
            assert!(read(text).is_err(), "{text}");
        }
    }
}
