//! Printed against computed: the printed digits decide.

use super::computed::Computed;
use super::printed::{PRINTED, Printed, Quantity};
use crate::sysid::IntervalEstimate;
use std::fmt;

/// Most digits that may differ for a misprint to be one of digits.
const MOST_DIGITS: usize = 2;

/// How a print compares.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// To every printed digit, or inside the 95 % interval of what was estimated.
    Agrees,
    /// The digits agree, the sign does not.
    Sign,
    /// All digits but these agree: as printed, as it should be.
    Digits(String, String),
    /// It does not.
    Differs,
}

/// One number.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// As printed.
    pub printed: Printed,
    /// As computed.
    pub computed: IntervalEstimate,
    /// How they compare.
    pub verdict: Verdict,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Verdict::Agrees => f.write_str("agrees"),
            Verdict::Sign => f.write_str("misprint: sign lost"),
            Verdict::Digits(printed, meant) => write!(f, "misprint: {printed} for {meant}"),
            Verdict::Differs => f.write_str("differs"),
        }
    }
}

impl Row {
    /// The computed value to one digit more than the print, or with its interval.
    pub fn computed_text(&self) -> String {
        let digits = decimals(self.printed.text);
        match self.printed.quantity {
            Quantity::Servo(_) => format!(
                "{:.2$} +- {:.2$}",
                self.computed.value,
                self.computed.high - self.computed.value,
                digits
            ),
            _ => format!("{:.*}", digits + 1, self.computed.value),
        }
    }
}

/// Every printed number beside its computed one.
pub fn check(computed: &Computed) -> Vec<Row> {
    let row = |printed: &Printed| {
        let value = computed.value(printed.quantity);
        Row {
            printed: *printed,
            computed: value,
            verdict: verdict(printed, &value),
        }
    };
    PRINTED.iter().map(row).collect()
}

/// Digits behind the point.
fn decimals(text: &str) -> usize {
    text.split_once('.').map_or(0, |(_, behind)| behind.len())
}

fn verdict(printed: &Printed, computed: &IntervalEstimate) -> Verdict {
    let Ok(value) = printed.text.parse::<f64>() else {
        return Verdict::Differs;
    };
    if let Quantity::Servo(_) = printed.quantity {
        return match computed.holds(value) {
            true => Verdict::Agrees,
            false => Verdict::Differs,
        };
    }
    let digits = decimals(printed.text);
    // Half a unit of the last printed digit, and what binary numbers add to it.
    let half = 0.5 * 10f64.powi(-(digits as i32)) * (1.0 + 1e-9);
    let near = |value: f64| (value - computed.value).abs() <= half + 1e-12 * computed.value.abs();
    if near(value) {
        return Verdict::Agrees;
    }
    if near(-value) {
        return Verdict::Sign;
    }
    let meant = format!("{:.digits$}", computed.value);
    let differing = printed
        .text
        .chars()
        .zip(meant.chars())
        .filter(|(a, b)| a != b);
    let same_length = printed.text.len() == meant.len();
    if same_length && differing.count() <= MOST_DIGITS {
        return Verdict::Digits(printed.text.to_string(), meant);
    }
    Verdict::Differs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(text: &'static str, computed: f64) -> Verdict {
        let printed = Printed {
            place: "",
            quantity: Quantity::Pole(0),
            text,
            in_paper: true,
        };
        verdict(&printed, &IntervalEstimate::around(computed, 0.0))
    }

    #[test]
    fn printed_digits_decide() {
        assert_eq!(judged("1.23", 1.2349), Verdict::Agrees);
        assert_eq!(
            judged("1.23", 1.2351),
            Verdict::Digits("1.23".into(), "1.24".into())
        );
        assert_eq!(judged("-1.23", 1.2349), Verdict::Sign);
        assert_eq!(
            judged("114.7", 146.72),
            Verdict::Digits("114.7".into(), "146.7".into())
        );
        assert_eq!(judged("1.23", 9.87), Verdict::Differs);
        assert_eq!(judged("1.23", f64::NAN), Verdict::Differs);
    }
}
