//! What the motion itself says: zero, sense of the angles, lengths and masses of the links.

use super::Guess;
use super::log_guess::{JointGuess, LogGuess};
use super::values::{gravity_of_torques, median, rests, rod_length_m, zero_at_rest};
use crate::RawLog;
use crate::model::import::ServoFigures;
use crate::model::new_model::LinkPlan;
use crate::output::shortened;

/// Acceleration of gravity where nothing else is said, m/s^2.
const GRAVITY_M_S2: f64 = 9.81;
/// A link of which nothing is known.
const LENGTH_M: f64 = 0.25;
const MASS_KG: f64 = 0.3;

/// The joints' motion in SI.
pub(super) struct Evidence {
    time_s: Vec<f64>,
    /// Per joint; empty where it is not measured.
    angle_rad: Vec<Vec<f64>>,
    /// Zero and amplitude of gravity's torque on the first joint, where torques tell.
    gravity: Option<(&'static str, f64)>,
    driven: bool,
}

impl Evidence {
    /// What the columns of a log say.
    pub fn of(log: &RawLog, columns: &LogGuess, time_s: &[f64]) -> Self {
        let joints = columns.joints.iter();
        let angles = joints.map(|j| j.position.as_ref().map(|c| c.si(log)).unwrap_or_default());
        let angle_rad: Vec<Vec<f64>> = angles.collect();
        let first = &columns.joints[0];
        let torque = first.input.as_ref().filter(|_| first.drive == "torque");
        Evidence {
            gravity: torque
                .filter(|_| angle_rad.iter().all(|angle| !angle.is_empty()))
                .and_then(|torque| gravity_of_torques(time_s, &angle_rad, &torque.si(log))),
            driven: columns.joints.iter().any(|joint| joint.drive != "passive"),
            time_s: time_s.to_vec(),
            angle_rad,
        }
    }

    /// What an angle of 0 means, and why.
    pub fn zero(&self) -> (&'static str, String) {
        let angle = &self.angle_rad[0];
        if angle.is_empty() {
            return ("hanging", "a guess: no angle is measured".to_string());
        }
        if let Some((zero, _)) = self.gravity {
            return (zero, "how torques follow the angles".to_string());
        }
        if self.driven {
            let why = "a guess: driven angles do not tell; `handstand log check` tries the others";
            return ("hanging", why.to_string());
        }
        if !rests(angle) {
            let why = "a guess: the first joint turns round, so where it rests does not show";
            return ("hanging", why.to_string());
        }
        let rest = median(angle);
        match zero_at_rest(rest) {
            Some(zero) => (
                zero,
                format!("the first joint moves freely around {rest:.2} rad"),
            ),
            None => (
                "hanging",
                format!("a free joint rests hanging; the first one does at {rest:.2} rad"),
            ),
        }
    }

    /// Gives free joints that hang at another angle than 0 the offset of their zero.
    pub fn offsets(&self, zero: &str, columns: &mut LogGuess, guesses: &mut Vec<Guess>) {
        if zero != "hanging" || self.driven || self.gravity.is_some() {
            return;
        }
        for (joint, angle) in columns.joints.iter_mut().zip(&self.angle_rad) {
            let rest = median(angle);
            let own = rests(angle) && zero_at_rest(rest) != Some("hanging");
            let Some(column) = joint.position.as_mut().filter(|_| own) else {
                continue;
            };
            // To a mrad: a median says no more.
            column.offset_rad = -(1e3 * rest).round() / 1e3;
            guesses.push(Guess::new(
                "angle offset",
                format!(
                    "{} rad, added to {:?}",
                    column.offset_rad,
                    shortened(&column.name)
                ),
                "the joint moves freely around there, so that is where it hangs",
            ));
        }
    }

    /// Whether angles are relative, and why.
    pub fn angles(&self, zero: &str) -> (&'static str, String) {
        let rests: Vec<f64> = self.angle_rad.iter().map(|angle| median(angle)).collect();
        let alike = rests.iter().all(|rest| (rest - rests[0]).abs() < 0.5);
        match zero {
            "hanging" => (
                "relative",
                "a guess: hanging links look the same both ways".to_string(),
            ),
            _ if alike => (
                "absolute",
                format!("all angles lie around {:.2} rad", rests[0]),
            ),
            _ => (
                "relative",
                "the outer angles do not lie where the first does".to_string(),
            ),
        }
    }

    /// A link per joint.
    pub fn links(&self, columns: &LogGuess, guesses: &mut Vec<Guess>) -> Vec<LinkPlan> {
        let one_free = columns.joints.len() == 1 && !self.driven;
        let swing = rod_length_m(&self.time_s, &self.angle_rad[0], GRAVITY_M_S2);
        let length = swing.filter(|_| one_free);
        let one = columns.joints.len() == 1;
        let pulled = self.gravity.filter(|_| one).map(|(_, torque_nm)| {
            let mass_kg = torque_nm / (GRAVITY_M_S2 * LENGTH_M / 2.0);
            (1e3 * mass_kg).round() / 1e3
        });
        let pulled = pulled.filter(|mass_kg| (0.01..100.0).contains(mass_kg));
        let mass_kg = pulled.unwrap_or(MASS_KG);
        match length {
            Some(length) => guesses.push(Guess::new(
                "link",
                format!("an even rod of {length:.3} m"),
                "how often it swings; its mass is a guess",
            )),
            None if pulled.is_some() => guesses.push(Guess::new(
                "link",
                format!("an even rod of {LENGTH_M} m and {mass_kg} kg"),
                "gravity's torque; its length is a guess",
            )),
            None if columns.joints.len() == 1 => guesses.push(Guess::new(
                "link",
                format!("an even rod of {LENGTH_M} m and {MASS_KG} kg"),
                "a guess: measure it, or let `handstand fit` estimate it",
            )),
            None => guesses.push(Guess::new(
                "links",
                format!("even rods of {LENGTH_M} m and {MASS_KG} kg, in a plane"),
                "a guess: measure them, or let `handstand fit` estimate them; --robot takes those \
                 of a robot's URDF or MJCF file",
            )),
        }
        if columns
            .joints
            .iter()
            .any(|joint| ["duty", "position", "speed"].contains(&joint.drive))
        {
            let servo = ServoFigures::guessed("position");
            guesses.push(Guess::new(
                "motor",
                format!(
                    "{} N m at standstill, {} rad/s without load",
                    servo.stall_torque_nm, servo.no_load_speed_rad_s
                ),
                "a guess: its data sheet says",
            ));
        }
        let length_m = length.map_or(LENGTH_M, |length| (1e3 * length).round() / 1e3);
        columns
            .joints
            .iter()
            .map(|joint| link(joint, length_m, mass_kg))
            .collect()
    }
}

pub(super) fn link(joint: &JointGuess, length_m: f64, mass_kg: f64) -> LinkPlan {
    let motor = ["duty", "position", "speed"].contains(&joint.drive);
    let servo = ServoFigures::guessed(joint.drive);
    LinkPlan {
        slide: None,
        length_m,
        com_m: length_m / 2.0,
        mass_kg,
        inertia_kg_m2: None,
        drive: joint.drive.to_string(),
        gain: (motor && joint.drive != "duty").then_some(servo.gain),
        stall_torque_nm: motor.then_some(servo.stall_torque_nm),
        no_load_speed_rad_s: motor.then_some(servo.no_load_speed_rad_s),
    }
}
