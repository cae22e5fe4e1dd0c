//! Shooting nodes: the state a window starts from, guessed from the measurement, then fitted close
//! to the guess.

use super::assumed::{AssumedJoint, AssumedStates};
use super::horizon::Window;
use crate::motion::Motion;
use crate::sim::{HiddenQuantity, HiddenUnknown, Plant, StartState};
use nalgebra::{DVector, Matrix3, Vector3};

/// Start state of a window with n joints: 3 n unknowns, and those that no reading tells. Where a
/// sensor trails, the angle follows from the readings' speed and the joint's speed from their
/// acceleration; so where columns are off in time by different times.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowStart {
    /// What the n encoders read, rad in the log's convention; then how the log's angles change,
    /// rad/s; then how these speeds change, rad/s^2, which says nothing where no sensor trails and
    /// all columns are off by the same time. Behind these, what is hidden, in the order of
    /// [`Plant::hidden`]; as the window before leaves it, where they are missing.
    pub unknowns: DVector<f64>,
}

/// What the samples around a window's start say of its state, and how surely.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StartGuess {
    pub window_start: WindowStart,
    /// Standard deviations of the start's unknowns.
    pub deviation: DVector<f64>,
    /// The least and the most that they may be: so many deviations off, but for shares.
    low: DVector<f64>,
    high: DVector<f64>,
}

/// How many standard deviations a start state may lie from the guess.
const REACH_DEVIATIONS: f64 = 6.0;
/// No start angle, rad, speed, rad/s, and acceleration, rad/s^2, is known better than this (of a
/// slide, no displacement in m, and so on: 0.2 mm are less than its rail bends), however
/// smooth the log: smoothing and rounding leave slow errors that neighbouring samples share.
const LEAST_DEVIATIONS: [f64; 3] = [2e-4, 4e-3, 0.1];
/// By how many times the doubt of its joint's start what is hidden there may differ from what the
/// window before left, in whose course errors have grown; and by which share of all it can be.
const HIDDEN_DEVIATIONS: f64 = 6.0;
const SHARE_DEVIATION: f64 = 0.5;
/// What was before a log is as much of the share that it can be: anything.
const BEFORE_DEVIATION: f64 = 1.0;
/// Half the span of the samples that determine a window's start.
pub(super) const REACH_S: f64 = 0.06;
/// Standard deviation of a speed of which nothing is known, rad/s.
const SPEED_UNKNOWN_RAD_S: f64 = 2.0;

impl StartGuess {
    /// From a parabola through the samples around the window's start; `sigma` is each joint's
    /// noise, `assumed` says where joints are whose angle is not measured.
    pub fn of(
        motion: &Motion,
        sigma: &[f64],
        assumed: &AssumedStates,
        window: &Window,
    ) -> StartGuess {
        let (joints, first) = (motion.position_rad.len(), window.samples.start);
        let mut unknowns = DVector::zeros(3 * joints);
        let mut deviation = DVector::zeros(3 * joints);
        for (joint, position) in motion.position_rad.iter().enumerate() {
            let time = &motion.time_s;
            if let Some(state) = &assumed[joint] {
                let rate = (sigma[joint], motion.velocity_rad_s[joint].as_deref());
                let guessed = assumed_start(time, state, rate, first);
                for (order, (value, own)) in guessed.into_iter().enumerate() {
                    unknowns[order * joints + joint] = value;
                    deviation[order * joints + joint] = own;
                }
                continue;
            }
            let [wide, near] = LocalParabola::wide_and_near(time, position, first);
            for (order, least) in LEAST_DEVIATIONS.into_iter().enumerate() {
                let at = order * joints + joint;
                unknowns[at] = wide.derivatives[order];
                // Where a shorter parabola says otherwise, the motion is no parabola.
                deviation[at] = least
                    + sigma[joint] * wide.gains[order]
                    + (wide.derivatives[order] - near.derivatives[order]).abs();
                // A sensor that trails tells a change of the acceleration from nowhere to this, or
                // back, too late.
                if order == 2 {
                    deviation[at] += wide.derivatives[order].abs();
                }
            }
            let speed = joints + joint;
            let logged = motion.velocity_rad_s[joint].as_ref().map(|v| v[first]);
            // A logged speed helps where it agrees; how good it is nobody says.
            let agrees = |v: &f64| (v - unknowns[speed]).abs() < 4.0 * deviation[speed];
            if let Some(logged) = logged.filter(|v| v.is_finite()).filter(agrees) {
                unknowns[speed] = logged;
            }
        }
        let reach = REACH_DEVIATIONS * &deviation;
        StartGuess {
            low: &unknowns - &reach,
            high: &unknowns + &reach,
            window_start: WindowStart { unknowns },
            deviation,
        }
    }

    /// Has what is hidden as unknowns, too: expected as it is `left` by the window before, the less
    /// surely the less the samples say of its joint. What is unknown of a motion each of its
    /// `windows` has, as much of the same doubt.
    pub fn hide(&mut self, hidden: &[HiddenUnknown], left: &[f64], windows: usize) {
        let joints = self.window_start.unknowns.len() / 3;
        let before = BEFORE_DEVIATION * (windows.max(1) as f64).sqrt();
        for (unknown, left) in hidden.iter().zip(left) {
            let doubt =
                |order: usize| HIDDEN_DEVIATIONS * self.deviation[order * joints + unknown.joint];
            let (middle, deviation, (low, high)) = match unknown.quantity {
                HiddenQuantity::Share { scale } => {
                    let deviation = (doubt(0) / scale).min(SHARE_DEVIATION);
                    (left.clamp(-1.0, 1.0), deviation, (-1.0, 1.0))
                }
                HiddenQuantity::Before { .. } => (0.0, before, (-1.0, 1.0)),
                HiddenQuantity::Amount { .. } => (0.0, before, (0.0, 1.0)),
                HiddenQuantity::Place { .. } | HiddenQuantity::Speed { .. } => {
                    (left.clamp(-1.0, 1.0), before, (-1.0, 1.0))
                }
                HiddenQuantity::Rate => {
                    let reach = REACH_DEVIATIONS * doubt(1);
                    let middle = left.clamp(-reach, reach);
                    (middle, doubt(1), (-reach, reach))
                }
            };
            push(&mut self.window_start.unknowns, middle);
            push(&mut self.deviation, deviation);
            push(&mut self.low, low);
            push(&mut self.high, high);
        }
    }

    /// Which unknowns lie on the edge of what the samples allow, and on which side: -1, +1, or 0
    /// inside.
    pub fn edges(&self, window_start: &WindowStart) -> Vec<f64> {
        let edge = |i: usize| {
            let (value, near) = (window_start.unknowns[i], 1e-9 * self.deviation[i]);
            match () {
                () if value <= self.low[i] + near => -1.0,
                () if value >= self.high[i] - near => 1.0,
                () => 0.0,
            }
        };
        (0..window_start.unknowns.len()).map(edge).collect()
    }

    /// Keeps it within what the samples allow: what a start state can't be, it may not absorb.
    pub fn clamp(&self, window_start: &mut WindowStart) {
        for (i, value) in window_start.unknowns.iter_mut().enumerate() {
            *value = value.clamp(self.low[i], self.high[i]);
        }
    }

    /// Precision of each unknown of a window start, and its distance to the guess.
    pub fn prior(&self, window_start: &WindowStart) -> (DVector<f64>, DVector<f64>) {
        let precision = self.deviation.map(|deviation| deviation.powi(-2));
        (
            precision,
            &self.window_start.unknowns - &window_start.unknowns,
        )
    }
}

impl WindowStart {
    /// The start that the samples around it suggest.
    pub(super) fn guess(
        motion: &Motion,
        sigma: &[f64],
        assumed: &AssumedStates,
        window: &Window,
    ) -> WindowStart {
        StartGuess::of(motion, sigma, assumed, window).window_start
    }

    /// Has what is hidden as unknowns, too: what of it is not known as it is expected.
    pub(super) fn hide_as(&mut self, guess: &StartGuess) {
        let expected = &guess.window_start.unknowns;
        for i in self.unknowns.len()..expected.len() {
            push(&mut self.unknowns, expected[i]);
        }
        guess.clamp(self);
    }

    /// The same without what is hidden.
    pub(super) fn forget_hidden(&mut self, joints: usize) {
        self.unknowns.resize_vertically_mut(3 * joints, 0.0);
    }

    /// What is hidden, if that is told.
    pub(super) fn hidden(&self, plant: &Plant) -> &[f64] {
        &self.unknowns.as_slice()[3 * plant.len()..]
    }

    /// The simulator's start state.
    pub fn start(&self, plant: &Plant) -> StartState {
        let joints = plant.len();
        let (reading, rates) = self.unknowns.as_slice().split_at(joints);
        let (speed, rates) = rates.split_at(joints);
        let acceleration = &rates[..joints];
        let [reading, speed] = plant.at_begin([reading, speed, acceleration]);
        StartState {
            angle_rad: plant.decode_rad(&plant.ahead_rad(&reading, &speed)),
            speed_rad_s: plant.decode_rad_s(&plant.ahead_rad_s(&speed, acceleration)),
            reading_slope: Some(plant.reading_slopes(&speed, acceleration)),
        }
    }
}

/// What the samples around one say of a window that begins there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct StartDoubt {
    /// How much farther than noise alone they lie from a parabola, in standard deviations of what
    /// noise does; of the joint of which they lie farthest. Joints whose angle is not measured say
    /// nothing.
    pub doubt: f64,
    /// How many joints they show at rest, which may be the reading's alone: one that hangs within
    /// its play tells nothing of the joint.
    pub at_rest: usize,
}

impl StartDoubt {
    pub fn at(motion: &Motion, sigma: &[f64], at: usize) -> StartDoubt {
        let mut found = StartDoubt {
            doubt: 0.0,
            at_rest: 0,
        };
        for (position, sigma) in motion.position_rad.iter().zip(sigma) {
            let parabola = LocalParabola::around(&motion.time_s, position, at, REACH_S);
            let usual = parabola.spare as f64;
            if usual > 0.0 {
                let left = parabola.left / sigma.powi(2);
                found.doubt = found.doubt.max((left - usual) / (2.0 * usual).sqrt());
                let deviation = sigma * parabola.gains[1];
                found.at_rest += usize::from(parabola.derivatives[1].abs() < 3.0 * deviation);
            }
        }
        found
    }
}

fn push(values: &mut DVector<f64>, value: f64) {
    values.resize_vertically_mut(values.len() + 1, value);
}

/// Angle, speed and acceleration of a joint whose angle is not measured, each with its standard
/// deviation; `rate` is the noise of its rate, and the rate if that is measured.
fn assumed_start(
    time_s: &[f64],
    state: &AssumedJoint,
    (sigma, rate): (f64, Option<&[f64]>),
    first: usize,
) -> [(f64, f64); 3] {
    let angle = (state.angle_rad[first], state.angle_deviation_rad);
    let Some(rate) = rate.filter(|_| state.speed_deviation_rad_s.is_none()) else {
        let deviation = state.speed_deviation_rad_s.unwrap_or(SPEED_UNKNOWN_RAD_S);
        let acceleration = deviation / REACH_S;
        return [
            angle,
            (state.speed_rad_s[first], deviation),
            (0.0, acceleration),
        ];
    };
    let [wide, near] = LocalParabola::wide_and_near(time_s, rate, first);
    let of = |order: usize| {
        let deviation = LEAST_DEVIATIONS[order + 1]
            + sigma * wide.gains[order]
            + (wide.derivatives[order] - near.derivatives[order]).abs();
        (wide.derivatives[order], deviation)
    };
    [angle, of(0), of(1)]
}

/// Value, slope and second derivative of a local parabola, and their standard deviations per unit
/// of measurement noise.
struct LocalParabola {
    derivatives: [f64; 3],
    gains: [f64; 3],
    /// Sum of the squares that it leaves, and how many samples there are beyond three.
    left: f64,
    spare: usize,
}

impl LocalParabola {
    /// Around sample `at`, and around it through half as many samples.
    fn wide_and_near(time_s: &[f64], values: &[f64], at: usize) -> [Self; 2] {
        [REACH_S, REACH_S / 2.0].map(|reach| LocalParabola::around(time_s, values, at, reach))
    }

    /// Fitted around sample `at` to its neighbours within `reach` seconds: at least 5 samples that
    /// were measured, where there are as many.
    fn around(time_s: &[f64], values: &[f64], at: usize, reach: f64) -> Self {
        let mut first = at;
        while first > 0 && time_s[at] - time_s[first - 1] <= reach {
            first -= 1;
        }
        let mut last = at;
        while last + 1 < values.len() && (time_s[last + 1] - time_s[at] <= reach || last < at + 2) {
            last += 1;
        }
        let few = |first: usize, last: usize| {
            let measured = values[first..=last].iter().filter(|v| v.is_finite());
            measured.count() < 5
        };
        while few(first, last) && first > 0 {
            first -= 1;
        }
        while few(first, last) && last + 1 < values.len() {
            last += 1;
        }
        let mut normal = Matrix3::<f64>::identity() * 1e-9;
        let mut right = Vector3::<f64>::zeros();
        let measured = || (first..=last).filter(|&k| values[k].is_finite());
        let row = |k: usize| {
            let x = (time_s[k] - time_s[at]) / reach;
            Vector3::new(1.0, x, x * x)
        };
        for k in measured() {
            normal += row(k) * row(k).transpose();
            right += row(k) * values[k];
        }
        let Some(inverse) = normal.try_inverse() else {
            return LocalParabola {
                derivatives: [values[at], 0.0, 0.0],
                gains: [1.0, 1.0 / reach, 1.0 / reach.powi(2)],
                left: 0.0,
                spare: 0,
            };
        };
        let c = inverse * right;
        let deviation = |i: usize| inverse[(i, i)].sqrt();
        LocalParabola {
            derivatives: [c[0], c[1] / reach, 2.0 * c[2] / reach.powi(2)],
            gains: [
                deviation(0),
                deviation(1) / reach,
                2.0 * deviation(2) / reach.powi(2),
            ],
            left: measured()
                .map(|k| (values[k] - c.dot(&row(k))).powi(2))
                .sum(),
            spare: measured().count().saturating_sub(3),
        }
    }
}
