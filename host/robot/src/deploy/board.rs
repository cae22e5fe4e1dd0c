//! The board's side of a plan: servos, limits, gyro and moments.

use super::observer::WORD;
use crate::dynamics::EquationsOfMotion;
use crate::error::{Error, Result};
use crate::model::Model;
use handstand_shared::message::Attitude;
use handstand_shared::observer::{INPUTS, JOINTS};
use handstand_shared::plan::{Gyro, Joint, Law, Moment, Plan};
use handstand_shared::raw::Position;

/// Servos of a driven joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ServoPair {
    /// The servo that measures and drives.
    pub id: u8,
    /// The servo that drives along, mirrored; 255 if there is none.
    pub mirror: u8,
    /// Whether the joint's angle falls when the servo turns counter-clockwise.
    pub reversed: bool,
    /// Position code at the joint's zero.
    pub centre: u16,
}

/// Servos, limits and sensors of a robot with a CM-5, beside its model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Board {
    /// Period of the law, s.
    pub period_s: f64,
    /// Shoulder and hip.
    pub servos: [ServoPair; INPUTS],
    /// Torque of each joint at full output, N m.
    pub full_nm: [f64; INPUTS],
    /// Largest torque commanded to each joint, N m.
    pub most_nm: [f64; INPUTS],
    /// Share of full output that each joint's servos lose of every command: jumped over.
    pub dead_zone: [f64; INPUTS],
    /// Torque of each joint below which a command does nothing, though it acts whole beyond, N m.
    pub least_nm: [f64; INPUTS],
    /// Largest change of a torque in a period, N m.
    pub slew_nm: f64,
    /// Where the first link's attitude comes from.
    pub gyro: Gyro,
    /// Deviation of the first link from upright at which the robot has fallen, rad.
    pub range_rad: f64,
    /// Deviation of a driven joint from its zero at which torque goes off, rad.
    pub joint_range_rad: f64,
    /// Speed of a driven joint at which torque goes off, rad/s.
    pub joint_speed_rad_s: f64,
}

impl Board {
    /// The Bioloid humanoid: shoulders 1 and 2, hips 11 and 12, 2 N m, 8 % dead zone, attitude from
    /// the host.
    pub const BIOLOID: Board = Board {
        period_s: 0.01,
        servos: [
            ServoPair {
                id: 1,
                mirror: 2,
                reversed: false,
                centre: Position::CENTRE.0,
            },
            ServoPair {
                id: 11,
                mirror: 12,
                reversed: false,
                centre: Position::CENTRE.0,
            },
        ],
        full_nm: [2.0; INPUTS],
        most_nm: [2.0; INPUTS],
        dead_zone: [0.08; INPUTS],
        least_nm: [0.0; INPUTS],
        slew_nm: 1.0,
        gyro: Gyro {
            from_host: true,
            zero: 512,
            scale: 0,
        },
        range_rad: 0.8,
        joint_range_rad: 1.2,
        joint_speed_rad_s: 6.0,
    };
}

impl Board {
    /// The plan of this law.
    ///
    /// # Errors
    /// Limits that do not fit the words.
    pub(super) fn plan(
        &self,
        law: Law,
        moments: [Moment; JOINTS],
        input_step_nm: [f64; INPUTS],
    ) -> Result<Plan> {
        let [shoulder, hip] = input_step_nm;
        let plan = Plan {
            law,
            joints: [self.joint(0, shoulder)?, self.joint(1, hip)?],
            gyro: self.gyro,
            moments,
            range: (self.range_rad / Attitude::ANGLE_LSB_RAD).round() as u16,
        };
        // What the firmware would refuse must not leave here.
        let mut bytes = Vec::new();
        plan.bytes(|byte| bytes.push(byte));
        match Plan::from_bytes(&bytes) {
            Some(back) if back == plan => Ok(plan),
            _ => Err(Error::design(
                "the firmware would refuse this plan",
                "check the servos' ids, centres, dead zone, range and speed; the slew limit must \
                 exceed the dead zone",
            )),
        }
    }

    fn joint(&self, place: usize, input_step_nm: f64) -> Result<Joint> {
        let servo = self.servos[place];
        let steps = |torque_nm: f64| (torque_nm / input_step_nm).round().min(WORD) as i16;
        // Behind the dead zone the rest of the range makes the whole torque.
        let dead = (self.dead_zone[place] * 1023.0).round() as u16;
        let (full_nm, span) = (self.full_nm[place], 1023 - dead);
        let range = (self.joint_range_rad / Position::LSB_RAD).floor() as i16;
        let fastest = self.joint_speed_rad_s * self.period_s / Position::LSB_RAD;
        let gain = (input_step_nm / full_nm * f64::from(span) * 65_536.0).round();
        if !(1.0..=65_535.0).contains(&gain) {
            return Err(Error::design(
                format!(
                    "a torque step of {input_step_nm} N m and a full torque of {full_nm} N m make \
                     {gain} / 65536 codes a step"
                ),
                "that has to be 1 to 65535: give another step or another full torque",
            ));
        }
        Ok(Joint {
            id: servo.id,
            mirror: servo.mirror,
            reversed: servo.reversed,
            centre: servo.centre,
            dead,
            gain: gain as u16,
            least: steps(self.least_nm[place]),
            most: steps(self.most_nm[place]),
            slew: steps(self.slew_nm),
            lowest: -range,
            highest: range,
            fastest: fastest.round() as u16,
        })
    }
}

/// Each link's moment with all that hangs on its end, in 1/16384 of the largest.
pub(super) fn moments(model: &Model) -> [Moment; JOINTS] {
    let rig = model.rig(false);
    let equations = EquationsOfMotion::new(&rig.chain, rig.gravity_turn_rad);
    let moments = equations.moments_kg_m();
    let most = moments
        .iter()
        .flatten()
        .fold(0.0, |most: f64, part| most.max(part.abs()));
    let scaled = |part: f64| (part / most * 16_384.0).round() as i16;
    let mut links = [Moment::ZERO; JOINTS];
    for (link, [along, aside]) in links.iter_mut().zip(moments) {
        (link.along, link.aside) = (scaled(along), scaled(aside));
    }
    links
}
