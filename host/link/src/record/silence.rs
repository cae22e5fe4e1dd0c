//! A servo that falls silent while the others answer.

/// So many answers of a servo missing on end are no bad line: it has fallen silent.
const ON_END: u64 = 10;
/// Share of its answers that a line may lose before that is told.
const MOST_SHARE: f64 = 0.05;

/// Answers of one servo that did not come.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct ServoSilence {
    samples: u64,
    missed: u64,
    on_end: u64,
    longest: u64,
}

impl ServoSilence {
    /// Counts a sample that the servo `answered` in, or did not.
    pub fn count(&mut self, answered: bool) {
        self.samples += 1;
        self.missed += u64::from(!answered);
        self.on_end = if answered { 0 } else { self.on_end + 1 };
        self.longest = self.longest.max(self.on_end);
    }

    /// The share of the samples in which it did not answer, where that is more than a line loses
    /// now and then.
    pub fn share(&self) -> Option<f64> {
        let share = self.missed as f64 / self.samples.max(1) as f64;
        (self.longest >= ON_END || share > MOST_SHARE).then_some(share)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(answered: impl Iterator<Item = bool>) -> Option<f64> {
        let mut silence = ServoSilence::default();
        answered.for_each(|answered| silence.count(answered));
        silence.share()
    }

    #[test]
    fn gaps_are_gaps_and_silence_is_told() {
        assert_eq!(share(std::iter::empty()), None);
        assert_eq!(share((0..1000).map(|k| k % 50 != 0)), None);
        assert_eq!(share((0..1000).map(|k| k % 10 != 0)), Some(0.1));
        assert_eq!(share((0..1000).map(|k| !(400..409).contains(&k))), None);
        assert_eq!(share((0..1000).map(|k| k < 990)), Some(0.01));
        assert_eq!(share((0..40).map(|_| false)), Some(1.0));
    }
}
