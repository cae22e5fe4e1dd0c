//! What a diagnosis said, read from its JSON: the only place that knows its keys.

use serde::Deserialize;
use serde_json::Value as Json;
use std::collections::BTreeMap;

/// A value with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SaidValue {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// An effect that a result gives.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SaidEffect {
    pub kind: String,
    /// Counted from 1; none when it acts on the whole rig.
    pub joint: Option<usize>,
    /// By key.
    pub parameters: BTreeMap<String, SaidValue>,
}

/// What a result says.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Said {
    /// The verdict, in its own word.
    pub verdict: String,
    /// Effects of the best explanation.
    pub effects: Vec<SaidEffect>,
    /// What the best explanation says is missing or wrong, then what those say that do as well:
    /// addresses of effects, and of values that explain by themselves.
    pub sets: Vec<Vec<String>>,
    /// Values of the model that were fitted, by path.
    pub values: Vec<(String, f64)>,
    /// Seconds run without correction, where the result has one such number.
    pub horizon_s: Option<f64>,
    /// The integration step of the best explanation, where it is shorter than the file's.
    pub shorter_step_s: Option<f64>,
}

impl SaidEffect {
    pub fn address(&self) -> String {
        match self.joint {
            Some(joint) => format!("{}@{joint}", self.kind),
            None => self.kind.clone(),
        }
    }

    pub fn value(&self, key: &str) -> Option<f64> {
        self.parameters.get(key).map(|said| said.value)
    }
}

#[derive(Deserialize)]
struct JsonEffect {
    kind: String,
    joint: Option<usize>,
    parameters: BTreeMap<String, JsonValue>,
}

#[derive(Deserialize)]
struct JsonValue {
    value: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
}

fn effects(json: &Json) -> Vec<SaidEffect> {
    let list = json.as_array().into_iter().flatten();
    let effects = list.filter_map(|json| JsonEffect::deserialize(json).ok());
    let number = |value: Option<f64>, otherwise: f64| value.unwrap_or(otherwise);
    effects
        .map(|effect| SaidEffect {
            kind: effect.kind,
            joint: effect.joint,
            parameters: effect
                .parameters
                .into_iter()
                .map(|(key, said)| {
                    let value = SaidValue {
                        value: number(said.value, f64::NAN),
                        // JSON knows no infinity.
                        low: number(said.low, f64::NEG_INFINITY),
                        high: number(said.high, f64::INFINITY),
                    };
                    (key, value)
                })
                .collect(),
        })
        .collect()
}

/// Values of the model file in a list of a result, by path.
fn values(list: &Json) -> Vec<(String, f64)> {
    let list = list.as_array().into_iter().flatten();
    let value = |value: &Json| {
        let path = value["path"].as_str()?;
        Some((path.to_string(), value["value"].as_f64()?))
    };
    list.filter_map(value).collect()
}

/// A wrong value under the name of the effect that says the same. None for values of effects that
/// the file frees: friction, which its owner only guesses.
fn name(value: &Json) -> Option<String> {
    let path = value["path"].as_str()?;
    let (owner, field) = path.split_once('.')?;
    let number = |kind: &str| owner.strip_prefix(kind);
    match (number("link"), number("joint"), field) {
        (Some(link), _, "mass_kg") => Some(format!("mass@{link}")),
        (_, Some(joint), "stall_torque_nm") => Some(format!("torque_scale@{joint}")),
        (None, None, _) => (value["free"] != true).then(|| owner.to_string()),
        _ => Some(path.to_string()),
    }
}

/// Names of an explanation: its effects, or the values that explain without any.
fn set(explanation: &Json) -> Vec<String> {
    let effects = effects(&explanation["effects"]);
    if !effects.is_empty() {
        effects.iter().map(SaidEffect::address).collect()
    } else {
        let wrong = explanation["wrong_values"].as_array().into_iter().flatten();
        let beyond = wrong.filter(|value| value["within_uncertainty"] != true);
        beyond.filter_map(name).collect()
    }
}

/// Reads a result.
pub(crate) fn said(json: &Json) -> Said {
    let alternatives = json["alternatives"].as_array().into_iter().flatten();
    let fitted = [&json["base"], &json["wrong_values"]];
    Said {
        verdict: json["verdict"].as_str().unwrap_or_default().to_string(),
        effects: effects(&json["effects"]),
        sets: std::iter::once(json).chain(alternatives).map(set).collect(),
        values: fitted.into_iter().flat_map(values).collect(),
        horizon_s: json["horizon_s"].as_f64(),
        shorter_step_s: json["shorter_step_s"].as_f64(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_result_is_read_by_its_documented_keys() {
        let effect = |kind: &str| {
            json!({ "kind": kind, "title": "t", "joint": 2, "parameters": {
                "torque_nm": { "value": 0.1, "low": 0.05, "high": null, "unit": "N m",
                               "on_bound": false } } })
        };
        let said = said(&json!({
            "verdict": "ambiguous",
            "effects": [effect("coulomb")],
            "alternatives": [{ "effects": [effect("stribeck"), effect("mass")], "error_rad": 0.1 }],
            "base": [{ "path": "viscous@1.coefficient_nm_s_rad", "value": 0.02 }],
            "horizon_s": 0.5,
        }));
        assert_eq!(said.verdict, "ambiguous");
        assert_eq!(said.sets, [vec!["coulomb@2"], vec!["stribeck@2", "mass@2"]]);
        let torque = said.effects[0].parameters["torque_nm"];
        assert_eq!((torque.value, torque.low), (0.1, 0.05));
        assert_eq!(torque.high, f64::INFINITY);
        assert_eq!(
            said.values,
            [("viscous@1.coefficient_nm_s_rad".to_string(), 0.02)]
        );
        assert_eq!(said.horizon_s, Some(0.5));
    }

    #[test]
    fn a_wrong_value_is_named_as_the_effect_that_says_the_same() {
        let value = |path: &str| json!({ "path": path, "value": 0.3, "given": 0.2 });
        let mut friction = value("viscous@1.coefficient_nm_s_rad");
        friction["free"] = json!(true);
        let said = said(&json!({
            "verdict": "ambiguous",
            "effects": [],
            "wrong_values": [value("link2.mass_kg"), friction],
            "alternatives": [
                { "effects": [], "wrong_values": [value("joint1.stall_torque_nm")] },
                { "effects": [], "wrong_values": [value("link1.com_m")] },
                { "effects": [], "wrong_values": [value("armature@3.inertia_kg_m2")] },
            ],
        }));
        let names = ["mass@2", "torque_scale@1", "link1.com_m", "armature@3"];
        assert_eq!(said.sets, names.map(|name| [name]));
        assert_eq!(said.values.len(), 2);
    }
}
