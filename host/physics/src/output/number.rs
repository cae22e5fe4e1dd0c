//! Numbers as people read them.

/// Stands for a value there is none of.
pub const NONE: &str = "–";

/// Three significant digits; `–` for what is no number.
pub fn short(value: f64) -> String {
    special(value).unwrap_or_else(|| significant(value, 3))
}

/// Four significant digits, for values that go on into a file or another command.
pub fn exact(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        value.to_string()
    } else {
        significant(value, 4)
    }
}

/// With an exponent below 1e-4 and from 1e6.
fn significant(value: f64, digits: i32) -> String {
    let power = power(value);
    if (-4..6).contains(&power) {
        plain(value, decimals(digits - 1 - power))
    } else {
        format!("{value:.*e}", decimals(digits - 1))
    }
}

/// Bytes in lower-case hexadecimal.
pub fn hex(bytes: impl AsRef<[u8]>) -> String {
    let bytes = bytes.as_ref().iter();
    bytes.map(|byte| format!("{byte:02x}")).collect()
}

/// A value that was chosen, not measured: as [`short`], without zeros that claim precision.
pub fn given(value: f64) -> String {
    let text = short(value);
    let (digits, power) = text.split_at(text.find('e').unwrap_or(text.len()));
    if digits.contains('.') {
        digits
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_string()
            + power
    } else {
        text
    }
}

/// An angle in milliradians, without the unit.
pub fn mrad(value_rad: f64) -> String {
    short(1e3 * value_rad)
}

/// As [`mrad`], with three digits at most behind the point, as columns that are compared have them.
pub fn mrad_in_column(value_rad: f64) -> String {
    let value = 1e3 * value_rad;
    if !value.is_finite() {
        return short(value);
    }
    let digits = match value.abs() {
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        v if v >= 0.9995 => 2,
        _ => 3,
    };
    format!("{value:.digits$}")
}

/// A share of 1 as a percentage, with its sign. What is not all of it is never 100 %: it has as
/// many digits as tell it from that, two at most behind the point.
pub fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match special(percent) {
        Some(text) => format!("{text} %"),
        None if (99.5..100.0).contains(&percent) => {
            let digits = (1..=2).find(|digits| plain(percent, *digits) != plain(100.0, *digits));
            match digits {
                Some(digits) => format!("{} %", plain(percent, digits)),
                None => "> 99.99 %".to_string(),
            }
        }
        None if percent.abs() < 10.0 => format!("{} %", plain(percent, 1)),
        None => format!("{} %", plain(percent, 0)),
    }
}

/// A value and the ends of its interval, all to the decimals that the interval's width deserves.
pub fn interval(value: f64, low: f64, high: f64) -> [String; 3] {
    let width = high - low;
    if !(width > 0.0 && width.is_finite() && value.is_finite()) {
        return [value, low, high].map(short);
    }
    let power = power(width);
    let largest = [value, low, high]
        .into_iter()
        .fold(0.0, |largest: f64, v| largest.max(v.abs()));
    if power < -7 || largest >= 1e6 {
        return [value, low, high].map(short);
    }
    [value, low, high].map(|value| format!("{:.*}", decimals(1 - power), value + 0.0))
}

/// "0.0821 N m (0.0794 to 0.0851)".
pub fn measured(value: f64, low: f64, high: f64, unit: &str) -> String {
    let [value, low, high] = interval(value, low, high);
    format!("{} ({low} to {high})", with_unit(&value, unit))
}

/// A number and its unit: "0.5 rad"; a pure number stands alone.
pub fn with_unit(number: &str, unit: &str) -> String {
    match crate::output::number::unit(unit) {
        "" => number.to_string(),
        unit => format!("{number} {unit}"),
    }
}

/// A unit as written behind a number: nothing for a pure number.
pub fn unit(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}

fn special(value: f64) -> Option<String> {
    match value {
        value if value.is_nan() => Some(NONE.into()),
        f64::INFINITY => Some("∞".into()),
        f64::NEG_INFINITY => Some("-∞".into()),
        0.0 => Some("0".into()),
        _ => None,
    }
}

/// Power of ten of the leading digit.
fn power(value: f64) -> i32 {
    value.abs().log10().floor() as i32
}

fn decimals(wanted: i32) -> usize {
    wanted.clamp(0, 9) as usize
}

/// Never "-0".
fn plain(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let nothing = text
        .trim_start_matches('-')
        .chars()
        .all(|c| "0.".contains(c));
    if nothing { text.replace('-', "") } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits() {
        assert_eq!(short(0.012345), "0.0123");
        assert_eq!(short(-123.456), "-123");
        assert_eq!(short(41.234), "41.2");
        assert_eq!(short(1.5e-9), "1.50e-9");
        assert_eq!(given(0.1), "0.1");
        assert_eq!(given(100.0), "100");
        assert_eq!(given(0.0), "0");
        assert_eq!(given(-1.5), "-1.5");
        assert_eq!(given(0.012345), "0.0123");
        assert_eq!(given(50.0), "50");
        assert_eq!(given(1e-5), "1e-5");
        assert_eq!(short(f64::NAN), "–");
        assert_eq!(short(f64::INFINITY), "∞");
        assert_eq!(exact(0.0123456), "0.01235");
        assert_eq!(exact(123456.0), "123456");
        assert_eq!(exact(1.5e-9), "1.500e-9");
        assert_eq!(mrad_in_column(0.01234), "12.3");
        assert_eq!(mrad_in_column(1e-5), "0.010");
        assert_eq!(mrad_in_column(f64::NAN), "–");
    }

    #[test]
    fn a_pure_number_has_no_unit() {
        assert_eq!(measured(1.02, 1.0, 1.04, "1"), "1.020 (1.000 to 1.040)");
        assert_eq!(with_unit("5", "rad"), "5 rad");
    }

    #[test]
    fn percentages() {
        assert_eq!(percent(0.853), "85 %");
        assert_eq!(percent(0.9967), "99.7 %");
        assert_eq!(percent(0.99967), "99.97 %");
        assert_eq!(percent(0.999999), "> 99.99 %");
        assert_eq!(percent(1.0), "100 %");
        assert_eq!(percent(1.07), "107 %");
        assert_eq!(percent(0.0), "0 %");
        assert_eq!(percent(0.0123), "1.2 %");
        assert_eq!(percent(-0.0001), "0.0 %");
    }

    #[test]
    fn an_interval_sets_the_decimals() {
        assert_eq!(
            interval(0.08213, 0.0794, 0.0851),
            ["0.0821", "0.0794", "0.0851"]
        );
        assert_eq!(interval(12.3456, 8.0, 16.0), ["12.3", "8.0", "16.0"]);
        assert_eq!(interval(1.0, 1.0, 1.0), ["1.00", "1.00", "1.00"]);
    }
}
