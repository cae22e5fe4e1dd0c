//! A bench arm that plays given inputs: what its log holds after an experiment.

use super::motion::{ArmRecording, NOISE, SupplyDrift, noisy, normal};
use super::physics::Mount;
use super::truth::{Arm, ArmCommands};
use super::{stage, stream};

/// First of the streams from which the noise of played motions is drawn.
const PLAYED: u64 = 300;

/// What an arm is given to play, and under which conditions.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmInputs {
    /// When each duty is sent, s.
    pub time_s: Vec<f64>,
    /// Duty, -1 to 1.
    pub duty: Vec<f64>,
    /// Whether the motor is energised.
    pub torque_on: Vec<bool>,
    /// Supply that is set, V; without it, it drifts as a battery does.
    pub supply_v: Option<f64>,
    /// Known mass bolted on, kg.
    pub payload_kg: f64,
    /// Whether the rig is turned by 180 degrees about the vertical.
    pub turned: bool,
}

/// The log of the arm of this seed that hides effects of these kinds, as [`bench`](super::bench)
/// makes it, when it plays these inputs from rest.
pub fn play(seed: u64, kinds: &[&'static str], inputs: &ArmInputs) -> String {
    let (rig, secrets, _) = stage(seed, kinds);
    let truth = rig.physics(&secrets);
    let mut rng = stream(seed, PLAYED);
    let drift = SupplyDrift::random(&mut rng);
    let mount = Mount {
        payload_kg: inputs.payload_kg,
        turned: inputs.turned,
    };
    let supply_v = inputs.time_s.iter().map(|&time_s| match inputs.supply_v {
        Some(volts) => volts,
        None => drift.at(time_s),
    });
    let commands = ArmCommands {
        time_s: inputs.time_s.clone(),
        duty: inputs.duty.clone(),
        torque_on: inputs.torque_on.clone(),
        supply_v: supply_v.collect(),
    };
    let mut arm = Arm::settled(&truth, mount);
    let mut rate_rad_s = Vec::new();
    let mut sensed = Vec::with_capacity(commands.time_s.len());
    let mut noises = Vec::with_capacity(commands.time_s.len());
    let mut noise = NOISE.0 * normal(&mut rng);
    for k in 0..commands.time_s.len() {
        sensed.push(arm.sensed());
        noises.push(noise);
        rate_rad_s.extend(arm.rate(&mut rng));
        if let Some(next_s) = commands.time_s.get(k + 1) {
            let span_s = next_s - commands.time_s[k];
            commands.carry(&mut arm, k, span_s);
            let kept = (-span_s / NOISE.1).exp();
            noise = kept * noise + (1.0 - kept * kept).sqrt() * NOISE.0 * normal(&mut rng);
        }
    }
    let sensed = commands.logged(&mut arm).unwrap_or(sensed);
    let recording = ArmRecording {
        commands,
        position: noisy(&sensed, &noises),
        rate_rad_s,
        mount,
    };
    recording.csv("Bench arm, an experiment.")
}
