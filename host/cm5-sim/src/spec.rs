//! A simulated bus as text:
//! `ids=1-18,delay=0,dead=3,robot=MODEL.toml,joints=1+2/11+12,start=hanging`.

use super::bus::Bus;
use super::fault::Faults;
use super::plant::Start;
use super::spec_error::SpecError;
use super::x_spec::XSpec;
use handstand_shared::control_table::{BAUD, RETURN_DELAY, Register, STATUS_LEVEL};
use handstand_shared::dynamixel::ids;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// How fast a servo named by `warms` does: from 30 to the limit of 70 degrees within two seconds.
const WARMS_PER_S: f64 = 25.0;

/// Which servos there are, how they are set, and their faults. The default is servos 1 to 18 with
/// factory settings.
#[derive(Debug, Clone, PartialEq)]
pub struct BusSpec {
    /// Ids of the servos.
    pub ids: Vec<u8>,
    /// The robot on them.
    pub robot: Option<RobotSpec>,
    registers: Vec<(Register, u16)>,
    x: Option<XSpec>,
    drop: f64,
    flip: f64,
    late: f64,
    wrong_id: f64,
    echo: bool,
    dead: Vec<u8>,
    hot: Vec<u8>,
    warms: Vec<u8>,
    overload: Vec<u8>,
    jam: Vec<u8>,
    corrupt_request: f64,
    write_us: f64,
    supply_v: Option<f64>,
    seed: u64,
}

/// A robot on simulated servos.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RobotSpec {
    /// Its model file.
    pub model: PathBuf,
    /// Servos of each driven joint, from the base outwards; without it those of the Bioloid's
    /// shoulders and hips, or servo 1 where only one joint is driven.
    pub joints: Option<Vec<Vec<u8>>>,
    /// Initial pose.
    pub start: Start,
    /// Departure of each joint from it, from the base outwards, rad; the rest is 0.
    pub lean_rad: Vec<f64>,
    /// Time constant with which its motors follow their servos' regulators, s; 0: at once.
    pub lag_s: f64,
    /// The gyro on its first link.
    pub gyro: GyroSpec,
}

/// A gyro at the CM-5's ADC.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroSpec {
    /// ADC code at rest; not always a whole one.
    pub zero: f64,
    /// Rate per code, rad/s.
    pub step_rad_s: f64,
}

impl Default for GyroSpec {
    /// A code per degree and second, 512 at rest.
    fn default() -> Self {
        GyroSpec {
            zero: 512.0,
            step_rad_s: 1f64.to_radians(),
        }
    }
}

impl Default for BusSpec {
    fn default() -> Self {
        BusSpec {
            ids: (1..=18).collect(),
            robot: None,
            registers: vec![(RETURN_DELAY, RETURN_DELAY.default)],
            x: None,
            drop: 0.0,
            flip: 0.0,
            late: 0.0,
            wrong_id: 0.0,
            echo: false,
            dead: Vec::new(),
            hot: Vec::new(),
            warms: Vec::new(),
            overload: Vec::new(),
            jam: Vec::new(),
            corrupt_request: 0.0,
            write_us: 0.0,
            supply_v: None,
            seed: 1,
        }
    }
}

impl BusSpec {
    /// The bus it describes, without the robot.
    pub fn bus(&self) -> Bus {
        if let Some(x) = &self.x {
            return self.x_bus(x);
        }
        let mut bus = Bus::new(self.ids.iter().copied());
        for (place, servo) in (0..).zip(&mut bus.servos) {
            let id = servo.id();
            for (register, code) in &self.registers {
                servo.set(*register, *code);
            }
            servo.faults = self.faults(id, place);
            servo.supply_v = self.supply_v.unwrap_or(11.1);
            servo.jammed = self.jam.contains(&id);
            if self.overload.contains(&id) {
                servo.overload();
            }
            if self.hot.contains(&id) {
                servo.temperature = 85.0;
            }
            if self.warms.contains(&id) {
                servo.warms_per_s = WARMS_PER_S;
            }
        }
        bus
    }

    fn faults(&self, id: u8, place: u64) -> Faults {
        let mut faults = Faults::none(self.seed << 8 | place);
        faults.dead = self.dead.contains(&id);
        faults.drop = self.drop;
        faults.flip = self.flip;
        faults.late = self.late;
        faults.wrong_id = self.wrong_id;
        faults.corrupt_request = self.corrupt_request;
        faults.write_ns = (self.write_us * 1e3) as u64;
        faults.echo = self.echo;
        faults
    }

    /// The same servos with Protocol 2.0.
    fn x_bus(&self, x: &XSpec) -> Bus {
        let mut bus = Bus::new([]);
        for (place, id) in (0..).zip(&self.ids) {
            let mut servo = x.servo(*id, &self.registers);
            servo.faults = self.faults(*id, place);
            servo.jammed = self.jam.contains(id);
            servo.supply_v = self.supply_v.unwrap_or(servo.supply_v);
            if self.hot.contains(id) {
                servo.temperature = 85.0;
            }
            if self.overload.contains(id) {
                servo.overload();
            }
            bus.x.servos.push(servo);
        }
        bus
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), SpecError> {
        let wrong = |expected: &str| SpecError::value(key, value, expected);
        let number = |most: f64| {
            let number = value.parse().ok();
            let number = number.filter(|number| (0.0..=most).contains(number));
            number.ok_or_else(|| wrong(&format!("a number from 0 to {most}")))
        };
        let code = |most: u16| {
            let code = value.parse().ok().filter(|code| *code <= most);
            code.ok_or_else(|| wrong(&format!("a code from 0 to {most}")))
        };
        match key {
            "ids" => self.ids = id_list(value)?,
            "delay" => self.registers.push((RETURN_DELAY, code(254)?)),
            "level" => self.registers.push((STATUS_LEVEL, code(2)?)),
            "baud" => self.registers.push((BAUD, code(254)?)),
            "drop" => self.drop = number(1.0)?,
            "flip" => self.flip = number(1.0)?,
            "late" => self.late = number(1.0)?,
            "wrong_id" => self.wrong_id = number(1.0)?,
            "corrupt_request" => self.corrupt_request = number(1.0)?,
            "write_us" => self.write_us = number(10_000.0)?,
            "echo" => self.echo = true,
            "dead" => self.dead = id_list(value)?,
            "hot" => self.hot = id_list(value)?,
            "warms" => self.warms = id_list(value)?,
            "overload" => self.overload = id_list(value)?,
            "jam" => self.jam = id_list(value)?,
            "supply" => self.supply_v = Some(number(20.0)?),
            "model" => self.x = Some(XSpec::of(value)?),
            "firmware" | "mode" | "turns" | "turnaround" => match &mut self.x {
                Some(x) => x.set(key, value)?,
                None => return Err(SpecError::NoServoModel),
            },
            "seed" => self.seed = value.parse().map_err(|_| wrong("a whole number"))?,
            "robot" => self.robot.get_or_insert_default().model = value.into(),
            "joints" => {
                let joints = value.split('/').map(id_list).collect::<Result<_, _>>()?;
                self.robot.get_or_insert_default().joints = Some(joints);
            }
            "start" => {
                self.robot.get_or_insert_default().start = match value {
                    "hanging" => Start::Hanging,
                    "upright" => Start::Upright,
                    "held" => Start::Held,
                    _ => return Err(wrong("hanging, upright or held")),
                }
            }
            "lag" => self.robot.get_or_insert_default().lag_s = number(1.0)?,
            "gyro" => {
                let parts = value.split_once('/');
                let parts = parts.and_then(|(zero, step)| {
                    Some((zero.parse::<f64>().ok()?, step.parse::<f64>().ok()?))
                });
                let parts = parts.filter(|(zero, step)| {
                    (0.0..=1023.0).contains(zero) && (0.01..=100.0).contains(step)
                });
                let (zero, step) =
                    parts.ok_or_else(|| wrong("code at rest and deg/s per code, 512/1"))?;
                let step_rad_s = step.to_radians();
                self.robot.get_or_insert_default().gyro = GyroSpec { zero, step_rad_s };
            }
            "lean" => {
                let degrees = value.split('/').map(|part| part.parse::<f64>().ok());
                let degrees = degrees.map(|part| part.filter(|part| part.abs() <= 180.0));
                let degrees: Option<Vec<f64>> = degrees.collect();
                let degrees = degrees.ok_or_else(|| wrong("degrees of each joint, 1/-1/0.5"))?;
                self.robot.get_or_insert_default().lean_rad =
                    degrees.into_iter().map(f64::to_radians).collect();
            }
            _ => return Err(SpecError::UnknownKey(key.into())),
        }
        Ok(())
    }
}

impl FromStr for BusSpec {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Self, SpecError> {
        BusSpec::with_robot(text, None)
    }
}

impl BusSpec {
    /// What `text` describes, with this model as its robot, whose `joints` and `start` the text may
    /// then name.
    ///
    /// # Errors
    /// The text describes no bus.
    pub fn with_robot(text: &str, model: Option<&Path>) -> Result<Self, SpecError> {
        let mut spec = BusSpec::default();
        for part in text.split(',').filter(|part| !part.is_empty()) {
            let (key, value) = part.split_once('=').unwrap_or((part, ""));
            spec.set(key, value)?;
        }
        if let Some(model) = model {
            spec.robot.get_or_insert_default().model = model.into();
        }
        if spec.x.is_some() && !spec.warms.is_empty() {
            let expected = "servos of Protocol 1.0: leave model out";
            return Err(SpecError::value("warms", "", expected));
        }
        match &spec.robot {
            Some(_) if spec.x.is_some() => Err(SpecError::RobotOnX),
            Some(robot) if robot.model.as_os_str().is_empty() => Err(SpecError::NoModel),
            _ => Ok(spec),
        }
    }
}

fn id_list(text: &str) -> Result<Vec<u8>, SpecError> {
    let ids: Option<_> = ids(text).collect();
    ids.ok_or_else(|| SpecError::Ids(text.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_read_and_errors_are_named() {
        let spec: BusSpec = "ids=1-3+7,delay=0,dead=2,echo,drop=0.5".parse().unwrap();
        assert_eq!(spec.ids, [1, 2, 3, 7]);
        assert!(spec.echo && spec.dead == [2] && spec.drop == 0.5);
        let bus = spec.bus();
        assert_eq!(bus.servos[3].get(RETURN_DELAY), 0);
        assert!(bus.servos[1].faults.dead && !bus.servos[0].faults.dead);
        let beside = BusSpec::with_robot("joints=3/4,start=upright", Some(Path::new("a.toml")));
        let expected = RobotSpec {
            model: "a.toml".into(),
            joints: Some(vec![vec![3], vec![4]]),
            start: Start::Upright,
            ..RobotSpec::default()
        };
        assert_eq!(beside.unwrap().robot, Some(expected));
        assert_eq!("".parse(), Ok(BusSpec::default()));
        for (wrong, said) in [
            ("idz=1", "`idz`"),
            ("ids=5-2", "1-18"),
            ("ids=254", "253"),
            ("drop=2", "0 to 1"),
            ("delay=255", "254"),
            ("joints=1+2", "robot=MODEL.toml"),
            ("robot=a.toml,start=lying", "hanging, upright or held"),
            ("robot=a.toml,lean=1/x", "degrees of each joint"),
            ("robot=a.toml,gyro=512", "deg/s per code"),
        ] {
            let error = wrong.parse::<BusSpec>().unwrap_err().to_string();
            assert!(error.contains(said), "{wrong}: {error}");
        }
    }
}
