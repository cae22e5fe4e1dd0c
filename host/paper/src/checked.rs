//! Printed against computed: the printed digits decide.

use super::computed::Computed;
use super::printed::{Printed, PrintedQuantity, printed};
use crate::sysid::IntervalEstimate;
use std::fmt;

/// Most digits that may differ for a misprint to be one of digits.
const MOST_DIGITS: usize = 2;

/// How a print compares.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Agreement {
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
pub struct CheckedNumber {
    /// As printed.
    pub printed: Printed,
    /// As computed.
    pub computed: IntervalEstimate,
    /// How they compare.
    pub verdict: Agreement,
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Agreement::Agrees => f.write_str("agrees"),
            Agreement::Sign => f.write_str("misprint: sign lost"),
            Agreement::Digits(printed, meant) => write!(f, "misprint: {printed} for {meant}"),
            Agreement::Differs => f.write_str("differs"),
        }
    }
}

impl CheckedNumber {
    /// The computed value to one digit more than the print, or with its interval.
    pub fn computed_text(&self) -> String {
        let (digits, computed) = (decimals(self.printed.text), &self.computed);
        let half = computed.high - computed.value;
        match self.printed.quantity {
            PrintedQuantity::Servo(_) => format!("{:.digits$} +- {half:.digits$}", computed.value),
            _ => format!("{:.*}", digits + 1, computed.value),
        }
    }
}

/// Every printed number beside its computed one.
pub fn check(computed: &Computed) -> Vec<CheckedNumber> {
    let check = |printed: Printed| {
        let value = computed.value(printed.quantity);
        CheckedNumber {
            verdict: verdict(&printed, &value),
            computed: value,
            printed,
        }
    };
    printed().into_iter().map(check).collect()
}

/// Digits behind the point.
fn decimals(text: &str) -> usize {
    text.split_once('.').map_or(0, |(_, behind)| behind.len())
}

fn verdict(printed: &Printed, computed: &IntervalEstimate) -> Agreement {
    let Ok(value) = printed.text.parse::<f64>() else {
        return Agreement::Differs;
    };
    if let PrintedQuantity::Servo(_) = printed.quantity {
        return if computed.holds(value) {
            Agreement::Agrees
        } else {
            Agreement::Differs
        };
    }
    let digits = decimals(printed.text);
    // Half a unit of the last printed digit, and what binary numbers add to it.
    let half = 0.5 * 10f64.powi(-(digits as i32)) * (1.0 + 1e-9);
    let near = |value: f64| (value - computed.value).abs() <= half + 1e-12 * computed.value.abs();
    let meant = format!("{:.digits$}", computed.value);
    let pairs = printed.text.chars().zip(meant.chars());
    let few = pairs.filter(|(a, b)| a != b).count() <= MOST_DIGITS;
    match printed.text.len() == meant.len() && few {
        _ if near(value) => Agreement::Agrees,
        _ if near(-value) => Agreement::Sign,
        true => Agreement::Digits(printed.text.to_string(), meant),
        false => Agreement::Differs,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(text: &'static str, computed: f64) -> Agreement {
        let printed = Printed {
            place: "",
            quantity: PrintedQuantity::Pole(0),
            text,
            in_paper: true,
        };
        verdict(&printed, &IntervalEstimate::around(computed, 0.0))
    }

    #[test]
    fn printed_digits_decide() {
        assert_eq!(judged("1.23", 1.2349), Agreement::Agrees);
        assert_eq!(
            judged("1.23", 1.2351),
            Agreement::Digits("1.23".into(), "1.24".into())
        );
        assert_eq!(judged("-1.23", 1.2349), Agreement::Sign);
        assert_eq!(
            judged("114.7", 146.72),
            Agreement::Digits("114.7".into(), "146.7".into())
        );
        assert_eq!(judged("1.23", 9.87), Agreement::Differs);
        assert_eq!(judged("1.23", f64::NAN), Agreement::Differs);
    }
}
