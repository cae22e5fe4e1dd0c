//! A simulated bus in words: `ids=1-18,delay=0,dead=3`.

use super::sim_robot::SimRobot;
use crate::bus_sim::{Bus, Faults};
use crate::error::Result as Done;
use handstand_shared::control_table::{BAUD, RETURN_DELAY, Register, STATUS_LEVEL};
use std::str::FromStr;

/// Which servos there are, how they are set, and what goes wrong. Without words: 1 to 18, factory settings, all well.
#[derive(Debug, Clone, PartialEq)]
pub struct SimWords {
    /// Their ids.
    pub ids: Vec<u8>,
    /// What hangs on them.
    pub robot: Option<SimRobot>,
    registers: Vec<(Register, u16)>,
    drop: f64,
    flip: f64,
    late: f64,
    wrong_id: f64,
    echo: bool,
    dead: Vec<u8>,
    hot: Vec<u8>,
    overload: Vec<u8>,
    jam: Vec<u8>,
    mishear: f64,
    supply_v: f64,
    seed: u64,
}

impl Default for SimWords {
    fn default() -> Self {
        SimWords {
            ids: (1..=18).collect(),
            robot: None,
            registers: vec![(RETURN_DELAY, RETURN_DELAY.default)],
            drop: 0.0,
            flip: 0.0,
            late: 0.0,
            wrong_id: 0.0,
            echo: false,
            dead: Vec::new(),
            hot: Vec::new(),
            overload: Vec::new(),
            jam: Vec::new(),
            mishear: 0.0,
            supply_v: 11.1,
            seed: 1,
        }
    }
}

const KEYS: &str = "ids, delay, level, baud, drop, flip, late, wrong_id, mishear, echo, dead, hot, overload, jam, supply, robot, joints, start, seed";

impl SimWords {
    /// The bus they describe, with the robot on it.
    ///
    /// # Errors
    /// The robot's model cannot be read, does not fit, or hangs on servos that are not there.
    pub fn set_up(&self) -> Done<Bus> {
        let mut bus = self.bus();
        if let Some(robot) = &self.robot {
            bus.hang(robot.set_up(&self.ids)?);
        }
        Ok(bus)
    }

    /// The bus they describe, the servos free.
    pub fn bus(&self) -> Bus {
        let mut bus = Bus::new(self.ids.iter().copied());
        for (place, servo) in (0..).zip(&mut bus.servos) {
            let id = servo.id();
            for (register, code) in &self.registers {
                servo.set(*register, *code);
            }
            let mut faults = Faults::none(self.seed << 8 | place);
            faults.dead = self.dead.contains(&id);
            faults.drop = self.drop;
            faults.flip = self.flip;
            faults.late = self.late;
            faults.wrong_id = self.wrong_id;
            faults.mishear = self.mishear;
            faults.echo = self.echo;
            servo.faults = faults;
            servo.supply_v = self.supply_v;
            servo.jammed = self.jam.contains(&id);
            if self.overload.contains(&id) {
                servo.overload();
            }
            if self.hot.contains(&id) {
                servo.temperature = 85.0;
            }
        }
        bus
    }
}

impl FromStr for SimWords {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut words = SimWords::default();
        for part in text.split(',').filter(|part| !part.is_empty()) {
            let (key, value) = part.split_once('=').unwrap_or((part, ""));
            match key {
                "ids" => words.ids = ids(value)?,
                "delay" => words.registers.push((RETURN_DELAY, code(key, value, 254)?)),
                "level" => words.registers.push((STATUS_LEVEL, code(key, value, 2)?)),
                "baud" => words.registers.push((BAUD, code(key, value, 254)?)),
                "drop" => words.drop = number(key, value, 1.0)?,
                "flip" => words.flip = number(key, value, 1.0)?,
                "late" => words.late = number(key, value, 1.0)?,
                "wrong_id" => words.wrong_id = number(key, value, 1.0)?,
                "mishear" => words.mishear = number(key, value, 1.0)?,
                "echo" => words.echo = true,
                "dead" => words.dead = ids(value)?,
                "hot" => words.hot = ids(value)?,
                "overload" => words.overload = ids(value)?,
                "jam" => words.jam = ids(value)?,
                "robot" => words.robot().model = value.into(),
                "joints" => words.robot().joints = Some(SimRobot::joints(value)?),
                "start" => words.robot().start = value.parse()?,
                "supply" => words.supply_v = number(key, value, 20.0)?,
                "seed" => {
                    words.seed = value
                        .parse()
                        .map_err(|_| format!("seed={value}: give a whole number"))?
                }
                _ => {
                    return Err(format!(
                        "`{key}` is no key of a simulated bus; there are: {KEYS}"
                    ));
                }
            }
        }
        match &words.robot {
            Some(robot) if robot.model.as_os_str().is_empty() => {
                Err("joints and start are a robot's: name its model, robot=MODEL.toml".to_string())
            }
            _ => Ok(words),
        }
    }
}

impl SimWords {
    fn robot(&mut self) -> &mut SimRobot {
        self.robot.get_or_insert_default()
    }
}

/// Ids as in `1-4+9` or `1-4,9`.
///
/// # Errors
/// What is no id, and how to write them.
pub fn ids(text: &str) -> Result<Vec<u8>, String> {
    let wrong = || format!("`{text}` names no ids: write 1-18 or 1-4+9, each 0 to 253");
    let mut ids = Vec::new();
    for part in text.split(['+', ',']) {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        let first: u8 = first.trim().parse().map_err(|_| wrong())?;
        let last: u8 = last.trim().parse().map_err(|_| wrong())?;
        if first > last || last > 253 {
            return Err(wrong());
        }
        ids.extend(first..=last);
    }
    Ok(ids)
}

fn code(key: &str, value: &str, most: u16) -> Result<u16, String> {
    let wrong = || format!("{key}={value}: give a code from 0 to {most}");
    value
        .parse()
        .ok()
        .filter(|code| *code <= most)
        .ok_or_else(wrong)
}

fn number(key: &str, value: &str, most: f64) -> Result<f64, String> {
    let wrong = || format!("{key}={value}: give a number from 0 to {most}");
    value
        .parse()
        .ok()
        .filter(|number| (0.0..=most).contains(number))
        .ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_and_wrong_ones_named() {
        let words: SimWords = "ids=1-3+7,delay=0,dead=2,echo,drop=0.5".parse().unwrap();
        assert_eq!(words.ids, [1, 2, 3, 7]);
        assert!(words.echo && words.dead == [2] && words.drop == 0.5);
        let bus = words.bus();
        assert_eq!(bus.servos[3].get(RETURN_DELAY), 0);
        assert!(bus.servos[1].faults.dead && !bus.servos[0].faults.dead);
        assert_eq!("".parse(), Ok(SimWords::default()));
        for (wrong, said) in [
            ("idz=1", "`idz`"),
            ("ids=5-2", "1-18"),
            ("ids=254", "253"),
            ("drop=2", "0 to 1"),
            ("delay=255", "254"),
            ("joints=1+2", "robot=MODEL.toml"),
            ("robot=a.toml,start=lying", "hanging or upright"),
        ] {
            let error = wrong.parse::<SimWords>().unwrap_err();
            assert!(error.contains(said), "{wrong}: {error}");
        }
    }
}
