//! That explanations cannot be told apart by these logs, and what would tell them apart.

use super::findings::{Alternative, Diagnosis, FittedEffect, Verdict, WrongValue};
use super::words::{SHOWN, explained_by};
use crate::effects;
use crate::model::{JointField, LinkField, ParameterPath};

/// "A says the same in other words." where an alternative does.
pub(super) fn same_in_other_words(diagnosis: &Diagnosis) -> Option<String> {
    let same = diagnosis.alternatives.iter().find(|other| other.same_law)?;
    let explained = explained_by(&same.effects, &same.wrong_values);
    Some(format!(
        "In other words, which say the same of every experiment: {explained}."
    ))
}

/// "These logs cannot tell them apart; what parts them: ..." where the verdict has rivals.
pub(super) fn inseparable(diagnosis: &Diagnosis) -> Option<String> {
    let others = others(diagnosis).next()?;
    let what = match diagnosis.verdict {
        Verdict::Ambiguous => "them apart".to_string(),
        _ => format!(
            "this from {}",
            explained_by(&others.effects, &others.wrong_values)
        ),
    };
    let remedy = remedy(diagnosis).map_or(String::new(), |remedy| {
        format!("; what parts them: {remedy}")
    });
    Some(format!("These logs cannot tell {what}{remedy}."))
}

/// The alternatives that say something else.
fn others(diagnosis: &Diagnosis) -> impl Iterator<Item = &Alternative> {
    let all = diagnosis.alternatives.iter();
    all.filter(|other| !other.same_law)
}

/// What separates the first explanations: a value measured by itself, or the experiment in which
/// two effects differ.
fn remedy(diagnosis: &Diagnosis) -> Option<String> {
    let others = others(diagnosis).take(SHOWN - 1);
    let own = (&diagnosis.effects, &diagnosis.wrong_values);
    let sets: Vec<(&Vec<FittedEffect>, &Vec<WrongValue>)> = std::iter::once(own)
        .chain(others.map(|other| (&other.effects, &other.wrong_values)))
        .collect();
    let by_values = sets.iter().filter(|(effects, _)| effects.is_empty());
    let mut measured = by_values.flat_map(|(_, values)| values.iter());
    if let Some(measure) = measured.find_map(|value| how_to_measure(&value.fitted.path)) {
        return Some(measure);
    }
    let differing = |a: &FittedEffect| {
        let in_set = |(effects, _): &(&Vec<FittedEffect>, &Vec<WrongValue>)| {
            effects
                .iter()
                .any(|b| (&a.kind, a.joint) == (&b.kind, b.joint))
        };
        !sets.iter().all(in_set)
    };
    let effects = sets.iter().flat_map(|(effects, _)| effects.iter());
    let kinds = effects
        .filter(|effect| differing(effect))
        .map(|effect| effect.kind.as_str());
    let kinds: Vec<&str> = kinds.collect();
    let infos = || {
        kinds
            .iter()
            .filter_map(|kind| Some(effects::named(kind)?.info()))
    };
    let parted = infos().flat_map(|info| info.confusions());
    let mut parted = parted.filter(|confusion| kinds.contains(&confusion.with));
    let experiment = || infos().next().map(|info| info.experiment.to_string());
    let by_confusion = parted.find_map(|confusion| Some(confusion.why.split_once("; ")?.1));
    by_confusion.map(str::to_string).or_else(experiment)
}

/// How a value of the model file is measured by itself; none for one of an effect.
pub fn how_to_measure(path: &str) -> Option<String> {
    let how = match path.parse().ok()? {
        ParameterPath::Link { index, field } => {
            let link = index + 1;
            match field {
                LinkField::Length => format!("measure link {link}"),
                LinkField::Com => format!("balance link {link} on an edge"),
                LinkField::Mass => format!("weigh link {link}"),
                LinkField::Inertia => {
                    format!("swing link {link} off its drive and time it")
                }
            }
        }
        ParameterPath::Joint { index, field } => {
            let joint = index + 1;
            match field {
                JointField::StallTorque | JointField::StallForce => {
                    format!("hold a known mass at a known arm with joint {joint}")
                }
                JointField::NoLoadSpeed | JointField::NoLoadLinearSpeed => {
                    format!("time joint {joint} without load at full duty")
                }
                JointField::GainPerRad
                | JointField::GainSPerRad
                | JointField::GainPerM
                | JointField::GainSPerM => {
                    format!("read the gain that is set in the servo of joint {joint}")
                }
            }
        }
        ParameterPath::Effect { .. } => return None,
    };
    Some(how)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_measured_by_itself() {
        assert_eq!(
            how_to_measure("link2.mass_kg").as_deref(),
            Some("weigh link 2")
        );
        let torque = how_to_measure("joint1.stall_torque_nm").unwrap();
        assert!(torque.contains("known mass"), "{torque}");
        assert_eq!(how_to_measure("viscous@1.coefficient_nm_s_rad"), None);
    }
}
