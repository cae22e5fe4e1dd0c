//! How logs of public rigs name and write their columns.

use super::rig::DriveKind;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::fmt::Write as _;

/// A column: its name, and what a number in SI is multiplied by.
type Column = (String, f64);

/// Columns of a log.
#[derive(Debug, Clone)]
pub struct Names {
    time: Column,
    /// Per joint: angle, and input where there is one.
    joints: Vec<(Column, Option<Column>)>,
    separator: char,
}

const DEG: f64 = 180.0 / std::f64::consts::PI;
const TICKS: f64 = 4096.0 / std::f64::consts::TAU;

/// Names as a recorder of this kind would write them.
pub(super) fn names(chance: &mut ChaCha8Rng, drive: DriveKind, joints: usize) -> Names {
    let times = [
        ("time_s", 1.0),
        ("t", 1.0),
        ("timestamp", 1.0),
        ("Time [ms]", 1e3),
        ("__time", 1.0),
        ("time_us", 1e6),
    ];
    let angles = [
        ("angle_deg", DEG),
        ("q_rad", 1.0),
        ("position", 1.0),
        ("Position (deg)", DEG),
        ("theta", 1.0),
        ("present_position_ticks", TICKS),
    ];
    let inputs: &[(&str, f64)] = match drive {
        DriveKind::Passive => &[],
        DriveKind::Torque => &[("torque_nm", 1.0), ("tau", 1.0), ("effort", 1.0)],
        DriveKind::Duty => &[("duty", 1.0), ("pwm_percent", 100.0), ("duty_pct", 100.0)],
        DriveKind::Position => &[
            ("goal_deg", DEG),
            ("goal_position_rad", 1.0),
            ("target_angle_deg", DEG),
        ],
        DriveKind::Speed => &[("goal_speed_rad_s", 1.0), ("goal_velocity_deg_s", DEG)],
    };
    let time = times[chance.random_range(0..times.len())];
    // Servos that count are commanded by goals.
    let counts = matches!(drive, DriveKind::Position | DriveKind::Speed);
    let angles = &angles[..angles.len() - usize::from(!counts)];
    let angle = angles[chance.random_range(0..angles.len())];
    let input = (!inputs.is_empty()).then(|| inputs[chance.random_range(0..inputs.len())]);
    let numbered = |(name, factor): (&str, f64), joint: usize| match joints {
        1 => (name.to_string(), factor),
        _ => (format!("joint{}_{name}", joint + 1), factor),
    };
    Names {
        time: (time.0.to_string(), time.1),
        joints: (0..joints)
            .map(|joint| {
                (
                    numbered(angle, joint),
                    input.map(|input| numbered(input, joint)),
                )
            })
            .collect(),
        separator: [',', ';', '\t'][chance.random_range(0..3)],
    }
}

impl Names {
    /// A log as its recorder writes it.
    pub(super) fn csv(&self, rows: &[(f64, Vec<(f64, f64)>)]) -> String {
        let mut text = self.time.0.clone();
        for (angle, input) in &self.joints {
            for (name, _) in [Some(angle), input.as_ref()].into_iter().flatten() {
                let _ = write!(text, "{}{name}", self.separator);
            }
        }
        text.push('\n');
        for (time_s, joints) in rows {
            let _ = write!(text, "{:.6}", time_s * self.time.1);
            for ((angle, input), (own_angle, own_input)) in joints.iter().zip(&self.joints) {
                let written = [
                    Some((*angle, own_angle)),
                    own_input.as_ref().map(|own| (*input, own)),
                ];
                for (value, (name, factor)) in written.into_iter().flatten() {
                    let digits = if name.ends_with("ticks") { 0 } else { 5 };
                    let _ = write!(text, "{}{:.digits$}", self.separator, value * factor);
                }
            }
            text.push('\n');
        }
        text
    }
}
