//! Gains that were designed elsewhere, as a controller among the others.

use super::{ControllerDesign, ControllerInfo, DesignModel, Speeds};
use crate::error::{Error, Result};
use crate::model::{Drive, Model};
use crate::sim::closed_loop::{Controller, StateFeedback};
use crate::synth::{StateFeedbackPlan, upright};

/// Largest departure of a plan's pose from upright, rad, and of its inputs from 0.
const AT_REST: f64 = 1e-6;

static INFO: ControllerInfo = ControllerInfo {
    id: "plan",
    title: "given gains",
    law: "u = -K [x, past u], K as given",
    speeds: Speeds::True,
    known_equilibrium: false,
    reference: "--plan",
};

/// Gains of a plan, whatever robot they meet.
#[derive(Debug)]
pub struct GivenGains {
    /// N m per state, a row per drive: angles, speeds, past torques.
    k: Vec<Vec<f64>>,
    joints: usize,
}

impl GivenGains {
    /// Those of a plan for `model` that is run every `period_s`. Studies command torques: gains of
    /// duties are turned into them.
    ///
    /// # Errors
    /// Drives that take no torque and no duty; a pose other than upright; another sampling time; a
    /// robot in space.
    pub fn new(plan: &StateFeedbackPlan, model: &Model, period_s: f64) -> Result<GivenGains> {
        model.planar_only("studies are of planar chains (`gains` takes both)")?;
        let joints = model.link_count();
        let upright = upright(model);
        let off = plan.pose_rad.iter().zip(&upright).map(|(a, b)| a - b);
        if off
            .chain(plan.u0.iter().copied())
            .any(|off| off.abs() > AT_REST)
        {
            return Err(Error::design(
                "the plan does not hold the robot upright without torque",
                "studies hold robots upright: design without --pose, or ask `handstand gains` for \
                 the verdict",
            ));
        }
        if plan.ts_s.is_none_or(|ts_s| (ts_s - period_s).abs() > 1e-9) {
            let sampled = plan.ts_s.map(|ts_s| format!("every {ts_s} s"));
            let sampled = sampled.unwrap_or_else(|| "continuous time".into());
            return Err(Error::design(
                format!("the plan is for {sampled}, not for every {period_s} s"),
                "give the sampling time of the plan, or design for this one",
            ));
        }
        let full_nm = |joint: usize| match &model.joints[joint].drive {
            Drive::Torque => Ok(1.0),
            Drive::Duty(motor) => Ok(motor.stall_torque_nm),
            _ => Err(Error::design(
                format!(
                    "joint {} is commanded neither in torque nor in duty",
                    joint + 1
                ),
                "studies command torques; ask `handstand gains` for the verdict on this plan",
            )),
        };
        let full_nm: Vec<f64> = model
            .driven_joints()
            .into_iter()
            .map(full_nm)
            .collect::<Result<_>>()?;
        let row = |(row, full): (&Vec<f64>, &f64)| {
            let (own, past) = row.split_at(2 * joints);
            let own = own.iter().map(|k| full * k);
            // Past duties are past torques over what they make.
            let past = past.iter().zip(full_nm.iter().cycle());
            let past = past.map(|(k, past_full)| full * k / past_full);
            own.chain(past).collect()
        };
        Ok(GivenGains {
            k: plan.k.iter().zip(&full_nm).map(row).collect(),
            joints,
        })
    }
}

impl GivenGains {
    /// N m per state, a row per drive: angles, speeds, past torques.
    pub fn k(&self) -> &[Vec<f64>] {
        &self.k
    }
}

impl ControllerDesign for GivenGains {
    fn info(&self) -> &ControllerInfo {
        &INFO
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let (joints, drives) = (known.joints(), known.drives());
        if (joints, drives) != (self.joints, self.k.len()) {
            return Err(Error::design(
                format!("the plan is not for {joints} joints, {drives} of them driven"),
                "give the plan that was made for this robot",
            ));
        }
        Ok(Box::new(StateFeedback::new(joints, self.k.clone())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::closed_loop::Measurement;
    use std::path::Path;

    /// Duties of drives of 2 and 4 N m: the torques of the same law.
    #[test]
    fn duties_become_torques() {
        let text = include_str!("../../../../models/handstand.toml");
        let mut model = Model::parse(text, Path::new("handstand.toml")).unwrap();
        for (joint, stall_torque_nm) in [(1, 2.0), (2, 4.0)] {
            model.joints[joint].drive = Drive::Duty(crate::model::Motor {
                stall_torque_nm,
                no_load_speed_rad_s: f64::INFINITY,
                nominal_supply_v: None,
            });
        }
        let plan = StateFeedbackPlan {
            k: vec![
                vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.25],
                vec![0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            ],
            pose_rad: upright(&model),
            u0: vec![0.0; 2],
            ts_s: Some(0.01),
            delay_s: 0.01,
        };
        let given = GivenGains::new(&plan, &model, 0.01).unwrap();
        let known = DesignModel::new(&model, &upright(&model), 0.01).unwrap();
        let law = given.build(&known).unwrap();
        // A duty of 0.5 at the first drive and of 0.25 at the second went before.
        let mut memory = vec![1.0, 1.0];
        let measured = Measurement {
            angle_rad: &[0.1, 0.2, 0.0],
            speed_rad_s: &[0.0; 3],
        };
        let mut torque = [0.0; 2];
        law.control(&mut memory, measured, &mut torque);
        let duty = [-0.1 - 0.5 * 0.5 - 0.25 * 0.25, -0.2];
        assert!((torque[0] - 2.0 * duty[0]).abs() < 1e-12, "{torque:?}");
        assert!((torque[1] - 4.0 * duty[1]).abs() < 1e-12, "{torque:?}");
        let late = GivenGains::new(&plan, &model, 0.02).unwrap_err();
        assert!(late.to_string().contains("0.01 s"), "{late}");
    }
}
