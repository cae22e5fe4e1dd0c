//! Whether an explanation that leaves nothing in short windows holds over long runs, too.

use super::block_errors::BlockErrors;
use super::explanation::VerdictEvidence;
use crate::fitting::{Horizon, fit_start_states};
use crate::output::number::short;

/// Times the noise above which a long run shows what short windows do not.
const FAR: f64 = 3.0;

/// What long runs show of an explanation that is judged in short windows, chosen from the data, and
/// leaves nothing but noise there; none where they show no more.
///
/// Windows are short where long runs are lost to something else that is missing. Once the rest is
/// explained, what is left of that shows.
pub(super) fn longer_runs(evidence: &VerdictEvidence) -> Option<String> {
    let (evaluator, chosen) = (evidence.evaluator, evidence.chosen());
    let chosen_from_data = !evaluator.horizon_given && evaluator.horizon != Horizon::Whole;
    if !chosen_from_data || !evaluator.at_noise_floor(chosen) {
        return None;
    }
    let data = evaluator.held_out.as_ref().unwrap_or(&evaluator.training);
    let whole = data.recut(Horizon::Whole);
    let fit = fit_start_states(&chosen.fit().model, &whole);
    warning(BlockErrors::of(&fit.residuals, &whole).rms())
}

/// `times` is the error of long runs in units of the noise.
fn warning(times: f64) -> Option<String> {
    (times > FAR).then(|| {
        format!(
            "over long runs the explanation leaves {} times the noise: something that short \
             windows do not show may be missing too, or the motion sticks a sample sooner or \
             later; add what is named and diagnose again with --horizon whole",
            short(times)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::warning;

    #[test]
    fn long_runs_are_warned_of_where_they_leave_more_than_noise() {
        assert_eq!(warning(1.4), None);
        assert_eq!(warning(f64::NAN), None);
        assert!(warning(20.0).unwrap().contains("20.0 times the noise"));
    }
}
