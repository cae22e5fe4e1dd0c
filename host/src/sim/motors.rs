//! Motors that turn apart from their joints, behind gears that give.
//!
//! They are integrated along with the joints, and remembered from step to step.

use super::memory::EffectMemory;
use super::plant::Plant;
use crate::effects::MemoryCell;

/// A motor of which nothing earlier is known.
pub(super) const UNKNOWN: MemoryCell = [f64::NAN; 2];

/// Share of a motor's torque below which friction may leave it anywhere between the flanks.
const LIGHT_SHARE: f64 = 0.01;

/// State of the motors, one a joint, those of rigid gears idle; empty where all are rigid.
#[derive(Debug, Clone, Default)]
pub(super) struct Motors {
    /// Angle as seen at the joint, rad.
    pub angle: Vec<f64>,
    /// Speed as seen at the joint, rad/s.
    pub speed: Vec<f64>,
    /// Acceleration, rad/s^2, found with those of the joints.
    pub slope: Vec<f64>,
}

impl Motors {
    /// Idle ones for the joints of `plant`.
    pub fn new(plant: &Plant) -> Motors {
        let motors = if plant.has_motors() { plant.len() } else { 0 };
        Motors {
            angle: vec![0.0; motors],
            speed: vec![0.0; motors],
            slope: vec![0.0; motors],
        }
    }

    /// Puts them where they are remembered to be, the joints being at these angles and speeds. One
    /// of which nothing is remembered turns as its joint does, its gear carrying what holds the
    /// joint, N m.
    pub fn recall(
        &mut self,
        plant: &Plant,
        memory: &EffectMemory,
        (angle, speed): (&[f64], &[f64]),
        holding_nm: impl Fn(usize) -> f64,
    ) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            let (Some(coupling), Some(cell)) = (plan.coupling, plan.gear_cell) else {
                continue;
            };
            let [own_angle, own_speed] = memory.0[cell];
            if own_angle.is_nan() {
                let light_nm = LIGHT_SHARE * plan.full_torque_nm;
                let wound = coupling.wound_rad(holding_nm(joint), light_nm);
                (self.angle[joint], self.speed[joint]) = (angle[joint] + wound, speed[joint]);
            } else {
                (self.angle[joint], self.speed[joint]) = (own_angle, own_speed);
            }
        }
    }

    /// Remembers where they are.
    pub fn remember(&self, plant: &Plant, memory: &mut EffectMemory) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            if let Some(cell) = plan.gear_cell {
                memory.0[cell] = [self.angle[joint], self.speed[joint]];
            }
        }
    }
}
