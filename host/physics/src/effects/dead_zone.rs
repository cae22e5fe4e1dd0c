//! Dead zone: the drive swallows small commands.

use super::{EffectInfo, Law, Needs, OnSlide, Parameter, Scope, Site};

/// u = 0 while |u| <= width, else u + punch sgn(u); never reversed; punch does not lead beyond full
/// range.
#[derive(Debug)]
pub struct DeadZone;

pub(super) static INFO: EffectInfo = EffectInfo {
    id: "dead_zone",
    title: "dead zone of the drive",
    aliases: &["deadband", "minimum duty", "minimum PWM", "insensitivity"],
    site: Site::Command,
    scope: Scope::DrivenJoint,
    needs: Needs::Nothing,
    on_slide: OnSlide::Same,
    law: "applied duty = 0 while |u| <= width, else u + punch * sgn(u)",
    parameters: &[
        Parameter::of(
            "width",
            "share of full range below which the command does nothing",
        )
        .off(0.0)
        .typical(0.02, 0.15)
        .bounds(0.0, 0.6)
        .starts(&[0.05, 0.12]),
        Parameter::of(
            "punch",
            "duty added to every command outside the zone; below zero it takes away",
        )
        .off(0.0)
        .typical(0.0, 0.05)
        .bounds(-0.3, 0.3)
        .starts(&[0.0, 0.03]),
    ],
    looks_like: "near zero command the arm rests anywhere on a plateau of error; under feedback it \
     hunts in a limit cycle; with the torque off nothing remains of it",
    confused_with: &[
        "gear_backlash: both leave the arm alone about no command; backlash only until the motor \
         is across",
        "coulomb: both swallow small commands; with the torque off only friction remains",
        "backlash: both leave a plateau; backlash has a fixed width in angle after each reversal, \
         a dead zone a fixed width in command",
        "stribeck: both leave small commands without motion; breakaway grows neither with the \
         supply nor with the duty, and stays with the torque off",
    ],
    experiment: "ramp the command slowly through zero at two loads, then drop the arm with the \
     torque off",
    reference: "Tao, Kokotovic, Adaptive Control of Systems with Actuator and Sensor \
     Nonlinearities (1996); ROBOTIS AX-12 manual, compliance margin and punch",
};

impl Law for DeadZone {
    fn difference(&self) -> f64 {
        2e-2
    }

    fn command(&self, values: &[f64], duty: f64) -> f64 {
        let [width, punch] = values else { return duty };
        if duty.abs() <= *width {
            0.0
        } else {
            beyond(*punch, duty.abs()).copysign(duty)
        }
    }

    /// Of each side the share of the duties beyond the zone, at the middle of these: exact, but
    /// for those across which full range or reversal cuts the law off.
    fn mean_command(&self, values: &[f64], duty: f64, spread: f64) -> f64 {
        let [width, punch] = values else { return duty };
        if spread == 0.0 {
            return self.command(values, duty);
        }
        let side = |duty: f64| {
            let (low, high) = ((duty - spread).max(*width), duty + spread);
            if high > low {
                (high - low) / (2.0 * spread) * beyond(*punch, 0.5 * (low + high))
            } else {
                0.0
            }
        };
        side(duty) - side(-duty)
    }

    fn command_jump(&self, values: &[f64]) -> f64 {
        let [width, punch] = values else { return 0.0 };
        beyond(*punch, *width)
    }
}

/// The duty applied outside the zone, of one above zero.
fn beyond(punch: f64, duty: f64) -> f64 {
    (duty + punch).clamp(0.0, duty.max(1.0))
}
