//! Rigs for measuring how good a diagnosis is: an arm or the robot, with any set of hidden effects.

use super::bench_arm::BenchArm;
use super::gyro;
use super::hidden_effect::{HiddenEffect, of_whole_rig};
use super::motion::ArmRecording;
use super::physics::Physics;
use super::robot::{LINKS, Laws};
use super::robot_motion::{SUPPLY_V, balance, hang};
use super::rounding::rounded;
use super::text::{self, EffectLine};
use super::unknown_law::UnknownLaw;
use super::{SHOWN_BY_MOTIONS, arm_logs, drawn, motions, mounts, stage, stream};
use rand::Rng;

/// Which rig moves how; every motion lasts 20 s.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motions {
    /// The bench arm of the challenges: two motions to learn from, one held out.
    Arm,
    /// The robot of three links hanging from its bar: likewise.
    Hanging,
    /// The same motions, and two of it balancing upright: one to learn from, one held out.
    Balancing,
}

/// A log of a bench.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchLog {
    /// Name of the file.
    pub name: String,
    /// Its content.
    pub csv: String,
    /// Whether it is held out.
    pub held_out: bool,
}

/// An effect that a bench hides.
#[derive(Debug, Clone, PartialEq)]
pub struct BenchEffect {
    /// Id in the library of effects.
    pub kind: &'static str,
    /// Joint it acts on, counted from 1; none when it acts on the whole rig.
    pub joint: Option<usize>,
    /// Its values, by the keys of its parameters.
    pub parameters: Vec<(&'static str, f64)>,
}

/// A rig as its owner believes it to be, its logs, and what it hides.
#[derive(Debug, Clone, PartialEq)]
pub struct Bench {
    /// The model its owner believes in.
    pub model_toml: String,
    /// The true model.
    pub true_model_toml: String,
    /// The logs.
    pub logs: Vec<BenchLog>,
    /// What is hidden.
    pub effects: Vec<BenchEffect>,
}

/// Makes the bench of this seed that hides effects of these kinds, each of
/// [`KINDS`](super::KINDS) and at most once; equal arguments give equal bytes. None where the robot
/// cannot be balanced however weak the effects are.
pub fn bench(motions: Motions, seed: u64, kinds: &[&'static str]) -> Option<Bench> {
    match motions {
        Motions::Arm => Some(arm(seed, kinds)),
        Motions::Hanging | Motions::Balancing => robot(motions, seed, kinds),
    }
}

/// The true model of a bench, by the same arguments: as [`bench()`] has it, and without the logs
/// where these do not decide what is hidden.
pub fn true_model_toml(motions: Motions, seed: u64, kinds: &[&'static str]) -> Option<String> {
    match motions {
        Motions::Arm if !kinds.contains(&SHOWN_BY_MOTIONS) => {
            let (rig, secrets) = drawn(seed, kinds);
            Some(text::model_toml(&rig, rig.friction, &secrets))
        }
        Motions::Hanging => {
            let hidden: Vec<Placed> = kinds.iter().map(|kind| placed(seed, kind)).collect();
            let (friction, _) = friction(seed, &hidden);
            Some(toml(&[&friction[..], &hidden[..]].concat(), &hidden))
        }
        _ => bench(motions, seed, kinds).map(|bench| bench.true_model_toml),
    }
}

/// The arm of this seed with effects of these kinds at this share of the strength that [`bench()`]
/// hides them with; the same arm moves under the same commands, whatever the share.
pub fn weakened_arm(seed: u64, kinds: &[&'static str], share: f64) -> Bench {
    let (rig, secrets, _) = stage(seed, kinds);
    let weakened = secrets.iter().map(|secret| secret.weakened(share));
    let secrets: Vec<HiddenEffect> = weakened.collect();
    let recordings = motions(seed, &rig.physics(&secrets), &rig, mounts(seed));
    arm_bench(&rig, secrets, &recordings)
}

/// The arm of this seed with the law of this name, one of [`unknown_laws`](super::unknown_laws), at
/// random values; none of another name.
pub fn unknown_law_arm(seed: u64, name: &str) -> Option<(Bench, UnknownLaw)> {
    let rig = BenchArm::random(&mut stream(seed, 1), &[]);
    let law = UnknownLaw::random(&mut stream(seed, UNKNOWN), name)?;
    let mut truth = rig.physics(&[]);
    truth.unknown = Some(law.clone());
    let recordings = motions(seed, &truth, &rig, mounts(seed));
    let mut bench = arm_bench(&rig, Vec::new(), &recordings);
    bench.true_model_toml += &law.toml();
    Some((bench, law))
}

/// The stream from which the values of a law are drawn that the library lacks.
const UNKNOWN: u64 = 90;

fn arm(seed: u64, kinds: &[&'static str]) -> Bench {
    let (rig, secrets, recordings) = stage(seed, kinds);
    arm_bench(&rig, secrets, &recordings)
}

pub(super) fn arm_bench(
    rig: &BenchArm,
    secrets: Vec<HiddenEffect>,
    recordings: &[ArmRecording; 3],
) -> Bench {
    let logs = arm_logs(recordings).into_iter().enumerate();
    Bench {
        model_toml: text::model_toml(rig, rig.believed, &[]),
        true_model_toml: text::model_toml(rig, rig.friction, &secrets),
        logs: logs
            .map(|(k, (name, csv))| BenchLog {
                name,
                csv,
                held_out: k == 2,
            })
            .collect(),
        effects: secrets
            .into_iter()
            .map(|secret| BenchEffect {
                kind: secret.kind,
                joint: (!of_whole_rig(secret.kind)).then_some(1),
                parameters: secret.parameters,
            })
            .collect(),
    }
}

/// Length, joint to centre of mass, mass, inertia about it: arms, torso with head, legs.
const LINK: [(f64, f64, f64, f64); LINKS] = [
    (0.1436, 0.0687, 0.3676, 7890.7e-7),
    (0.1158, 0.0575, 0.9815, 32898.6e-7),
    (0.1840, 0.1163, 0.5764, 11328.0e-7),
];
/// Torque at full duty, N m: none at the bar, two servos at shoulder and hip.
const STALL_NM: [f64; LINKS] = [0.0, 3.0, 3.0];
/// Friction of shoulder and hip, least and most: N m s/rad, and N m.
const FRICTION: [(&str, f64, f64); 2] = [("viscous", 0.01, 0.03), ("coulomb", 0.02, 0.05)];
/// First of the streams from which the robot's hidden effects are drawn.
const SECRETS: u64 = 200;
/// Kinds that only driven joints have.
const OF_DRIVES: [&str; 17] = [
    "load_friction",
    "drive_asymmetry",
    "direction_asymmetry",
    "dead_zone",
    "delay",
    "supply_sensitivity",
    "supply_sag",
    "torque_saturation",
    "speed_limit",
    "cogging",
    "torque_scale",
    "slew_limit",
    "drive_lag",
    "thermal_drift",
    "fold_back",
    "gear_compliance",
    "gear_backlash",
];
/// Kinds that a regulator may know: they have a derivative and act on the motion, not on what is
/// read of it.
const SMOOTH: [&str; 9] = [
    "viscous",
    "base_tilt",
    "com_angle",
    "mass",
    "armature",
    "cable_spring",
    "delay",
    "torque_scale",
    "speed_limit",
];
/// How often effects are made weaker until the robot can be balanced, and what is left each time.
const TRIES: usize = 15;
const WEAKENED: f64 = 0.8;

/// An effect at a joint, counted from 0.
type Placed = (HiddenEffect, usize);

fn robot(motions: Motions, seed: u64, kinds: &[&'static str]) -> Option<Bench> {
    let mut hidden: Vec<Placed> = kinds.iter().map(|kind| placed(seed, kind)).collect();
    let (friction, believed) = friction(seed, &hidden);
    for _ in 0..TRIES {
        if let Some(logs) = record(motions, seed, &friction, &hidden) {
            return Some(Bench {
                model_toml: toml(&believed, &hidden),
                true_model_toml: toml(&[&friction[..], &hidden[..]].concat(), &hidden),
                logs,
                effects: hidden
                    .into_iter()
                    .map(|(effect, joint)| BenchEffect {
                        kind: effect.kind,
                        joint: (!of_whole_rig(effect.kind)).then_some(joint + 1),
                        parameters: effect.parameters,
                    })
                    .collect(),
            });
        }
        for (effect, _) in &mut hidden {
            *effect = effect.weakened(WEAKENED);
        }
    }
    None
}

/// What is hidden of this kind at this seed, and where.
fn placed(seed: u64, kind: &'static str) -> Placed {
    let place = super::KINDS.iter().position(|known| *known == kind);
    let mut rng = stream(seed, SECRETS + place.unwrap_or(0) as u64);
    let joint = match kind {
        kind if of_whole_rig(kind) => 0,
        kind if OF_DRIVES.contains(&kind) => rng.random_range(1..LINKS),
        _ => rng.random_range(0..LINKS),
    };
    (HiddenEffect::of_robot(&mut rng, kind), joint)
}

/// True and believed friction of shoulder and hip, absent where it is hidden.
fn friction(seed: u64, hidden: &[Placed]) -> (Vec<Placed>, Vec<Placed>) {
    let mut rng = stream(seed, 1);
    let (mut truth, mut believed) = (Vec::new(), Vec::new());
    for joint in 1..LINKS {
        for (kind, low, high) in FRICTION {
            let value = rng.random_range(low..high);
            let off = rng.random_range(0.7..1.3);
            if hidden
                .iter()
                .any(|(effect, at)| effect.kind == kind && *at == joint)
            {
                continue;
            }
            let key = match kind {
                "viscous" => "coefficient_nm_s_rad",
                _ => "torque_nm",
            };
            let effect = |value, digits| HiddenEffect {
                kind,
                parameters: vec![(key, rounded(value, digits))],
            };
            truth.push((effect(value, 5), joint));
            believed.push((effect(value * off, 4), joint));
        }
    }
    (truth, believed)
}

fn record(
    motions: Motions,
    seed: u64,
    friction: &[Placed],
    hidden: &[Placed],
) -> Option<Vec<BenchLog>> {
    let all: Vec<Placed> = [friction, hidden].concat();
    let hanging = ["a", "b", "c"].into_iter().enumerate().map(|(k, name)| {
        let rig = laws(&all, k == 1);
        let recording = hang(&rig, &mut stream(seed, 3 + k as u64));
        BenchLog {
            name: format!("hanging_{name}.csv"),
            csv: recording.csv(&format!("Robot hanging from its bar, motion {name}.")),
            held_out: k == 2,
        }
    });
    let mut logs: Vec<BenchLog> = Vec::new();
    if motions == Motions::Balancing {
        let rig = laws(&all, false);
        let known = all
            .iter()
            .filter(|(effect, _)| SMOOTH.contains(&effect.kind));
        let smooth = laws(&known.cloned().collect::<Vec<_>>(), false);
        for (k, name) in ["a", "b"].into_iter().enumerate() {
            let recording = balance(&rig, &smooth, &mut stream(seed, 10 + k as u64))?;
            logs.push(BenchLog {
                name: format!("balancing_{name}.csv"),
                csv: recording.csv(&format!("Robot balancing on its bar, motion {name}.")),
                held_out: k == 1,
            });
        }
    }
    Some(hanging.chain(logs).collect())
}

/// The robot's laws with these effects.
fn laws(effects: &[Placed], turned: bool) -> Laws {
    let joint = |k: usize| {
        let (_, com_m, mass_kg, inertia_kg_m2) = LINK[k];
        Physics::ideal(com_m, mass_kg, inertia_kg_m2, STALL_NM[k], SUPPLY_V)
    };
    let mut joints: [Physics; LINKS] = std::array::from_fn(joint);
    for (effect, joint) in effects {
        let known = joints[*joint].switch_on(effect.kind, &effect.values());
        assert!(known, "{} has no law here", effect.kind);
    }
    Laws {
        joints,
        length_m: LINK.map(|(length_m, ..)| length_m),
        turned,
    }
}

/// The robot as a model file with these effects, and the gyros that show what is hidden.
fn toml(effects: &[Placed], hidden: &[Placed]) -> String {
    let gyros = hidden
        .iter()
        .filter(|(effect, _)| gyro::KINDS.contains(&effect.kind));
    let gyros: Vec<usize> = gyros.map(|(_, joint)| *joint).collect();
    let lines: Vec<EffectLine> = effects
        .iter()
        .map(|(effect, joint)| EffectLine {
            kind: effect.kind,
            joint: joint + 1,
            parameters: &effect.parameters,
        })
        .collect();
    text::robot_toml(&LINK, &STALL_NM, SUPPLY_V, &lines, &gyros)
}
