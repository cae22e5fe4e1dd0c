//! The state a window starts from: unknown, guessed from the measurement, then fitted.

use super::data::{Data, Window};
use crate::sim::{Plant, Start};

/// Start of a window: readings and speeds, per joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// What the encoders read, rad in the log's convention.
    pub reading_rad: Vec<f64>,
    /// Joint speeds as the log's angles change, rad/s (absolute where the log's angles are).
    pub speed_rad_s: Vec<f64>,
}

impl Node {
    /// The node a local parabola through the first samples suggests.
    pub fn guess(data: &Data, window: &Window) -> Node {
        let motion = &data.motions[window.motion];
        let joints = motion.position_rad.len();
        let mut node = Node {
            reading_rad: Vec::with_capacity(joints),
            speed_rad_s: Vec::with_capacity(joints),
        };
        for joint in 0..joints {
            let (angle, speed) = local_line(
                &motion.time_s,
                &motion.position_rad[joint],
                window.samples.start,
            );
            let logged = motion.velocity_rad_s[joint]
                .as_ref()
                .map(|v| v[window.samples.start]);
            node.reading_rad.push(angle);
            node.speed_rad_s
                .push(logged.filter(|v| v.is_finite()).unwrap_or(speed));
        }
        node
    }

    /// The simulator's start state.
    pub fn start(&self, plant: &Plant) -> Start {
        let mut speed = self.speed_rad_s.clone();
        if plant.is_absolute() {
            for joint in (1..speed.len()).rev() {
                speed[joint] -= speed[joint - 1];
            }
        }
        Start {
            angle_rad: plant.decode_rad(&self.reading_rad),
            speed_rad_s: speed,
        }
    }

    /// Number of unknowns: an angle and a speed per joint.
    pub fn unknowns(&self) -> usize {
        2 * self.reading_rad.len()
    }

    /// Unknown `i`: the angles first, then the speeds.
    pub fn at(&mut self, i: usize) -> &mut f64 {
        let joints = self.reading_rad.len();
        if i < joints {
            &mut self.reading_rad[i]
        } else {
            &mut self.speed_rad_s[i - joints]
        }
    }
}

/// Value and slope at sample `at` of a parabola through its neighbours within about 60 ms (at least 5 samples).
fn local_line(time_s: &[f64], values: &[f64], at: usize) -> (f64, f64) {
    let reach = 0.06;
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
    let mut normal = nalgebra::Matrix3::<f64>::zeros();
    let mut right = nalgebra::Vector3::<f64>::zeros();
    for k in first..=last {
        if !values[k].is_finite() {
            continue;
        }
        let x = (time_s[k] - time_s[at]) / reach;
        let row = nalgebra::Vector3::new(1.0, x, x * x);
        normal += row * row.transpose();
        right += row * values[k];
    }
    for i in 0..3 {
        normal[(i, i)] += 1e-9;
    }
    match normal.cholesky() {
        Some(cholesky) => {
            let c = cholesky.solve(&right);
            (c[0], c[1] / reach)
        }
        None => (values[at], 0.0),
    }
}
