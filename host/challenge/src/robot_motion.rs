//! The robot's motions as a bench would log them: hanging from the bar it follows references,
//! upright it balances.

use super::motion::{NOISE, PERIOD_S, SupplyDrift, normal, sample_times, stepped};
use super::physics::DriveCommand;
use super::reference::Reference;
use super::regulator::{DRIVEN, Duties, RobotRegulator};
use super::robot::{Joints, LINKS, Laws, Robot};
use super::rounding::rounded;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Supply at which the stall torque holds, V.
pub const SUPPLY_V: f64 = 9.8;
/// Largest duty of the hanging robot's controller.
const MOST_DUTY: f64 = 0.8;
/// Share of duties at the largest beyond which the controller counts as rattling.
const MOST_CLIPPED: f64 = 0.15;
/// Reading, rad, and speed, rad/s, beyond which the motion is repeated more gently.
const MOST: (f64, f64) = (2.0, 15.0);
/// N m/rad, N m s/rad and the weight's torque that is held, N m, of shoulder and hip.
const GAINS: [(f64, f64, f64); DRIVEN.len()] = [(1.6, 0.12, 0.9), (0.8, 0.05, 0.4)];
/// Duty and frequencies, Hz, of the sines that probe the balancing robot.
const PROBES: [(f64, f64, f64); 3] = [(0.02, 0.2, 0.6), (0.02, 0.8, 1.6), (0.015, 2.0, 4.0)];
/// Angle off the pose, rad, at which the robot counts as fallen.
const FALLEN_RAD: f64 = 0.5;

/// What one log of the robot says.
#[derive(Debug, Clone, Default)]
pub struct RobotRecording {
    /// When each sample was taken, s.
    pub time_s: Vec<f64>,
    /// Rounded readings, rad.
    pub position: Vec<Joints>,
    /// Readings of the gyros, rad/s, of the links that have one, from the bar outwards.
    pub rates: Vec<Vec<f64>>,
    /// Duties that are sent at that time.
    pub duty: Vec<Duties>,
    /// Whether the motors are energised.
    pub torque_on: Vec<bool>,
    /// Supply, V.
    pub supply_v: Vec<f64>,
    turned: bool,
    /// Links with a gyro, counted from 0.
    gyros: Vec<usize>,
}

/// Longest delay of a drive, s.
pub fn late(laws: &Laws) -> f64 {
    let delays = DRIVEN.map(|k| laws.joints[k].delay_s);
    delays.into_iter().fold(0.0, f64::max)
}

impl RobotRecording {
    fn of(laws: &Laws) -> Self {
        RobotRecording {
            turned: laws.turned,
            gyros: laws.gyros(),
            ..RobotRecording::default()
        }
    }

    /// Duty of a drive that arrives at `time_s`; 0 before the first.
    fn arriving(&self, drive: usize, time_s: f64) -> f64 {
        let index = self.time_s.iter().rposition(|&sent_s| sent_s <= time_s);
        index.map_or(0.0, |index| self.duty[index][drive])
    }

    /// Carries the robot on from the last sample by `span_s`.
    fn carry(&self, robot: &mut Robot, laws: &Laws, span_s: f64) {
        let last = self.time_s.len() - 1;
        robot.advance(span_s, |since_s| {
            std::array::from_fn(|k| {
                let drive = DRIVEN.iter().position(|&driven| driven == k);
                let sent_s = self.time_s[last] + since_s - laws.joints[k].delay_s;
                DriveCommand {
                    duty: drive.map_or(0.0, |drive| {
                        if laws.joints[k].delay_s == 0.0 {
                            self.duty[last][drive]
                        } else {
                            self.arriving(drive, sent_s)
                        }
                    }),
                    supply_v: self.supply_v[last],
                    torque_on: self.torque_on[last],
                }
            })
        });
    }

    fn add(&mut self, time_s: f64, position: Joints, duty: Duties, on: bool, supply_v: f64) {
        self.time_s.push(time_s);
        self.position.push(position);
        self.duty.push(if on { duty } else { [0.0; DRIVEN.len()] });
        self.torque_on.push(on);
        self.supply_v.push(supply_v);
    }

    /// Puts what the log holds where its columns are off in time in the place of what was read with
    /// this noise, after the robot has been driven to the last sample.
    fn read_off_time(&mut self, robot: &mut Robot, laws: &Laws, noises: &[Noise]) {
        let late_s = |k: usize| laws.joints[k].logged_late_s;
        let early_s = (0..LINKS).map(|k| -late_s(k)).fold(0.0, f64::max);
        if early_s > 0.0 {
            self.carry(robot, laws, early_s);
        }
        let rows = self.time_s.iter().zip(&mut self.position).zip(noises);
        for ((time_s, position), noise) in rows {
            let readings = noise.readings(robot.logged(time_s - self.time_s[0]));
            for k in (0..LINKS).filter(|k| late_s(*k) != 0.0) {
                position[k] = readings[k];
            }
        }
    }

    /// The log as a file.
    pub fn csv(&self, title: &str) -> String {
        let mut text = format!(
            "# {title}\n\
             # Time is when the sample was taken and its duties sent.\n\
             # Duty is the share of full range.\n\
             # Angles from hanging, counter-clockwise, in steps of 300 deg / 1024.\n\
             time_s,q1_rad,q2_rad,q3_rad,duty2,duty3,supply_v,torque_on,payload_kg,turned"
        );
        for k in &self.gyros {
            let _ = write!(text, ",gyro{}_rad_s", k + 1);
        }
        text.push('\n');
        for k in 0..self.time_s.len() {
            let _ = write!(text, "{:.6}", self.time_s[k]);
            for angle in self.position[k] {
                let _ = write!(text, ",{angle:.7}");
            }
            for duty in self.duty[k] {
                let _ = write!(text, ",{duty:.6}");
            }
            let (on, turned) = (u8::from(self.torque_on[k]), u8::from(self.turned));
            let _ = write!(text, ",{:.1},{on},0.000,{turned}", self.supply_v[k]);
            for rate in &self.rates[k] {
                let _ = write!(text, ",{rate:.2}");
            }
            text.push('\n');
        }
        text
    }
}

/// Noise of the encoders, correlated in time.
#[derive(Clone, Copy)]
struct Noise(Joints);

impl Noise {
    fn new(rng: &mut ChaCha8Rng) -> Self {
        Noise(std::array::from_fn(|_| NOISE.0 * normal(rng)))
    }

    fn readings(&self, sensed: Joints) -> Joints {
        std::array::from_fn(|k| stepped(sensed[k] + self.0[k]))
    }

    fn advance(&mut self, span_s: f64, rng: &mut ChaCha8Rng) {
        let kept = (-span_s / NOISE.1).exp();
        for noise in &mut self.0 {
            *noise = kept * *noise + (1.0 - kept * kept).sqrt() * NOISE.0 * normal(rng);
        }
    }
}

/// Where the robot comes to rest when it is let go at 0, its friction raised for that.
fn settled(laws: &Laws) -> Joints {
    let mut damped = laws.clone();
    for joint in &mut damped.joints {
        joint.viscous += 0.02;
    }
    let mut robot = Robot::new(&damped, [0.0; LINKS], [0.0; LINKS]);
    let released = DriveCommand {
        duty: 0.0,
        supply_v: SUPPLY_V,
        torque_on: false,
    };
    robot.advance(5.0, |_| [released; LINKS]);
    robot.angle
}

/// A motion of the hanging robot, repeated more gently until it stays clear of standing upright.
pub fn hang(laws: &Laws, rng: &mut ChaCha8Rng) -> RobotRecording {
    let goals = DRIVEN.map(|_| Reference::random(rng));
    let supply = SupplyDrift::random(rng);
    let start = settled(laws);
    let mut gentleness = 1.0;
    loop {
        // Every attempt meets the same noise.
        let mut noise = rng.clone();
        let (recording, tame) = hang_once(laws, start, &goals, &supply, gentleness, &mut noise);
        if tame || gentleness < 0.1 {
            return recording;
        }
        gentleness *= 0.8;
    }
}

fn hang_once(
    laws: &Laws,
    start: Joints,
    goals: &[Reference; DRIVEN.len()],
    supply: &SupplyDrift,
    gentleness: f64,
    rng: &mut ChaCha8Rng,
) -> (RobotRecording, bool) {
    let goals: Vec<Reference> = goals.iter().map(|goal| goal.scaled(gentleness)).collect();
    let mut recording = RobotRecording::of(laws);
    let times = sample_times(rng);
    let mut robot = Robot::new(laws, start, [0.0; LINKS]);
    let (mut noise, mut noises) = (Noise::new(rng), Vec::with_capacity(times.len()));
    let (mut speed, mut clipped) = ([0.0; DRIVEN.len()], 0);
    for (k, &time_s) in times.iter().enumerate() {
        let readings = noise.readings(robot.sensed());
        noises.push(noise);
        recording.rates.push(robot.rates(rng));
        // One goal tells when the motors rest.
        let on = goals[0].at(time_s).torque_on;
        let duty = std::array::from_fn(|drive| {
            let (joint, asked) = (DRIVEN[drive], goals[drive].at(time_s));
            let before = recording.position.last().unwrap_or(&readings)[joint];
            speed[drive] += 0.5 * ((readings[joint] - before) / PERIOD_S - speed[drive]);
            let (stiff, damp, weight) = GAINS[drive];
            let back =
                stiff * (asked.angle - readings[joint]) + damp * (asked.speed - speed[drive]);
            let torque = gentleness * back + weight * asked.angle.sin();
            let duty = torque / laws.joints[joint].stall_nm;
            rounded(duty.clamp(-MOST_DUTY, MOST_DUTY), 6)
        });
        clipped += duty.iter().filter(|duty| duty.abs() >= MOST_DUTY).count();
        recording.add(time_s, readings, duty, on, supply.at(time_s));
        let fast = recording.position[k.saturating_sub(4)];
        let ends = readings.iter().zip(&fast);
        if ends.clone().any(|(now, _)| now.abs() > MOST.0)
            || ends
                .clone()
                .any(|(now, then)| (now - then).abs() > MOST.1 * 4.0 * PERIOD_S)
        {
            return (recording, false);
        }
        if let Some(next_s) = times.get(k + 1) {
            recording.carry(&mut robot, laws, next_s - time_s);
            noise.advance(next_s - time_s, rng);
        }
    }
    recording.read_off_time(&mut robot, laws, &noises);
    let most = MOST_CLIPPED * (times.len() * DRIVEN.len()) as f64;
    (recording, clipped as f64 <= most)
}

/// A motion of the balancing robot; none where it falls. `smooth` are the laws that its regulator
/// knows: those without dry friction and dead zones.
pub fn balance(laws: &Laws, smooth: &Laws, rng: &mut ChaCha8Rng) -> Option<RobotRecording> {
    let mut regulator = RobotRegulator::upright(smooth)?;
    let supply = SupplyDrift::random(rng);
    let sines: [[[f64; 3]; PROBES.len()]; DRIVEN.len()] = DRIVEN.map(|_| {
        PROBES.map(|(duty, low_hz, high_hz)| {
            [
                duty * rng.random_range(0.7..1.3),
                rng.random_range(low_hz..high_hz),
                rng.random_range(0.0..TAU),
            ]
        })
    });
    let start = regulator.pose.map(|q| q + rng.random_range(-0.003..0.003));
    let mut recording = RobotRecording::of(laws);
    let times = sample_times(rng);
    let mut robot = Robot::new(laws, start, [0.0; LINKS]);
    let (mut noise, mut noises) = (Noise::new(rng), Vec::with_capacity(times.len()));
    for (k, &time_s) in times.iter().enumerate() {
        let probe = sines.map(|sines| {
            let wave = |[a, f, p]: [f64; 3]| a * (TAU * f * time_s + p).sin();
            sines.into_iter().map(wave).sum()
        });
        let readings = noise.readings(robot.sensed());
        noises.push(noise);
        recording.rates.push(robot.rates(rng));
        let duty = regulator.duty(&robot.angle, &robot.speed, &probe);
        let duty = duty.map(|duty| rounded(duty, 6));
        recording.add(time_s, readings, duty, true, supply.at(time_s));
        if let Some(next_s) = times.get(k + 1) {
            recording.carry(&mut robot, laws, next_s - time_s);
            noise.advance(next_s - time_s, rng);
        }
        let off = robot.angle.iter().zip(&regulator.pose);
        if off.into_iter().any(|(q, at)| (q - at).abs() > FALLEN_RAD) {
            return None;
        }
    }
    recording.read_off_time(&mut robot, laws, &noises);
    Some(recording)
}
