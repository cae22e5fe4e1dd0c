//! What a number of a model file may be, and how that is asked for.

/// What a number may be.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limits {
    pub low: f64,
    pub high: f64,
    /// Whether `low` itself is refused, shown as "above".
    pub above: bool,
}

impl Limits {
    pub const fn within(low: f64, high: f64) -> Self {
        Limits {
            low,
            high,
            above: false,
        }
    }

    pub const fn above(low: f64, high: f64) -> Self {
        Limits {
            low,
            high,
            above: true,
        }
    }

    pub fn allow(self, number: f64) -> bool {
        number <= self.high
            && if self.above {
                number > self.low
            } else {
                number >= self.low
            }
    }

    pub fn wish(self) -> String {
        let Limits { low, high, above } = self;
        match (above, high.is_finite()) {
            (true, true) => format!("give a number above {low}, up to {high}"),
            (true, false) => format!("give a number above {low}"),
            (false, _) => format!("give a number from {low} to {high}"),
        }
    }
}
