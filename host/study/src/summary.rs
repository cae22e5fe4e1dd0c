//! Summary statistics of many runs.

use serde::Serialize;

/// A share and the ends of its 95 % interval (Wilson 1927).
pub fn share_interval(of: usize, all: usize) -> [f64; 2] {
    if all == 0 {
        return [0.0, 1.0];
    }
    let (n, p, z) = (all as f64, of as f64 / all as f64, 1.959_963_984_540_054);
    let centre = p + z * z / (2.0 * n);
    let spread = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + z * z / n;
    [
        ((centre - spread) / scale).max(0.0),
        ((centre + spread) / scale).min(1.0),
    ]
}

/// Summary of a Monte Carlo study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Fingerprint of the study.
    pub fingerprint: String,
    /// Runs.
    pub runs: usize,
    /// Runs that were stabilised.
    pub stabilised: usize,
    /// Their share.
    pub stabilised_share: f64,
    /// Lower end of its 95 % interval.
    pub stabilised_low: f64,
    /// Upper end.
    pub stabilised_high: f64,
    /// Share of the runs that fell.
    pub fallen_share: f64,
    /// Share of robots whose loop, linearised at their balance, is unstable.
    pub unstable: f64,
    /// Quantiles of each figure over the stabilised runs.
    pub figures: Vec<FigureQuantiles>,
    /// How each uncertain value goes with being stabilised.
    pub influence: Vec<Influence>,
}

/// Quantiles of a figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FigureQuantiles {
    /// Column.
    pub figure: String,
    /// 5 %, 50 % and 95 %; none if no run was stabilised.
    pub quantiles: Option<[f64; 3]>,
}

/// An uncertain value's correlation with being stabilised.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Influence {
    /// Column.
    pub value: String,
    /// Of the value with being stabilised, -1 to 1.
    pub correlation: f64,
    /// Of its distance from its mean with being stabilised: an error that is bad to either side
    /// shows here.
    pub correlation_of_size: f64,
}

/// Columns of the rows that are summarised.
pub(super) const FIGURES: [&str; 5] = [
    "rms_angle_rad",
    "rms_torque_nm",
    "largest_rad",
    "limit_cycle_rad",
    "settle_s",
];

impl Summary {
    /// Of a table: its columns' names, and rows of values, not-a-number where a field is empty.
    pub fn of(fingerprint: &str, columns: &[String], rows: &[Vec<f64>]) -> Summary {
        let place = |name: &str| columns.iter().position(|column| column == name);
        let column = |name: &str| -> Vec<f64> {
            match place(name) {
                Some(place) => rows.iter().map(|row| row[place]).collect(),
                None => Vec::new(),
            }
        };
        let stabilised: Vec<bool> = column("stabilised").iter().map(|is| *is == 1.0).collect();
        let count = stabilised.iter().filter(|is| **is).count();
        let fallen = column("fell_s")
            .iter()
            .filter(|time| !time.is_nan())
            .count();
        let radius = column("spectral_radius");
        let unstable = radius.iter().filter(|radius| **radius >= 1.0).count();
        let [stabilised_low, stabilised_high] = share_interval(count, rows.len());
        let share = |of: usize| of as f64 / rows.len().max(1) as f64;
        let distribution = |name: &str| FigureQuantiles {
            figure: name.to_string(),
            quantiles: quantiles(
                column(name)
                    .into_iter()
                    .zip(&stabilised)
                    .filter(|(_, s)| **s)
                    .map(|(v, _)| v),
            ),
        };
        let uncertain = columns.iter().filter(|name| name.contains(':'));
        Summary {
            fingerprint: fingerprint.to_string(),
            runs: rows.len(),
            stabilised: count,
            stabilised_share: share(count),
            stabilised_low,
            stabilised_high,
            fallen_share: share(fallen),
            unstable: share(unstable),
            figures: FIGURES.iter().map(|name| distribution(name)).collect(),
            influence: uncertain
                .map(|name| {
                    let values = column(name);
                    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
                    let sizes: Vec<f64> = values.iter().map(|v| (v - mean).abs()).collect();
                    Influence {
                        value: name.clone(),
                        correlation: correlation(&values, &stabilised),
                        correlation_of_size: correlation(&sizes, &stabilised),
                    }
                })
                .collect(),
        }
    }
}

fn quantiles(values: impl Iterator<Item = f64>) -> Option<[f64; 3]> {
    // Never settled counts as later than any.
    let mut values: Vec<f64> = values
        .map(|v| if v.is_nan() { f64::INFINITY } else { v })
        .collect();
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some([0.05, 0.5, 0.95].map(|share| values[(share * last as f64).round() as usize]))
}

fn correlation(values: &[f64], stabilised: &[bool]) -> f64 {
    let n = values.len().max(1) as f64;
    let numbers = || {
        stabilised
            .iter()
            .map(|stabilised| f64::from(u8::from(*stabilised)))
    };
    let (mean, mean_stood) = (values.iter().sum::<f64>() / n, numbers().sum::<f64>() / n);
    let (mut both, mut own, mut other) = (0.0, 0.0, 0.0);
    for (value, stabilised) in values.iter().zip(numbers()) {
        both += (value - mean) * (stabilised - mean_stood);
        own += (value - mean).powi(2);
        other += (stabilised - mean_stood).powi(2);
    }
    if own * other > 0.0 {
        both / (own * other).sqrt()
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_wilson_s() {
        let [low, high] = share_interval(8, 10);
        assert!((low - 0.4902).abs() < 1e-4 && (high - 0.9433).abs() < 1e-4);
        assert_eq!(share_interval(0, 0), [0.0, 1.0]);
        assert!(share_interval(10, 10)[1] > 1.0 - 1e-12 && share_interval(0, 10)[0] < 1e-12);
    }

    #[test]
    fn a_value_that_decides_correlates_wholly() {
        let values = [1.0, 2.0, 1.0, 2.0];
        let stabilised = [true, false, true, false];
        assert!((correlation(&values, &stabilised) + 1.0).abs() < 1e-12);
        assert_eq!(correlation(&[1.0; 4], &stabilised), 0.0);
    }
}
