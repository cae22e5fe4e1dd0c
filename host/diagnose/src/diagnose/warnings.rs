//! What a diagnosis warns of.

use super::findings::Diagnosis;
use super::inseparable::how_to_measure;
use super::names::listed;
use crate::effects::parameter;
use crate::fitting::FittedValue;
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

/// Values of an effect that only a mixture of which is known: their intervals are all that they may
/// be, though the effect is there.
pub(super) fn unidentified(diagnosis: &Diagnosis) -> impl Iterator<Item = String> {
    diagnosis.effects.iter().filter_map(|effect| {
        let may_be_anything = |value: &&FittedValue| {
            let known = parameter(&effect.kind, &value.key);
            known.is_some_and(|known| value.low <= known.bounds.0 && known.bounds.1 <= value.high)
        };
        let values = effect.parameters.iter().filter(may_be_anything);
        let paths: Vec<String> = values.map(|value| value.path.clone()).collect();
        let (not_known, known) = match paths.len() {
            0 => return None,
            1 => ("does not follow", "it is known only together with others"),
            _ => ("do not follow", "they are known only together"),
        };
        Some(format!(
            "{} {not_known} from these motions: {known}",
            listed(paths)
        ))
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
            let measured = how_to_measure(a).or_else(|| how_to_measure(b));
            let remedy = measured.map_or(String::new(), |how| format!("; {how}, and fix it"));
            format!(
                "{a} and {b} are hardly told apart by these motions (correlation \
                 {correlation}){remedy}"
            )
        })
        .collect();
    if more > 0 {
        lines.push(format!("and {more} more such pairs"));
    }
    lines
}

/// That the explanation was fitted in shorter integration steps than the file's.
pub(super) fn shorter_steps(diagnosis: &Diagnosis) -> Option<String> {
    let step_s = diagnosis.shorter_step_s?;
    Some(format!(
        "the integration steps of the file are too long for this explanation: its values were \
         fitted with step_s = {}, which `add` and `fit` write",
        short(step_s)
    ))
}
