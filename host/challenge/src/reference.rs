//! What the arm is asked to do: a sequence of segments that together excite every effect.

use rand::Rng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::TAU;

/// Length of a motion, s.
pub const MOTION_S: f64 = 20.0;
/// Time of a hold, s.
const HOLD_S: f64 = 0.7;
/// The motor is off for this long at the end of a drop, s.
const DROP_S: f64 = 1.5;

/// One kind of movement, with what was drawn for it; angles in rad, frequencies in Hz.
#[derive(Debug, Clone)]
enum Shape {
    /// Back and forth at a constant, slow speed.
    Triangle { amplitude: f64 },
    /// Steps between angles, each held.
    Steps { angles: Vec<f64> },
    /// A sum of sines: amplitude, frequency, phase.
    Multisine { sines: [[f64; 3]; 3] },
    /// A sine that quickens from 1 Hz.
    Chirp { amplitude: f64, end_hz: f64 },
    /// Raised, then let go.
    Drop { angle: f64 },
    /// Hardly moving about an angle.
    Dither { amplitude: f64, frequency: f64 },
}

/// A shape from a time on.
#[derive(Debug, Clone)]
struct Segment {
    start_s: f64,
    length_s: f64,
    shape: Shape,
}

/// Reference angles over time.
#[derive(Debug, Clone)]
pub struct Reference {
    segments: Vec<Segment>,
    scale: f64,
}

/// What is asked of the arm at an instant.
#[derive(Debug, Clone, Copy)]
pub struct Setpoint {
    /// Angle, rad.
    pub angle: f64,
    /// Speed to feed forward, rad/s.
    pub speed: f64,
    /// Acceleration to feed forward, rad/s^2.
    pub acceleration: f64,
    /// Whether the motor is on.
    pub torque_on: bool,
}

impl Reference {
    /// Every kind of movement once, in random order, lasting 2.7 to 4 s each.
    pub fn random(rng: &mut ChaCha8Rng) -> Reference {
        let mut shapes = vec![
            Shape::Triangle {
                amplitude: rng.random_range(0.2..0.5),
            },
            Shape::Steps {
                angles: alternating(rng),
            },
            Shape::Multisine { sines: sines(rng) },
            Shape::Chirp {
                amplitude: rng.random_range(0.45..0.58),
                end_hz: rng.random_range(2.6..3.0),
            },
            Shape::Drop {
                angle: sign(rng) * rng.random_range(1.1..1.3),
            },
            Shape::Dither {
                amplitude: rng.random_range(0.08..0.2),
                frequency: rng.random_range(0.7..1.5),
            },
        ];
        shapes.shuffle(rng);
        let weights: Vec<f64> = shapes.iter().map(|_| rng.random_range(2.9..3.7)).collect();
        let total: f64 = weights.iter().sum();
        let mut start_s = 0.0;
        let segments = shapes
            .into_iter()
            .zip(weights)
            .map(|(shape, weight)| {
                let length_s = MOTION_S * weight / total;
                let segment = Segment {
                    start_s,
                    length_s,
                    shape,
                };
                start_s += length_s;
                segment
            })
            .collect();
        Reference {
            segments,
            scale: 1.0,
        }
    }

    /// The same goal with all angles `scale` times as wide.
    pub fn scaled(&self, scale: f64) -> Reference {
        Reference {
            segments: self.segments.clone(),
            scale,
        }
    }

    /// What is asked at `time_s`.
    pub fn at(&self, time_s: f64) -> Setpoint {
        let index = self
            .segments
            .iter()
            .rposition(|s| s.start_s <= time_s)
            .unwrap_or(0);
        let segment = &self.segments[index];
        let since_s = time_s - segment.start_s;
        const D: f64 = 0.005;
        let [before, now, after] = [-D, 0.0, D].map(|d| self.scale * segment.angle(since_s + d));
        let (mut speed, mut acceleration) = (0.0, 0.0);
        match segment.shape {
            Shape::Steps { .. } | Shape::Drop { .. } => {}
            Shape::Triangle { .. } | Shape::Dither { .. } => speed = (after - before) / (2.0 * D),
            Shape::Multisine { .. } | Shape::Chirp { .. } => {
                speed = (after - before) / (2.0 * D);
                acceleration = (after - 2.0 * now + before) / (D * D);
            }
        }
        let dropping =
            matches!(segment.shape, Shape::Drop { .. }) && since_s > segment.length_s - DROP_S;
        Setpoint {
            angle: now,
            speed,
            acceleration,
            torque_on: !dropping,
        }
    }
}

impl Segment {
    /// Reference angle, rad, at `since_s` from its start; near 0 at both ends.
    fn angle(&self, since_s: f64) -> f64 {
        let since_s = since_s.clamp(0.0, self.length_s);
        let left_s = self.length_s - since_s;
        let window = ramp(since_s / 0.3) * ramp(left_s / 0.3);
        match &self.shape {
            Shape::Triangle { amplitude } => {
                let phase = since_s / self.length_s;
                let height = (4.0 * phase).min((2.0 - 4.0 * phase).max(4.0 * phase - 4.0));
                amplitude * height
            }
            Shape::Steps { angles } => {
                let index = (since_s / HOLD_S) as usize;
                if left_s < 0.3 {
                    0.0
                } else {
                    angles[index % angles.len()]
                }
            }
            Shape::Multisine { sines } => {
                let sum: f64 = sines
                    .iter()
                    .map(|[a, f, p]| a * (TAU * f * since_s + p).sin())
                    .sum();
                window * sum
            }
            Shape::Chirp { amplitude, end_hz } => {
                let rise = (end_hz - 1.0) / self.length_s;
                window * amplitude * (TAU * (since_s + 0.5 * rise * since_s * since_s)).sin()
            }
            Shape::Drop { angle } => {
                if left_s < DROP_S {
                    0.0
                } else {
                    angle * ramp(since_s / 0.7)
                }
            }
            Shape::Dither {
                amplitude,
                frequency,
            } => window * amplitude * (TAU * frequency * since_s).sin(),
        }
    }
}

/// 0 below 0, 1 above 1, smooth between.
fn ramp(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

fn sign(rng: &mut ChaCha8Rng) -> f64 {
    if rng.random_bool(0.5) { 1.0 } else { -1.0 }
}

/// Angles of either sign by turns.
fn alternating(rng: &mut ChaCha8Rng) -> Vec<f64> {
    let first = sign(rng);
    (0..6)
        .map(|k| first * if k % 2 == 0 { 1.0 } else { -1.0 } * rng.random_range(0.25..1.0))
        .collect()
}

fn sines(rng: &mut ChaCha8Rng) -> [[f64; 3]; 3] {
    [(0.3, 0.7, 0.4), (0.7, 1.3, 0.3), (1.3, 2.0, 0.2)].map(|(low_hz, high_hz, amplitude)| {
        [
            amplitude * rng.random_range(0.8..1.2),
            rng.random_range(low_hz..high_hz),
            rng.random_range(0.0..TAU),
        ]
    })
}
