//! Servos of Protocol 1.0 read one by one, through an adapter.

use super::one_sample::{OddCodes, OneCodes};
use super::reach::{GoalRange, one_held, one_may_reach};
use super::sample::{RobotSample, ServoSample};
use super::source::{EmergencyOff, SampleSource, send_twice};
use crate::error::{Error, Result};
use crate::{
    OneServo, Protocol, SerialLink, ServoError, ServoResult, Servos, StatusError, emergency_packet,
    outlasting_answers,
};
use handstand_shared::control_table::one::TORQUE_MODE;
use handstand_shared::control_table::{
    GOAL_POSITION, Item, MOVING_SPEED, PRESENT_POSITION, Register, TORQUE_ENABLE, TORQUE_LIMIT,
};
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::raw::TorqueLimit;
use std::time::Duration;

/// Servos of Protocol 1.0 behind an adapter, read one by one.
pub struct Adapter<L: SerialLink> {
    servos: Servos<L>,
    ids: Vec<u8>,
    /// What each is; none until it has answered.
    known: Vec<Option<OneServo>>,
    period: Duration,
    begun: Duration,
    next: Duration,
    /// The codes of the goals that they have.
    goals: Vec<Option<i32>>,
    armed: bool,
    /// Whether it has ever been armed: before, the servos' torque is not known.
    commanded: bool,
    danger: Option<String>,
    odd: OddCodes,
}

impl<L: SerialLink> Adapter<L> {
    /// These servos, every `period` or as often as the line allows.
    ///
    /// # Errors
    /// A servo of a model that is not known, or of Protocol 2.0; the port failed. One that is
    /// silent is asked again in each round.
    pub fn new(mut servos: Servos<L>, ids: &[u8], period: Duration) -> Result<Self> {
        let known = ids.iter().map(|id| known(&mut servos, *id));
        let known = known.collect::<Result<Vec<_>>>()?;
        // A second try must not cost the round more than one servo's time.
        servos.tries = 2;
        let begun = servos.link().now();
        Ok(Adapter {
            servos,
            ids: ids.to_vec(),
            known,
            period,
            begun,
            next: begun,
            goals: vec![None; ids.len()],
            armed: false,
            commanded: false,
            danger: None,
            odd: OddCodes::default(),
        })
    }

    /// The servos.
    pub fn servos(&mut self) -> &mut Servos<L> {
        &mut self.servos
    }

    fn read(&mut self, place: usize) -> Result<ServoSample> {
        let id = self.ids[place];
        if self.known[place].is_none() {
            self.servos.tries = 1;
            self.known[place] = known(&mut self.servos, id)?;
            self.servos.tries = 2;
        }
        let Some(servo) = self.known[place] else {
            return Ok(ServoSample::default());
        };
        let goal_rad = self.goals[place].map(|code| servo.angle_of(code));
        let joint = match self.servos.read(id, u16::from(PRESENT_POSITION.address), 8) {
            Ok(reading) => {
                self.danger = self.danger.take().or_else(|| danger(id, reading.error));
                let codes = OneCodes::of_reading(&reading);
                codes.map_or(ServoSample::default(), |codes| {
                    codes.sample(&servo, &mut self.odd)
                })
            }
            Err(error) => {
                error.port()?;
                ServoSample::default()
            }
        };
        Ok(ServoSample { goal_rad, ..joint })
    }

    /// All of them.
    ///
    /// # Errors
    /// One that has not answered.
    fn all_known(&self) -> Result<Vec<OneServo>> {
        let places = self.ids.iter().zip(&self.known);
        let all = places.map(|(id, known)| known.ok_or(ServoError::NoResponse { id: *id }));
        Ok(all.collect::<ServoResult<_>>()?)
    }

    fn send_goals(&mut self, goals_rad: &[f64]) -> Result<()> {
        let servos = self.all_known()?;
        let codes = servos.iter().zip(goals_rad);
        let codes: Vec<i32> = codes.map(|(servo, goal)| servo.code_of(*goal)).collect();
        self.send_codes(&codes)
    }

    fn send_codes(&mut self, codes: &[i32]) -> Result<()> {
        self.goals = codes.iter().map(|code| Some(*code)).collect();
        let codes: Vec<(u8, i32)> = self
            .ids
            .iter()
            .copied()
            .zip(codes.iter().copied())
            .collect();
        let item = Item::of_register(&GOAL_POSITION);
        Ok(self.servos.sync_write_codes(&item, &codes)?)
    }

    fn write_each(&mut self, register: Register, code: u16) -> Result<()> {
        let codes: Vec<(u8, u16)> = self.ids.iter().map(|id| (*id, code)).collect();
        Ok(self.servos.sync_write(register, &codes)?)
    }
}

impl<L: SerialLink> SampleSource for Adapter<L> {
    fn sample(&mut self, goals_rad: Option<&[f64]>) -> Result<Option<RobotSample>> {
        let wait = self.next.saturating_sub(self.servos.link().now());
        self.servos.link().pause(wait);
        let now = self.servos.link().now();
        // Late rounds are not made up for.
        self.next = (self.next + self.period).max(now);
        if let Some(goals) = goals_rad.filter(|_| self.armed) {
            self.send_goals(goals)?;
        }
        let joints = (0..self.ids.len())
            .map(|place| self.read(place))
            .collect::<Result<_>>()?;
        Ok(Some(RobotSample {
            time_s: (now - self.begun).as_secs_f64(),
            joints,
            gyro: None,
            torque_on: self.commanded.then_some(self.armed),
            has_current: false,
        }))
    }

    fn may_reach(&mut self, goals: &[GoalRange]) -> Result<()> {
        let servos = self.all_known()?;
        let mut pairs = servos.iter().zip(goals);
        pairs.try_for_each(|(servo, goals)| one_may_reach(servo, *goals))
    }

    fn remarks(&self) -> Vec<String> {
        self.odd.remarks()
    }

    fn arm(&mut self) -> Result<()> {
        let mut here = Vec::new();
        for servo in self.all_known()? {
            let id = servo.id;
            if servo.model.has_torque_mode && self.servos.code(id, &TORQUE_MODE)? != 0 {
                return Err(Error::device(
                    format!("servo {id} is in torque control mode, which takes no positions"),
                    format!("handstand bus write {id} torque-control-mode-enable 0"),
                ));
            }
            let item = self.servos.item(id, PRESENT_POSITION)?;
            let code = self.servos.code(id, &item)?;
            here.push(one_held(&servo, code)?);
        }
        (self.armed, self.commanded) = (true, true);
        self.write_each(TORQUE_LIMIT, TorqueLimit::FULL.0)?;
        self.write_each(MOVING_SPEED, 0)?;
        self.send_codes(&here)?;
        self.write_each(TORQUE_ENABLE, 1)
    }

    fn disarm(&mut self) -> Result<()> {
        self.servos.torque_off()?;
        self.armed = false;
        Ok(())
    }

    fn emergency_off(&mut self) -> Option<EmergencyOff> {
        let link = self.servos.link();
        let idle = outlasting_answers(link.baud());
        let off = emergency_packet(Protocol::One);
        Some(send_twice(link.second_writer()?, idle, off))
    }

    fn danger(&self) -> Option<String> {
        self.danger.clone().filter(|_| self.armed)
    }
}

impl<L: SerialLink> Drop for Adapter<L> {
    fn drop(&mut self) {
        if self.armed {
            // Nobody is left who could be told that it failed.
            let _ = self.servos.torque_off();
        }
    }
}

/// What a servo is; none if it does not answer.
///
/// # Errors
/// Its model is not known, or the port failed.
fn known<L: SerialLink>(servos: &mut Servos<L>, id: u8) -> Result<Option<OneServo>> {
    match servos.one_servo(id) {
        Ok(servo) => Ok(Some(servo)),
        Err(error) if error.is_transient() => Ok(None),
        Err(error) => Err(error.into()),
    }
}

fn danger(id: u8, error: StatusError) -> Option<String> {
    let StatusError::Flags(error) = error else {
        return None;
    };
    let grave = [ErrorBits::OVERLOAD, ErrorBits::OVERHEAT, ErrorBits::VOLTAGE];
    let is_grave = grave.into_iter().any(|bits| error.has(bits));
    is_grave.then(|| {
        format!(
            "servo {id} reports: {}",
            error.names().collect::<Vec<_>>().join(", ")
        )
    })
}
