//! How far readings lie from a smooth curve.

use handstand::motion::Motion;
use nalgebra::{DMatrix, DVector};

/// Readings that a cubic is laid through.
const NEIGHBOURS: usize = 9;
/// Values of a cubic.
const CUBIC: usize = 4;

/// Root-mean-square distance of the readings from the cubics through nine neighbours each, rad, for
/// each degree of freedom left; over all joints and motions.
///
/// Beside the reading's resolution this holds what time stamps are off by, times the speed.
pub(super) fn scatter_rad(motions: &[Motion]) -> f64 {
    let (mut sum, mut freedom) = (0.0, 0usize);
    for motion in motions {
        for position in &motion.position_rad {
            for (time, reading) in motion
                .time_s
                .windows(NEIGHBOURS)
                .zip(position.windows(NEIGHBOURS))
            {
                if let Some(squares) = off_cubic(time, reading) {
                    sum += squares;
                    freedom += NEIGHBOURS - CUBIC;
                }
            }
        }
    }
    (sum / freedom.max(1) as f64).sqrt()
}

/// Sum of squared distances from the least-squares cubic.
fn off_cubic(time_s: &[f64], reading_rad: &[f64]) -> Option<f64> {
    let (first, last) = (time_s[0], time_s[time_s.len() - 1]);
    let columns = DMatrix::from_fn(time_s.len(), CUBIC, |row, power| {
        let place = 2.0 * (time_s[row] - first) / (last - first) - 1.0;
        place.powi(power as i32)
    });
    let readings = DVector::from_column_slice(reading_rad);
    let values = columns
        .clone()
        .svd(true, true)
        .solve(&readings, 1e-12)
        .ok()?;
    let squares = (readings - columns * values).norm_squared();
    squares.is_finite().then_some(squares)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_has_no_scatter_and_an_alternation_has_its_own() {
        let time: Vec<f64> = (0..9).map(|k| 0.1 * f64::from(k)).collect();
        let cubic: Vec<f64> = time.iter().map(|t| 1.0 - t + 0.5 * t.powi(3)).collect();
        assert!(off_cubic(&time, &cubic).unwrap() < 1e-20);
        let zigzag: Vec<f64> = (0..9)
            .map(|k| if k % 2 == 0 { 1e-3 } else { -1e-3 })
            .collect();
        let squares = off_cubic(&time, &zigzag).unwrap();
        assert!((7e-6..9e-6).contains(&squares), "{squares}");
    }
}
