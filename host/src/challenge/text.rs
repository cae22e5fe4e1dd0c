//! The files of a challenge that are written in words.

use super::bench_arm::{BenchArm, Friction, NOMINAL_SUPPLY_V, STALL_NM};
use super::hidden_effect::HiddenEffect;
use super::physics::{GRAVITY_M_S2, PAYLOAD_AT_M};
use handstand_shared::raw::Position;
use std::fmt::Write;

/// The rig as a model file, with `friction` and, if given, the secret.
pub fn model_toml(rig: &BenchArm, friction: Friction, secret: Option<&HiddenEffect>) -> String {
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
    if let Some(secret) = secret {
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
    text
}

fn effect(text: &mut String, kind: &str, parameters: &[(&str, f64)]) {
    let _ = write!(text, "\n[[effect]]\nkind = \"{kind}\"\n");
    // A tilt is of the whole rig.
    if kind != "base_tilt" {
        text.push_str("joint = 1\n");
    }
    for (key, value) in parameters {
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
