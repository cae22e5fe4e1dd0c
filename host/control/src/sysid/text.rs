//! A transfer function as people write it.

use std::fmt::Write as _;

/// `0.06217 z / (z^2 - 1.469 z + 0.5544)`: polynomials in the delay as polynomials in z, `digits`
/// significant.
pub fn transfer_function(b: &[f64], denominator: &[f64], digits: usize) -> String {
    let order = b.len().max(denominator.len()) - 1;
    let top = polynomial(b, order, digits);
    let bottom = polynomial(denominator, order, digits);
    let terms = b.iter().filter(|c| **c != 0.0).count();
    let top = if terms > 1 { format!("({top})") } else { top };
    match bottom.as_str() {
        "1" => top,
        _ => format!("{top} / ({bottom})"),
    }
}

fn polynomial(coefficients: &[f64], order: usize, digits: usize) -> String {
    let mut text = String::new();
    for (delay, value) in coefficients.iter().enumerate() {
        if *value == 0.0 {
            continue;
        }
        let sign = match (text.is_empty(), *value < 0.0) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        };
        let power = match order - delay {
            0 => String::new(),
            1 => "z".to_string(),
            power => format!("z^{power}"),
        };
        let size = significant(value.abs(), digits);
        let number = match (size.as_str(), power.as_str()) {
            ("1", "") => "1".to_string(),
            ("1", _) => power,
            (_, "") => size,
            _ => format!("{size} {power}"),
        };
        let _ = write!(text, "{sign}{number}");
    }
    if text.is_empty() {
        text.push('0');
    }
    text
}

/// A number above zero to so many significant digits; 1 is "1".
fn significant(value: f64, digits: usize) -> String {
    if value == 1.0 {
        return "1".to_string();
    }
    let power = value.log10().floor() as i32;
    if !(-5..=6).contains(&power) {
        return format!("{value:.*e}", digits.saturating_sub(1));
    }
    let decimals = (digits as i32 - 1 - power).max(0) as usize;
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::transfer_function;

    #[test]
    fn as_in_the_paper() {
        let text = transfer_function(&[0.0, 0.06217], &[1.0, -1.469, 0.5544], 4);
        assert_eq!(text, "0.06217 z / (z^2 - 1.469 z + 0.5544)");
        assert_eq!(
            transfer_function(&[0.0, 0.0, 0.5, -0.25], &[1.0, -1.0], 3),
            "(0.500 z - 0.250) / (z^3 - z^2)"
        );
        assert_eq!(transfer_function(&[0.5], &[1.0], 2), "0.50");
    }
}
