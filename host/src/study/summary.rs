//! Many runs in a few figures.

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

/// What a Monte Carlo study came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Fingerprint of the study.
    pub fingerprint: String,
    /// Runs.
    pub runs: usize,
    /// Runs that stood to the end.
    pub stood: usize,
    /// Their share.
    pub survival: f64,
    /// Lower end of its 95 % interval.
    pub survival_low: f64,
    /// Upper end.
    pub survival_high: f64,
    /// Share of robots whose loop, linearised at their balance, is unstable.
    pub unstable: f64,
    /// Distribution of each figure over the runs that stood.
    pub figures: Vec<Distribution>,
    /// How each uncertain value goes with standing.
    pub influence: Vec<Influence>,
}

/// Quantiles of a figure.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Distribution {
    /// Column.
    pub figure: String,
    /// 5 %, 50 % and 95 %; none if no run stood.
    pub quantiles: Option<[f64; 3]>,
}

/// An uncertain value's correlation with standing.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Influence {
    /// Column.
    pub value: String,
    /// Of the value with standing, -1 to 1.
    pub correlation: f64,
    /// Of its distance from its mean with standing: an error that is bad to either side shows here.
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
        let stood: Vec<bool> = column("fell_s").iter().map(|time| time.is_nan()).collect();
        let count = stood.iter().filter(|stood| **stood).count();
        let radius = column("spectral_radius");
        let unstable = radius.iter().filter(|radius| **radius >= 1.0).count();
        let [survival_low, survival_high] = share_interval(count, rows.len());
        let share = |of: usize| of as f64 / rows.len().max(1) as f64;
        let distribution = |name: &str| Distribution {
            figure: name.to_string(),
            quantiles: quantiles(
                column(name)
                    .into_iter()
                    .zip(&stood)
                    .filter(|(_, s)| **s)
                    .map(|(v, _)| v),
            ),
        };
        let uncertain = columns.iter().filter(|name| name.contains(':'));
        Summary {
            fingerprint: fingerprint.to_string(),
            runs: rows.len(),
            stood: count,
            survival: share(count),
            survival_low,
            survival_high,
            unstable: share(unstable),
            figures: FIGURES.iter().map(|name| distribution(name)).collect(),
            influence: uncertain
                .map(|name| {
                    let values = column(name);
                    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
                    let sizes: Vec<f64> = values.iter().map(|v| (v - mean).abs()).collect();
                    Influence {
                        value: name.clone(),
                        correlation: correlation(&values, &stood),
                        correlation_of_size: correlation(&sizes, &stood),
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

fn correlation(values: &[f64], stood: &[bool]) -> f64 {
    let n = values.len().max(1) as f64;
    let numbers = || stood.iter().map(|stood| f64::from(u8::from(*stood)));
    let (mean, mean_stood) = (values.iter().sum::<f64>() / n, numbers().sum::<f64>() / n);
    let (mut both, mut own, mut other) = (0.0, 0.0, 0.0);
    for (value, stood) in values.iter().zip(numbers()) {
        both += (value - mean) * (stood - mean_stood);
        own += (value - mean).powi(2);
        other += (stood - mean_stood).powi(2);
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
        let stood = [true, false, true, false];
        assert!((correlation(&values, &stood) + 1.0).abs() < 1e-12);
        assert_eq!(correlation(&[1.0; 4], &stood), 0.0);
    }
}
