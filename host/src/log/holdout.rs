//! Splits motions into training and held-out ones.

use super::Motion;

/// Motions to learn from and motions to be judged by; none is in both.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Split {
    /// Fitted.
    pub training: Vec<Motion>,
    /// Predicted only. Empty when there was a single motion: then no claim about new motions can be
    /// made.
    pub held_out: Vec<Motion>,
}

/// Splits by whole motions. `explicit_holdout` is held out if there is any; otherwise the last
/// third of `motions`, at least one and never more than a half; a single motion is all trained on.
pub fn split(mut motions: Vec<Motion>, explicit_holdout: Vec<Motion>) -> Split {
    if !explicit_holdout.is_empty() {
        return Split {
            training: motions,
            held_out: explicit_holdout,
        };
    }
    let count = match motions.len() {
        0 | 1 => 0,
        all => (all / 3).max(1),
    };
    let held_out = motions.split_off(motions.len() - count);
    Split {
        training: motions,
        held_out,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::tests::fixture::motion;

    #[test]
    fn holds_out_the_last_third() {
        for (all, held) in [
            (0, 0),
            (1, 0),
            (2, 1),
            (3, 1),
            (4, 1),
            (5, 1),
            (6, 2),
            (22, 7),
        ] {
            let motions: Vec<_> = (0..all).map(|i| motion(&format!("m{i}"), 20)).collect();
            let split = split(motions, Vec::new());
            assert_eq!(split.held_out.len(), held);
            assert_eq!(split.training.len(), all - held);
            assert!(all == 0 || split.training[0].name == "m0");
        }
    }

    #[test]
    fn an_explicit_holdout_wins() {
        let split = split(
            vec![motion("a", 20), motion("b", 20)],
            vec![motion("c", 20)],
        );
        assert_eq!(split.training.len(), 2);
        assert_eq!(split.held_out[0].name, "c");
    }
}
