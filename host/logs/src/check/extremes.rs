//! The extremes of a series.

/// Lowest and highest value, and how often each occurs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extremes {
    /// Lowest value, and how often.
    pub low: (f64, usize),
    /// Highest value, and how often.
    pub high: (f64, usize),
    /// How many values.
    pub count: usize,
}

impl Extremes {
    /// Of no value.
    pub const NONE: Extremes = Extremes {
        low: (f64::INFINITY, 0),
        high: (f64::NEG_INFINITY, 0),
        count: 0,
    };

    /// Takes a value; what is not a number was not measured.
    pub fn take(&mut self, value: f64) {
        if value.is_nan() {
            return;
        }
        self.count += 1;
        let (below, above) = (value < self.low.0, value > self.high.0);
        for (extreme, beyond) in [(&mut self.low, below), (&mut self.high, above)] {
            if beyond {
                *extreme = (value, 1);
            } else if value == extreme.0 {
                extreme.1 += 1;
            }
        }
    }

    /// Highest less lowest.
    pub fn range(&self) -> f64 {
        (self.high.0 - self.low.0).max(0.0)
    }

    /// The extremes at which more than 5 % of the samples sit, with their share.
    pub fn crowded(&self) -> impl Iterator<Item = (f64, f64)> {
        let count = self.count.max(1) as f64;
        [self.low, self.high]
            .into_iter()
            .map(move |(value, times)| (value, times as f64 / count))
            .filter(|(_, share)| *share > 0.05)
    }
}
