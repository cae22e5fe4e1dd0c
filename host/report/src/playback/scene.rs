//! What the page plays: a chain or a robot in space, and tracks of its angles over time.

use super::tree::DrawnTree;
use crate::compare::Comparison;
use crate::model::shapes::RobotShapes;
use crate::model::{Angles, Drive, MeasuredSignal, Model};
use crate::motion::Motion;
use serde::Serialize;

/// Most samples of a track; longer motions are thinned evenly.
const MOST_SAMPLES: usize = 8000;

/// Everything the page shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// Heading.
    pub title: String,
    /// A planar chain, from the base outwards; nothing of a robot in space.
    pub links: Vec<DrawnLink>,
    /// A robot in space.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tree: Option<DrawnTree>,
    /// Its joints, from the base outwards.
    pub joints: Vec<DrawnJoint>,
    /// Whether the first joint turns freely on a bar; else a drive holds it.
    pub on_bar: bool,
    /// Whether to draw a head below the shoulder: three links that hang or stand on a bar by the
    /// first.
    pub head: bool,
    /// What can be played.
    pub motions: Vec<DrawnMotion>,
}

/// A joint as it is spoken of.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnJoint {
    /// What the robot's file calls it; "joint 1" in a planar chain.
    pub name: String,
    /// Whether it slides: its values are then in m.
    pub slides: bool,
}

/// A link as drawn.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnLink {
    /// Joint to next joint, or to the tip, m.
    pub length_m: f64,
    /// Joint to centre of mass, m.
    pub com_m: f64,
    /// Mass, kg.
    pub mass_kg: f64,
}

/// One motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnMotion {
    /// Name of the log.
    pub name: String,
    /// What moves along, the measurement first.
    pub tracks: Vec<Track>,
    /// What the drives were commanded.
    pub inputs: Vec<Input>,
}

/// Where a track comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TrackKind {
    /// The log.
    Measured,
    /// A model along the log's inputs.
    Model,
    /// Another log.
    Overlay,
}

/// Angles over time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Track {
    /// Name in the legend.
    pub name: String,
    /// Where it comes from.
    pub kind: TrackKind,
    /// Since the motion's start, s.
    pub time_s: Vec<f64>,
    /// Per link: angle from hanging, counter-clockwise, rad; nothing of a robot in space.
    pub link_rad: Vec<Vec<f64>>,
    /// Per joint: angle in the log's own convention, rad, or m where it slides.
    pub joint_rad: Vec<Vec<f64>>,
}

/// A drive's input over time, at the measured track's samples.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Input {
    /// Joint, counted from 1.
    pub joint: usize,
    /// "torque", "force", "duty", "goal".
    pub what: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// Values.
    pub values: Vec<f64>,
}

impl Scene {
    /// The measured `motions` of `model`. A robot in space is drawn as capsules until
    /// [`dress`](Scene::dress).
    pub fn measured(model: &Model, motions: &[Motion]) -> Scene {
        let passive = |joint: usize| matches!(model.joints[joint].drive, Drive::Passive);
        let is_planar = !model.is_in_space();
        let on_bar = is_planar && passive(0);
        Scene {
            title: model.name.clone(),
            links: if is_planar { links(model) } else { Vec::new() },
            tree: DrawnTree::of(model, &RobotShapes::default()),
            joints: joints(model),
            on_bar,
            head: on_bar && model.link_count() == 3 && !(passive(1) && passive(2)),
            motions: motions
                .iter()
                .map(|motion| DrawnMotion {
                    name: motion.name.clone(),
                    tracks: vec![measured(model, motion, "measured", TrackKind::Measured)],
                    inputs: inputs(model, motion),
                })
                .collect(),
        }
    }

    /// Draws a robot in space by its own shapes.
    pub fn dress(&mut self, model: &Model, shapes: &RobotShapes) {
        self.tree = DrawnTree::of(model, shapes);
    }

    /// Adds what a model predicts for each motion.
    pub fn add_model(&mut self, model: &Model, comparison: &Comparison) {
        for motion in &mut self.motions {
            let own = comparison
                .traces
                .iter()
                .filter(|trace| trace.motion == motion.name);
            let angles = own.filter(|trace| trace.quantity == MeasuredSignal::Angle);
            let traces: Vec<_> = angles.collect();
            if traces.len() != model.link_count() {
                continue;
            }
            let joint_rad: Vec<_> = traces.iter().map(|t| t.predicted.as_slice()).collect();
            let (name, time_s) = (&comparison.model, &traces[0].time_s);
            motion
                .tracks
                .push(track(model, name, TrackKind::Model, time_s, &joint_rad));
        }
    }

    /// Adds the motions of another log, the first over the first and so on.
    pub fn add_overlay(&mut self, model: &Model, others: &[Motion]) {
        for (motion, other) in self.motions.iter_mut().zip(others) {
            motion
                .tracks
                .push(measured(model, other, &other.name, TrackKind::Overlay));
        }
    }
}

fn links(model: &Model) -> Vec<DrawnLink> {
    let links = model.links.iter().map(|link| DrawnLink {
        // A last link may come without a length: an even rod's is twice its centre of mass.
        length_m: match link.length_m {
            0.0 => 2.0 * link.com_m.abs(),
            length => length,
        },
        com_m: link.com_m,
        mass_kg: link.mass_kg,
    });
    links.collect()
}

fn joints(model: &Model) -> Vec<DrawnJoint> {
    let joints = model.joints.iter().enumerate();
    let joints = joints.map(|(index, joint)| DrawnJoint {
        name: match model.joint_name(index) {
            Some(name) => name.to_string(),
            None => format!("joint {}", index + 1),
        },
        slides: joint.slide.is_some(),
    });
    joints.collect()
}

/// Samples that are kept: every n-th.
fn thinned(values: &[f64]) -> Vec<f64> {
    let stride = values.len().div_ceil(MOST_SAMPLES).max(1);
    values.iter().copied().step_by(stride).collect()
}

/// A joint stands where it was last seen while nothing is measured.
fn held(angles: &[f64]) -> Vec<f64> {
    let first = angles.iter().copied().find(|angle| angle.is_finite());
    let mut last = first.unwrap_or(0.0);
    let seen = |angle: &f64| {
        if angle.is_finite() {
            last = *angle;
        }
        last
    };
    angles.iter().map(seen).collect()
}

/// To five decimals, finer than can be seen.
fn rounded(values: &[f64]) -> Vec<f64> {
    values
        .iter()
        .map(|value| (value * 1e5).round() / 1e5)
        .collect()
}

fn measured(model: &Model, motion: &Motion, name: &str, kind: TrackKind) -> Track {
    let joint_rad = motion.position_rad.iter();
    let joint_rad: Vec<Vec<f64>> = joint_rad.map(|q| thinned(&held(q))).collect();
    let joint_rad: Vec<&[f64]> = joint_rad.iter().map(Vec::as_slice).collect();
    track(model, name, kind, &thinned(&motion.time_s), &joint_rad)
}

/// Times from the first; in a plane the links' angles from the joints', which are relative or
/// absolute.
fn track(
    model: &Model,
    name: &str,
    kind: TrackKind,
    time_s: &[f64],
    joint_rad: &[&[f64]],
) -> Track {
    let first = time_s.first().copied().unwrap_or(0.0);
    let mut from = vec![model.angle_zero.from_hanging_rad(); time_s.len()];
    let mut link_rad = Vec::new();
    let planar = joint_rad.iter().filter(|_| !model.is_in_space());
    for angles in planar {
        let own: Vec<f64> = angles
            .iter()
            .zip(&from)
            .map(|(angle, from)| angle + from)
            .collect();
        link_rad.push(rounded(&own));
        if model.angles == Angles::Relative {
            from = own;
        }
    }
    Track {
        name: name.to_string(),
        kind,
        time_s: rounded(&time_s.iter().map(|time| time - first).collect::<Vec<_>>()),
        link_rad,
        joint_rad: joint_rad.iter().map(|angles| rounded(angles)).collect(),
    }
}

fn inputs(model: &Model, motion: &Motion) -> Vec<Input> {
    let of = |(joint, values): (usize, &Option<Vec<f64>>)| {
        let slides = model.joints[joint].slide.is_some();
        let (what, unit, on_slide) = match model.joints[joint].drive {
            Drive::Passive => return None,
            Drive::Torque if slides => ("force", "N m", "N"),
            Drive::Torque => ("torque", "N m", "N"),
            Drive::Duty(_) => ("duty", "", ""),
            Drive::Position { .. } => ("goal", "rad", "m"),
            Drive::Speed { .. } => ("goal", "rad/s", "m/s"),
        };
        Some(Input {
            joint: joint + 1,
            what,
            unit: if slides { on_slide } else { unit },
            values: rounded(&thinned(values.as_ref()?)),
        })
    };
    motion.input.iter().enumerate().filter_map(of).collect()
}

#[cfg(test)]
mod tests;
