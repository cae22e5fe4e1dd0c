//! What carries over from one step to the next, and from one stretch of a motion to the stretch
//! after it: readings of encoders with memory, and what drives and joints remember.

use super::drive::DriveInput;
use super::joint_plan::JointPlan;
use super::plant::Plant;
use super::run::StartState;
use super::sensor_state::SensorState;
use crate::effects::{BodyState, MemoryCell, StepState};

/// Memory of a plant between the stretches of one motion.
#[derive(Debug, Clone, Default)]
pub struct PlantMemory {
    pub(super) sensors: SensorState,
    pub(super) effects: EffectMemory,
    /// Sample at which the stretch before ended, and in which state; none where nothing is
    /// remembered.
    pub(super) ended: Option<(usize, StartState)>,
    /// Inputs of the drives before the log of the motion, by joint; its first ones where empty.
    pub(super) before: Vec<f64>,
    /// What is hidden where the next stretch begins, in the order of [`Plant::hidden`]; as
    /// remembered where empty.
    pub(super) begins: Vec<f64>,
}

/// One cell per effect that remembers and joint at which it acts; its place is that of
/// [`ActiveEffect::cell`](super::joint_plan::ActiveEffect).
#[derive(Debug, Clone, Default)]
pub(super) struct EffectMemory(pub Vec<MemoryCell>);

impl EffectMemory {
    /// Where a motion begins at these angles and speeds, nothing being known of before.
    pub fn beginning(plant: &Plant, angle: &[f64], speed: &[f64]) -> EffectMemory {
        let mut memory = EffectMemory(vec![MemoryCell::EMPTY; plant.remembers]);
        for (joint, plan) in plant.joints.iter().enumerate() {
            let at = StepState {
                speed_rad_s: speed[joint],
                ..StepState::at_rest(angle[joint] - plant.zeros_rad[joint])
            };
            for (e, cell) in plan.remembering() {
                memory.0[cell] = e.effect.recall(e.values(), &at);
            }
            if let Some(cell) = plan.gear_cell {
                memory.0[cell] = BodyState::UNKNOWN.into();
            }
        }
        if let Some((_, cell)) = plant.base {
            memory.0[cell..cell + 2].fill(BodyState::UNKNOWN.into());
        }
        memory
    }

    /// Inputs as the drives follow them through a step.
    pub fn obey(&self, plant: &Plant, inputs: &mut [DriveInput], step_s: f64) {
        for (plan, at) in plant.joints.iter().zip(inputs) {
            *at = self.obeyed(plan, *at, step_s);
        }
    }

    fn obeyed(&self, plan: &JointPlan, at: DriveInput, step_s: f64) -> DriveInput {
        let effects = plan.command.iter().filter(|_| at.energised);
        let input = effects.fold(at.input, |input, e| {
            (e.effect).obey(e.values(), e.recall(&self.0), input, step_s)
        });
        DriveInput { input, ..at }
    }

    /// After a step of `step_s` with these inputs that ended at these angles and speeds.
    pub fn remember(
        &mut self,
        plant: &Plant,
        inputs: &[DriveInput],
        (angle, speed): (&[f64], &[f64]),
        step_s: f64,
    ) {
        for (joint, plan) in plant.joints.iter().enumerate() {
            if plan.remembering().next().is_none() {
                continue;
            }
            let input = self.obeyed(plan, inputs[joint], step_s);
            let reading = plant.encoded_rad(joint, angle);
            let motor_speed = plan.motor_speed_rad_s(&self.0, speed[joint]);
            let at = StepState {
                input: inputs[joint].input,
                duty: plan.duty(input, reading.into(), motor_speed),
                energised: input.energised,
                angle_rad: angle[joint] - plant.zeros_rad[joint],
                speed_rad_s: speed[joint],
            };
            // Each of the command's effects gets what those before it let through.
            let mut arriving = at;
            for (e, cell) in plan.command.iter().filter_map(|e| Some((e, e.cell?))) {
                let memory = self.0[cell];
                (e.effect).remember(e.values(), &mut self.0[cell], &arriving, step_s);
                if at.energised {
                    let through = e.effect.obey(e.values(), memory, arriving.input, step_s);
                    arriving.input = through;
                }
            }
            let of_command = plan.command.iter().filter(|e| e.cell.is_some()).count();
            for (e, cell) in plan.remembering().skip(of_command) {
                (e.effect).remember(e.values(), &mut self.0[cell], &at, step_s);
            }
        }
    }
}
