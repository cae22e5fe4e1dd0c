//! Sliders for every value of the model and every effect of the library.

use super::compare::motions;
use super::{evaluated, frame, in_milli};
use crate::diagnose::candidates;
use crate::effects::Parameter;
use crate::fitting::Candidate;
use crate::model::{JointField, Link, LinkField, Model, ParameterPath};
use crate::reply::LabError;
use crate::session::{LabSession, SessionEvaluation, value_name};
use maud::{Markup, PreEscaped, html};
use serde_json::{Value, json};

/// The page.
pub fn page(session: &LabSession) -> Result<Markup, LabError> {
    let saved = session.view();
    let (evaluation, body) = evaluated(session, &saved, |evaluation| Ok(shown(evaluation)))?;
    let script = match evaluation {
        Some(_) => "what_if.js",
        None => "lab.js",
    };
    Ok(frame::page(
        session,
        &saved,
        "what-if",
        evaluation.as_deref(),
        script,
        &body,
    ))
}

fn shown(evaluation: &SessionEvaluation) -> Markup {
    let model = &evaluation.run.model;
    let candidates = candidates(model, &evaluation.run.data.motions, &[]);
    // What could end the script element is written otherwise.
    let library = library(model, &candidates)
        .to_string()
        .replace('<', "\\u003c");
    html! {
        section {
            h1 { "What if a value were another one?" }
            p.lead { "Move a slider and watch the curves. The windows and their noise floor stay \
                      those of the model as it is." }
            div.bench {
                div.bench-sliders {
                    div.row {
                        label for="effect" { "Try an effect" }
                        select #effect {
                            @for candidate in &candidates {
                                option value=(candidate.to_string()) {
                                    (candidate.effect.info().title)
                                    @if let Some(joint) = candidate.joint { ", joint " (joint + 1) }
                                }
                            }
                        }
                        button #add-effect type="button" { "Try it" }
                    }
                    div #sliders {}
                    div.row {
                        button.main #keep type="button" { "Keep as the next step" }
                        button #reset type="button" { "As it was" }
                    }
                }
                div.bench-curves {
                    div.big-error aria-live="polite" {
                        span { "Error " span #error-about {}
                            b #error-if { (in_milli(evaluation.rms(), evaluation)) } " "
                            (evaluation.over()) }
                        span { "as it is " b #error-was { (in_milli(evaluation.rms(), evaluation)) }
                            }
                        span { "floor " (in_milli(evaluation.floor(), evaluation)) }
                    }
                    div.row { (motions(evaluation)) }
                    div #curves data-kind="what-if" {}
                }
            }
            script #library type="application/json" { (PreEscaped(library)) }
        }
    }
}

/// What can be moved: the model's own values, then each effect's.
fn library(model: &Model, candidates: &[Candidate]) -> Value {
    let own = own_paths(model).into_iter().filter_map(|path| {
        let value = path.get(model).filter(|value| value.is_finite())?;
        let (low, high) = match parameter(model, path) {
            Some(parameter) => effect_range(parameter, value),
            None if value == 0.0 => range_of_zero(model, path),
            None => (0.25 * value.abs(), 4.0 * value.abs()),
        };
        let (low, high) = if value < 0.0 && low > value {
            (-high, -low)
        } else {
            (low, high)
        };
        let meaning = parameter(model, path).map_or("", |parameter| parameter.meaning);
        Some(entry(path, value, (low, high), meaning))
    });
    let effects = candidates.iter().map(|candidate| {
        let info = candidate.effect.info();
        let values = candidate
            .paths()
            .zip(candidate.parameters())
            .map(|(path, parameter)| {
                let value = parameter.starts[0];
                entry(
                    path,
                    value,
                    effect_range(parameter, value),
                    parameter.meaning,
                )
            });
        json!({
            "name": candidate.to_string(),
            "title": info.title,
            "law": info.law,
            "values": values.collect::<Vec<_>>(),
        })
    });
    json!({ "values": own.collect::<Vec<_>>(), "effects": effects.collect::<Vec<_>>() })
}

fn entry(path: ParameterPath, value: f64, (low, high): (f64, f64), meaning: &str) -> Value {
    json!({
        "path": path.to_string(),
        "name": value_name(&path.to_string()),
        "unit": path.unit(),
        "value": value,
        "low": low,
        "high": high,
        "meaning": meaning,
    })
}

/// From a value that is zero to what a link of this rig's size and mass may have.
fn range_of_zero(model: &Model, path: ParameterPath) -> (f64, f64) {
    let largest = |of: fn(&Link) -> f64| model.links.iter().map(of).fold(0.0, f64::max);
    let size_m = largest(|link| link.length_m.max(link.com_m.abs()));
    let mass_kg = largest(|link| link.mass_kg);
    let high = match path {
        ParameterPath::Link { field, .. } => match field {
            LinkField::Length | LinkField::Com => size_m,
            LinkField::Mass => mass_kg,
            LinkField::Inertia => mass_kg * size_m * size_m,
        },
        _ => Some(path.bounds(model).1)
            .filter(|high| high.is_finite())
            .unwrap_or(1.0),
    };
    (0.0, high)
}

/// Addresses of every number of a model.
pub(super) fn own_paths(model: &Model) -> Vec<ParameterPath> {
    let links = (0..model.link_count())
        .flat_map(|index| LinkField::ALL.map(|field| ParameterPath::Link { index, field }));
    let joints = (0..model.link_count())
        .flat_map(|index| JointField::ALL.map(|field| ParameterPath::Joint { index, field }));
    let effects = model.effects.iter().flat_map(ParameterPath::of_effect);
    links.chain(joints).chain(effects).collect()
}

fn parameter(model: &Model, path: ParameterPath) -> Option<&'static Parameter> {
    let ParameterPath::Effect {
        id,
        joint,
        parameter,
        ..
    } = path
    else {
        return None;
    };
    let is = |e: &&crate::model::EffectInstance| e.effect.info().id == id && e.joint == joint;
    model
        .effects
        .iter()
        .find(is)?
        .effect
        .info()
        .parameters
        .get(parameter)
}

/// From where the effect vanishes to three times what is met in practice, within its bounds.
fn effect_range(parameter: &Parameter, value: f64) -> (f64, f64) {
    let (typical_low, typical_high) = parameter.typical;
    let off = parameter.off.filter(|off| off.is_finite());
    let off_or = |end: f64| off.unwrap_or(end);
    let low = typical_low.min(off_or(typical_low)).min(value);
    let high = typical_high.max(off_or(typical_high)).max(value);
    let middle = off_or(low);
    let (low, high) = (
        middle + 3.0 * (low - middle),
        middle + 3.0 * (high - middle),
    );
    (low.max(parameter.bounds.0), high.min(parameter.bounds.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_value_of_zero_can_be_moved_too() {
        let text = "[rig]\nname = \"p\"\nangle_zero = \"hanging\"\n\
             [[link]]\ncom_m = 0.1\nmass_kg = 0.2\ninertia_kg_m2 = 0.0\n\
             [[joint]]\ndrive = \"passive\"\n[log]\ntime = { column = \"t\", unit = \"s\" }\n\
             [[log.joint]]\nposition = { column = \"q\", unit = \"rad\" }\n";
        let model = Model::parse(text, Path::new("p.toml")).unwrap();
        let library = library(&model, &[]);
        let values = library["values"].as_array().unwrap();
        assert!(
            values
                .iter()
                .any(|value| value["path"] == "link1.inertia_kg_m2")
        );
        for value in values {
            let (low, high) = (value["low"].as_f64(), value["high"].as_f64());
            assert!(low.unwrap() < high.unwrap(), "{value}");
        }
    }
}
