//! The range of a number in a TOML file.

use std::fmt;

/// A range; `Display` reads on from "a number": "above 0, up to 1000".
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Lowest value.
    pub low: f64,
    /// Highest value.
    pub high: f64,
    /// Whether `low` itself is refused.
    pub above: bool,
}

impl Limits {
    /// From `low` to `high`.
    pub const fn within(low: f64, high: f64) -> Self {
        Limits {
            low,
            high,
            above: false,
        }
    }

    /// Above `low`, up to `high`.
    pub const fn above(low: f64, high: f64) -> Self {
        Limits {
            low,
            high,
            above: true,
        }
    }

    /// Whether the number is finite and in the range.
    pub fn allow(self, number: f64) -> bool {
        let low = number > self.low || !self.above && number == self.low;
        number.is_finite() && low && number <= self.high
    }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Limits { low, high, above } = self;
        match (above, high.is_finite()) {
            (true, true) => write!(f, "above {low}, up to {high}"),
            (true, false) => write!(f, "above {low}"),
            (false, _) => write!(f, "from {low} to {high}"),
        }
    }
}
