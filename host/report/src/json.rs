//! The report as JSON.

use super::Report;
use crate::diagnose::Diagnosis;
use crate::study::Verification;
use crate::synth::Design;
use crate::synth::export::{self, Provenance};
use handstand_diagnose::discover::Discovery;
use serde_json::{Map, Value};

/// The whole report, its diagnosis as [`diagnosis_json`] writes it. Values that are no number
/// become `null`.
pub fn json(report: &Report) -> Value {
    let mut value = plain(report);
    if let Some(diagnosis) = &report.diagnosis {
        value["diagnosis"] = diagnosis_json(diagnosis);
    }
    value
}

/// A diagnosis: its fields as they are, but the `parameters` of effects keyed by name:
/// `{"torque_nm": {"value", "low", "high", "unit", "on_bound"}}`. Values that are no number become
/// `null`.
pub fn diagnosis_json(diagnosis: &Diagnosis) -> Value {
    let mut value = plain(diagnosis);
    key_parameters(&mut value, "effects");
    for alternative in value["alternatives"].as_array_mut().into_iter().flatten() {
        key_parameters(alternative, "effects");
    }
    value
}

/// A discovery: its fields as they are, the `parameters` of terms keyed as those of a diagnosis's
/// effects, and the `diagnosis` it rests on.
pub fn discovery_json(discovery: &Discovery) -> Value {
    let mut value = plain(discovery);
    key_parameters(&mut value, "terms");
    for other in value["others"].as_array_mut().into_iter().flatten() {
        key_parameters(other, "terms");
    }
    value["diagnosis"] = diagnosis_json(&discovery.diagnosis);
    value
}

/// Gains as [`export::json`] writes them, and the simulated loop's `verification`.
pub fn gains_json(design: &Design, made: &Provenance, verification: &Verification) -> Value {
    let mut value = export::json(design, made);
    value["verification"] = plain(verification);
    value
}

fn plain(value: &impl serde::Serialize) -> Value {
    serde_json::to_value(value).expect("plain values with text keys are always JSON")
}

/// Keys the parameters of what stands in a list.
fn key_parameters(holder: &mut Value, list: &str) {
    for effect in holder[list].as_array_mut().into_iter().flatten() {
        effect["parameters"] = keyed(effect["parameters"].take());
    }
}

fn keyed(parameters: Value) -> Value {
    let mut object = Map::new();
    for mut parameter in parameters.as_array().cloned().unwrap_or_default() {
        let key = parameter["key"].as_str().unwrap_or_default().to_string();
        let fields = ["value", "low", "high", "unit", "on_bound"];
        let taken = fields.map(|field| (field.to_string(), parameter[field].take()));
        object.insert(key, Value::Object(taken.into_iter().collect()));
    }
    Value::Object(object)
}

#[cfg(test)]
mod tests {
    use super::super::tests::sample;
    use super::*;

    #[test]
    fn parameters_are_keyed_by_name() {
        let value = json(&sample::report());
        let diagnosis = &value["diagnosis"];
        assert_eq!(diagnosis["verdict"], "named");
        let effect = &diagnosis["effects"][0];
        assert_eq!(effect["kind"], "coulomb");
        assert_eq!(effect["joint"], 1);
        assert_eq!(
            effect["parameters"]["torque_nm"],
            serde_json::json!({
                "value": 0.0821, "low": 0.0794, "high": 0.0851, "unit": "N m", "on_bound": false
            })
        );
        assert!(diagnosis["alternatives"][0]["effects"][0]["parameters"].is_object());
        for key in ["before_rad", "after_rad", "floor_rad"] {
            assert!(!diagnosis["error"][key].is_null(), "{key}");
        }
        assert!(value["provenance"]["logs"][0]["sha256"].is_string());
    }

    #[test]
    fn what_is_no_number_becomes_null() {
        let mut diagnosis = sample::diagnosis();
        diagnosis.error.after_rad = f64::NAN;
        diagnosis.effects[0].parameters[0].high = f64::INFINITY;
        let value = diagnosis_json(&diagnosis);
        assert!(value["error"]["after_rad"].is_null());
        assert!(value["effects"][0]["parameters"]["torque_nm"]["high"].is_null());
    }
}
