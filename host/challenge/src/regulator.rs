//! A sampled regulator that balances the robot: it is there so that there are logs of balancing,
//! and may know all of the truth.

use super::motion::PERIOD_S;
use super::physics::DriveCommand;
use super::robot::{Joints, LINKS, Laws, Robot};
use super::robot_motion::{SUPPLY_V, late};
use nalgebra::{DMatrix, DVector};

/// Driven joints, counted from 0.
pub const DRIVEN: [usize; 2] = [1, 2];
/// Duties of the driven joints.
pub type Duties = [f64; DRIVEN.len()];

/// u = holding - K x, with the duties still on their way in x.
#[derive(Debug)]
pub struct RobotRegulator {
    gain: DMatrix<f64>,
    /// The pose that is held, rad.
    pub pose: Joints,
    /// Duties that hold it.
    pub holding: Duties,
    /// Deviations of the duties still on their way, oldest first.
    sent: Vec<Duties>,
}

impl RobotRegulator {
    /// About the upright pose of these laws, which must be smooth there; none where there is no
    /// such pose, or no regulator.
    pub fn upright(laws: &Laws) -> Option<RobotRegulator> {
        let pose = upright(laws)?;
        let torque = laws.holding(&pose);
        // A torque is asked for by a duty: what arrives of full duty, at the same supply.
        let holding = DRIVEN.map(|k| {
            let drive = |duty| laws.joints[k].drive(command(duty), 0.0);
            torque[k] / ((drive(0.05) - drive(-0.05)) / 0.1)
        });
        let (a, b) = linear(laws, &pose, &holding);
        let past = (a.nrows() - 2 * LINKS) / DRIVEN.len();
        let weight = |k: usize| [100.0, 1.0, 0.0][(k / LINKS).min(2)];
        let q = DMatrix::from_diagonal(&DVector::from_fn(a.nrows(), |k, _| weight(k)));
        let r = DMatrix::from_fn(DRIVEN.len(), DRIVEN.len(), |k, l| {
            if k == l {
                laws.joints[DRIVEN[k]].stall_nm.powi(2)
            } else {
                0.0
            }
        });
        Some(RobotRegulator {
            gain: riccati(&a, &b, &q, &r)?,
            pose,
            holding,
            sent: vec![[0.0; DRIVEN.len()]; past],
        })
    }

    /// Duty for this state, `probe` added to it.
    pub fn duty(&mut self, angle: &Joints, speed: &Joints, probe: &Duties) -> Duties {
        let moved = angle.iter().zip(&self.pose).map(|(q, at)| q - at);
        let state = moved
            .chain(*speed)
            .chain(self.sent.iter().flatten().copied());
        let state = DVector::from_iterator(self.gain.ncols(), state);
        let back = &self.gain * state;
        let duty = |k: usize| (self.holding[k] - back[k] + probe[k]).clamp(-1.0, 1.0);
        let duty: Duties = std::array::from_fn(duty);
        if !self.sent.is_empty() {
            self.sent.remove(0);
            self.sent
                .push(std::array::from_fn(|k| duty[k] - self.holding[k]));
        }
        duty
    }
}

/// Straight driven joints, the first where nothing pulls it; by Newton's method.
fn upright(laws: &Laws) -> Option<Joints> {
    let pull = |lean: f64| laws.holding(&[lean, 0.0, 0.0])[0];
    let mut lean = std::f64::consts::PI;
    for _ in 0..50 {
        let slope = (pull(lean + 1e-5) - pull(lean - 1e-5)) / 2e-5;
        lean -= pull(lean) / slope;
    }
    (pull(lean).abs() < 1e-9 && (lean - std::f64::consts::PI).abs() < 0.6)
        .then_some([lean, 0.0, 0.0])
}

fn command(duty: f64) -> DriveCommand {
    DriveCommand {
        duty,
        supply_v: SUPPLY_V,
        torque_on: true,
    }
}

/// State after one sample from a state and duties, oldest first, as deviations from the pose.
fn after(laws: &Laws, pose: &Joints, holding: &Duties, x: &[f64], sent: &[Duties]) -> Vec<f64> {
    let angle = std::array::from_fn(|k| pose[k] + x[k]);
    let speed = std::array::from_fn(|k| x[LINKS + k]);
    let mut robot = Robot::new(laws, angle, speed);
    let now = sent.len() - 1;
    robot.advance(PERIOD_S, |since_s| {
        std::array::from_fn(|k| {
            let Some(drive) = DRIVEN.iter().position(|&driven| driven == k) else {
                return command(0.0);
            };
            let ago = ((laws.joints[k].delay_s - since_s) / PERIOD_S)
                .ceil()
                .max(0.0) as usize;
            command(holding[drive] + sent[now - ago.min(now)][drive])
        })
    });
    let moved = robot.angle.iter().zip(pose).map(|(q, at)| q - at);
    moved.chain(robot.speed).collect()
}

/// The sampled robot about the pose, by differences: its state, then the duties still on their way.
fn linear(laws: &Laws, pose: &Joints, holding: &Duties) -> (DMatrix<f64>, DMatrix<f64>) {
    let (states, inputs) = (2 * LINKS, DRIVEN.len());
    let past = (late(laws) / PERIOD_S).ceil() as usize;
    let size = states + inputs * past;
    let mut a = DMatrix::zeros(size, size);
    let mut b = DMatrix::zeros(size, inputs);
    let column = |x: &dyn Fn(f64) -> (Vec<f64>, Vec<Duties>), by: f64| -> Vec<f64> {
        let side = |by| {
            let (x, sent) = x(by);
            after(laws, pose, holding, &x, &sent)
        };
        let (up, down) = (side(by), side(-by));
        up.iter()
            .zip(down)
            .map(|(u, d)| (u - d) / (2.0 * by))
            .collect()
    };
    let still = || (vec![0.0; states], vec![[0.0; DRIVEN.len()]; past + 1]);
    for k in 0..states {
        let moved = column(
            &|by| {
                let (mut x, sent) = still();
                x[k] = by;
                (x, sent)
            },
            1e-5,
        );
        for (row, value) in moved.into_iter().enumerate() {
            a[(row, k)] = value;
        }
    }
    for age in 0..=past {
        for k in 0..inputs {
            let moved = column(
                &|by| {
                    let (x, mut sent) = still();
                    sent[age][k] = by;
                    (x, sent)
                },
                1e-4,
            );
            for (row, value) in moved.into_iter().enumerate() {
                if age == past {
                    b[(row, k)] = value
                } else {
                    a[(row, states + inputs * age + k)] = value
                }
            }
        }
    }
    for age in 0..past {
        for k in 0..inputs {
            let row = states + inputs * age + k;
            if age + 1 < past {
                a[(row, row + inputs)] = 1.0
            } else {
                b[(row, k)] = 1.0
            }
        }
    }
    (a, b)
}

/// Gain of the regulator, by iterating the Riccati equation.
fn riccati(
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
    q: &DMatrix<f64>,
    r: &DMatrix<f64>,
) -> Option<DMatrix<f64>> {
    let mut p = q.clone();
    for _ in 0..20_000 {
        let gain = (r + b.transpose() * &p * b)
            .cholesky()?
            .solve(&(b.transpose() * &p * a));
        let next = q + a.transpose() * &p * (a - b * &gain);
        let change = (&next - &p).amax();
        p = 0.5 * (&next + next.transpose());
        if change <= 1e-11 * p.amax() {
            return Some(gain);
        }
    }
    None
}
