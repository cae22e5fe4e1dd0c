//! Before torque comes on: the plan onto the CM-5, the servos into wheel mode, all of them heard.

use super::balancer::{Balancer, telemetry};
use super::status::BalanceStatus;
use super::wheel_mode::WheelChange;
use crate::deploy;
use crate::error::{Error, Result};
use crate::link::record::ReportReader;
use crate::link::{SerialLink, Servos};
use handstand_shared::message::{Command, Mode, ServoList};
use handstand_shared::packed::SERVOS;
use handstand_shared::plan::Plan;
use std::time::Duration;

/// Reports before which not every servo's supply and mode are known, or a gyro's zero, the mean
/// over some 0.32 s, has not settled: 2 s.
const SETTLED: usize = 200;
/// For so long the CM-5 repeats that torque is off after a mode was chosen.
const INSISTS: Duration = Duration::from_millis(250);

impl<L: SerialLink> Balancer<L> {
    /// The plan that the CM-5 has.
    ///
    /// # Errors
    /// It has none, or one of another version.
    pub fn stored_plan(&mut self) -> Result<Plan> {
        let bytes = deploy::read_back(&mut self.session)?;
        Plan::from_bytes(&bytes)
            .filter(|_| self.session.hello.plan != 0)
            .ok_or_else(|| {
                Error::device(
                    "the CM-5 has no plan to balance with",
                    "name a model, handstand balance MODEL.toml, or deploy one: handstand deploy",
                )
            })
    }

    /// Makes the CM-5 have this plan; whether it had to be uploaded. `progress` gets the bytes
    /// sent.
    ///
    /// # Errors
    /// The CM-5 does not answer, refuses, or keeps another one.
    pub fn deploy(&mut self, plan: &Plan, progress: impl FnMut(u64)) -> Result<bool> {
        if self.session.hello.plan == plan.fingerprint() {
            return Ok(false);
        }
        let mut bytes = Vec::new();
        plan.bytes(|byte| bytes.push(byte));
        deploy::upload(&mut self.session, &bytes, progress)?;
        deploy::verify(&mut self.session, &bytes, plan.fingerprint())?;
        Ok(true)
    }

    /// What must be changed in the servos.
    ///
    /// # Errors
    /// One that the plan drives is not in the list of servos, or does not answer.
    pub fn wheel_changes(&mut self, plan: &Plan) -> Result<Vec<WheelChange>> {
        let driven = driven(plan);
        if let Some(id) = driven.iter().find(|id| !self.ids.contains(id)) {
            return Err(Error::usage(
                format!("the plan drives servo {id}, which is not among --ids"),
                "name all servos that hold the robot",
            ));
        }
        let ids = self.ids.clone();
        let mut servos = self.adapter()?;
        Ok(WheelChange::needed(&mut servos, &ids, &driven)?)
    }

    /// Makes these changes, and reads them back.
    ///
    /// # Errors
    /// A servo does not answer or keeps another code.
    pub fn set_up(&mut self, changes: &[WheelChange]) -> Result<()> {
        let mut servos = self.adapter()?;
        for change in changes {
            change.make(&mut servos)?;
        }
        Ok(())
    }

    fn adapter(&mut self) -> Result<Servos<&mut L>> {
        self.session
            .obey(&Command::Mode(Mode::Bridge), "pass bytes on")?;
        let link = self.session.link();
        link.pause(INSISTS);
        link.clear()?;
        Ok(Servos::new(link))
    }

    /// Names the servos, and hears them until all have told their supply and mode, and a gyro at
    /// rest its zero.
    ///
    /// # Errors
    /// The CM-5 refuses or falls silent.
    pub fn make_ready(&mut self, plan: &Plan) -> Result<()> {
        self.status = BalanceStatus::new(plan, &self.ids);
        let mut list = ServoList {
            count: self.ids.len() as u8,
            ids: [0; SERVOS],
        };
        list.ids[..self.ids.len()].copy_from_slice(&self.ids);
        self.session.greet()?;
        self.session
            .obey(&Command::ServoList(list), "take the list of servos")?;
        self.session
            .obey(&Command::Mode(Mode::Balance), "prepare to balance")?;
        let account = telemetry(&mut self.session)?;
        let begun = self.session.link().now();
        self.reader = ReportReader::new(&self.ids, begun, &account);
        for _ in 0..SETTLED {
            self.step()?;
        }
        Ok(())
    }
}

/// Servos that the plan drives.
fn driven(plan: &Plan) -> Vec<u8> {
    let both = plan
        .joints
        .iter()
        .flat_map(|joint| [joint.id, joint.mirror]);
    both.filter(|id| *id < 254).collect()
}
