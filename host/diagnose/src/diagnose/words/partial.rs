//! What an explanation that is not the whole of it is good for, in words.

use super::super::findings::{Diagnosis, FittedEffect};
use super::super::names::joined;
use crate::output::number::short;

/// An explanation that leaves no more than this share of the squared error is a usable model: of
/// the error itself a thirtieth.
const USABLE: f64 = 1e-3;

/// How far what comes closest may be relied on.
pub(super) fn worth(diagnosis: &Diagnosis) -> String {
    let error = &diagnosis.error;
    let before = error.refitted_rad.unwrap_or(error.before_rad);
    let left = (error.after_rad / before).powi(2);
    if !error.held_out || left.is_nan() || left > USABLE {
        return "What comes closest is not the whole of it: do not take it for the cause.".into();
    }
    let unit = error.quantity.milli();
    let [after, before] = [error.after_rad, before].map(|rad| short(1e3 * rad));
    let shared: Vec<FittedEffect> = in_every(diagnosis).cloned().collect();
    let shared = if shared.is_empty() || diagnosis.alternatives.is_empty() {
        String::new()
    } else {
        format!(" Whatever does as well has {}, too.", joined(&shared))
    };
    format!(
        "It is a usable model, which leaves {after} of {before} {unit} on motions that it was not \
         fitted to, and not the whole of it: what is left follows no known effect.{shared}"
    )
}

/// The effects that every explanation as good has, too.
fn in_every(diagnosis: &Diagnosis) -> impl Iterator<Item = &FittedEffect> {
    diagnosis.effects.iter().filter(|effect| {
        let mut alternatives = diagnosis.alternatives.iter();
        alternatives.all(|other| {
            let mut own = other.effects.iter();
            own.any(|own| own.kind == effect.kind && own.joint == effect.joint)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::super::tests::{effect, said};
    use super::worth;
    use crate::diagnose::Verdict;

    #[test]
    fn a_thirtieth_of_the_error_is_a_model_to_use() {
        let both = ["coulomb", "viscous"].map(|kind| effect(kind, Some(1)));
        let other = ["stribeck", "viscous"].map(|kind| effect(kind, Some(1)));
        let mut found = said(Verdict::Unexplained, both.to_vec(), vec![other.to_vec()]);
        found.error.refitted_rad = Some(40.0 * found.error.after_rad);
        let usable = worth(&found);
        assert!(usable.starts_with("It is a usable model"), "{usable}");
        let shared = "Whatever does as well has viscous friction at joint 1, too.";
        assert!(usable.ends_with(shared), "{usable}");
        found.alternatives.clear();
        assert!(!worth(&found).contains("Whatever"));

        let is_warned = |found: &_| worth(found).contains("do not take it for the cause");
        let mut less = found.clone();
        less.error.refitted_rad = Some(20.0 * less.error.after_rad);
        assert!(is_warned(&less));
        found.error.held_out = false;
        assert!(is_warned(&found));
    }
}
