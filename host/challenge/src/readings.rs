//! Rigs whose readings err in a given way: to measure whether fitted values are known as well as it
//! is said.

use super::bench::{Bench, BenchEffect, BenchLog};
use super::hidden_effect::HiddenEffect;
use super::motion::{PERIOD_S, normal};
use super::physics::{DriveCommand, GRAVITY_M_S2, Mount, Physics};
use super::rounding::rounded;
use super::text::{self, EffectLine};
use super::truth::Arm;
use super::{bench, stage, stream};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::fmt::Write;

/// How readings of an angle err.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Readings {
    /// White noise.
    Noise,
    /// The steps of an encoder of 4096 a turn, and no noise.
    Steps,
    /// White noise of half a step, then the steps.
    NoisySteps,
    /// Noise that lasts for some samples, then the steps.
    LastingNoise,
}

/// Every way.
pub const READINGS: [Readings; 4] = [
    Readings::Noise,
    Readings::Steps,
    Readings::NoisySteps,
    Readings::LastingNoise,
];

/// Step of the encoder, rad.
const STEP_RAD: f64 = std::f64::consts::TAU / 4096.0;
/// Standard deviation of the noise, rad.
const NOISE_RAD: f64 = 0.87e-3;
/// How long noise lasts, s.
const LASTS_S: f64 = 0.03;
/// Samples of a swing: 20 s.
const SAMPLES: usize = 2000;
/// Streams of the pendulum, of where it is let go, and the first of those of the readings' noise.
const PENDULUM: u64 = 400;
const LET_GO: u64 = 401;
const NOISES: u64 = 402;

impl Readings {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Readings::Noise => "white noise",
            Readings::Steps => "steps",
            Readings::NoisySteps => "white noise and steps",
            Readings::LastingNoise => "lasting noise and steps",
        }
    }

    /// What is read of these angles, rad.
    fn of(self, angles_rad: &[f64], rng: &mut ChaCha8Rng) -> Vec<f64> {
        let kept = (-PERIOD_S / LASTS_S).exp();
        let mut lasting = normal(rng);
        let read = angles_rad.iter().map(|angle| {
            let white = normal(rng);
            lasting = kept * lasting + (1.0 - kept * kept).sqrt() * white;
            let stepped = |angle: f64| (angle / STEP_RAD).round() * STEP_RAD;
            match self {
                Readings::Noise => angle + NOISE_RAD * white,
                Readings::Steps => stepped(*angle),
                Readings::NoisySteps => stepped(angle + NOISE_RAD * white),
                Readings::LastingNoise => stepped(angle + NOISE_RAD * lasting),
            }
        });
        read.collect()
    }
}

/// The arm of [`bench`](super::bench) that hides an effect of this kind, its angle read in this
/// way; its model says nothing of the encoder.
pub fn read_arm(seed: u64, kind: &'static str, readings: Readings) -> Bench {
    let (rig, secrets, recordings) = stage(seed, &[kind]);
    let truth = rig.physics(&secrets);
    let mut number = NOISES;
    let recordings = recordings.map(|mut recording| {
        number += 1;
        let (sensed, _) = recording.commands.replay(&truth, recording.mount);
        recording.position = readings.of(&sensed, &mut stream(seed, number));
        recording
    });
    let mut bench = bench::arm_bench(&rig, secrets, &recordings);
    for text in [&mut bench.model_toml, &mut bench.true_model_toml] {
        *text = without_resolution(text);
    }
    bench
}

/// The text without what it says of the encoder's steps.
fn without_resolution(text: &str) -> String {
    let lines = text
        .lines()
        .map(|line| match line.split_once(", resolution_rad = ") {
            Some((before, _)) => format!("{before} }}\n"),
            None => format!("{line}\n"),
        });
    lines.collect()
}

/// A pendulum that hides its drag in air, let go from three angles and read in this way; its owner
/// knows its viscous and dry friction to 30 %.
pub fn read_pendulum(seed: u64, readings: Readings) -> Bench {
    let mut rng = stream(seed, PENDULUM);
    let mut within = |low: f64, high: f64, digits| rounded(rng.random_range(low..high), digits);
    let link = [
        within(0.15, 0.2, 4),
        within(0.12, 0.18, 4),
        within(4e-4, 8e-4, 7),
    ];
    let drag = within(3e-3, 9e-3, 6);
    let friction = [within(2e-4, 6e-4, 6), within(8e-4, 1.6e-3, 6)];
    let believed = friction.map(|value| rounded(value * within(0.7, 1.3, 6), 6));
    let mut truth = Physics::ideal(link[0], link[1], link[2], 0.0, 1.0);
    let hidden = HiddenEffect {
        kind: "air_drag",
        parameters: vec![("coefficient_nm_s2_rad2", drag)],
    };
    for (kind, value) in [("viscous", friction[0]), ("coulomb", friction[1])] {
        truth.switch_on(kind, &[value]);
    }
    truth.switch_on(hidden.kind, &hidden.values());
    let mut let_go = stream(seed, LET_GO);
    let motions = [("a", 2.6), ("b", 1.4), ("c", 2.0)].into_iter().enumerate();
    let logs = motions.map(|(k, (name, angle))| {
        let from_rad = angle + let_go.random_range(-0.1..0.1);
        let swung = swing(&truth, from_rad);
        let read = readings.of(&swung, &mut stream(seed, NOISES + k as u64));
        BenchLog {
            name: format!("swing_{name}.csv"),
            csv: csv(&read),
            held_out: k == 2,
        }
    });
    Bench {
        logs: logs.collect(),
        model_toml: pendulum_toml(link, believed, &[]),
        true_model_toml: pendulum_toml(link, friction, std::slice::from_ref(&hidden)),
        effects: vec![BenchEffect {
            kind: hidden.kind,
            joint: Some(1),
            parameters: hidden.parameters,
        }],
    }
}

/// Angles of a pendulum that is let go, rad, one a sample.
fn swing(truth: &Physics, from_rad: f64) -> Vec<f64> {
    let mut pendulum = Arm::at_rest(truth, Mount::default(), from_rad);
    let free = DriveCommand {
        duty: 0.0,
        supply_v: 1.0,
        torque_on: false,
    };
    let samples = (0..SAMPLES).map(|_| {
        let angle = pendulum.sensed();
        pendulum.advance(PERIOD_S, |_| free);
        angle
    });
    samples.collect()
}

fn csv(read_rad: &[f64]) -> String {
    let mut text = "time_s,position_rad\n".to_string();
    for (k, angle) in read_rad.iter().enumerate() {
        let _ = writeln!(text, "{:.2},{angle:.7}", k as f64 * PERIOD_S);
    }
    text
}

/// The pendulum as a model file: of its link joint to centre of mass, mass and inertia, of its
/// friction the viscous and the dry one.
fn pendulum_toml(link: [f64; 3], friction: [f64; 2], secrets: &[HiddenEffect]) -> String {
    let [com_m, mass_kg, inertia_kg_m2] = link;
    let mut text = format!(
        "[rig]\nname = \"pendulum\"\nangle_zero = \"hanging\"\ngravity_m_s2 = {GRAVITY_M_S2}\n\n\
         [[link]]\ncom_m = {com_m}\nmass_kg = {mass_kg}\ninertia_kg_m2 = {inertia_kg_m2}\n\n\
         [[joint]]\ndrive = \"passive\"\n"
    );
    let known = [
        ("viscous", "coefficient_nm_s_rad", friction[0]),
        ("coulomb", "torque_nm", friction[1]),
    ];
    for (kind, key, value) in known {
        text::effect_at(
            &mut text,
            &EffectLine {
                kind,
                joint: 1,
                parameters: &[(key, value)],
            },
        );
    }
    for secret in secrets {
        text::effect_at(
            &mut text,
            &EffectLine {
                kind: secret.kind,
                joint: 1,
                parameters: &secret.parameters,
            },
        );
    }
    text + "\n[log]\ntime = { column = \"time_s\", unit = \"s\" }\n\n\
            [[log.joint]]\nposition = { column = \"position_rad\", unit = \"rad\" }\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use handstand_model::motion::Motion;

    fn angles() -> Vec<f64> {
        (0..4000).map(|k| 1e-3 * f64::from(k)).collect()
    }

    #[test]
    fn every_way_errs_by_as_much_as_it_says() {
        let step = STEP_RAD / 12f64.sqrt();
        let both = (NOISE_RAD.powi(2) + step.powi(2)).sqrt();
        for (readings, expected) in READINGS.into_iter().zip([NOISE_RAD, step, both, both]) {
            let read = readings.of(&angles(), &mut stream(1, 1));
            let errors = read
                .iter()
                .zip(angles())
                .map(|(read, angle)| (read - angle).powi(2));
            let rms = (errors.sum::<f64>() / 4000.0).sqrt();
            assert!((rms / expected - 1.0).abs() < 0.1, "{readings:?} {rms}");
        }
    }

    #[test]
    fn a_pendulum_that_is_let_go_comes_to_rest_by_itself() {
        let bench = read_pendulum(3, Readings::Steps);
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.toml");
        let model = handstand_model::Model::parse(&bench.true_model_toml, &path).unwrap();
        for log in &bench.logs {
            let file = dir.path().join(&log.name);
            std::fs::write(&file, &log.csv).unwrap();
            let request = handstand_logs::LogRequest::whole(file);
            let read: Vec<Motion> = handstand_logs::read(&[request], &model.log).unwrap();
            let angles = &read[0].position_rad[0];
            assert!(angles[0] > 1.2);
            assert!(
                angles[SAMPLES - 50..]
                    .iter()
                    .all(|angle| *angle == angles[SAMPLES - 1])
            );
        }
    }
}
