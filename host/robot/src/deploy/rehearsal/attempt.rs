//! An attempt to balance a simulated robot with a plan, through the firmware's own logic.

use super::Setting;
use crate::deploy::balance::{AttitudeSource, BalanceEnd, BalanceOutcome, Balancer};
use crate::error::{Error, Result};
use crate::link::virtual_cm5::{
    Cm5Port, SimLink, attitude_sensor_of, set_up_model, spec_with_robot,
};
use crate::model::Model;
use crate::study::{Manner, can_stick};
use handstand_shared::message::ArmLimits;
use handstand_shared::plan::Plan;
use serde::Serialize;
use std::path::Path;

/// How long the robot shall stand, s.
pub const STANDS_S: f64 = 10.0;
/// The last of an attempt that shows in which manner it stands, s.
const LAST_S: f64 = 5.0;
/// At the beginning it comes back from where it was let go, s: no sway of its own.
const SETTLES_S: f64 = 2.0;

/// How an attempt went.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BalanceAttempt {
    /// Fingerprint of the plan that balanced it.
    pub fingerprint: String,
    /// How long it stood, s; at most 10 s.
    pub stood_s: f64,
    /// Whether that is all of it.
    pub stands: bool,
    /// Root mean square of the first link's angle from upright, rad, once 2 s have passed; none if
    /// it did not stand so long.
    pub sway_rms_rad: Option<f64>,
    /// In which manner it stood at the end; none if it did not.
    pub manner: Option<Manner>,
    /// Its end in words.
    pub end: String,
    /// Every report.
    #[serde(skip)]
    pub samples: Vec<AttemptSample>,
}

/// One report of an attempt.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttemptSample {
    /// Since torque came on, s.
    pub time_s: f64,
    /// The first link's angle from upright, rad.
    pub lean_rad: f64,
    /// Angles of shoulder and hip as their servos tell them, rad.
    pub joint_rad: [f64; 2],
}

impl BalanceAttempt {
    /// Sets the servos up, deploys the plan, arms, and balances until the time is over or the CM-5
    /// lets the robot down.
    ///
    /// # Errors
    /// The firmware does not answer or refuses.
    pub fn run(model: &Model, plan: &Plan, setting: &Setting) -> Result<BalanceAttempt> {
        let (text, ids) = setting.bus(plan);
        let spec = spec_with_robot(&text, Some(Path::new("rehearsal.toml")))?;
        let mut bus = set_up_model(&spec, model.clone())?;
        let attitude = attitude_sensor_of(&mut bus, model).ok_or_else(|| {
            Error::design("there is no robot on the bus", "this is a bug: report it")
        })?;
        let source = AttitudeSource::of_plan(Some(plan), Some(AttitudeSource::Simulated(attitude)));
        let mut balancer = Balancer::new(SimLink(Cm5Port::new(bus)), &ids, source)?;
        balancer.deploy(plan, |_| {})?;
        let changes = balancer.wheel_changes(plan)?;
        balancer.set_up(&changes)?;
        balancer.make_ready(plan)?;
        balancer.arm(ArmLimits::FULL)?;
        let mut samples = Vec::new();
        loop {
            balancer.step()?;
            if let Some(outcome) = balancer.end()? {
                return Ok(BalanceAttempt::new((model, plan), samples, &outcome));
            }
            let status = &balancer.status;
            samples.push(AttemptSample {
                time_s: status.balanced_s,
                lean_rad: status.lean_rad.unwrap_or(f64::NAN),
                joint_rad: status.joint_rad.map(|angle| angle.unwrap_or(f64::NAN)),
            });
            if status.balanced_s >= STANDS_S {
                let outcome = balancer.let_down(BalanceEnd::Finished)?;
                return Ok(BalanceAttempt::new((model, plan), samples, &outcome));
            }
        }
    }

    fn new(
        (model, plan): (&Model, &Plan),
        samples: Vec<AttemptSample>,
        outcome: &BalanceOutcome,
    ) -> BalanceAttempt {
        let angles = |sample: &AttemptSample| {
            let [shoulder, hip] = sample.joint_rad;
            (sample.time_s, vec![sample.lean_rad, shoulder, hip])
        };
        let angles: Vec<(f64, Vec<f64>)> = samples.iter().map(angles).collect();
        let late = samples.iter().filter(|sample| sample.time_s > SETTLES_S);
        let squares: Vec<f64> = late.map(|sample| sample.lean_rad.powi(2)).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        BalanceAttempt {
            fingerprint: format!("{:08X}", plan.fingerprint()),
            stood_s: outcome.balanced_s.min(STANDS_S),
            stands: outcome.end == BalanceEnd::Finished,
            sway_rms_rad: (!squares.is_empty()).then_some(mean.sqrt()),
            manner: (outcome.end == BalanceEnd::Finished)
                .then(|| Manner::of(&angles, LAST_S, can_stick(model))),
            end: outcome.words(),
            samples,
        }
    }
}
