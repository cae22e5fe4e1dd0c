//! What the page plays: a chain, and tracks of its angles over time.

use crate::compare::Comparison;
use crate::log::Motion;
use crate::model::{Angles, Drive, Model};
use serde::Serialize;

/// Most samples of a track; longer motions are thinned evenly.
const MOST_SAMPLES: usize = 8000;

/// Everything the page shows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scene {
    /// Heading.
    pub title: String,
    /// The chain, from the base outwards.
    pub links: Vec<DrawnLink>,
    /// Whether the first joint turns freely on a bar; else a drive holds it.
    pub on_bar: bool,
    /// Whether to draw a head below the shoulder: three links that hang or stand on a bar by the first.
    pub head: bool,
    /// What can be played.
    pub motions: Vec<DrawnMotion>,
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
    /// What the drives were told.
    pub inputs: Vec<Input>,
}

/// Where a track comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The log.
    Measured,
    /// A model along the log's inputs.
    Model,
    /// Another log.
    Beside,
}

/// Angles over time.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Track {
    /// Name in the legend.
    pub name: String,
    /// Where it comes from.
    pub kind: Kind,
    /// Since the motion's start, s.
    pub time_s: Vec<f64>,
    /// Per link: angle from hanging, counter-clockwise, rad.
    pub link_rad: Vec<Vec<f64>>,
    /// Per joint: angle in the log's own convention, rad.
    pub joint_rad: Vec<Vec<f64>>,
}

/// A drive's input over time, at the measured track's samples.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Input {
    /// Joint, counted from 1.
    pub joint: usize,
    /// "torque", "duty", "goal".
    pub what: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// Values.
    pub values: Vec<f64>,
}

impl Scene {
    /// The measured `motions` of `model`.
    pub fn measured(model: &Model, motions: &[Motion]) -> Scene {
        let passive = |joint: usize| matches!(model.joints[joint].drive, Drive::Passive);
        let on_bar = passive(0);
        Scene {
            title: model.name.clone(),
            links: links(model),
            on_bar,
            head: on_bar && model.link_count() == 3 && !(passive(1) && passive(2)),
            motions: motions
                .iter()
                .map(|motion| DrawnMotion {
                    name: motion.name.clone(),
                    tracks: vec![of_motion(
                        model,
                        motion,
                        "measured".to_string(),
                        Kind::Measured,
                    )],
                    inputs: inputs(model, motion),
                })
                .collect(),
        }
    }

    /// Adds what a model foretold for each motion.
    pub fn add_model(&mut self, model: &Model, comparison: &Comparison) {
        for motion in &mut self.motions {
            let traces: Vec<_> = comparison
                .traces
                .iter()
                .filter(|trace| trace.motion == motion.name)
                .collect();
            let Some(first) = traces
                .first()
                .filter(|_| traces.len() == model.link_count())
            else {
                continue;
            };
            let joint_rad = traces.iter().map(|t| t.predicted_rad.clone()).collect();
            let name = comparison.model.clone();
            let time_s = first.time_s.clone();
            motion
                .tracks
                .push(track(model, name, Kind::Model, time_s, joint_rad));
        }
    }

    /// Adds the motions of another log, the first beside the first and so on.
    pub fn add_beside(&mut self, model: &Model, others: &[Motion]) {
        for (motion, other) in self.motions.iter_mut().zip(others) {
            let name = other.name.clone();
            motion
                .tracks
                .push(of_motion(model, other, name, Kind::Beside));
        }
    }
}

fn links(model: &Model) -> Vec<DrawnLink> {
    model
        .links
        .iter()
        .map(|link| DrawnLink {
            // A last link may come without a length: an even rod's is twice its centre of mass.
            length_m: match link.length_m {
                0.0 => 2.0 * link.com_m.abs(),
                length => length,
            },
            com_m: link.com_m,
            mass_kg: link.mass_kg,
        })
        .collect()
}

fn stride(samples: usize) -> usize {
    samples.div_ceil(MOST_SAMPLES).max(1)
}

fn of_motion(model: &Model, motion: &Motion, name: String, kind: Kind) -> Track {
    let thin = |values: &[f64]| -> Vec<f64> {
        let every = values.iter().copied().step_by(stride(values.len()));
        every.collect()
    };
    let joint_rad = motion
        .position_rad
        .iter()
        .map(|values| thin(values))
        .collect();
    track(model, name, kind, thin(&motion.time_s), joint_rad)
}

/// Times from the first, angles rounded to what can be seen.
fn track(
    model: &Model,
    name: String,
    kind: Kind,
    time_s: Vec<f64>,
    joint_rad: Vec<Vec<f64>>,
) -> Track {
    let first = time_s.first().copied().unwrap_or(0.0);
    let round = |value: f64, places: f64| (value * places).round() / places;
    let mut link_rad = Vec::new();
    let mut before = vec![model.angle_zero.from_hanging_rad(); time_s.len()];
    for (joint, angles) in joint_rad.iter().enumerate() {
        let own: Vec<f64> = match model.angles {
            Angles::Relative => angles.iter().zip(&before).map(|(a, b)| a + b).collect(),
            Angles::Absolute => {
                let zero = model.angle_zero.from_hanging_rad();
                angles.iter().map(|a| a + zero).collect()
            }
        };
        link_rad.push(own.iter().map(|a| round(*a, 1e5)).collect());
        if joint == 0 || model.angles == Angles::Relative {
            before = own;
        }
    }
    let joint_rad = joint_rad
        .into_iter()
        .map(|angles| angles.into_iter().map(|a| round(a, 1e5)).collect())
        .collect();
    Track {
        name,
        kind,
        time_s: time_s.iter().map(|t| round(t - first, 1e5)).collect(),
        link_rad,
        joint_rad,
    }
}

fn inputs(model: &Model, motion: &Motion) -> Vec<Input> {
    let of = |(joint, values): (usize, &Option<Vec<f64>>)| {
        let values = values.as_ref()?;
        let (what, unit) = match model.joints[joint].drive {
            Drive::Passive => return None,
            Drive::Torque => ("torque", "N m"),
            Drive::Duty(_) => ("duty", ""),
            Drive::Position { .. } => ("goal", "rad"),
            Drive::Speed { .. } => ("goal", "rad/s"),
        };
        let thin = values.iter().step_by(stride(values.len()));
        Some(Input {
            joint: joint + 1,
            what,
            unit,
            values: thin.map(|v| (v * 1e5).round() / 1e5).collect(),
        })
    };
    motion.input.iter().enumerate().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::MotionSource;
    use std::f64::consts::PI;
    use std::path::Path;

    const MODEL: &str = include_str!("../../../models/handstand.toml");

    fn motion() -> Motion {
        Motion {
            name: "a.csv".into(),
            source: MotionSource {
                path: "a.csv".into(),
                sha256: String::new(),
                lines: (1, 2),
            },
            time_s: vec![7.0, 7.01],
            position_rad: vec![vec![PI / 2.0, 1.5], vec![0.0, 0.2], vec![0.0, -0.1]],
            velocity_rad_s: vec![None, None, None],
            input: vec![None, Some(vec![0.0, 1.0]), Some(vec![0.0, -2.0])],
            supply_v: None,
            torque_on: None,
            payload_kg: 0.0,
            turned: false,
        }
    }

    fn scene(text: &str) -> Scene {
        let model = Model::parse(text, Path::new("m.toml")).unwrap();
        Scene::measured(&model, &[motion()])
    }

    #[test]
    fn links_stand_where_their_joints_say() {
        let near = |found: &[Vec<f64>], sample: usize, wanted: [f64; 3]| {
            for (row, wanted) in found.iter().zip(wanted) {
                assert!((row[sample] - wanted).abs() < 2e-5, "{found:?} {wanted}");
            }
        };
        let relative = scene(MODEL);
        let track = &relative.motions[0].tracks[0];
        assert_eq!(track.time_s, [0.0, 0.01]);
        near(&track.link_rad, 0, [PI; 3]);
        let first = PI / 2.0 + 1.5;
        near(&track.link_rad, 1, [first, first + 0.2, first + 0.1]);
        let absolute = scene(&MODEL.replace("\"relative\"", "\"absolute\""));
        let track = &absolute.motions[0].tracks[0];
        near(&track.link_rad, 1, [first, PI / 2.0 + 0.2, PI / 2.0 - 0.1]);
    }

    #[test]
    fn the_handstand_hangs_on_a_bar_and_has_a_head_and_two_drives() {
        let scene = scene(MODEL);
        assert!(scene.on_bar && scene.head);
        let drives: Vec<usize> = scene.motions[0].inputs.iter().map(|i| i.joint).collect();
        assert_eq!(drives, [2, 3]);
        assert_eq!(scene.motions[0].inputs[1].values, [0.0, -2.0]);
        assert_eq!(scene.links[0].length_m, 0.1436);
    }

    /// A name must not end the page's data.
    #[test]
    fn names_cannot_break_out() {
        let scene = scene(&MODEL.replace("\"handstand\"", "\"</script><u>\""));
        let page = super::super::html(&scene, "handstand view <x>").unwrap();
        assert_eq!(page.matches("</script>").count(), 2, "its own two");
        assert!(!page.contains("<u>") && !page.contains("<x>"));
    }
}
