//! Rigs with a hidden effect, to find out whether it is found.
//!
//! The truth has its own equations and its own integrator and calls nothing of the library: a
//! mistake in the library's laws shows up as an effect that isn't found, instead of cancelling out.

mod bench;
mod bench_arm;
mod encoder;
mod gyro;
mod hidden_effect;
mod history;
mod motion;
mod moving_base;
mod physics;
mod played;
mod readings;
mod reference;
mod regulator;
mod robot;
mod robot_motion;
mod rounding;
mod score;
mod seal;
mod text;
mod truth;
mod unknown_law;

#[cfg(test)]
mod tests;

pub use bench::{
    Bench, BenchEffect, BenchLog, Motions, bench, true_model_toml, unknown_law_arm, weakened_arm,
};
pub use hidden_effect::{Hidden, KINDS, kind_named};
pub use played::{ArmInputs, play};
pub use readings::{READINGS, Readings, read_arm, read_pendulum};
pub use score::{ChallengeScore, ScoredValue, score, score_rows};
pub use seal::{ChallengeAnswer, seal, unseal};
pub use unknown_law::{UnknownLaw, unknown_laws};

use bench_arm::{BenchArm, STALL_NM};
use handstand_model::error::{Error, Result};
use hidden_effect::HiddenEffect;
use motion::{ArmRecording, record};
use physics::{Mount, Physics};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rounding::rounded;
use std::fs;
use std::path::Path;

/// A model, logs it doesn't fully explain, and why.
#[derive(Debug, Clone, PartialEq)]
pub struct Challenge {
    /// The model its owner believes in.
    pub model_toml: String,
    /// File name and content of each log.
    pub logs: Vec<(String, String)>,
    /// What is missing from the model.
    pub answer: ChallengeAnswer,
}

/// Makes the challenge of this seed; equal arguments give equal bytes.
pub fn generate(seed: u64, hidden: Hidden) -> Challenge {
    let secret = HiddenEffect::kind(&mut stream(seed, 0), hidden);
    let kinds: Vec<&'static str> = secret.into_iter().collect();
    let (rig, secrets, recordings) = stage(seed, &kinds);
    let parameters = secrets.iter().flat_map(|secret| &secret.parameters);
    Challenge {
        model_toml: text::model_toml(&rig, rig.believed, &[]),
        logs: arm_logs(&recordings),
        answer: ChallengeAnswer {
            seed,
            kind: secrets.first().map(|secret| secret.kind.to_owned()),
            joint: 1,
            parameters: parameters
                .map(|(key, value)| ((*key).to_owned(), *value))
                .collect(),
            true_model_toml: text::model_toml(&rig, rig.friction, &secrets),
        },
    }
}

/// File name and content of the log of each motion of the arm.
fn arm_logs(recordings: &[ArmRecording; 3]) -> Vec<(String, String)> {
    let names = ["a", "b", "c"].iter().zip(recordings);
    let log = |(name, recording): (&&str, &ArmRecording)| {
        let title = format!("Bench arm, motion {name}.");
        (format!("{name}.csv"), recording.csv(&title))
    };
    names.map(log).collect()
}

/// The arm, and what it hides before motions have shown how much.
fn drawn(seed: u64, kinds: &[&'static str]) -> (BenchArm, Vec<HiddenEffect>) {
    let secrets: Vec<HiddenEffect> = kinds.iter().map(|kind| secret(seed, kind)).collect();
    (BenchArm::random(&mut stream(seed, 1), &secrets), secrets)
}

/// The arm, what it hides, and its three motions.
fn stage(seed: u64, kinds: &[&'static str]) -> (BenchArm, Vec<HiddenEffect>, [ArmRecording; 3]) {
    let (rig, mut secrets) = drawn(seed, kinds);
    let mounts = mounts(seed);
    loop {
        let truth = rig.physics(&secrets);
        let recordings = motions(seed, &truth, &rig, mounts);
        let saturation = secrets
            .iter_mut()
            .find(|secret| secret.kind == SHOWN_BY_MOTIONS);
        match saturation {
            Some(HiddenEffect { parameters, .. }) if spared(&recordings, parameters[0].1) => {
                parameters[0].1 = rounded(0.9 * parameters[0].1, 6);
            }
            _ => return (rig, secrets, recordings),
        }
    }
}

/// How the arm is mounted in each motion.
fn mounts(seed: u64) -> [Mount; 3] {
    let mut payload = stream(seed, 2);
    [
        (0.0, false),
        (rounded(payload.random_range(0.08..0.12), 3), true),
        (0.05, false),
    ]
    .map(|(payload_kg, turned)| Mount { payload_kg, turned })
}

/// What is hidden of this kind at this seed. Each kind draws its values from a stream of its own:
/// at one seed they lie at different places of their ranges.
fn secret(seed: u64, kind: &'static str) -> HiddenEffect {
    let place = KINDS.iter().position(|known| *known == kind).unwrap_or(0);
    HiddenEffect::random(&mut stream(seed, SECRETS + place as u64), kind)
}

/// The kind whose value is lowered until the motions show it.
const SHOWN_BY_MOTIONS: &str = "torque_saturation";

/// First of the streams from which the values of hidden effects are drawn; those of the rig lie
/// below.
const SECRETS: u64 = 100;

fn motions(seed: u64, truth: &Physics, rig: &BenchArm, mounts: [Mount; 3]) -> [ArmRecording; 3] {
    let believed = rig.physics(&[]);
    let mut number = 2;
    mounts.map(|mount| {
        number += 1;
        record(truth, &believed, mount, &mut stream(seed, number))
    })
}

/// Whether fewer than 3 % of the samples ask for more than the limit, N m.
fn spared(recordings: &[ArmRecording], limit_nm: f64) -> bool {
    let recordings = recordings.iter();
    let duties = recordings.flat_map(|recording| &recording.commands.duty);
    let all = duties.clone().count();
    let beyond = duties.filter(|duty| STALL_NM * duty.abs() > limit_nm);
    (beyond.count() as f64) < 0.03 * all as f64
}

/// Independent random numbers for each purpose, so that one seed is one rig whatever it hides.
fn stream(seed: u64, purpose: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(purpose);
    rng
}

/// Writes the files of a challenge into `dir`, which is made if need be and must be empty.
///
/// # Errors
/// The folder is not empty, or the system refuses a file.
pub fn write(challenge: &Challenge, dir: &Path) -> Result<()> {
    match fs::read_dir(dir).map(|mut entries| entries.next().is_some()) {
        Ok(true) => {
            return Err(Error::usage(
                format!("{} is not empty", dir.display()),
                "name a new directory: nothing is overwritten",
            ));
        }
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            return Err(Error::file(dir, "read", error));
        }
        _ => {}
    }
    fs::create_dir_all(dir).map_err(|error| Error::file(dir, "create", error))?;
    let sealed = seal(&challenge.answer);
    let logs = challenge.logs.iter();
    let logs = logs.map(|(name, log)| (name.as_str(), log.as_str()));
    let others = [
        ("nominal.toml", challenge.model_toml.as_str()),
        ("answer.sealed", &sealed),
        ("README.txt", text::README),
    ];
    for (name, content) in others.into_iter().chain(logs) {
        let path = dir.join(name);
        fs::write(&path, content).map_err(|error| Error::file(&path, "write", error))?;
    }
    Ok(())
}
