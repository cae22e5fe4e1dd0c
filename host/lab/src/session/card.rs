//! A diagnosis as pages show it and sessions keep it: sentences, and a card for each explanation.

use super::evaluation::ShownUnit;
use super::names::value_name;
use crate::diagnose::words::error_line;
use crate::diagnose::{Alternative, Diagnosis, FittedEffect, RuledOut, WrongValue};
use crate::fitting::FittedValue;
use crate::output::number::measured;
use serde::{Deserialize, Serialize};

/// Cards of explanations that were ruled out.
const MOST_RULED_OUT: usize = 12;

/// What a diagnosis said.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedDiagnosis {
    /// The step whose model it is of.
    pub step: usize,
    /// The verdict as in JSON: `named`.
    pub verdict: String,
    /// The summary, its headline first.
    pub summary: Vec<String>,
    /// What to do next.
    pub next: Vec<String>,
    /// What to be wary of.
    pub warnings: Vec<String>,
    /// Error of the model as given, rad.
    pub before_rad: Option<f64>,
    /// Error of the model with what was found, rad.
    pub after_rad: Option<f64>,
    /// Error of a perfect model, rad.
    pub floor_rad: Option<f64>,
    /// Whether motions held out decided.
    pub held_out: bool,
    /// Longest windows it was judged over, s; whole motions without.
    pub horizon_s: Option<f64>,
    /// The explanations, the best first.
    pub cards: Vec<SavedCard>,
}

/// What became of an explanation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CardRole {
    /// The one chosen.
    Found,
    /// One that does as well.
    Rival,
    /// One that does as well and is not needed: the chosen one is simpler.
    NotNeeded,
    /// One that was tried and does worse.
    RuledOut,
}

/// An explanation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SavedCard {
    /// What became of it.
    pub role: CardRole,
    /// Effects it adds: `coulomb@1`.
    pub effects: Vec<String>,
    /// Values of the model it changes: `link1.com_m`.
    pub values: Vec<String>,
    /// Fitted values with their intervals, as text.
    pub fitted: Vec<String>,
    /// Error on the motions that were fitted, rad.
    pub training_rad: Option<f64>,
    /// Error on the motions held out, rad.
    pub held_out_rad: Option<f64>,
    /// Change of the Bayesian information criterion; negative is better.
    pub bic_change: Option<f64>,
    /// Why it was not chosen.
    pub why: String,
}

impl SavedDiagnosis {
    /// What a diagnosis of this step's model said.
    pub fn of(diagnosis: &Diagnosis, step: usize) -> SavedDiagnosis {
        let error = &diagnosis.error;
        let mut cards = Vec::new();
        if !diagnosis.effects.is_empty() || !diagnosis.wrong_values.is_empty() {
            cards.push(found(diagnosis));
        }
        let rivals = diagnosis.alternatives.iter();
        cards.extend(rivals.map(|rival| self::rival(rival, error.held_out)));
        let ruled_out = diagnosis.tried().into_iter();
        cards.extend(ruled_out.take(MOST_RULED_OUT).map(tried));
        SavedDiagnosis {
            step,
            verdict: diagnosis.verdict.name().to_string(),
            summary: diagnosis.summary.clone(),
            next: diagnosis.next.clone(),
            warnings: diagnosis.warnings.clone(),
            before_rad: finite(error.before_rad),
            after_rad: finite(error.after_rad),
            floor_rad: finite(error.floor_rad),
            held_out: error.held_out,
            horizon_s: diagnosis.horizon_s,
            cards,
        }
    }
}

impl SavedDiagnosis {
    /// Tells what becomes of the error in the unit in which people read it.
    pub fn tell_in(&mut self, unit: ShownUnit, diagnosis: &Diagnosis) {
        let own = error_line(diagnosis, (diagnosis.error.quantity.milli(), 1e3));
        let shown = error_line(diagnosis, (unit.error_unit, unit.error_per_si));
        let lines = self.summary.iter_mut().filter(|line| **line == own);
        lines.for_each(|line| line.clone_from(&shown));
    }
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

fn found(diagnosis: &Diagnosis) -> SavedCard {
    let error = &diagnosis.error;
    let after = finite(error.after_rad);
    SavedCard {
        role: CardRole::Found,
        training_rad: after.filter(|_| !error.held_out),
        held_out_rad: after.filter(|_| error.held_out),
        ..explanation(&diagnosis.effects, &diagnosis.wrong_values)
    }
}

fn rival(rival: &Alternative, held_out: bool) -> SavedCard {
    let error = finite(rival.error_rad);
    SavedCard {
        training_rad: error.filter(|_| !held_out),
        held_out_rad: error.filter(|_| held_out),
        ..explanation(&rival.effects, &rival.wrong_values)
    }
}

fn explanation(effects: &[FittedEffect], wrong: &[WrongValue]) -> SavedCard {
    let text = |fitted: &FittedValue| {
        let value = measured(fitted.value, fitted.low, fitted.high, &fitted.unit);
        format!("{} {value}", value_name(&fitted.path))
    };
    let parameters = effects.iter().flat_map(|effect| &effect.parameters);
    let wrong_values = wrong.iter().map(|wrong| &wrong.fitted);
    SavedCard {
        role: CardRole::Rival,
        effects: effects.iter().map(FittedEffect::address).collect(),
        values: wrong_values
            .clone()
            .map(|fitted| fitted.path.clone())
            .collect(),
        fitted: parameters.chain(wrong_values).map(text).collect(),
        training_rad: None,
        held_out_rad: None,
        bic_change: None,
        why: String::new(),
    }
}

fn tried(tried: &RuledOut) -> SavedCard {
    // Values of the model stand there by their address: `link1.com_m`.
    let (values, effects) = tried
        .set
        .iter()
        .cloned()
        .partition(|name| name.contains('.'));
    SavedCard {
        role: if tried.as_good {
            CardRole::NotNeeded
        } else {
            CardRole::RuledOut
        },
        effects,
        values,
        fitted: Vec::new(),
        training_rad: finite(tried.training_error_rad),
        held_out_rad: tried.held_out_error_rad.and_then(finite),
        bic_change: finite(tried.bic_change),
        why: tried.why.clone(),
    }
}
