//! A motion as a bench would log it: a host-side controller reads the rounded angle at 100 Hz and
//! sends duty.

use super::bench_arm::NOMINAL_SUPPLY_V;
use super::physics::{Mount, Physics};
use super::reference::{MOTION_S, Reference};
use super::rounding::rounded;
use super::truth::{Arm, ArmCommands};
use handstand_shared::raw::Position;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Time between samples, s, but for the jitter.
pub const PERIOD_S: f64 = 0.01;
/// Standard deviation of a sample's time, s.
const JITTER_S: f64 = 0.2e-3;
/// Standard deviation, rad, and correlation time, s, of the encoder's noise.
pub const NOISE: (f64, f64) = (0.5e-3, 0.03);
/// Largest duty the controller sends.
const MOST_DUTY: f64 = 0.6;
/// Beyond this reading, rad, the motion is repeated more gently.
const MOST_READING_RAD: f64 = 2.5;
/// Beyond this speed, rad/s, over [`SPEED_SAMPLES`], likewise.
const MOST_SPEED_RAD_S: f64 = 15.0;
/// Samples over which speed is taken from readings.
const SPEED_SAMPLES: usize = 4;
/// Share of samples at the largest duty beyond which the controller counts as rattling.
const MOST_CLIPPED: f64 = 0.04;

/// What one log says.
#[derive(Debug, Clone)]
pub struct ArmRecording {
    /// Times, duty, torque on, and the true supply.
    pub commands: ArmCommands,
    /// Rounded readings, rad.
    pub position: Vec<f64>,
    /// Readings of the gyro, rad/s; empty without one.
    pub rate_rad_s: Vec<f64>,
    /// Conditions.
    pub mount: Mount,
}

/// Records a motion of `truth`; the controller only knows the `believed` arm.
///
/// Repeated with smaller angles and weaker gains until the arm stays clear of standing upright.
pub fn record(
    truth: &Physics,
    believed: &Physics,
    mount: Mount,
    rng: &mut ChaCha8Rng,
) -> ArmRecording {
    let goal = Reference::random(rng);
    let supply = SupplyDrift::random(rng);
    let mut gentleness = 1.0;
    loop {
        // Every attempt meets the same noise.
        let mut noise = rng.clone();
        let controller = PdController::new(believed, mount, gentleness);
        let goal = goal.scaled(gentleness);
        let recording = attempt(truth, mount, &goal, &supply, controller, &mut noise);
        if recording.is_tame() || gentleness < 0.1 {
            return recording;
        }
        gentleness *= 0.85;
    }
}

fn attempt(
    truth: &Physics,
    mount: Mount,
    goal: &Reference,
    supply: &SupplyDrift,
    mut controller: PdController,
    rng: &mut ChaCha8Rng,
) -> ArmRecording {
    let times = sample_times(rng);
    let mut arm = Arm::settled(truth, mount);
    let mut commands = ArmCommands::default();
    let mut position = Vec::with_capacity(times.len());
    let mut rate_rad_s = Vec::new();
    let mut noise = NOISE.0 * normal(rng);
    let mut noises = Vec::with_capacity(times.len());
    for (k, &time_s) in times.iter().enumerate() {
        let reading = quantised(arm.sensed() + noise);
        noises.push(noise);
        rate_rad_s.extend(arm.rate(rng));
        let asked = goal.at(time_s);
        let duty = controller.duty(&asked, reading, span_before(&times, k));
        position.push(reading);
        commands.time_s.push(time_s);
        commands.duty.push(if asked.torque_on { duty } else { 0.0 });
        commands.torque_on.push(asked.torque_on);
        commands.supply_v.push(supply.at(time_s));
        if let Some(next_s) = times.get(k + 1) {
            let span_s = next_s - time_s;
            commands.carry(&mut arm, k, span_s);
            let kept = (-span_s / NOISE.1).exp();
            noise = kept * noise + (1.0 - kept * kept).sqrt() * NOISE.0 * normal(rng);
        }
    }
    if let Some(logged) = commands.logged(&mut arm) {
        position = noisy(&logged, &noises);
    }
    ArmRecording {
        commands,
        position,
        rate_rad_s,
        mount,
    }
}

/// Rounded readings of these encoder values with this noise, rad.
pub fn noisy(sensed: &[f64], noise: &[f64]) -> Vec<f64> {
    let readings = sensed.iter().zip(noise);
    readings.map(|(q, noise)| quantised(q + noise)).collect()
}

/// When the samples of a motion are taken, s: at 100 Hz, with jitter.
pub fn sample_times(rng: &mut ChaCha8Rng) -> Vec<f64> {
    let samples = (MOTION_S / PERIOD_S) as usize + 1;
    (0..samples)
        .map(|k| rounded((k as f64 * PERIOD_S + JITTER_S * normal(rng)).max(0.0), 6))
        .collect()
}

/// Time since the sample before `k`, s.
fn span_before(times: &[f64], k: usize) -> f64 {
    if k == 0 {
        PERIOD_S
    } else {
        times[k] - times[k - 1]
    }
}

impl ArmRecording {
    /// Largest reading, rad.
    pub fn widest(&self) -> f64 {
        self.position.iter().fold(0.0, |most, q| most.max(q.abs()))
    }

    /// Largest speed of the readings, rad/s.
    pub fn fastest(&self) -> f64 {
        let span_s = SPEED_SAMPLES as f64 * PERIOD_S;
        let ends = self.position.iter().zip(&self.position[SPEED_SAMPLES..]);
        ends.map(|(from, to)| (to - from).abs() / span_s)
            .fold(0.0, f64::max)
    }

    /// Whether the arm kept clear of upright and the controller didn't rattle.
    fn is_tame(&self) -> bool {
        let clipped = self
            .commands
            .duty
            .iter()
            .filter(|duty| duty.abs() >= MOST_DUTY)
            .count();
        self.widest() <= MOST_READING_RAD
            && self.fastest() <= MOST_SPEED_RAD_S
            && (clipped as f64) <= MOST_CLIPPED * self.position.len() as f64
    }

    /// The log as a file.
    pub fn csv(&self, title: &str) -> String {
        let mut text = format!(
            "# {title}\n\
             # Time is when the sample was taken and its duty sent; duty is the share of full \
             range.\n\
             # Angle from hanging, counter-clockwise, in steps of 300 deg / 1024.\n\
             time_s,position_rad,duty,supply_v,torque_on,payload_kg,turned"
        );
        text += if self.rate_rad_s.is_empty() {
            "\n"
        } else {
            ",gyro_rad_s\n"
        };
        let commands = &self.commands;
        for k in 0..self.position.len() {
            let _ = write!(
                text,
                "{:.6},{:.7},{:.6},{:.1},{},{:.3},{}",
                commands.time_s[k],
                self.position[k],
                commands.duty[k],
                commands.supply_v[k],
                u8::from(commands.torque_on[k]),
                self.mount.payload_kg,
                u8::from(self.mount.turned),
            );
            if let Some(rate) = self.rate_rad_s.get(k) {
                let _ = write!(text, ",{rate:.2}");
            }
            text.push('\n');
        }
        text
    }
}

/// Proportional and derivative gain on the reading, and what the believed arm needs for the goal.
struct PdController<'a> {
    believed: &'a Physics,
    mount: Mount,
    gains: [f64; 2],
    before: Option<f64>,
    speed: f64,
}

impl<'a> PdController<'a> {
    fn new(believed: &'a Physics, mount: Mount, gentleness: f64) -> Self {
        let inertia = believed.inertia_at_joint(mount);
        PdController {
            believed,
            mount,
            gains: [130.0, 10.0].map(|gain| gentleness * gain * inertia),
            before: None,
            speed: 0.0,
        }
    }

    /// Duty, with six digits, for the reading, rad, `span_s` after the one before.
    fn duty(&mut self, asked: &super::reference::Setpoint, reading: f64, span_s: f64) -> f64 {
        let moved = reading - self.before.replace(reading).unwrap_or(reading);
        self.speed += 0.5 * (moved / span_s - self.speed);
        let forward = self.believed.holding(self.mount, asked.angle)
            + self.believed.inertia_at_joint(self.mount) * asked.acceleration;
        let back =
            self.gains[0] * (asked.angle - reading) + self.gains[1] * (asked.speed - self.speed);
        let duty = (forward + back) / self.believed.stall_nm;
        rounded(duty.clamp(-MOST_DUTY, MOST_DUTY), 6)
    }
}

/// A battery or a bench supply that drifts.
pub struct SupplyDrift {
    ends: [f64; 2],
    wobble: [f64; 2],
}

impl SupplyDrift {
    /// From 8.3 to 11.3 V, at least 1 V apart from end to end.
    pub fn random(rng: &mut ChaCha8Rng) -> SupplyDrift {
        loop {
            let ends = [rng.random_range(8.5..11.1), rng.random_range(8.5..11.1)];
            if f64::abs(ends[0] - ends[1]) >= 1.0 {
                let wobble = [rng.random_range(0.05..0.2), rng.random_range(0.0..TAU)];
                return SupplyDrift { ends, wobble };
            }
        }
    }

    /// Supply, V.
    pub fn at(&self, time_s: f64) -> f64 {
        let share = time_s / MOTION_S;
        let line = self.ends[0] + share * (self.ends[1] - self.ends[0]);
        (line + self.wobble[0] * (2.0 * TAU * share + self.wobble[1]).sin())
            .max(0.5 * NOMINAL_SUPPLY_V)
    }
}

/// What a 10-bit encoder with hanging in the middle makes of an angle, rad; never a negative zero.
pub fn quantised(angle: f64) -> f64 {
    (angle / Position::LSB_RAD).round().clamp(-512.0, 511.0) * Position::LSB_RAD + 0.0
}

/// To the encoder's steps, without an end of its range; never a negative zero.
pub fn stepped(angle: f64) -> f64 {
    (angle / Position::LSB_RAD).round() * Position::LSB_RAD + 0.0
}

/// A draw from the standard normal distribution (Box and Muller): another method, as in the crate
/// `rand_distr`, would change every bench and with it the figures of the benchmark.
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    let radius = (-2.0 * (1.0 - rng.random::<f64>()).ln()).sqrt();
    radius * (TAU * rng.random::<f64>()).cos()
}
