//! Unknowns that no reading tells. Of every stretch's beginning: where in its play a joint is and
//! how fast it crosses it, how far dry friction is bent before it slides. Of a motion's beginning:
//! which input a drive had that is late, or gets on slowly, before the log; for how long it had
//! been overloaded; where its motor was behind a gear. Each effect says which it has
//! ([`Law::start_unknown`](crate::effects::Law::start_unknown)).
//!
//! A stretch takes over what the one before came to remember. That is as wrong at its end as the
//! errors of its start have grown by then, and in an unstable motion they grow fast. How far a gear
//! is wound up is taken over: its motor swings in, and knocks of its flanks leave a fit no slope.

use super::joint_plan::{ActiveEffect, JointPlan};
use super::memory::{EffectMemory, PlantMemory};
use super::plant::Plant;
use super::sensor_state::SensorState;
use crate::effects::{BodyState, StartUnknown, StepState};
use crate::model::Drive;
use crate::motion::Motion;

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
    /// Of a motion: by how much more than the first input of the log the one before it was, as a
    /// share, -1 to 1, of how far they may be apart.
    Before {
        /// Whether the drive gets from that to its input slowly, not only late.
        is_slow: bool,
    },
    /// Of a motion: where a motor behind a gear is, as a share, -1 to 1, of its scale.
    Place {
        /// rad (m) per 1.
        scale: f64,
        /// Share at which the flanks of a gear meet.
        flank: f64,
    },
    /// Of a motion: how fast it moves, as a share likewise.
    Speed {
        /// rad/s (m/s) per 1.
        scale: f64,
    },
    /// Of a motion: how much had come together before the log, as a share, 0 to 1, of the most.
    Amount {
        /// In the unit of what the effect remembers.
        most: f64,
    },
}

impl HiddenQuantity {
    /// Whether it is of a body beside the links.
    fn is_of_body(self) -> bool {
        matches!(
            self,
            HiddenQuantity::Place { .. } | HiddenQuantity::Speed { .. }
        )
    }

    /// Whether it is of the beginning of a motion, not of every stretch.
    pub fn is_of_motion(self) -> bool {
        matches!(
            self,
            HiddenQuantity::Before { .. } | HiddenQuantity::Amount { .. }
        ) || self.is_of_body()
    }
}

/// By how many times an input before the log may be farther from the first than those of the log.
const BEYOND: f64 = 1.5;

/// How many times a drive's torque at standstill may press.
const LOADED: f64 = 2.0;

/// What is unknown of a body beside the links that may be displaced by so much, rad (m).
fn body(most: f64, flank: f64, natural_rad_s: f64) -> [HiddenQuantity; 2] {
    [
        HiddenQuantity::Place {
            scale: most,
            flank: flank / most,
        },
        HiddenQuantity::Speed {
            scale: most * natural_rad_s,
        },
    ]
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
            for e in &plan.sense {
                if let Some(StartUnknown::Displacement { most: scale }) = e.start_unknown() {
                    let place = HiddenMemory::Sensor(sensors);
                    add(place, HiddenQuantity::Share { scale });
                    add(place, HiddenQuantity::Rate);
                }
                sensors += 1;
            }
            for (e, cell) in plan.remembering() {
                let quantity = match e.start_unknown() {
                    Some(StartUnknown::Displacement { most: scale }) => {
                        HiddenQuantity::Share { scale }
                    }
                    Some(StartUnknown::Amount { most }) => HiddenQuantity::Amount { most },
                    _ => continue,
                };
                add(HiddenMemory::Effect(cell), quantity);
            }
            if let (Some(coupling), Some(cell)) = (plan.coupling, plan.gear_cell) {
                let (most, flank) = coupling.reach_rad(LOADED * plan.full_torque_nm);
                let place = HiddenMemory::Effect(cell);
                for quantity in body(most, flank, coupling.natural_rad_s) {
                    add(place, quantity);
                }
            }
            if let Some(is_slow) = plan.depends_on_input_before {
                add(HiddenMemory::Input, HiddenQuantity::Before { is_slow });
            }
        }
        all
    }

    /// Whether it is of the same kind at the same place.
    pub fn is_alike(&self, other: &HiddenUnknown) -> bool {
        let kind = |unknown: &HiddenUnknown| {
            let is_slow = unknown.quantity == HiddenQuantity::Before { is_slow: true };
            (std::mem::discriminant(&unknown.quantity), is_slow)
        };
        (self.joint, self.place, kind(self)) == (other.joint, other.place, kind(other))
    }

    /// Its value where this is the displacement and its rate.
    fn of(&self, [displacement, rate]: [f64; 2]) -> f64 {
        match self.quantity {
            HiddenQuantity::Share { scale } if scale > 0.0 => displacement / scale,
            HiddenQuantity::Share { .. } => 0.0,
            HiddenQuantity::Rate => rate,
            HiddenQuantity::Place { scale, .. } => displacement / scale,
            HiddenQuantity::Speed { scale } => rate / scale,
            HiddenQuantity::Before { .. } | HiddenQuantity::Amount { .. } => 0.0,
        }
    }

    /// Displacement and rate with this value.
    fn put(&self, at: &mut [f64; 2], value: f64) {
        match self.quantity {
            HiddenQuantity::Share { scale } => at[0] = scale * value,
            HiddenQuantity::Rate => at[1] = value,
            HiddenQuantity::Place { scale, .. } => at[0] = scale * value,
            HiddenQuantity::Speed { scale } => at[1] = scale * value,
            HiddenQuantity::Before { .. } | HiddenQuantity::Amount { .. } => {}
        }
    }
}

impl Plant {
    /// Inputs of drives before the log of a motion begins with these values of what is hidden, in
    /// the order of [`Plant::hidden`]; with none, its first ones.
    pub(super) fn inputs_before(&self, motion: &Motion, values: &[f64]) -> Vec<f64> {
        let first = |input: &Option<Vec<f64>>| input.as_ref()?.first().copied();
        let inputs = motion.input.iter();
        let mut before: Vec<f64> = inputs.map(|input| first(input).unwrap_or(0.0)).collect();
        before.resize(self.len(), 0.0);
        for (unknown, value) in self.hidden.iter().zip(values) {
            if unknown.place == HiddenMemory::Input {
                before[unknown.joint] += value * self.before_span(motion, unknown.joint);
            }
        }
        before
    }

    /// How far the input before the log may be from the first one: anywhere that inputs of the
    /// motion go, none, full duty, or a goal where the joint stands, and half as far beyond.
    pub fn before_span(&self, motion: &Motion, joint: usize) -> f64 {
        let Some((first, inputs)) =
            (motion.input[joint].as_deref()).and_then(|input| Some((*input.first()?, input)))
        else {
            return 0.0;
        };
        let standing = motion.position_rad[joint].first().copied();
        let full: &[f64] = match self.joints[joint].drive {
            Drive::Position { .. } => standing.as_slice(),
            Drive::Duty(_) => &[-1.0, 1.0],
            Drive::Torque | Drive::Speed { .. } | Drive::Passive => &[],
        };
        let reached = inputs.iter().chain(full).chain(&[0.0]);
        let distances = reached.map(|input| (input - first).abs());
        BEYOND * distances.filter(|far| far.is_finite()).fold(0.0, f64::max)
    }

    /// Whether the inputs of a joint's drive are goals of its angle.
    pub fn is_told_angles(&self, joint: usize) -> bool {
        matches!(self.joints[joint].drive, Drive::Position { .. })
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
                HiddenMemory::Effect(cell) if unknown.quantity.is_of_body() => {
                    let body = self.effects.0.get(cell).copied().map(BodyState::from);
                    body.map(|body| [body.place, body.speed])
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
    /// Has drives had these inputs for long where a motion begins, by joint, and as much come
    /// together as these values say, in the order of [`Plant::hidden`]: where there are none, as
    /// much as nothing earlier makes.
    pub(super) fn begin_motion(&mut self, plant: &Plant, before: &[f64], values: &[f64]) {
        let state = StepState::at_rest(0.0);
        for (plan, &input) in plant.joints.iter().zip(before) {
            for (e, cell) in plan.remembering() {
                if matches!(e.start_unknown(), Some(StartUnknown::Input { .. })) {
                    self.0[cell] = e.effect.recall_unknown(e.values(), input, &state);
                }
            }
        }
        for (unknown, value) in plant.hidden.iter().zip(values) {
            let HiddenMemory::Effect(at) = unknown.place else {
                continue;
            };
            if unknown.quantity.is_of_body() {
                let body = BodyState::from(self.0[at]);
                let mut moving = [body.place, body.speed];
                unknown.put(&mut moving, *value);
                let [place, speed] = moving;
                self.0[at] = BodyState { place, speed }.into();
            }
            let HiddenQuantity::Amount { most } = unknown.quantity else {
                continue;
            };
            let mut remembering = plant.joints[unknown.joint].remembering();
            if let Some((e, _)) = remembering.find(|(_, cell)| *cell == at) {
                self.0[at] = e.effect.recall_unknown(e.values(), most * value, &state);
            }
        }
    }

    /// Puts what is hidden in friction where the joints are at these angles, rad, in the
    /// order of [`Plant::hidden`].
    pub(super) fn put_hidden(&mut self, plant: &Plant, angle: &[f64], values: &[f64]) {
        for (unknown, value) in plant.hidden.iter().zip(values) {
            if unknown.quantity.is_of_motion() {
                continue;
            }
            if let HiddenMemory::Effect(cell) = unknown.place {
                let joint = unknown.joint;
                if let Some(e) = plant.remembering(joint, cell) {
                    let mut at = [0.0; 2];
                    unknown.put(&mut at, *value);
                    let state = StepState::at_rest(angle[joint] - plant.zeros_rad[joint]);
                    self.0[cell] = e.effect.recall_unknown(e.values(), at[0], &state);
                }
            }
        }
    }
}
