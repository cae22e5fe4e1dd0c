//! A robot on simulated servos: a plant whose driven joints are the servos' shafts.
//!
//! The servos regulate (goal, compliance, wheel mode, torque limit) and set the duty cycle; motor,
//! gear, friction and links are the plant's.

use super::plant::Plant;
use super::regulator::Regulator;
use super::servo::Servo;
use super::spec::GyroSpec;
use handstand_shared::control_table::GOAL_POSITION;
use handstand_shared::raw::Position;
use std::collections::VecDeque;
use std::sync::mpsc::Sender;

/// Period of the states sent to a listener, s.
const STATE_PERIOD_S: f64 = 0.01;

/// True state of the robot at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct RobotState {
    /// Since it was set up, s.
    pub time_s: f64,
    /// Angle of each joint, rad, in the model's convention.
    pub angle_rad: Vec<f64>,
    /// Speed of each joint, rad/s.
    pub speed_rad_s: Vec<f64>,
    /// Drive of each joint; `None` where it is passive.
    pub drive: Vec<Option<DrivenJoint>>,
    /// Supply of the servos, V.
    pub supply_v: f64,
}

/// Drive of a joint at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrivenJoint {
    /// Goal register as the joint's angle, rad.
    pub goal_rad: f64,
    /// Duty cycle at the motor, -1 to 1.
    pub duty: f64,
    /// Whether torque is on.
    pub torque_on: bool,
}

/// A driven joint and its servos.
#[derive(Debug)]
struct JointServos {
    joint: usize,
    ids: Vec<u8>,
    delay_s: f64,
    /// Regulators over the delay: the motors follow late.
    history: VecDeque<(f64, Vec<Regulator>)>,
    /// Time constant with which the motor follows the regulators, s; 0: at once.
    lag_s: f64,
    /// What the regulators demand.
    duty: f64,
    /// What the motor has.
    motor_duty: f64,
}

/// A plant on servos.
#[derive(Debug)]
pub struct Robot {
    plant: Box<dyn Plant>,
    driven: Vec<JointServos>,
    gyro: GyroSpec,
    /// Whether somebody holds it until torque is on.
    is_held: bool,
    time_s: f64,
    period_s: f64,
    sent_s: f64,
    listener: Option<Sender<RobotState>>,
}

impl Robot {
    /// `servos` are the driven joints of the plant with their servos' ids; a servo after the first
    /// faces the other way.
    pub fn new(plant: Box<dyn Plant>, servos: impl IntoIterator<Item = (usize, Vec<u8>)>) -> Self {
        let driven = servos.into_iter().map(|(joint, ids)| JointServos {
            joint,
            ids,
            delay_s: plant.delay_s(joint),
            history: VecDeque::new(),
            lag_s: 0.0,
            duty: 0.0,
            motor_duty: 0.0,
        });
        Robot {
            driven: driven.collect(),
            plant,
            gyro: GyroSpec::default(),
            is_held: false,
            time_s: 0.0,
            period_s: STATE_PERIOD_S,
            sent_s: f64::NEG_INFINITY,
            listener: None,
        }
    }

    /// Send the state to `listener` a hundred times a second.
    pub fn watch(&mut self, listener: Sender<RobotState>) {
        self.watch_every(STATE_PERIOD_S, listener);
    }

    /// Send the state to `listener` every `period_s`, at most a thousand times a second.
    pub fn watch_every(&mut self, period_s: f64, listener: Sender<RobotState>) {
        self.period_s = period_s;
        self.listener = Some(listener);
    }

    /// Put another gyro on the first link.
    pub fn set_gyro(&mut self, gyro: GyroSpec) {
        self.gyro = gyro;
    }

    /// ADC code of the gyro on the first link, 0..=1023.
    pub fn gyro_code(&self) -> u16 {
        let code = self.gyro.zero + self.rate_rad_s() / self.gyro.step_rad_s;
        code.round().clamp(0.0, 1023.0) as u16
    }

    /// Let every motor's duty follow its regulators with this time constant, s.
    pub fn set_lag(&mut self, lag_s: f64) {
        for driven in &mut self.driven {
            driven.lag_s = lag_s;
        }
    }

    /// Keep the links where they are until a servo's torque is on, as somebody does who holds it.
    pub fn hold(&mut self) {
        self.is_held = true;
    }

    /// Ids of its servos.
    pub fn ids(&self) -> impl Iterator<Item = u8> + '_ {
        self.driven.iter().flat_map(|driven| driven.ids.clone())
    }

    /// Step of its plant's integration, s.
    pub(crate) fn step_s(&self) -> f64 {
        self.plant.step_s()
    }

    /// Angular rate of the first link, rad/s, as a gyro on it measures it.
    pub fn rate_rad_s(&self) -> f64 {
        self.plant.speed_rad_s(0)
    }

    /// Advance by `dt_s` under the servos' regulators, and turn their shafts.
    pub fn step(&mut self, servos: &mut [Servo], dt_s: f64) {
        self.time_s += dt_s;
        for driven in &mut self.driven {
            driven.drive(self.plant.as_mut(), servos, self.time_s, dt_s);
        }
        let own = |servo: &Servo| {
            self.driven
                .iter()
                .any(|joint| joint.ids.contains(&servo.id()))
        };
        self.is_held &= !servos
            .iter()
            .any(|servo| own(servo) && servo.torque_is_on());
        if !self.is_held {
            self.plant.advance(dt_s);
        }
        for driven in &self.driven {
            driven.turn_shafts(self.plant.as_ref(), servos);
        }
        if self.time_s - self.sent_s >= self.period_s - 1e-9
            && let Some(listener) = &self.listener
        {
            self.sent_s = self.time_s;
            // A listener that is gone needs no state.
            let _ = listener.send(self.state(servos));
        }
    }

    fn state(&self, servos: &[Servo]) -> RobotState {
        let joints = self.plant.joint_count();
        let mut drive = vec![None; joints];
        for driven in &self.driven {
            drive[driven.joint] = driven.state(servos);
        }
        let first = self.driven.first().and_then(|driven| driven.first(servos));
        RobotState {
            time_s: self.time_s,
            angle_rad: (0..joints).map(|at| self.plant.angle_rad(at)).collect(),
            speed_rad_s: (0..joints).map(|at| self.plant.speed_rad_s(at)).collect(),
            drive,
            supply_v: first.map_or(0.0, |servo| servo.supply_v),
        }
    }
}

impl JointServos {
    fn first<'a>(&self, servos: &'a [Servo]) -> Option<&'a Servo> {
        let id = *self.ids.first()?;
        servos.iter().find(|servo| servo.id() == id)
    }

    /// 1 for the first servo of the joint, -1 for those that face it.
    fn sign(&self, id: u8) -> f64 {
        if self.ids.first() == Some(&id) {
            1.0
        } else {
            -1.0
        }
    }

    /// Drive the joint with the mean duty cycle of its servos, one delay and the lag late.
    fn drive(&mut self, plant: &mut dyn Plant, servos: &[Servo], now_s: f64, dt_s: f64) {
        let own = servos.iter().filter(|servo| self.ids.contains(&servo.id()));
        let own: Vec<&Servo> = own.collect();
        let regulators = own.iter().map(|servo| servo.regulator()).collect();
        self.history.push_back((now_s, regulators));
        while self.history.len() > 1 && self.history[1].0 <= now_s - self.delay_s + 1e-9 {
            self.history.pop_front();
        }
        let Some((_, regulators)) = self.history.front() else {
            return;
        };
        let energised = regulators.iter().any(Regulator::is_on);
        let duties = regulators.iter().zip(&own).map(|(regulator, servo)| {
            self.sign(servo.id()) * regulator.duty_in_motion(&servo.shaft)
        });
        self.duty = duties.sum::<f64>() / regulators.len().max(1) as f64;
        let supply_v = own.first().map_or(0.0, |servo| servo.supply_v);
        let share = if self.lag_s > 0.0 {
            1.0 - (-dt_s / self.lag_s).exp()
        } else {
            1.0
        };
        self.motor_duty += share * (self.duty - self.motor_duty);
        if !energised {
            self.motor_duty = 0.0;
        }
        plant.set_duty(self.joint, energised.then_some(self.motor_duty), supply_v);
    }

    fn turn_shafts(&self, plant: &dyn Plant, servos: &mut [Servo]) {
        let (angle_rad, speed_rad_s) = plant.shaft(self.joint);
        for servo in servos.iter_mut() {
            if self.ids.contains(&servo.id()) {
                let sign = self.sign(servo.id());
                servo.shaft.angle_rad = sign * angle_rad;
                servo.shaft.speed_rad_s = sign * speed_rad_s;
                servo.load = sign * self.duty;
            }
        }
    }

    fn state(&self, servos: &[Servo]) -> Option<DrivenJoint> {
        let servo = self.first(servos)?;
        Some(DrivenJoint {
            goal_rad: Position(servo.get(GOAL_POSITION)).to_rad(),
            duty: self.duty,
            torque_on: servo.torque_is_on(),
        })
    }
}
