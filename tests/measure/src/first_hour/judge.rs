//! Whether a verdict holds what is hidden, whoever gave it: the command line, or the lab.

use super::rig::DrawnRig;
use serde_json::Value;

/// How a walk ended.
#[derive(Debug, Clone, PartialEq)]
pub enum End {
    /// The hidden effect is in the verdict's set, or one of those that it leaves open; or another
    /// value of it, where the first model holds it.
    Found,
    /// The first model holds it already, estimated from the log, and nothing else is missing.
    InFirstModel,
    /// The verdict is another; its summary.
    Other(String),
    /// A log was refused, or another unit asked for; what was said.
    Refused(String),
}

/// A walk with what it took.
#[derive(Debug, Clone)]
pub struct Walk {
    /// How it ended.
    pub end: End,
    /// The diagnosis' verdict, where one was reached.
    pub verdict: String,
    /// Error of the first model on held-out motion, mrad, and what was left of it by the effect
    /// that was added, where something was.
    pub error_mrad: [Option<f64>; 2],
    /// What noise and resolution leave of it, mrad.
    pub floor_mrad: Option<f64>,
}

impl Walk {
    /// One that ended before a diagnosis.
    pub(super) fn ended(end: End) -> Walk {
        Walk {
            end,
            verdict: String::new(),
            error_mrad: [None; 2],
            floor_mrad: None,
        }
    }
}

/// An explanation: addresses of effects, `coulomb@1`, and of values of the model.
#[derive(Debug, Clone, Default)]
pub(super) struct Explanation {
    pub effects: Vec<String>,
    pub values: Vec<String>,
}

/// A verdict with the explanations that it leaves open, the chosen one first.
#[derive(Debug, Clone)]
pub(super) struct Judged {
    pub verdict: String,
    pub summary: String,
    pub explanations: Vec<Explanation>,
}

impl Explanation {
    fn holds(&self, ids: &[&str]) -> bool {
        let is_hidden = |address: &String| {
            let kind = address.split(['@', '.']).next().unwrap_or_default();
            ids.contains(&kind)
        };
        self.effects.iter().any(is_hidden)
            || self.effects.is_empty() && self.values.iter().any(is_hidden)
    }
}

impl Judged {
    /// What this verdict of the first model is worth on that rig.
    pub fn end(&self, rig: &DrawnRig, first_model: &str) -> End {
        let ids = rig.hidden.ids();
        let in_model = ids
            .iter()
            .any(|id| first_model.contains(&format!("kind = \"{id}\"")));
        match self.verdict.as_str() {
            "unfit" => End::Refused(self.summary.clone()),
            "named" | "ambiguous" if self.explanations.iter().any(|set| set.holds(ids)) => {
                End::Found
            }
            "nominal" | "adequate" | "wrong_value" if in_model => End::InFirstModel,
            _ => End::Other(self.summary.clone()),
        }
    }
}

/// The texts of a list.
pub(super) fn texts(list: &Value) -> Vec<String> {
    let list = list.as_array().into_iter().flatten();
    list.filter_map(|text| text.as_str().map(String::from))
        .collect()
}
