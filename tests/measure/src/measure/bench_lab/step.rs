//! A step that a person takes, and how long it took each time.

/// What was measured of a step.
#[derive(Debug, Clone)]
pub struct Step {
    /// What was done.
    pub what: String,
    /// How long it may take, ms.
    pub limit_ms: f64,
    /// How long it took, in ascending order, ms.
    times_ms: Vec<f64>,
}

impl Step {
    /// A step measured some times.
    pub fn new(what: impl Into<String>, limit_ms: f64, mut times_ms: Vec<f64>) -> Step {
        times_ms.sort_by(f64::total_cmp);
        Step {
            what: what.into(),
            limit_ms,
            times_ms,
        }
    }

    /// The time within which this share of the rounds was done, ms; not a number of none.
    pub fn quantile_ms(&self, share: f64) -> f64 {
        let last = self.times_ms.len().saturating_sub(1) as f64;
        let at = (last * share).round() as usize;
        self.times_ms.get(at).copied().unwrap_or(f64::NAN)
    }

    /// Whether the median keeps the limit.
    pub fn in_time(&self) -> bool {
        self.quantile_ms(0.5) <= self.limit_ms
    }
}
