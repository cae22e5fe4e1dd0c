//! Servos of Protocol 1.0 read one by one, through an adapter.

use super::sample::{RobotSample, ServoSample};
use super::source::{EmergencyOff, SampleSource, send_twice};
use crate::error::Result;
use crate::link::{Protocol, SerialLink, Servos, StatusError, emergency_packet};
use handstand_shared::control_table::{
    GOAL_POSITION, MOVING_SPEED, PRESENT_POSITION, Register, TORQUE_ENABLE, TORQUE_LIMIT,
};
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::raw::{Position, TorqueLimit};
use std::time::Duration;

/// Servos of Protocol 1.0 behind an adapter, read one by one.
pub struct Adapter<L: SerialLink> {
    servos: Servos<L>,
    ids: Vec<u8>,
    period: Duration,
    begun: Duration,
    next: Duration,
    goals: Vec<Option<Position>>,
    armed: bool,
    /// Whether it has ever been armed: before, the servos' torque is not known.
    commanded: bool,
    danger: Option<String>,
}

impl<L: SerialLink> Adapter<L> {
    /// These servos, every `period` or as often as the line allows.
    pub fn new(mut servos: Servos<L>, ids: &[u8], period: Duration) -> Self {
        // A second try must not cost the round more than one servo's time.
        servos.tries = 2;
        let begun = servos.link().now();
        Adapter {
            servos,
            ids: ids.to_vec(),
            period,
            begun,
            next: begun,
            goals: vec![None; ids.len()],
            armed: false,
            commanded: false,
            danger: None,
        }
    }

    fn read(&mut self, place: usize) -> Result<ServoSample> {
        let id = self.ids[place];
        let goal_rad = self.goals[place].map(Position::to_rad);
        let joint = match self.servos.read(id, u16::from(PRESENT_POSITION.address), 8) {
            Ok(reading) => {
                self.danger = self.danger.take().or_else(|| danger(id, reading.error));
                ServoSample::of_reading(&reading).unwrap_or_default()
            }
            Err(error) => {
                error.port()?;
                ServoSample::default()
            }
        };
        Ok(ServoSample { goal_rad, ..joint })
    }

    fn send_goals(&mut self, goals_rad: &[f64]) -> Result<()> {
        let codes: Vec<(u8, u16)> = (self.ids.iter().zip(goals_rad))
            .map(|(id, goal)| (*id, Position::from_rad(*goal).0))
            .collect();
        self.goals = codes
            .iter()
            .map(|(_, code)| Some(Position(*code)))
            .collect();
        Ok(self.servos.sync_write(GOAL_POSITION, &codes)?)
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

    fn arm(&mut self) -> Result<()> {
        let mut here = Vec::new();
        for id in self.ids.clone() {
            let code = self.servos.get(id, PRESENT_POSITION)?;
            here.push(Position(code).to_rad());
        }
        (self.armed, self.commanded) = (true, true);
        self.write_each(TORQUE_LIMIT, TorqueLimit::FULL.0)?;
        self.write_each(MOVING_SPEED, 0)?;
        self.send_goals(&here)?;
        self.write_each(TORQUE_ENABLE, 1)
    }

    fn disarm(&mut self) -> Result<()> {
        self.servos.torque_off()?;
        self.armed = false;
        Ok(())
    }

    fn emergency_off(&mut self) -> Option<EmergencyOff> {
        let voice = self.servos.link().second_writer()?;
        Some(send_twice(voice, emergency_packet(Protocol::One)))
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
