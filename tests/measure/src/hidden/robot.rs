//! The truth by the virtual robot: logs as `excite`, `replay` and the firmware's logic make them.
//!
//! The robot hangs from its bar by simulated servos behind a simulated CM-5. Nothing of its true
//! state is read: the logs hold the servos' angles, the goals and the gyro's code.

use super::case::{Case, Files, HiddenEffect};
use handstand::effects;
use handstand::experiment::excite::{ExcitationKind, ExcitePlan, JointLimits, excite};
use handstand::link::record::{GoalMotion, RobotRecorder, Stream, follow, read};
use handstand::link::virtual_cm5::{Cm5Port, SimLink, set_up, spec_with_robot};
use handstand::model::edit::{add_effect, set_values};
use handstand::model::{EffectInstance, ParameterPath};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Kinds of effects that it can hide.
pub const ROBOT_KINDS: [&str; 6] = [
    "coulomb",
    "air_drag",
    "mass",
    "armature",
    "cable_spring",
    "torque_scale",
];

/// Servos of shoulder and hip.
const SERVOS: [[u8; 2]; 2] = [[1, 2], [11, 12]];
/// A bus on which an answer is lost now and then.
const BUS: &str = "ids=1-2+11-12,delay=0,drop=0.1";
/// Friction in the files, and by how much its owner's guess may be off.
const FRICTION: [(&str, f64); 3] = [
    ("viscous@1.coefficient_nm_s_rad", 0.010),
    ("coulomb@2.torque_nm", 0.16),
    ("coulomb@3.torque_nm", 0.16),
];
const GUESS: (f64, f64) = (0.75, 1.3);

const ROBOT: &str = include_str!("../../../../host/models/robot.toml");
const RECORDING: &str = include_str!("../../../../host/models/robot_recording.toml");

/// The motions: what each holds, and whether it is held out.
const MOTIONS: [(&str, &[ExcitationKind], bool); 3] = [
    ("a", &[ExcitationKind::Multisine], false),
    ("b", &[ExcitationKind::Steps], false),
    ("c", &[ExcitationKind::Multisine], true),
];

/// Writes models and logs of a case into a folder.
pub(super) fn write(case: &Case, dir: &Path) -> Result<Files, String> {
    written(case, dir).map_err(|error| error.to_string())
}

fn written(case: &Case, dir: &Path) -> handstand::Result<Files> {
    let mut random = ChaCha8Rng::seed_from_u64(case.seed);
    let mut friction = Vec::new();
    let mut guessed = Vec::new();
    for (path, value) in FRICTION {
        let path: ParameterPath = path.parse()?;
        let truth = value * random.random_range(0.8..1.25);
        friction.push((path, truth));
        guessed.push((path, truth * random.random_range(GUESS.0..GUESS.1)));
    }
    let hidden: Vec<EffectInstance> = case
        .hidden
        .iter()
        .filter_map(|kind| drawn(kind, case.seed))
        .collect();
    let save = |name: &str, text: &str| {
        let path = dir.join(name);
        std::fs::write(&path, text)
            .map_err(|error| handstand::Error::file(&path, "write", error))?;
        Ok::<PathBuf, handstand::Error>(path)
    };
    let with = |text: &str, values: &[(ParameterPath, f64)], effects: &[EffectInstance]| {
        let file = Path::new("robot.toml");
        let mut text = set_values(text, file, values)?;
        for effect in effects {
            text = add_effect(&text, file, effect, None)?;
        }
        Ok::<String, handstand::Error>(text)
    };
    let robot = save("robot.toml", &with(ROBOT, &friction, &hidden)?)?;
    let mut files = Files {
        nominal: save("nominal.toml", &with(RECORDING, &guessed, &[])?)?,
        truth: Some(save("true.toml", &with(RECORDING, &friction, &hidden)?)?),
        fit: Vec::new(),
        held_out: Vec::new(),
        effects: hidden.iter().map(known).collect(),
    };
    for (number, (name, kinds, held_out)) in (1..).zip(MOTIONS) {
        let log = dir.join(format!("{name}.csv"));
        let goals = save(
            &format!("goals_{name}.csv"),
            &excite(&plan(kinds, 10 * case.seed + number))?.to_csv(),
        )?;
        record(&robot, &goals, &log, case.seed)?;
        if held_out {
            files.held_out.push(log)
        } else {
            files.fit.push(log)
        }
    }
    Ok(files)
}

fn plan(kinds: &[ExcitationKind], seed: u64) -> ExcitePlan {
    let joint = |servos: [u8; 2]| JointLimits {
        servos: servos.to_vec(),
        low_rad: -0.6,
        high_rad: 0.6,
        speed_rad_s: 2.5,
    };
    ExcitePlan {
        joints: SERVOS.map(joint).to_vec(),
        kinds: kinds.to_vec(),
        each_s: 6.0,
        hz: 100.0,
        band_hz: (0.5, 3.0),
        seed,
    }
}

/// Plays the goals through the firmware's logic and writes down what its stream reports.
fn record(robot: &Path, goals: &Path, log: &Path, seed: u64) -> handstand::Result<()> {
    let bus = spec_with_robot(&format!("{BUS},seed={seed}"), Some(robot))?;
    let recording = read(goals)?;
    let motion = GoalMotion::of(&recording, goals)?;
    let port = Cm5Port::new(set_up(&bus)?);
    let mut source = Stream::new(SimLink(port), &recording.ids)?;
    let mut recorder = RobotRecorder::create(log, &recording.ids, false)?;
    follow(&motion, &mut source, Some(&mut recorder), &|| true, &|_| {})?;
    recorder.finish()
}

/// An effect of this kind with values and, where there is a choice, a joint of this seed.
fn drawn(kind: &str, seed: u64) -> Option<EffectInstance> {
    let place = ROBOT_KINDS.iter().position(|known| *known == kind)?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(1 + place as u64);
    let driven = random.random_range(1..3);
    let mut within = |low: f64, high: f64| {
        let value: f64 = random.random_range(low..high);
        (1e4 * value).round() / 1e4
    };
    let (joint, values) = match kind {
        "coulomb" => (0, vec![within(0.02, 0.06)]),
        "air_drag" => (0, vec![within(0.02, 0.06)]),
        "mass" => (driven, vec![within(0.08, 0.2)]),
        "armature" => (driven, vec![within(0.003, 0.01)]),
        "cable_spring" => (driven, vec![within(0.3, 1.0), within(-0.2, 0.2)]),
        _ => (driven, vec![within(0.6, 0.85)]),
    };
    Some(EffectInstance {
        effect: effects::named(kind)?,
        joint: Some(joint),
        values,
    })
}

fn known(effect: &EffectInstance) -> HiddenEffect {
    let info = effect.effect.info();
    let values = info.parameters.iter().zip(&effect.values);
    HiddenEffect {
        kind: info.id.to_string(),
        joint: effect.joint.map(|joint| joint + 1),
        parameters: values
            .map(|(parameter, value)| (parameter.key.to_string(), Value::from(*value)))
            .collect(),
    }
}
