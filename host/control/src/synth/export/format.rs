//! Numbers of a design as people read them.

use nalgebra::Complex;

/// Numbers, real or complex, conjugates together; many are counted.
pub(super) fn several(values: &[Complex<f64>]) -> String {
    const MOST: usize = 8;
    const NOTHING: f64 = 1e-6;
    let largest = values.iter().fold(0.0, |most: f64, z| most.max(z.norm()));
    let mut said = Vec::new();
    for value in values {
        // Past inputs bring poles at 0, which rounding scatters.
        if value.norm() < NOTHING * largest {
            said.push("0".to_string());
            continue;
        }
        let little = |part: f64| part.abs() <= 1e-9 * value.norm();
        match (little(value.im), little(value.re)) {
            (true, _) => said.push(number(value.re)),
            (false, _) if value.im < 0.0 => {}
            (false, true) => said.push(format!("±{}i", number(value.im))),
            (false, false) => said.push(format!("{}±{}i", number(value.re), number(value.im))),
        }
    }
    let more = said.len().saturating_sub(MOST);
    said.truncate(MOST);
    match more {
        0 => said.join(", "),
        more => format!("{}, and {more} more", said.join(", ")),
    }
}

fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_string(),
        size if (1e-4..1e6).contains(&size) => format!("{value:.4}"),
        _ => format!("{value:.3e}"),
    }
}

/// Eight significant digits.
pub(super) fn digits(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let power = value.abs().log10().floor() as i32;
    if (-4..7).contains(&power) {
        format!("{value:.*}", (7 - power).clamp(0, 11) as usize)
    } else {
        format!("{value:.7e}")
    }
}

/// A given number, to six digits at most.
pub(super) fn plain(value: f64) -> String {
    let text = format!("{value:.6}");
    let text = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text.as_str()
    };
    // A zero has no sign for people, one after rounding neither.
    if text == "-0" { "0" } else { text }.to_string()
}
