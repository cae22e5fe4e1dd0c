//! A robot that hangs on the servos: a model's chain of links, whose driven joints are the servos' shafts.
//!
//! The servos regulate (goal, compliance, wheel mode, torque limit) and say the duty; motor, gear, friction and links are the
//! model's. A model that says nothing of its motors, because its joints are driven by torques, gets the paper's limit.

use super::output::Output;
use super::servo::Servo;
use crate::error::{Error, Result};
use crate::model::{Drive, Model, Motor};
use crate::sim::Live;
use handstand_shared::control_table::GOAL_POSITION;
use handstand_shared::raw::Position;
use std::collections::VecDeque;
use std::sync::mpsc::Sender;

/// Torque of a joint at full duty, N m, where the model says none: the paper's limit.
const FULL_NM: f64 = 2.0;
/// Times between two states told.
const TELL_EVERY_S: f64 = 0.01;

/// The robot at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Since it was set up, s.
    pub time_s: f64,
    /// Of each joint, rad, in the model's convention.
    pub angle_rad: Vec<f64>,
    /// Of each joint, rad/s.
    pub speed_rad_s: Vec<f64>,
    /// What drives each joint; none where nothing does.
    pub drive: Vec<Option<DriveState>>,
    /// Supply of the servos, V.
    pub supply_v: f64,
}

/// What drives a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveState {
    /// Goal in the joint's angle, rad, as the registers have it.
    pub goal_rad: f64,
    /// Duty at the motor, -1 to 1.
    pub duty: f64,
    /// Whether torque is on.
    pub torque_on: bool,
}

/// A joint and the servos in it.
#[derive(Debug)]
struct Driven {
    joint: usize,
    /// Those after the first face the other way.
    ids: Vec<u8>,
    delay_s: f64,
    /// What the servos were set to, and when: the motors obey late.
    history: VecDeque<(f64, Vec<Output>)>,
    duty: f64,
}

/// A chain of links on servos.
#[derive(Debug)]
pub struct Robot {
    live: Live,
    driven: Vec<Driven>,
    joints: usize,
    time_s: f64,
    told_s: f64,
    hear: Option<Sender<State>>,
}

impl Robot {
    /// At rest at these angles, rad in the model's convention. `servos` are the ids of each driven joint, from the base
    /// outwards; a second servo in a joint faces the other way.
    ///
    /// # Errors
    /// Another number of angles or driven joints, or a joint without a servo.
    pub fn new(model: &Model, servos: &[Vec<u8>], angle_rad: &[f64]) -> Result<Robot> {
        let joints = (0..model.joints.len()).filter(|at| model.joints[*at].drive.is_driven());
        let joints: Vec<usize> = joints.collect();
        if joints.len() != servos.len() || servos.iter().any(Vec::is_empty) {
            return Err(Error::usage(
                format!(
                    "`{}` has {} driven joints, and servos are given for {}",
                    model.name,
                    joints.len(),
                    servos.iter().filter(|ids| !ids.is_empty()).count()
                ),
                "say which servos move each, from the base outwards: joints=1+2/11+12",
            ));
        }
        let live = Live::new(&with_motors(model), angle_rad)?;
        let driven = joints.into_iter().zip(servos).map(|(joint, ids)| Driven {
            joint,
            ids: ids.clone(),
            delay_s: live.delay_s(joint),
            history: VecDeque::new(),
            duty: 0.0,
        });
        Ok(Robot {
            driven: driven.collect(),
            joints: model.joints.len(),
            live,
            time_s: 0.0,
            told_s: f64::NEG_INFINITY,
            hear: None,
        })
    }

    /// Tells `hear` the state a hundred times a second.
    pub fn watch(&mut self, hear: Sender<State>) {
        self.hear = Some(hear);
    }

    /// Ids of the servos it hangs on.
    pub fn ids(&self) -> impl Iterator<Item = u8> + '_ {
        self.driven.iter().flat_map(|driven| driven.ids.clone())
    }

    /// Turning rate of the first link, rad/s, as a gyro on it has it.
    pub fn rate_rad_s(&self) -> f64 {
        self.live.speed_rad_s(0)
    }

    /// Goes on by `dt_s` under what the servos do, and turns their shafts.
    pub fn step(&mut self, servos: &mut [Servo], dt_s: f64) {
        self.time_s += dt_s;
        for driven in &mut self.driven {
            driven.push(&mut self.live, servos, self.time_s);
        }
        self.live.advance(dt_s);
        for driven in &self.driven {
            driven.place(&self.live, servos);
        }
        if self.time_s - self.told_s >= TELL_EVERY_S - 1e-9
            && let Some(hear) = &self.hear
        {
            self.told_s = self.time_s;
            // Who has stopped listening does not want to know.
            let _ = hear.send(self.state(servos));
        }
    }

    fn state(&self, servos: &[Servo]) -> State {
        let mut drive = vec![None; self.joints];
        for driven in &self.driven {
            drive[driven.joint] = driven.state(servos);
        }
        let first = self.driven.first().and_then(|driven| driven.first(servos));
        State {
            time_s: self.time_s,
            angle_rad: (0..self.joints).map(|at| self.live.angle_rad(at)).collect(),
            speed_rad_s: (0..self.joints)
                .map(|at| self.live.speed_rad_s(at))
                .collect(),
            drive,
            supply_v: first.map_or(0.0, |servo| servo.supply_v),
        }
    }
}

impl Driven {
    fn first<'a>(&self, servos: &'a [Servo]) -> Option<&'a Servo> {
        let id = *self.ids.first()?;
        servos.iter().find(|servo| servo.id() == id)
    }

    /// Tells the motor what the servos said a delay ago: the mean of their duties.
    fn push(&mut self, live: &mut Live, servos: &[Servo], now_s: f64) {
        let all = servos.iter().filter(|servo| self.ids.contains(&servo.id()));
        let outputs: Vec<(f64, &Servo)> = all
            .map(|servo| (sign(&self.ids, servo.id()), servo))
            .collect();
        let set = outputs.iter().map(|(_, servo)| servo.output()).collect();
        self.history.push_back((now_s, set));
        while self.history.len() > 1 && self.history[1].0 <= now_s - self.delay_s + 1e-9 {
            self.history.pop_front();
        }
        let Some((_, set)) = self.history.front() else {
            return;
        };
        let energised = set.iter().any(Output::is_on);
        let duties = set.iter().zip(&outputs);
        let sum: f64 = duties
            .map(|(output, (sign, servo))| sign * output.duty_in_motion(&servo.shaft))
            .sum();
        self.duty = sum / set.len().max(1) as f64;
        let supply_v = outputs.first().map_or(0.0, |(_, servo)| servo.supply_v);
        live.tell(self.joint, energised.then_some(self.duty), supply_v);
    }

    /// Turns the servos' shafts to where the joint is.
    fn place(&self, live: &Live, servos: &mut [Servo]) {
        let (angle_rad, speed_rad_s) = live.shaft(self.joint);
        for servo in servos.iter_mut() {
            if self.ids.contains(&servo.id()) {
                let sign = sign(&self.ids, servo.id());
                servo.shaft.angle_rad = sign * angle_rad;
                servo.shaft.speed_rad_s = sign * speed_rad_s;
                servo.load = sign * self.duty;
            }
        }
    }

    fn state(&self, servos: &[Servo]) -> Option<DriveState> {
        let servo = self.first(servos)?;
        Some(DriveState {
            goal_rad: Position(servo.get(GOAL_POSITION)).to_rad(),
            duty: self.duty,
            torque_on: servo.torque_is_on(),
        })
    }
}

/// 1 for the first servo of a joint, -1 for those that face it.
fn sign(ids: &[u8], id: u8) -> f64 {
    if ids.first() == Some(&id) { 1.0 } else { -1.0 }
}

fn with_motors(model: &Model) -> Model {
    let mut model = model.clone();
    for joint in &mut model.joints {
        if joint.drive == Drive::Torque {
            joint.drive = Drive::Duty(Motor {
                stall_torque_nm: FULL_NM,
                no_load_speed_rad_s: f64::INFINITY,
                nominal_supply_v: None,
            });
        }
    }
    model
}
