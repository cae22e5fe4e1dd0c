//! What a discovery says, as plain values for every writer.

use super::picture::TermPicture;
use crate::diagnose::{Diagnosis, FittedEffect, Verdict};
use crate::effects::expression::{LawDefinition, LawSite};
use crate::error::Result;
use crate::fitting::{
    Addition, FittedValue, Horizon, Progress, add_effects_from, candidates_named,
};
use crate::model::edit::add_expression;
use crate::model::{Model, ParameterPath};
use crate::motion::Split;
use serde::Serialize;
use std::path::Path;

/// What a discovery may end in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DiscoveryVerdict {
    /// The model as given leaves nothing to discover.
    NothingMissing,
    /// Values of the model's file are wrong, and no law is missing.
    WrongValue,
    /// A law leaves nothing but noise.
    Found,
    /// Several laws leave as little; the one shown has the fewest values.
    Ambiguous,
    /// A law removes a part of the error, and more than noise is left.
    Partial,
    /// No law of these signals explains what is left.
    NotFound,
    /// The logs cannot be learned from.
    Unfit,
}

/// A term of the law.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DiscoveredTerm {
    /// Its name: of an effect of the library, or of an `[[expression]]`.
    pub kind: String,
    /// Joint counted from 1; absent where it acts on all driven joints.
    pub joint: Option<usize>,
    /// Whether it is a torque or a friction: the key in model files.
    pub site: &'static str,
    /// The expression in the names of its values.
    pub expression: String,
    /// The same with its values in place, to three digits.
    pub with_values: String,
    /// Its values.
    pub parameters: Vec<FittedValue>,
    /// Where a model file has to define it.
    #[serde(skip)]
    pub definition: Option<LawDefinition>,
}

/// Another law that leaves as little.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OtherLaw {
    /// Its terms.
    pub terms: Vec<DiscoveredTerm>,
    /// What it leaves, rad.
    pub error_rad: f64,
}

/// Everything that was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Discovery {
    /// The verdict.
    pub verdict: DiscoveryVerdict,
    /// The terms, whose sum is the torque that the model lacks.
    pub terms: Vec<DiscoveredTerm>,
    /// Other laws that leave as little.
    pub others: Vec<OtherLaw>,
    /// Terms beside what the motions say, of which a picture can be drawn.
    pub pictures: Vec<TermPicture>,
    /// The diagnosis by these terms: errors, intervals, motions, warnings.
    pub diagnosis: Diagnosis,
}

impl Discovery {
    pub(super) fn new(diagnosis: Diagnosis, vocabulary: &[LawDefinition]) -> Discovery {
        let terms = |effects: &[FittedEffect]| -> Vec<DiscoveredTerm> {
            let terms = effects.iter().map(|effect| term(effect, vocabulary));
            terms.collect()
        };
        let others = diagnosis.alternatives.iter();
        let others = others.filter(|other| !other.effects.is_empty());
        Discovery {
            verdict: verdict(&diagnosis),
            terms: terms(&diagnosis.effects),
            others: others
                .map(|other| OtherLaw {
                    terms: terms(&other.effects),
                    error_rad: other.error_rad,
                })
                .collect(),
            pictures: Vec::new(),
            diagnosis,
        }
    }

    /// The terms as `handstand add` takes them.
    pub fn addresses(&self) -> Vec<String> {
        let effects = self.diagnosis.effects.iter();
        effects.map(FittedEffect::address).collect()
    }

    /// The text of a model with the law in it: its terms defined, and fitted once more with the
    /// model's free values, as `add` fits effects, from the values that were found.
    ///
    /// # Errors
    /// A model's text that is none; terms that the model has already.
    pub fn added_to(
        &self,
        text: &str,
        path: &Path,
        split: &Split,
        horizon: Option<Horizon>,
        progress: &dyn Fn(Progress),
    ) -> Result<Addition> {
        let mut text = text.to_string();
        let mut definitions: Vec<&LawDefinition> = Vec::new();
        for definition in self
            .terms
            .iter()
            .filter_map(|term| term.definition.as_ref())
        {
            // At several joints it is one law, and starts may differ.
            if definitions
                .iter()
                .all(|known| known.name != definition.name)
            {
                definitions.push(definition);
            }
        }
        for definition in definitions {
            text = add_expression(&text, path, definition)?;
        }
        let model = Model::parse(&text, path)?;
        let candidates = candidates_named(&self.addresses(), &model)?;
        let own = self.terms.iter().flat_map(|term| &term.parameters);
        let values = self.diagnosis.base.iter().chain(own);
        let start: Vec<(ParameterPath, f64)> = values
            .filter_map(|value| Some((value.path.parse().ok()?, value.value)))
            .collect();
        add_effects_from(&text, path, &candidates, &start, split, horizon, progress)
    }

    /// Whether something was not tried because the time was over, or the user took what there was.
    pub fn is_cut_short(&self) -> bool {
        !self.diagnosis.left_out.is_empty()
    }

    /// Whether there is a law to work with.
    pub fn has_law(&self) -> bool {
        use DiscoveryVerdict as V;
        matches!(self.verdict, V::Found | V::Ambiguous | V::Partial) && !self.terms.is_empty()
    }
}

fn verdict(diagnosis: &Diagnosis) -> DiscoveryVerdict {
    match diagnosis.verdict {
        Verdict::Nominal | Verdict::Adequate => DiscoveryVerdict::NothingMissing,
        Verdict::WrongValue => DiscoveryVerdict::WrongValue,
        Verdict::Named => DiscoveryVerdict::Found,
        Verdict::Ambiguous if diagnosis.effects.is_empty() => DiscoveryVerdict::WrongValue,
        Verdict::Ambiguous => DiscoveryVerdict::Ambiguous,
        Verdict::Unexplained if diagnosis.effects.is_empty() => DiscoveryVerdict::NotFound,
        Verdict::Unexplained => DiscoveryVerdict::Partial,
        Verdict::Unfit => DiscoveryVerdict::Unfit,
    }
}

fn term(effect: &FittedEffect, vocabulary: &[LawDefinition]) -> DiscoveredTerm {
    let definition = vocabulary.iter().find(|term| term.name == effect.kind);
    let (site, expression) = match definition {
        Some(term) => (term.site, term.expression.clone()),
        None => library_law(effect),
    };
    DiscoveredTerm {
        kind: effect.kind.clone(),
        joint: effect.joint,
        site: site.key(),
        with_values: with_values(&expression, &effect.parameters),
        expression,
        parameters: effect.parameters.clone(),
        definition: definition.map(|term| started_at(term, &effect.parameters)),
    }
}

/// The term with fits that begin at these values.
fn started_at(term: &LawDefinition, values: &[FittedValue]) -> LawDefinition {
    let mut term = term.clone();
    for parameter in &mut term.parameters {
        if let Some(found) = values.iter().find(|value| value.key == parameter.key) {
            let (low, high) = parameter.bounds;
            parameter.starts = vec![found.value.clamp(low, high)];
        }
    }
    term
}

/// The plain effects of the library as expressions; others by their name.
fn library_law(effect: &FittedEffect) -> (LawSite, String) {
    let key = effect.parameters.first().map_or("", |value| &value.key);
    match effect.kind.as_str() {
        "coulomb" => (LawSite::Friction, key.to_string()),
        "viscous" => (LawSite::Torque, format!("-{key} * w")),
        other => (LawSite::Torque, other.to_string()),
    }
}

/// The expression with numbers for the names of its values.
fn with_values(expression: &str, values: &[FittedValue]) -> String {
    let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut said = String::new();
    let mut rest = expression;
    while let Some(first) = rest.chars().next() {
        let end = if is_letter(first) {
            rest.find(|c| !is_letter(c)).unwrap_or(rest.len())
        } else {
            first.len_utf8()
        };
        let (word, behind) = rest.split_at(end);
        match values.iter().find(|value| value.key == word) {
            Some(value) => push_number(&mut said, value.value),
            None => said.push_str(word),
        }
        rest = behind;
    }
    said
}

/// Three digits behind what was said so far, their sign one with that before them.
fn push_number(said: &mut String, value: f64) {
    let digits: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    if digits >= 0.0 {
        *said += &digits.to_string();
        return;
    }
    let size = -digits;
    let signs = [("+ ", "- "), ("- ", "+ "), ("-", "")];
    match signs.into_iter().find(|(sign, _)| said.ends_with(sign)) {
        Some((sign, other)) => {
            said.truncate(said.len() - sign.len());
            *said += &format!("{other}{size}");
        }
        None if said.is_empty() || said.ends_with('(') => *said += &format!("-{size}"),
        None => *said += &format!("(-{size})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_in_a_law_as_one_would_write_them() {
        let value = |key: &str, value: f64| FittedValue {
            path: String::new(),
            key: key.to_string(),
            unit: String::new(),
            value,
            low: value,
            high: value,
            on_bound: false,
        };
        let said = |law: &str, a: f64, b: f64| with_values(law, &[value("a", a), value("b", b)]);
        assert_eq!(
            said("-a * dir * abs(w)^b", 0.07642, 3.0),
            "-0.0764 * dir * abs(w)^3"
        );
        assert_eq!(said("-a * (q - b)", -0.5, -0.25), "0.5 * (q + 0.25)");
        assert_eq!(said("a * sin(q + b)", -0.5, -0.25), "-0.5 * sin(q - 0.25)");
        assert_eq!(said("w * a / ab", -0.5, 1.0), "w * (-0.5) / ab");
    }
}
