//! Servos of Protocol 2.0 read together, through an adapter.

use super::group_sample::{HEALTH, STATE, angle_of, code_of, health, state};
use super::reach::{GoalLimits, GoalRange, SLACK_RAD};
use super::sample::{RobotSample, ServoSample};
use super::servo_watch::{ServoWatch, may_begin, may_move, takes_positions};
use super::source::{EmergencyOff, SampleSource, send_twice};
use crate::error::{Error, Result};
use crate::{
    GroupItem, Protocol, Reading, SerialLink, ServoResult, Servos, emergency_packet,
    group_read_bytes, outlasting_answers,
};
use handstand_shared::control_table::models::ServoModel;
use handstand_shared::control_table::x::*;
use handstand_shared::control_table::{Item, POSITION_LSB_RAD, RETURN_DELAY as DELAY};
use std::time::Duration;

/// Servos of Protocol 2.0 behind an adapter: one (fast) sync read a round for all, and supply and
/// temperature of one servo after the other.
pub struct GroupAdapter<L: SerialLink> {
    servos: Servos<L>,
    ids: Vec<u8>,
    models: Vec<&'static ServoModel>,
    fast: bool,
    period: Duration,
    begun: Duration,
    next: Duration,
    rounds: usize,
    /// Rounds in a row in which each servo was silent.
    silent: Vec<u32>,
    goals_rad: Vec<Option<f64>>,
    /// Where the servos stood when torque went on, until the first goals were sent.
    stood_rad: Option<Vec<f64>>,
    watch: ServoWatch,
    armed: bool,
    commanded: bool,
    danger: Option<String>,
}

impl<L: SerialLink> GroupAdapter<L> {
    /// These servos, every `period` or as often as the line allows. While torque is on the servos'
    /// bus watchdog stops them when the line is silent, unless `watchdog` is false.
    ///
    /// # Errors
    /// A servo does not answer, or is of a model that is not known; a period too long for the bus
    /// watchdog.
    pub fn new(
        mut servos: Servos<L>,
        ids: &[u8],
        period: Duration,
        watchdog: bool,
    ) -> Result<Self> {
        servos.protocol = Some(Protocol::Two);
        let (mut models, mut fast, mut firmware) = (Vec::new(), true, Vec::new());
        for id in ids {
            let identity = servos.identify(*id)?;
            let model = servos.model(*id)?;
            // How long it may wait before it answers.
            servos.get(*id, DELAY)?;
            fast &= model.has_fast_read(identity.firmware);
            firmware.push(identity.firmware);
            models.push(model);
        }
        // A second try must not cost the round more than one servo's time.
        servos.tries = 2;
        let begun = servos.link().now();
        Ok(GroupAdapter {
            watch: ServoWatch::new(watchdog, period, &models, &firmware, ids)?,
            servos,
            ids: ids.to_vec(),
            models,
            fast,
            period,
            begun,
            next: begun,
            rounds: 0,
            silent: vec![0; ids.len()],
            goals_rad: vec![None; ids.len()],
            stood_rad: None,
            armed: false,
            commanded: false,
            danger: None,
        })
    }

    /// Time of a round's bytes on the line, without goals and stuffing, us: what no servo and no
    /// adapter goes below.
    pub fn limit_us(&mut self) -> f64 {
        let state = group_read_bytes(&self.items(STATE), self.fast);
        let bytes = state + Protocol::Two.read_bytes(HEALTH.1);
        self.servos.link().line_time(bytes).as_secs_f64() * 1e6
    }

    /// The servos.
    pub fn servos(&mut self) -> &mut Servos<L> {
        &mut self.servos
    }

    /// An item of each servo. Those that have been silent come last: they may silence the others.
    fn items(&self, (address, count): (u16, u16)) -> Vec<GroupItem> {
        let mut places: Vec<usize> = (0..self.ids.len()).collect();
        places.sort_by_key(|place| self.silent[*place] > 2);
        let item = |place: usize| GroupItem {
            id: self.ids[place],
            address,
            count,
        };
        places.into_iter().map(item).collect()
    }

    /// What each servo says, in the order of ids.
    fn read_all(&mut self, what: (u16, u16)) -> Result<Vec<ServoResult<Reading>>> {
        let items = self.items(what);
        let answers = self.servos.read_group(&items)?;
        let ids = items.into_iter().map(|item| item.id);
        let mut all: Vec<_> = ids.zip(answers).collect();
        all.sort_by_key(|(id, _)| self.ids.iter().position(|own| own == id));
        Ok(all.into_iter().map(|(_, answer)| answer).collect())
    }

    /// A register of every servo; an error if one does not answer.
    fn read_each(&mut self, item: Item) -> Result<Vec<i32>> {
        let tries = std::mem::replace(&mut self.servos.tries, 5);
        let answers = self.read_all((item.address, u16::from(item.size)));
        self.servos.tries = tries;
        let codes = answers?.into_iter().map(|answer| {
            let reading = answer?;
            Ok(item.code(&reading.data).unwrap_or_default())
        });
        codes.collect()
    }

    /// Within which codes each servo takes goals: in position mode between its limits, else as far
    /// as the register goes.
    fn goal_limits(&mut self) -> Result<Vec<GoalLimits>> {
        let modes = self.read_each(OPERATING_MODE)?;
        let least = self.read_each(MIN_POSITION)?;
        let most = self.read_each(MAX_POSITION)?;
        let mut limits = Vec::new();
        for (place, id) in self.ids.iter().enumerate() {
            takes_positions(*id, modes[place])?;
            let is_bound = modes[place] == 3;
            limits.push(GoalLimits {
                id: *id,
                codes: if is_bound {
                    (least[place], most[place])
                } else {
                    (GOAL_POSITION.min, GOAL_POSITION.max)
                },
                registers: is_bound.then_some((MIN_POSITION.name, MAX_POSITION.name)),
            });
        }
        Ok(limits)
    }

    fn write_each(&mut self, item: Item, code: i32) -> Result<()> {
        let codes: Vec<(u8, i32)> = self.ids.iter().map(|id| (*id, code)).collect();
        Ok(self.servos.sync_write_codes(&item, &codes)?)
    }

    fn send_goals(&mut self, goals_rad: &[f64]) -> Result<()> {
        if let Some(stood_rad) = self.stood_rad.take() {
            may_begin(&self.ids, &stood_rad, goals_rad)?;
        }
        let codes = self.ids.iter().zip(goals_rad);
        let codes: Vec<(u8, i32)> = codes.map(|(id, goal)| (*id, code_of(*goal))).collect();
        let sent = codes.iter().map(|(_, code)| Some(angle_of(*code)));
        self.goals_rad = sent.collect();
        Ok(self.servos.sync_write_codes(&GOAL_POSITION, &codes)?)
    }

    fn sample_state(&mut self) -> Result<Vec<ServoSample>> {
        let mut joints = Vec::new();
        for (place, answer) in self.read_all(STATE)?.into_iter().enumerate() {
            let reading = answer.ok();
            let sample = reading
                .as_ref()
                .and_then(|it| state(self.models[place], it));
            self.silent[place] = match sample {
                Some(_) => 0,
                None => self.silent[place].saturating_add(1),
            };
            if reading.is_some_and(|reading| reading.error.has_alert()) {
                self.take_alert(self.ids[place])?;
            }
            joints.push(ServoSample {
                goal_rad: self.goals_rad[place],
                ..sample.unwrap_or_default()
            });
        }
        Ok(joints)
    }

    /// The alert says only that there is a hardware error.
    fn take_alert(&mut self, id: u8) -> Result<()> {
        if self.armed && self.danger.is_none() {
            let names = match self.servos.hardware_errors(id) {
                Ok(names) => names.join(", "),
                Err(error) => error.port()?.to_string(),
            };
            self.danger = Some(format!(
                "servo {id} reports: {names}; when the cause is gone: handstand bus reboot {id}"
            ));
        }
        Ok(())
    }

    /// Supply and temperature of the servo whose turn it is; its bus watchdog instead every other
    /// time while torque is on.
    fn sample_health(&mut self, joints: &mut [ServoSample]) -> Result<()> {
        let count = self.ids.len();
        let (turn, id) = (self.rounds % count, self.ids[self.rounds % count]);
        let watches = self.armed && self.watch.is_on() && self.rounds / count % 2 == 1;
        self.rounds += 1;
        if self.silent[turn] > 0 {
            return Ok(());
        }
        let (address, size) = if watches {
            (BUS_WATCHDOG.address, 1)
        } else {
            HEALTH
        };
        self.servos.tries = 1;
        let answer = self.servos.read(id, address, size);
        self.servos.tries = 2;
        match answer {
            Ok(reading) if watches => {
                if BUS_WATCHDOG.code(&reading.data) == Some(-1) {
                    self.danger.get_or_insert(self.watch.tripped(id));
                }
            }
            Ok(reading) => {
                let said = health(&reading);
                joints[turn].supply_v = said.map(|(supply_v, _)| supply_v);
                joints[turn].temperature_celsius = said.map(|(_, celsius)| celsius);
            }
            Err(error) => drop(error.port()?),
        }
        Ok(())
    }
}

impl<L: SerialLink> SampleSource for GroupAdapter<L> {
    fn sample(&mut self, goals_rad: Option<&[f64]>) -> Result<Option<RobotSample>> {
        let wait = self.next.saturating_sub(self.servos.link().now());
        self.servos.link().pause(wait);
        let now = self.servos.link().now();
        // Late rounds are not made up for.
        self.next = (self.next + self.period).max(now);
        if let Some(goals) = goals_rad.filter(|_| self.armed) {
            self.send_goals(goals)?;
        }
        let mut joints = self.sample_state()?;
        self.sample_health(&mut joints)?;
        Ok(Some(RobotSample {
            time_s: (now - self.begun).as_secs_f64(),
            joints,
            gyro: None,
            torque_on: self.commanded.then_some(self.armed),
            has_current: self
                .models
                .iter()
                .any(|model| model.current_lsb_a.is_some()),
        }))
    }

    fn may_reach(&mut self, goals: &[GoalRange]) -> Result<()> {
        let limits = self.goal_limits()?;
        let mut pairs = limits.iter().zip(goals);
        pairs.try_for_each(|(limits, goals)| limits.hold(*goals, code_of, angle_of))
    }

    fn arm(&mut self) -> Result<()> {
        let limits = self.goal_limits()?;
        let mut positions = self.read_each(PRESENT_POSITION)?;
        let offsets = self.read_each(HOMING_OFFSET)?;
        let errors = self.read_each(HARDWARE_ERROR)?;
        for (place, id) in self.ids.iter().enumerate() {
            let is_counted = limits[place].registers.is_none();
            let turn = is_counted.then_some(offsets[place]..offsets[place] + 4096);
            may_move(*id, positions[place], turn, errors[place])?;
            let slack = (SLACK_RAD / POSITION_LSB_RAD).round() as i32;
            positions[place] = limits[place].held(positions[place], slack)?;
        }
        // What an earlier trip left would refuse the goals.
        self.write_each(BUS_WATCHDOG, 0)?;
        self.write_each(PROFILE_ACCELERATION, 0)?;
        self.write_each(PROFILE_VELOCITY, 0)?;
        let here: Vec<f64> = positions.iter().map(|code| angle_of(*code)).collect();
        (self.stood_rad, self.danger) = (None, None);
        self.send_goals(&here)?;
        (self.armed, self.commanded) = (true, true);
        self.write_each(BUS_WATCHDOG, self.watch.code())?;
        self.write_each(TORQUE_ENABLE, 1)?;
        // Nothing answered these: what was not heard would be found out too late.
        for (item, wanted) in [(TORQUE_ENABLE, 1), (BUS_WATCHDOG, self.watch.code())] {
            let codes = self.read_each(item)?;
            if let Some(place) = codes.iter().position(|code| *code != wanted) {
                let (id, name, code) = (self.ids[place], item.name, codes[place]);
                self.disarm()?;
                return Err(Error::device(
                    format!("servo {id} has `{name}` {code} where {wanted} was written"),
                    "try again; `handstand bus doctor` finds what disturbs the line",
                ));
            }
        }
        self.stood_rad = Some(here);
        Ok(())
    }

    fn disarm(&mut self) -> Result<()> {
        self.servos.torque_off()?;
        self.armed = false;
        // Torque is off: what is left is that the next program finds the goals writable.
        self.write_each(BUS_WATCHDOG, 0)
    }

    fn emergency_off(&mut self) -> Option<EmergencyOff> {
        let link = self.servos.link();
        let idle = outlasting_answers(link.baud());
        let off = emergency_packet(Protocol::Two);
        Some(send_twice(link.second_writer()?, idle, off))
    }

    fn danger(&self) -> Option<String> {
        self.danger.clone().filter(|_| self.armed)
    }
}

impl<L: SerialLink> Drop for GroupAdapter<L> {
    fn drop(&mut self) {
        if self.armed {
            // It is too late to tell that it failed.
            let _ = self.disarm();
        }
    }
}
