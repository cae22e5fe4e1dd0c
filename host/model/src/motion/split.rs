//! Splits motions into training and held-out ones.

use super::Motion;
use crate::error::{Error, Result};

/// What to do about rows that are fitted and held out.
pub const NAME_ONCE: &str = "name each row once, a range includes its end: what was learned from \
                             proves nothing";

/// Motions to learn from and motions to be judged by; none is in both.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Split {
    /// Fitted.
    pub training: Vec<Motion>,
    /// Predicted only. Empty when there was a single motion: then no claim about new motions can be
    /// made.
    pub held_out: Vec<Motion>,
}

impl Split {
    /// Motions to learn from and motions to judge by, which came without their files.
    ///
    /// # Errors
    /// A motion that is in both, whatever it is called.
    pub fn told_apart(training: Vec<Motion>, held_out: Vec<Motion>) -> Result<Split> {
        for held in &held_out {
            let Some(fitted) = training.iter().find(|motion| motion.holds_the_same(held)) else {
                continue;
            };
            let (held, fitted) = (&held.name, &fitted.name);
            let message = if held == fitted {
                format!("{held} is fitted and held out")
            } else {
                format!(
                    "{held} is held out, and shares rows with {fitted}, which is fitted; the two \
                 motions hold the same samples"
                )
            };
            return Err(Error::usage(message, NAME_ONCE));
        }
        Ok(Split { training, held_out })
    }
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
    use crate::fixture::motion;

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
    fn a_motion_that_is_fitted_is_not_held_out() {
        let all = vec![motion("a", 20), motion("b", 30)];
        let told = |held: Motion| Split::told_apart(all.clone(), vec![held]);
        let said = |held: Motion| told(held).unwrap_err().to_string();
        assert_eq!(said(motion("a", 20)), "a is fitted and held out");
        let copy = Motion {
            name: "copy".into(),
            rate_rad_s: vec![None; 9],
            ..motion("b", 30)
        };
        assert!(said(copy).contains("copy is held out, and shares rows with b"));
        // A reader's zero, and one of a column with a sign.
        let mut zero = all.clone();
        zero[0].position_rad[0][5] = 0.0;
        let mut signed = zero[0].clone();
        signed.position_rad[0][5] = -0.0;
        assert!(Split::told_apart(zero, vec![signed]).is_err());
        let mut other = motion("a", 20);
        other.position_rad[0][7] += 1e-12;
        assert!(told(other).is_ok());
        let mut gap = all.clone();
        gap[0].position_rad[0][3] = f64::NAN;
        let held = vec![gap[0].clone()];
        assert!(Split::told_apart(gap, held).is_err(), "gaps are equal");
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
