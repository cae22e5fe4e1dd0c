//! The files of a challenge that are written in words.

use super::bench_arm::{BenchArm, Friction, NOMINAL_SUPPLY_V, STALL_NM};
use super::gyro::STEP_RAD_S;
use super::hidden_effect::{HiddenEffect, of_whole_rig};
use super::physics::{GRAVITY_M_S2, PAYLOAD_AT_M};
use handstand_shared::raw::Position;
use std::fmt::Write;

/// The rig as a model file, with `friction` and these secrets.
pub fn model_toml(rig: &BenchArm, friction: Friction, secrets: &[HiddenEffect]) -> String {
    let (com_m, mass_kg, inertia_kg_m2) = (rig.com_m, rig.mass_kg, rig.inertia_kg_m2);
    let mut text = format!(
        r#"[rig]
name = "bench arm"
angle_zero = "hanging"
gravity_m_s2 = {GRAVITY_M_S2}

[[link]]
length_m = {PAYLOAD_AT_M}
com_m = {com_m}
mass_kg = {mass_kg}
inertia_kg_m2 = {inertia_kg_m2}

[[joint]]
drive = "duty"
stall_torque_nm = {STALL_NM:?}
nominal_supply_v = {NOMINAL_SUPPLY_V:?}
"#
    );
    if let Some(viscous) = friction.viscous {
        effect(&mut text, "viscous", &[("coefficient_nm_s_rad", viscous)]);
    }
    if let Some(coulomb) = friction.coulomb {
        effect(&mut text, "coulomb", &[("torque_nm", coulomb)]);
    }
    for secret in secrets {
        effect(&mut text, secret.kind, &secret.parameters);
    }
    let _ = write!(
        text,
        r#"
[log]
time = {{ column = "time_s", unit = "s" }}
supply = {{ column = "supply_v", unit = "V" }}
torque_on = "torque_on"
payload = {{ column = "payload_kg", unit = "kg", at_m = {PAYLOAD_AT_M} }}
turned = "turned"

[[log.joint]]
position = {{ column = "position_rad", unit = "rad", resolution_rad = {:.7} }}
input = {{ column = "duty", unit = "1" }}
"#,
        Position::LSB_RAD
    );
    if rig.has_gyro {
        gyro(&mut text, "gyro_rad_s");
    }
    text
}

/// The line of a gyro's column.
fn gyro(text: &mut String, column: &str) {
    let _ = writeln!(
        text,
        "gyro = {{ column = \"{column}\", unit = \"rad/s\", resolution_rad_s = {STEP_RAD_S} }}"
    );
}

/// An effect as a model file has it.
pub struct EffectLine<'a> {
    /// Id in the library of effects.
    pub kind: &'a str,
    /// Joint, counted from 1.
    pub joint: usize,
    /// Keys and values.
    pub parameters: &'a [(&'static str, f64)],
}

/// The robot of three links as a model file with these effects. Links are length, joint to centre
/// of mass, mass and inertia; a stall torque of 0 is a passive joint; links with a gyro are counted
/// from 0.
pub fn robot_toml(
    links: &[(f64, f64, f64, f64)],
    stall_nm: &[f64],
    supply_v: f64,
    effects: &[EffectLine],
    gyros: &[usize],
) -> String {
    let mut text = format!(
        r#"[rig]
name = "robot on a bar"
angle_zero = "hanging"
gravity_m_s2 = {GRAVITY_M_S2}
"#
    );
    for (length_m, com_m, mass_kg, inertia_kg_m2) in links {
        let _ = write!(
            text,
            "\n[[link]]\nlength_m = {length_m}\ncom_m = {com_m}\nmass_kg = {mass_kg}\n\
             inertia_kg_m2 = {inertia_kg_m2}\n"
        );
    }
    for stall_nm in stall_nm {
        text += "\n[[joint]]\n";
        let _ = if *stall_nm > 0.0 {
            write!(
                text,
                "drive = \"duty\"\nstall_torque_nm = {stall_nm:?}\n\
             nominal_supply_v = {supply_v:?}\n"
            )
        } else {
            writeln!(text, "drive = \"passive\"")
        };
    }
    for line in effects {
        effect_at(&mut text, line);
    }
    let _ = write!(
        text,
        r#"
[log]
time = {{ column = "time_s", unit = "s" }}
supply = {{ column = "supply_v", unit = "V" }}
torque_on = "torque_on"
payload = {{ column = "payload_kg", unit = "kg", at_m = {PAYLOAD_AT_M} }}
turned = "turned"
"#
    );
    for (k, stall_nm) in stall_nm.iter().enumerate() {
        let (joint, lsb_rad) = (k + 1, Position::LSB_RAD);
        let _ = write!(
            text,
            "\n[[log.joint]]\nposition = {{ column = \"q{joint}_rad\", unit = \"rad\", \
             resolution_rad = {lsb_rad:.7} }}\n"
        );
        if *stall_nm > 0.0 {
            let _ = writeln!(text, "input = {{ column = \"duty{joint}\", unit = \"1\" }}");
        }
        if gyros.contains(&k) {
            gyro(&mut text, &format!("gyro{joint}_rad_s"));
        }
    }
    text
}

fn effect(text: &mut String, kind: &str, parameters: &[(&'static str, f64)]) {
    let joint = 1;
    effect_at(
        text,
        &EffectLine {
            kind,
            joint,
            parameters,
        },
    );
}

pub fn effect_at(text: &mut String, effect: &EffectLine) {
    let kind = effect.kind;
    let _ = write!(text, "\n[[effect]]\nkind = \"{kind}\"\n");
    if !of_whole_rig(kind) {
        let _ = writeln!(text, "joint = {}", effect.joint);
    }
    for (key, value) in effect.parameters {
        let _ = writeln!(text, "{key} = {value:?}");
    }
}

/// What to do with a challenge.
pub const README: &str = "\
A bench arm with at most one physical effect that nominal.toml does not know.

nominal.toml   what its owner believes; the friction is up to 30 % off, everything else but the
               missing effect is exact
a.csv          bare arm
b.csv          with a payload, the rig turned by 180 degrees about the vertical
c.csv          with another payload; keep it for the last check
answer.sealed  the answer; sealed so that nobody reads it by accident, not against anybody who \
               wants to

Name the effect and its values. In this folder:

  handstand log check nominal.toml a.csv b.csv c.csv
  handstand compare nominal.toml a.csv b.csv
  handstand diagnose nominal.toml a.csv b.csv --holdout c.csv
  handstand effects EFFECT   (what the effect it names is)
  handstand add nominal.toml EFFECT --fit a.csv b.csv --holdout c.csv -o model.toml
  handstand compare nominal.toml c.csv --model model.toml
  handstand challenge score . model.toml

If nothing is missing, score nominal.toml itself.
";
