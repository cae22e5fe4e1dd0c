//! Unknowns of a stretch's beginning that no reading tells: where in its play a joint is and how
//! fast it crosses it, how far dry friction is bent before it slides, what a drive that is late, or
//! gets on slowly, was told before the log begins.
//!
//! A stretch takes over what the one before came to remember. That is as wrong at its end as the
//! errors of its start have grown by then, and in an unstable motion they grow fast. How far a gear
//! is wound up is taken over: its motor swings in, and knocks of its flanks leave a fit no slope.

use super::joint_plan::{ActiveEffect, JointPlan};
use super::memory::{EffectMemory, PlantMemory};
use super::plant::Plant;
use super::sensor_state::SensorState;
use crate::effects::StepState;

/// One such unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HiddenUnknown {
    /// The joint at which it is.
    pub joint: usize,
    /// What of it is unknown.
    pub quantity: HiddenQuantity,
    place: HiddenMemory,
}

/// What is unknown of something hidden.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HiddenQuantity {
    /// A displacement as a share, -1 to 1, of its scale: so it stays what it is, at a flank for
    /// one, when a fit moves the scale.
    Share {
        /// rad (m) per 1.
        scale: f64,
    },
    /// How fast that changes, rad/s (m/s).
    Rate,
    /// By how much more than the first input of the log the one before it was, as a share of it:
    /// -1 where the log begins with the first command.
    Before {
        /// Whether the drive gets from that to its input slowly, not only late.
        is_slow: bool,
    },
}

/// Where it is remembered, by the cell there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum HiddenMemory {
    Sensor(usize),
    Effect(usize),
    Input,
}

impl HiddenUnknown {
    /// Those of a plant's joints.
    pub(super) fn all(joints: &[JointPlan]) -> Vec<HiddenUnknown> {
        let mut all = Vec::new();
        let mut sensors = 0;
        for (joint, plan) in joints.iter().enumerate() {
            let mut add = |place, quantity| {
                all.push(HiddenUnknown {
                    joint,
                    quantity,
                    place,
                });
            };
            let share = |scale| HiddenQuantity::Share { scale };
            for e in &plan.sense {
                if let Some(scale) = e.effect.hidden_scale(e.values()) {
                    add(HiddenMemory::Sensor(sensors), share(scale));
                    add(HiddenMemory::Sensor(sensors), HiddenQuantity::Rate);
                }
                sensors += 1;
            }
            for (e, cell) in plan.remembering() {
                if let Some(scale) = e.effect.hidden_scale(e.values()) {
                    add(HiddenMemory::Effect(cell), share(scale));
                }
            }
            let is_slow = plan.follows_slowly();
            if plan.is_late || is_slow {
                add(HiddenMemory::Input, HiddenQuantity::Before { is_slow });
            }
        }
        all
    }

    /// Whether it is of the same kind at the same place.
    pub fn is_alike(&self, other: &HiddenUnknown) -> bool {
        let kind = |unknown: &HiddenUnknown| std::mem::discriminant(&unknown.quantity);
        (self.joint, self.place, kind(self)) == (other.joint, other.place, kind(other))
    }

    /// Its value where this is the displacement and its rate.
    fn of(&self, [displacement, rate]: [f64; 2]) -> f64 {
        match self.quantity {
            HiddenQuantity::Share { scale } if scale > 0.0 => displacement / scale,
            HiddenQuantity::Share { .. } => 0.0,
            HiddenQuantity::Rate => rate,
            HiddenQuantity::Before { .. } => 0.0,
        }
    }

    /// Displacement and rate with this value.
    fn put(&self, at: &mut [f64; 2], value: f64) {
        match self.quantity {
            HiddenQuantity::Share { scale } => at[0] = scale * value,
            HiddenQuantity::Rate => at[1] = value,
            HiddenQuantity::Before { .. } => {}
        }
    }
}

impl Plant {
    /// What drives were told before the log begins, as a share of its first input, with these
    /// values of what is hidden, in the order of [`Plant::hidden`].
    pub(super) fn put_before(&self, values: &[f64], share: &mut [f64]) {
        share.fill(1.0);
        for (unknown, value) in self.hidden.iter().zip(values) {
            if unknown.place == HiddenMemory::Input {
                share[unknown.joint] = 1.0 + value;
            }
        }
    }

    /// What no reading tells of where a stretch begins.
    pub fn hidden(&self) -> &[HiddenUnknown] {
        &self.hidden
    }

    /// The effect at a joint that remembers in this cell.
    fn remembering(&self, joint: usize, cell: usize) -> Option<&ActiveEffect> {
        let mut remembering = self.joints[joint].remembering();
        let own = remembering.find(|(_, own)| *own == cell);
        own.map(|(e, _)| e)
    }

    fn sensor(&self, cell: usize) -> Option<&ActiveEffect> {
        self.joints.iter().flat_map(|plan| &plan.sense).nth(cell)
    }
}

impl PlantMemory {
    /// Has the next stretch begin with these values of what is hidden, in the order of
    /// [`Plant::hidden`]; with none, as remembered.
    pub fn begin_with(&mut self, hidden: &[f64]) {
        self.begins.clear();
        self.begins.extend_from_slice(hidden);
    }

    /// What is hidden as it is remembered, in the order of [`Plant::hidden`]; 0 where nothing is.
    pub fn hidden(&self, plant: &Plant) -> Vec<f64> {
        let value = |unknown: &HiddenUnknown| {
            let at = match unknown.place {
                HiddenMemory::Sensor(cell) => {
                    let memory = self.sensors.cells.get(cell).copied().flatten();
                    memory
                        .zip(plant.sensor(cell))
                        .map(|(m, e)| e.effect.slipped(m))
                }
                HiddenMemory::Effect(cell) => {
                    let memory = self.effects.0.get(cell).copied();
                    memory
                        .zip(plant.remembering(unknown.joint, cell))
                        .map(|(m, e)| [e.effect.displacement(m), 0.0])
                }
                HiddenMemory::Input => None,
            };
            at.map(|at| unknown.of(at))
                .filter(|value| value.is_finite())
        };
        plant
            .hidden
            .iter()
            .map(|unknown| value(unknown).unwrap_or(0.0))
            .collect()
    }
}

impl SensorState {
    /// Puts what is hidden at the sensors, in the order of [`Plant::hidden`].
    pub(super) fn put_hidden(&mut self, plant: &Plant, values: &[f64]) {
        self.fit_to(plant);
        for (unknown, value) in plant.hidden.iter().zip(values) {
            if let HiddenMemory::Sensor(cell) = unknown.place
                && let Some(e) = plant.sensor(cell)
            {
                let memory = self.cells[cell].unwrap_or_default();
                let mut slipped = e.effect.slipped(memory);
                unknown.put(&mut slipped, *value);
                self.cells[cell] = Some(e.effect.slip(e.values(), slipped));
            }
        }
    }
}

impl EffectMemory {
    /// Has commands been obeyed for long that were so much of the log's first input, by joint.
    pub(super) fn obeyed_before(
        &mut self,
        plant: &Plant,
        inputs: &[Option<Vec<f64>>],
        share: &[f64],
    ) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            let first = inputs[joint].as_ref().and_then(|input| input.first());
            let (Some(first), true) = (first, plan.follows_slowly()) else {
                continue;
            };
            let told = share[joint] * first;
            for (e, cell) in plan.command.iter().filter_map(|e| Some((e, e.cell?))) {
                let state = StepState::at_rest(0.0);
                self.0[cell] = e.effect.displaced(e.values(), told, &state);
            }
        }
    }

    /// Puts what is hidden in friction where the joints are at these angles, rad, in the
    /// order of [`Plant::hidden`].
    pub(super) fn put_hidden(&mut self, plant: &Plant, angle: &[f64], values: &[f64]) {
        for (unknown, value) in plant.hidden.iter().zip(values) {
            if let HiddenMemory::Effect(cell) = unknown.place {
                let joint = unknown.joint;
                if let Some(e) = plant.remembering(joint, cell) {
                    let mut at = [0.0; 2];
                    unknown.put(&mut at, *value);
                    let state = StepState::at_rest(angle[joint] - plant.zeros_rad[joint]);
                    self.0[cell] = e.effect.displaced(e.values(), at[0], &state);
                }
            }
        }
    }
}
