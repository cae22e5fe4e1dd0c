//! The state a window starts from: unknown, guessed from the measurement, then fitted close to the guess.

use super::data::{Data, Window};
use crate::sim::{Plant, Start};

/// Start of a window: readings, and how they change, per joint. Where a sensor trails, the angle is found from the
/// readings' speed and the joint's speed from their acceleration.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// What the encoders read, rad in the log's convention.
    pub reading_rad: Vec<f64>,
    /// Joint speeds as the log's angles change, rad/s (absolute where the log's angles are).
    pub speed_rad_s: Vec<f64>,
    /// How these speeds change, rad/s^2; tells nothing where no sensor trails.
    pub acceleration_rad_s2: Vec<f64>,
}

/// What the samples around a window's start say of it, and how surely.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Guess {
    pub node: Node,
    /// Standard deviations of the node's unknowns: angles, speeds, then accelerations.
    pub deviation: Vec<f64>,
}

/// How many standard deviations a start state may lie from the guess.
const REACH_DEVIATIONS: f64 = 6.0;
/// No start angle is known better than this, however smooth the log: smoothing and rounding leave slow errors that
/// neighbouring samples share.
const LEAST_RAD: f64 = 2e-4;
/// The same for a start speed.
const LEAST_RAD_S: f64 = 4e-3;
/// The same for a start acceleration.
const LEAST_RAD_S2: f64 = 0.1;
/// Half the span of the samples that tell a window's start.
const REACH_S: f64 = 0.06;

impl Guess {
    /// From a parabola through the samples around the window's start.
    pub fn of(data: &Data, window: &Window) -> Guess {
        let motion = &data.motions[window.motion];
        let joints = motion.position_rad.len();
        let mut guess = Guess {
            node: Node {
                reading_rad: vec![0.0; joints],
                speed_rad_s: vec![0.0; joints],
                acceleration_rad_s2: vec![0.0; joints],
            },
            deviation: vec![0.0; 3 * joints],
        };
        for joint in 0..joints {
            let (time, position) = (&motion.time_s, &motion.position_rad[joint]);
            let line = local_line(time, position, window.samples.start, REACH_S);
            let near = local_line(time, position, window.samples.start, REACH_S / 2.0);
            let sigma = data.sigma_rad[joint];
            guess.node.reading_rad[joint] = line.value;
            guess.node.speed_rad_s[joint] = line.slope;
            guess.node.acceleration_rad_s2[joint] = line.bend;
            // Where a shorter parabola says otherwise, the motion is no parabola.
            guess.deviation[joint] =
                LEAST_RAD + sigma * line.value_gain + (line.value - near.value).abs();
            guess.deviation[joints + joint] =
                LEAST_RAD_S + sigma * line.slope_gain + (line.slope - near.slope).abs();
            guess.deviation[2 * joints + joint] =
                LEAST_RAD_S2 + sigma * line.bend_gain + (line.bend - near.bend).abs();
            let logged = motion.velocity_rad_s[joint]
                .as_ref()
                .map(|v| v[window.samples.start]);
            if let Some(speed) = logged.filter(|v| v.is_finite()) {
                // A logged speed helps where it agrees; how good it is nobody says.
                if (speed - line.slope).abs() < 4.0 * guess.deviation[joints + joint] {
                    guess.node.speed_rad_s[joint] = speed;
                }
            }
        }
        guess
    }

    /// Which unknowns lie on the edge of what the samples allow, and on which side: -1, +1, or 0 inside.
    pub fn edges(&self, node: &Node) -> Vec<f64> {
        let (mut node, mut middle) = (node.clone(), self.node.clone());
        (0..node.unknowns())
            .map(|i| {
                let reach = REACH_DEVIATIONS * self.deviation[i];
                let off = *node.at(i) - *middle.at(i);
                if off.abs() >= reach * (1.0 - 1e-9) {
                    off.signum()
                } else {
                    0.0
                }
            })
            .collect()
    }

    /// Keeps a node within six standard deviations: what a start state can't be, it may not absorb.
    pub fn clamp(&self, node: &mut Node) {
        let mut middle = self.node.clone();
        for i in 0..node.unknowns() {
            let reach = REACH_DEVIATIONS * self.deviation[i];
            let middle = *middle.at(i);
            let value = node.at(i);
            *value = value.clamp(middle - reach, middle + reach);
        }
    }
}

impl Node {
    /// The node the samples around a window's start suggest.
    pub fn guess(data: &Data, window: &Window) -> Node {
        Guess::of(data, window).node
    }

    /// The simulator's start state.
    pub fn start(&self, plant: &Plant) -> Start {
        let (reading, speed) = (&self.reading_rad, &self.speed_rad_s);
        Start {
            angle_rad: plant.decode_rad(&plant.ahead_rad(reading, speed)),
            speed_rad_s: plant.decode_rad_s(&plant.ahead_rad(speed, &self.acceleration_rad_s2)),
            reading_rad_s: Some(speed.clone()),
        }
    }

    /// Number of unknowns: an angle, a speed and an acceleration per joint.
    pub fn unknowns(&self) -> usize {
        3 * self.reading_rad.len()
    }

    /// Unknown `i`: the angles first, then the speeds, then the accelerations.
    pub fn at(&mut self, i: usize) -> &mut f64 {
        let joints = self.reading_rad.len();
        match i / joints {
            0 => &mut self.reading_rad[i],
            1 => &mut self.speed_rad_s[i - joints],
            _ => &mut self.acceleration_rad_s2[i - 2 * joints],
        }
    }
}

/// Value, slope and second derivative of a local parabola, and their standard deviations per unit of measurement noise.
struct LocalLine {
    value: f64,
    slope: f64,
    value_gain: f64,
    slope_gain: f64,
    bend: f64,
    bend_gain: f64,
}

/// Fits a parabola around sample `at` to its neighbours within `reach` seconds (at least 5 samples).
fn local_line(time_s: &[f64], values: &[f64], at: usize, reach: f64) -> LocalLine {
    let mut first = at;
    while first > 0 && time_s[at] - time_s[first - 1] <= reach {
        first -= 1;
    }
    let mut last = at;
    while last + 1 < values.len() && (time_s[last + 1] - time_s[at] <= reach || last < at + 2) {
        last += 1;
    }
    while last - first < 4 && first > 0 {
        first -= 1;
    }
    while last - first < 4 && last + 1 < values.len() {
        last += 1;
    }
    let mut normal = nalgebra::Matrix3::<f64>::identity() * 1e-9;
    let mut right = nalgebra::Vector3::<f64>::zeros();
    for k in (first..=last).filter(|&k| values[k].is_finite()) {
        let x = (time_s[k] - time_s[at]) / reach;
        let row = nalgebra::Vector3::new(1.0, x, x * x);
        normal += row * row.transpose();
        right += row * values[k];
    }
    match normal.try_inverse() {
        Some(inverse) => {
            let c = inverse * right;
            LocalLine {
                value: c[0],
                slope: c[1] / reach,
                value_gain: inverse[(0, 0)].sqrt(),
                slope_gain: inverse[(1, 1)].sqrt() / reach,
                bend: 2.0 * c[2] / reach.powi(2),
                bend_gain: 2.0 * inverse[(2, 2)].sqrt() / reach.powi(2),
            }
        }
        None => LocalLine {
            value: values[at],
            slope: 0.0,
            value_gain: 1.0,
            slope_gain: 1.0 / reach,
            bend: 0.0,
            bend_gain: 1.0 / reach.powi(2),
        },
    }
}
