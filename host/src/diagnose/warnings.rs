//! What a diagnosis warns of.

use super::findings::Diagnosis;
use crate::output::number::{percent, short, with_unit};

/// Pairs of values warned of; the rest are counted.
const PAIRS: usize = 3;

pub(super) fn on_bound(diagnosis: &Diagnosis) -> impl Iterator<Item = String> {
    let added = diagnosis
        .effects
        .iter()
        .flat_map(|effect| &effect.parameters);
    let values = diagnosis
        .base
        .iter()
        .chain(added)
        .filter(|value| value.on_bound);
    values.map(|value| {
        format!(
            "{} = {} lies on its bound: the data push it further than is physical, or it is not needed",
            value.path,
            with_unit(&short(value.value), &value.unit)
        )
    })
}

/// The pairs told apart worst, worst first.
pub(super) fn pairs(diagnosis: &Diagnosis) -> Vec<String> {
    let mut pairs: Vec<_> = diagnosis.collinear.iter().collect();
    pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    let more = pairs.len().saturating_sub(PAIRS);
    let mut lines: Vec<String> = pairs
        .into_iter()
        .take(PAIRS)
        .map(|(a, b, r)| {
            let correlation = percent(r.abs());
            format!(
                "{a} and {b} are hardly told apart by these motions (correlation {correlation})"
            )
        })
        .collect();
    if more > 0 {
        lines.push(format!("and {more} more such pairs"));
    }
    lines
}

/// That the explanation was judged in shorter integration steps than the file's.
pub(super) fn shorter_steps(diagnosis: &Diagnosis) -> Option<String> {
    let step_s = diagnosis.shorter_step_s?;
    Some(format!(
        "the integration steps of the file are too long for this explanation: it was judged with \
         step_s = {}, which `add` and `fit` write",
        short(step_s)
    ))
}
