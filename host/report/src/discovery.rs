//! A discovery as text and JSON: the law, what it leaves, and what else would do.

use crate::json::diagnosis_json;
use crate::text::{error, list, parameters};
use crate::words::in_milli;
use handstand_diagnose::discover::{DiscoveredTerm, Discovery, DiscoveryVerdict};
use handstand_model::model::JointNames;
use serde_json::{Value, json};

/// Laws shown beside the one found.
const SHOWN: usize = 5;

/// Everything a discovery says that fits a terminal.
pub fn discovery_text(discovery: &Discovery, names: &JointNames) -> String {
    let diagnosis = &discovery.diagnosis;
    let mut headline = vec![format!("Verdict: {}", sentence(discovery.verdict))];
    if discovery.verdict == DiscoveryVerdict::Unfit {
        headline.extend(diagnosis.summary.iter().cloned());
    }
    let law = discovery.terms.iter();
    let law: Vec<String> = law.map(|term| line(term, names)).collect();
    let wrong = diagnosis
        .wrong_values
        .iter()
        .map(|wrong| wrong.fitted.to_string());
    let sections = [
        Some(headline.join("\n")),
        list("The model lacks, in sum", &law),
        list("Wrong values", &wrong.collect::<Vec<_>>()),
        parameters("Values", &diagnosis.effects, names),
        error(diagnosis),
        list("As good", &others(discovery, names)),
        list("Next", &next(discovery)),
        list("Warnings", &diagnosis.warnings),
    ];
    let sections: Vec<String> = sections.into_iter().flatten().collect();
    names.in_text(&sections.join("\n\n")) + "\n"
}

/// The discovery as JSON: `verdict`, `terms`, `others`, and the `diagnosis` it rests on.
pub fn discovery_json(discovery: &Discovery) -> Value {
    let others = discovery.others.iter();
    let others = others.map(|(terms, error_rad)| json!({ "terms": terms, "error_rad": error_rad }));
    json!({
        "verdict": discovery.verdict,
        "terms": discovery.terms,
        "others": others.collect::<Vec<_>>(),
        "diagnosis": diagnosis_json(&discovery.diagnosis),
    })
}

/// The verdict in a sentence.
fn sentence(verdict: DiscoveryVerdict) -> &'static str {
    match verdict {
        DiscoveryVerdict::NothingMissing => {
            "nothing is missing. The model explains the logs to their noise."
        }
        DiscoveryVerdict::WrongValue => {
            "wrong value. With other values in the file nothing is missing."
        }
        DiscoveryVerdict::Found => "found. This law leaves nothing but noise.",
        DiscoveryVerdict::Ambiguous => {
            "found, and not alone. Other laws leave as little: the logs do not tell them apart."
        }
        DiscoveryVerdict::Partial => {
            "a part. This law removes a part of the error; more than noise is left, and no third \
             term explains it."
        }
        DiscoveryVerdict::NotFound => {
            "not found. No law of the joint's angle, speed, load, input, supply or time explains \
             what is left: it depends on the past, or on a body that is not measured."
        }
        DiscoveryVerdict::Unfit => "unfit.",
    }
}

/// "joint 1: torque = -0.0112 * dir * abs(w / 5)^2.98 (drag_power)"
fn line(term: &DiscoveredTerm, names: &JointNames) -> String {
    let place = match term.joint {
        Some(joint) => names
            .joint(joint)
            .map_or(format!("joint {joint}"), str::to_string),
        None => "every driven joint".to_string(),
    };
    format!("{place}: {} = {}", term.site, term.with_values)
}

fn others(discovery: &Discovery, names: &JointNames) -> Vec<String> {
    let quantity = discovery.diagnosis.error.quantity;
    let other = |(terms, error_rad): &(Vec<DiscoveredTerm>, f64)| {
        let terms = terms.iter().map(|term| line(term, names));
        let terms = terms.collect::<Vec<_>>().join(" and ");
        format!("{}: {terms}", in_milli(*error_rad, quantity))
    };
    let mut lines: Vec<String> = discovery.others.iter().take(SHOWN).map(other).collect();
    if discovery.others.len() > SHOWN {
        lines.push(format!("and {} more", discovery.others.len() - SHOWN));
    }
    lines
}

fn next(discovery: &Discovery) -> Vec<String> {
    match discovery.verdict {
        DiscoveryVerdict::Unfit => discovery.diagnosis.next.clone(),
        DiscoveryVerdict::WrongValue => {
            vec!["fit the value: `handstand fit MODEL LOGS --free PATH -o NEW.toml`".to_string()]
        }
        _ if discovery.has_law() => vec![
            "`-o NEW.toml` writes the model with this law: an `[[expression]]` per term, fitted \
             like any effect"
                .to_string(),
        ],
        _ => Vec::new(),
    }
}
