//! Rounding to what the files show.

/// To `digits` decimal places, so that files hold exactly what was simulated; never a negative
/// zero.
pub fn rounded(value: f64, digits: i32) -> f64 {
    let unit = 10_f64.powi(digits);
    (value * unit).round() / unit + 0.0
}
