//! Commands that jump, of joints that regulate their angle: a dead zone's.
//!
//! Where within a step a joint crosses the reading at which its command jumps, a step does not see:
//! it would take the jump a part of itself too soon or too late, and no small change of a value
//! would show in it. So the command is the mean over what the reading moves in a step, half before
//! and half after: summed over steps that counts every moment once. (Filippov, Differential
//! Equations with Discontinuous Righthand Sides (1988), for what rests at a jump.)

use super::{Forces, StateView};
use crate::model::Drive;
use crate::sim::drive::OwnReading;
use crate::sim::plant::Plant;
use crate::sim::rows::Rows;

impl<R: Rows> Forces<R> {
    /// Finds how hard commands that jump kick joints about these angles.
    ///
    /// A joint that such a kick drives back across the reading at which it came rests there in
    /// truth; in steps it would hunt, and every derivative with it. Over what the kick moves it in
    /// a step the mean of the law holds it as a spring does, at a radian a step.
    pub fn find_kicks(&mut self, plant: &Plant, angle: &[f64]) {
        let n = angle.len();
        let jump_nm = |joint: usize| {
            let plan = &plant.joints[joint];
            let commands = plan.command.iter();
            match plan.drive {
                Drive::Position { .. } => {
                    let jumps = commands.map(|e| e.effect.command_jump(e.values()));
                    jumps.sum::<f64>() * plan.full_torque_nm
                }
                _ => 0.0,
            }
        };
        if (0..n).all(|joint| jump_nm(joint) == 0.0) {
            return;
        }
        let kick = |joint: usize| match jump_nm(joint) {
            0.0 => 0.0,
            jump_nm => jump_nm * self.response(plant, joint, angle)[joint],
        };
        let kicks: Vec<f64> = (0..n).map(kick).collect();
        self.kicks.as_mut().copy_from_slice(&kicks);
    }

    /// What a regulated joint reads of itself, and how far that moves in half a step: by its speed,
    /// and by the kick it may get.
    pub(super) fn own_reading(&self, plant: &Plant, joint: usize, at: StateView<'_>) -> OwnReading {
        let angle_rad = plant.encoded_rad(joint, at.angle);
        if plant.joints[joint].command.is_empty() {
            return angle_rad.into();
        }
        let (half_s, kick_rad_s2) = (self.half_step_s, self.kicks[joint]);
        let speed_rad_s = plant.encoded_slope_rad_s(joint, at.speed).abs();
        OwnReading {
            angle_rad,
            moves_rad: (speed_rad_s + 2.0 * kick_rad_s2 * half_s) * half_s,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::effects::named;
    use crate::model::{Drive, EffectInstance, Model, Motor};
    use crate::sim::drive::DriveInput;
    use crate::sim::plant::Plant;
    use crate::sim::rows::FixedRows;
    use crate::sim::stepper::Stepper;
    use std::path::Path;

    /// Where a regulated arm, hung up or without weight, is half a second after it rested at one
    /// angle and was given another as its goal; a share of the command is swallowed.
    fn led_rad(gravity_m_s2: f64, [from_rad, goal_rad]: [f64; 2], width: f64, step_s: f64) -> f64 {
        let text = include_str!("../../../../models/bench_arm.toml");
        let mut model = Model::parse(text, Path::new("bench_arm.toml")).unwrap();
        model.gravity_m_s2 = gravity_m_s2;
        model.joints[0].drive = Drive::Position {
            gain_per_rad: 5.0,
            motor: Motor {
                stall_torque_nm: 1.5,
                no_load_speed_rad_s: 6.0,
                nominal_supply_v: None,
            },
        };
        let link = &mut model.links[0];
        (link.com_m, link.mass_kg, link.inertia_kg_m2) = (0.1, 0.1, 1e-3);
        model.effects = vec![
            EffectInstance {
                effect: named("armature").unwrap(),
                joint: Some(0),
                values: vec![0.02],
            },
            EffectInstance {
                effect: named("dead_zone").unwrap(),
                joint: Some(0),
                values: vec![width, 0.0],
            },
        ];
        let plant = Plant::without_log(&model);
        let rest = plant.zeros_rad[0];
        let mut stepper = Stepper::<FixedRows<1>>::new(&plant, &[rest + from_rad], &[0.0]);
        let goal = DriveInput {
            input: goal_rad,
            ..DriveInput::ZERO
        };
        for _ in 0..(0.5 / step_s).round() as usize {
            stepper.advance(&plant, &[goal], step_s);
        }
        stepper.angle[0] - rest
    }

    #[test]
    fn a_joint_that_swings_into_its_dead_zone_does_so_to_second_order() {
        let exact = led_rad(0.0, [0.0, 0.4], 0.1, 2e-5);
        for step_s in [1e-2, 5e-3, 2.5e-3] {
            let off_rad = (led_rad(0.0, [0.0, 0.4], 0.1, step_s) - exact).abs();
            assert!(off_rad < step_s * step_s, "{step_s} s: {off_rad}");
        }
    }

    #[test]
    fn a_joint_that_its_weight_presses_onto_the_edge_rests_there_smoothly() {
        // Held out to the side: the weight takes less than the tenth of full torque at the edge.
        let at = |width: f64, step_s: f64| led_rad(9.81, [1.2, 1.2], width, step_s);
        for step_s in [1e-2, 5e-3] {
            let slope = |by: f64| (at(0.1 + by, step_s) - at(0.1, step_s)) / by;
            let slopes = [1e-3, 1e-4, 1e-5].map(slope);
            // Wholly at rest an edge farther by so much of the duty holds it a fifth of that lower.
            let is_near = |slope: &f64| (-0.3..-0.15).contains(slope);
            assert!(slopes.iter().all(is_near), "{step_s} s: {slopes:?}");
        }
    }
}
