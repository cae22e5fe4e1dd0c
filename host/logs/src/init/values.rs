//! What a column's values say of it: unit, sign, and where the angles rest.

use super::counts::counts;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Beyond two turns either way no joint of a chain swings in rad, but it does in degrees.
const MOST_RAD: f64 = 2.0 * TAU;

/// Lowest and highest finite value; none where there is no such value.
pub fn range(values: &[f64]) -> Option<(f64, f64)> {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let low = finite().reduce(f64::min)?;
    Some((low, finite().reduce(f64::max)?))
}

/// Whether the values are all one, or none is finite.
pub fn stands_still(values: &[f64]) -> bool {
    range(values).is_none_or(|(low, high)| low == high)
}

/// The middle of the finite values; 0 of none.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// An angle stays by a goal that it is nearer to than this share of its own spread.
const STAYS_BY: f64 = 0.4;

/// Whether an angle stays by what may be its goal, as a servo that regulates it makes it: their
/// difference is small beside how far the angle moves (root mean squares).
pub fn stays_by(angle: &[f64], goal: &[f64]) -> bool {
    let pairs = || {
        angle
            .iter()
            .zip(goal)
            .filter(|(a, g)| a.is_finite() && g.is_finite())
    };
    let count = pairs().count().max(1) as f64;
    let mean = pairs().map(|(angle, _)| angle).sum::<f64>() / count;
    let spread: f64 = pairs().map(|(angle, _)| (angle - mean).powi(2)).sum();
    let apart: f64 = pairs().map(|(angle, goal)| (angle - goal).powi(2)).sum();
    apart < STAYS_BY.powi(2) * spread
}

/// The unit of a time whose name says none, from the middle step between rows.
pub fn time_unit(values: &[f64]) -> &'static str {
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    match median(
        &steps
            .into_iter()
            .filter(|step| *step > 0.0)
            .collect::<Vec<_>>(),
    ) {
        step if step < 0.5 => "s",
        step if step < 500.0 => "ms",
        step if step < 5e5 => "us",
        _ => "ns",
    }
}

/// The unit of an angle whose name says none, with counts per turn.
pub fn angle_unit(values: &[f64]) -> (&'static str, Option<f64>) {
    let (low, high) = range(values).unwrap_or((0.0, 0.0));
    let whole = values
        .iter()
        .filter(|v| v.is_finite())
        .all(|v| v.fract() == 0.0);
    match () {
        () if low.abs().max(high.abs()) <= MOST_RAD => ("rad", None),
        () if whole && high - low > 0.0 && low >= 0.0 => ("ticks", Some(counts(high))),
        () => ("deg", None),
    }
}

/// Full scales of duties that are counts: timers and registers of servos.
const FULL_SCALES: [f64; 7] = [255.0, 885.0, 1000.0, 1023.0, 4095.0, 32767.0, 65535.0];

/// The unit of a duty whose name says none, with the counts of its full scale: no per cent exceeds
/// a hundred.
pub fn duty_unit(values: &[f64]) -> (&'static str, Option<f64>) {
    let (low, high) = range(values).unwrap_or((0.0, 0.0));
    match high.max(-low) {
        most if most <= 1.5 => ("1", None),
        most if most <= 100.5 => ("%", None),
        most => {
            let full = FULL_SCALES.into_iter().find(|full| most <= *full);
            ("counts", Some(full.unwrap_or(most.ceil())))
        }
    }
}

/// A speed's unit and sign, from the slope of its angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpeedFit {
    /// `rad/s`, `deg/s` or `rpm`.
    pub unit: &'static str,
    /// Whether it counts the other way round.
    pub reversed: bool,
    /// Value written per rad/s.
    pub ratio: f64,
}

/// Which unit makes the speeds the angles' slopes; none where they are not.
///
/// `time_s` and `angle_rad` are in SI, `speed` as written.
pub fn speed_fit(time_s: &[f64], angle_rad: &[f64], speed: &[f64]) -> Option<SpeedFit> {
    let Slopes { cross, square, own } = Slopes::of(time_s, angle_rad, speed).alike()?;
    // Noise of the slopes lowers their share in the speed and the reverse; between the two lies
    // the ratio.
    let ratio = (own / square).sqrt();
    let units = [("rad/s", 1.0), ("deg/s", 180.0 / PI), ("rpm", 60.0 / TAU)];
    let off = |unit: f64| (ratio / unit).ln().abs();
    let (unit, factor) = units
        .into_iter()
        .min_by(|a, b| off(a.1).total_cmp(&off(b.1)))?;
    (off(factor) < 0.7).then_some(SpeedFit {
        unit,
        reversed: cross < 0.0,
        ratio,
    })
}

/// Correlation of values with the slope of the angles, -1 to 1; 0 where either does not change.
pub fn slope_correlation(time_s: &[f64], angle_rad: &[f64], values: &[f64]) -> f64 {
    let slope = |k: usize| (angle_rad[k + 1] - angle_rad[k - 1]) / (time_s[k + 1] - time_s[k - 1]);
    let pairs = (1..time_s.len().saturating_sub(1)).map(|k| (slope(k), values[k]));
    let pairs: Vec<(f64, f64)> = pairs
        .filter(|(slope, value)| slope.is_finite() && value.is_finite())
        .collect();
    let count = pairs.len().max(1) as f64;
    let means = pairs
        .iter()
        .fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
    let (mut cross, mut square, mut own) = (0.0, 0.0, 0.0);
    for (slope, value) in pairs {
        let (slope, value) = (slope - means.0 / count, value - means.1 / count);
        cross += slope * value;
        square += slope * slope;
        own += value * value;
    }
    if square * own > 0.0 {
        cross / (square * own).sqrt()
    } else {
        0.0
    }
}

/// Sums of products of the slopes of angles and of speeds.
struct Slopes {
    cross: f64,
    square: f64,
    own: f64,
}

impl Slopes {
    fn of(time_s: &[f64], angle_rad: &[f64], speed: &[f64]) -> Slopes {
        let (mut cross, mut square, mut own) = (0.0, 0.0, 0.0);
        for k in 1..time_s.len().saturating_sub(1) {
            let span = time_s[k + 1] - time_s[k - 1];
            let slope = (angle_rad[k + 1] - angle_rad[k - 1]) / span;
            if span > 0.0 && slope.is_finite() && speed[k].is_finite() {
                cross += slope * speed[k];
                square += slope * slope;
                own += speed[k] * speed[k];
            }
        }
        Slopes { cross, square, own }
    }

    /// Themselves, if the two go together: where noise outweighs motion, nothing can be said.
    fn alike(self) -> Option<Slopes> {
        let alike = self.cross / (self.square * self.own).sqrt();
        (alike.abs() > 0.7).then_some(self)
    }
}

/// So near a pose a joint that hangs there rests, rad: what lies further off has a zero of its own.
const AT_POSE_RAD: f64 = 0.3;

/// `hanging`, `horizontal` or `upright`, whichever explains that a free joint rests around this
/// angle; none where none does.
pub fn zero_at_rest(rest_rad: f64) -> Option<&'static str> {
    let turned = rest_rad.rem_euclid(TAU);
    let off = |angle: f64| {
        let apart = (turned - angle).rem_euclid(TAU);
        apart.min(TAU - apart)
    };
    let mut zeros = [
        ("hanging", 0.0),
        ("upright", PI),
        ("horizontal", -FRAC_PI_2),
        ("horizontal", FRAC_PI_2),
    ]
    .into_iter();
    let at = zeros.find(|(_, angle)| off(*angle) < AT_POSE_RAD)?;
    Some(at.0)
}

/// Whether a free joint of these angles comes to rest at their middle, rad: it does not where it
/// turns round.
pub fn rests(angle_rad: &[f64]) -> bool {
    range(angle_rad).is_some_and(|(low, high)| high - low < TAU)
}

/// Torques of gravity on the first joint: where they say that angles are zero, and their amplitude,
/// N m; none where the torques do not follow the motion.
///
/// The torque is split by least squares into sines and cosines of the links' angles (each from the
/// link before), and per joint into what its speed, the speed's sign and its acceleration add.
pub fn gravity_of_torques(
    time_s: &[f64],
    angle_rad: &[Vec<f64>],
    torque_nm: &[f64],
) -> Option<(&'static str, f64)> {
    const SPAN_S: f64 = 0.025;
    const MOST_ROWS: usize = 5000;
    let steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let step_s = median(&steps);
    let apart = ((SPAN_S / step_s).round() as usize).max(1);
    let last = time_s.len().checked_sub(apart)?;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let every = (time_s.len() / MOST_ROWS).max(1);
    for k in (apart..last).step_by(every) {
        let mut row = vec![torque_nm[k]];
        let mut sum = 0.0;
        for angle in angle_rad {
            sum += angle[k];
            row.extend([sum.sin(), sum.cos()]);
        }
        for angle in angle_rad {
            let speed =
                (angle[k + apart] - angle[k - apart]) / (time_s[k + apart] - time_s[k - apart]);
            let bend = angle[k + apart] - 2.0 * angle[k] + angle[k - apart];
            let sign = if speed.abs() > 0.05 {
                speed.signum()
            } else {
                0.0
            };
            row.extend([speed, sign, bend / (apart as f64 * step_s).powi(2)]);
        }
        if row.iter().all(|value| value.is_finite()) {
            rows.push(row);
        }
    }
    let unknowns = 5 * angle_rad.len();
    if unknowns == 0 || rows.len() < 10 * unknowns {
        return None;
    }
    let a = nalgebra::DMatrix::from_fn(rows.len(), unknowns, |i, j| rows[i][j + 1]);
    let b = nalgebra::DVector::from_fn(rows.len(), |i, _| rows[i][0]);
    let found = a.clone().svd(true, true).solve(&b, 1e-9).ok()?;
    let unexplained = (&a * &found - &b).norm() / b.norm();
    if unexplained.is_nan() || unexplained >= 0.4 {
        return None;
    }
    let (sin, cos) = (found[0], found[1]);
    let zero = match sin.abs() >= cos.abs() {
        true if sin > 0.0 => "hanging",
        true => "upright",
        false => "horizontal",
    };
    Some((zero, sin.hypot(cos)))
}

/// Share of the widest swing that a half swing must lead away from the rest.
const AWAY: f64 = 0.02;

/// Length of an even rod that swings as often about its rest as these angles do, m; none where
/// they do not swing.
pub fn rod_length_m(time_s: &[f64], angle_rad: &[f64], gravity_m_s2: f64) -> Option<f64> {
    let rest = median(angle_rad);
    let widest = angle_rad.iter().map(|angle| (angle - rest).abs());
    let beyond = AWAY * widest.filter(|away| away.is_finite()).fold(0.0, f64::max);
    let (mut crossings, mut below) = (Vec::new(), false);
    for (time_s, angle) in time_s.iter().zip(angle_rad) {
        // Noise about the rest is no swing: each half must lead away from it.
        if angle - rest < -beyond {
            below = true;
        } else if below && angle - rest > beyond {
            crossings.push(*time_s);
            below = false;
        }
    }
    let periods: Vec<f64> = crossings.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if periods.len() < 3 {
        return None;
    }
    let omega = TAU / median(&periods);
    let length_m = 1.5 * gravity_m_s2 / (omega * omega);
    (0.01..5.0).contains(&length_m).then_some(length_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speeds_unit_and_sign_come_from_the_slopes() {
        let time_s: Vec<f64> = (0..200).map(|k| 0.01 * f64::from(k)).collect();
        let angle: Vec<f64> = time_s.iter().map(|t| (3.0 * t).sin()).collect();
        for (unit, factor, sign) in [
            ("rad/s", 1.0, 1.0),
            ("deg/s", 57.29578, -1.0),
            ("rpm", 9.5493, 1.0),
        ] {
            let speed: Vec<f64> = time_s
                .iter()
                .map(|t| sign * factor * 3.0 * (3.0 * t).cos())
                .collect();
            let fit = speed_fit(&time_s, &angle, &speed).unwrap();
            assert_eq!((fit.unit, fit.reversed), (unit, sign < 0.0));
        }
        let noise: Vec<f64> = (0..200).map(|k| f64::from(k * 7919 % 101) - 50.0).collect();
        assert_eq!(speed_fit(&time_s, &angle, &noise), None);
    }

    #[test]
    fn rest_and_torques_tell_the_zero() {
        let tell = [-0.1, 3.2, -3.0, 1.5, -1.6, 6.2].map(|rest| zero_at_rest(rest).unwrap());
        let told = [
            "hanging",
            "upright",
            "upright",
            "horizontal",
            "horizontal",
            "hanging",
        ];
        assert_eq!(tell, told);
        assert_eq!([0.88, -0.6, 2.3, 100.0].map(zero_at_rest), [None; 4]);
        let time_s: Vec<f64> = (0..400).map(|k| 0.01 * f64::from(k)).collect();
        let angle: Vec<f64> = time_s.iter().map(|t| 2.0 * (4.0 * t).sin()).collect();
        // A motor that swings an arm of 0.3 kg m^2 against gravity: the acceleration outweighs it.
        let torque = |sign: f64| -> Vec<f64> {
            let torque = |q: &f64| sign * 2.0 * q.sin() - 0.3 * 16.0 * q;
            angle.iter().map(torque).collect()
        };
        let told = |sign| gravity_of_torques(&time_s, std::slice::from_ref(&angle), &torque(sign));
        for (sign, zero) in [(1.0, "hanging"), (-1.0, "upright")] {
            let (found, amplitude) = told(sign).unwrap();
            assert_eq!(found, zero);
            assert!((amplitude - 2.0).abs() < 0.1, "{amplitude}");
        }
        let noise: Vec<f64> = (0..400).map(|k| f64::from(k * 7919 % 101) - 50.0).collect();
        assert_eq!(gravity_of_torques(&time_s, &[angle], &noise), None);
    }

    #[test]
    fn units_come_from_ranges() {
        assert_eq!(time_unit(&[0.0, 10.0, 20.0]), "ms");
        assert_eq!(time_unit(&[0.0, 1e4, 2e4]), "us");
        assert_eq!(time_unit(&[0.0, 0.01, 0.02]), "s");
        assert_eq!(duty_unit(&[0.5, -1.0]), ("1", None));
        assert_eq!(duty_unit(&[-100.0, 45.0]), ("%", None));
        assert_eq!(duty_unit(&[-221.0, 45.0]), ("counts", Some(255.0)));
        assert_eq!(duty_unit(&[1e6]), ("counts", Some(1e6)));
        assert_eq!(angle_unit(&[0.1, -3.0]), ("rad", None));
        assert_eq!(angle_unit(&[-90.5, 45.0]), ("deg", None));
        assert_eq!(angle_unit(&[2048.0, 1000.0]), ("ticks", Some(4096.0)));
    }

    #[test]
    fn a_swing_tells_a_rods_length() {
        let time_s: Vec<f64> = (0..1000).map(|k| 0.01 * f64::from(k)).collect();
        let omega = (1.5 * 9.81 / 0.3f64).sqrt();
        let angle: Vec<f64> = time_s.iter().map(|t| 0.1 * (omega * t).cos()).collect();
        let length = rod_length_m(&time_s, &angle, 9.81).unwrap();
        assert!((length - 0.3).abs() < 0.02, "{length}");
    }
}
