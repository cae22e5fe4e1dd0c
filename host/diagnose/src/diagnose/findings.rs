//! The result of a diagnosis, as plain values for every writer: text, JSON, HTML.

use super::words;
use crate::effects;
use crate::fitting::{Candidate, ErrorReduction, FittedValue, MotionWindow};
use crate::log::{LogFinding, Severity};
use crate::model::MeasuredSignal;
use crate::model::{Model, ParameterPath, effect_on};
use serde::Serialize;

/// What a diagnosis may end in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The model as given explains the measurement; nothing but noise is left.
    Nominal,
    /// The model as given leaves more than noise, but no more than the user tolerates.
    Adequate,
    /// Values in the model file are wrong; with right ones nothing is missing.
    WrongValue,
    /// The missing effects are known.
    Named,
    /// Several sets of effects explain the measurement equally well.
    Ambiguous,
    /// Something is missing and no candidate explains it.
    Unexplained,
    /// The data can't answer the question.
    Unfit,
}

impl Verdict {
    /// One word for it, as in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Nominal => "nominal",
            Verdict::Adequate => "adequate",
            Verdict::WrongValue => "wrong_value",
            Verdict::Named => "named",
            Verdict::Ambiguous => "ambiguous",
            Verdict::Unexplained => "unexplained",
            Verdict::Unfit => "unfit",
        }
    }
}

impl Diagnosis {
    /// What was tried and not chosen: the smallest error on motions held out first, then what never
    /// came that far.
    pub fn tried(&self) -> Vec<&RuledOut> {
        let held_out = |tried: &RuledOut| tried.held_out_error_rad.unwrap_or(f64::INFINITY);
        let mut tried: Vec<&RuledOut> = self.ruled_out.iter().collect();
        tried.sort_by(|a, b| {
            let order = held_out(a).total_cmp(&held_out(b));
            order.then(a.training_error_rad.total_cmp(&b.training_error_rad))
        });
        tried
    }
}

/// How the search for explanations ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SearchEnded {
    /// All was tried that could matter.
    #[default]
    Complete,
    /// An explanation leaves no more than the user tolerates.
    Tolerance,
    /// Its time was over.
    Time,
    /// The user took what there was.
    Stopped,
}

/// An effect with its fitted values.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedEffect {
    /// Id in the library.
    pub kind: String,
    /// Name for people.
    pub title: String,
    /// Joint counted from 1; absent when it acts on the whole rig, or on all driven joints.
    pub joint: Option<usize>,
    /// Its values.
    pub parameters: Vec<FittedValue>,
}

/// A value of the model file that the motions contradict.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WrongValue {
    /// The value in the file.
    pub given: f64,
    /// Whether the file frees it: its owner does not claim to know it.
    pub free: bool,
    /// Whether the motions ask for a value that its owner would not wonder at: within two standard
    /// uncertainties of the given one.
    pub within_uncertainty: bool,
    /// The value that the motions ask for.
    #[serde(flatten)]
    pub fitted: FittedValue,
}

/// A rival explanation that the data do not rule out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Alternative {
    /// Its effects.
    pub effects: Vec<FittedEffect>,
    /// Its values of the model file, where it explains the measurement by those.
    pub wrong_values: Vec<WrongValue>,
    /// Root-mean-square error it leaves, rad, on the motions of [`Diagnosis::error`].
    pub error_rad: f64,
    /// Whether it says what the explanation says, in every experiment: a scale, and the value of
    /// the file that it scales. Such an alternative leaves nothing open.
    pub same_law: bool,
}

/// A candidate that was tried and not chosen: ruled out, or as good and not needed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RuledOut {
    /// Effects tried together, as `id@joint`.
    pub set: Vec<String>,
    /// Error it leaves on training motions, rad.
    pub training_error_rad: f64,
    /// Error it leaves on held-out motions, rad, where it came that far.
    pub held_out_error_rad: Option<f64>,
    /// Change of the Bayesian information criterion against the base model; negative is
    /// better.
    pub bic_change: f64,
    /// Whether these motions tell it from the chosen explanation at all: if not, it does as well
    /// and is not needed, which rules nothing out.
    pub as_good: bool,
    /// Why it was not chosen, in words.
    pub why: String,
}

/// Structure of the residual that the best explanation leaves.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ResidualStructure {
    /// Share of the remaining squared error above the floor that a free-form term could still gain.
    pub explainable_share: f64,
    /// 95 % lower limit of that share.
    pub explainable_low: f64,
    /// Which variables the free form used most, in words.
    pub shape: String,
}

/// Error of one motion before and after.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MotionError {
    /// The motion.
    pub motion: String,
    /// Whether it was held out.
    pub held_out: bool,
    /// Root-mean-square error of the base model, rad.
    pub before_rad: f64,
    /// Root-mean-square error with the effects added, rad.
    pub after_rad: f64,
}

/// Share of the squared error of the model as given that something removes, in units of the noise.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BudgetShare {
    /// Root-mean-square error of the model that is compared, rad: with the part alone, or without
    /// it.
    pub error_rad: f64,
    /// The share; below zero where the error grows.
    pub share: f64,
    /// Lower end of its 95 % interval, by block bootstrap.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// What the error budget calls the values that the file frees.
pub const FREE_VALUES: &str = "free values";

/// A part of the explanation in the error budget.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BudgetedPart {
    /// The effect as `id@joint`, the value's address, or `free values`: those that the file frees,
    /// refitted.
    pub part: String,
    /// What it removes alone; of an effect, with the free values refitted.
    pub alone: BudgetShare,
    /// What goes only with it, all other parts refitted without it.
    pub beyond_others: BudgetShare,
}

/// What the explanation gains where these motions are held out and the others fitted.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Fold {
    /// The motions held out.
    pub held_out: Vec<String>,
    /// Root-mean-square error without the explanation, rad.
    pub before_rad: f64,
    /// With it.
    pub after_rad: f64,
    /// Whether it gains log-likelihood, each motion with its own noise.
    pub gains: bool,
}

/// Everything a diagnosis says.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Diagnosis {
    /// The verdict.
    pub verdict: Verdict,
    /// Effects that are missing: all of them when named, the best set when ambiguous, a partial set
    /// when unexplained.
    pub effects: Vec<FittedEffect>,
    /// Values of the model file that are wrong: all that is needed where the verdict says so;
    /// beside the effects, those that the motions contradict.
    pub wrong_values: Vec<WrongValue>,
    /// Error of the model as given, of the same refitted, with what was found, and of a perfect
    /// model.
    pub error: ErrorReduction,
    /// How much of the error each part of the explanation removes.
    pub budget: Vec<BudgetedPart>,
    /// Sets that do as well, when ambiguous.
    pub alternatives: Vec<Alternative>,
    /// Base values refitted along.
    pub base: Vec<FittedValue>,
    /// What was tried and not chosen, best first.
    pub ruled_out: Vec<RuledOut>,
    /// Structure of the residual.
    pub residual_structure: Option<ResidualStructure>,
    /// Per motion.
    pub motions: Vec<MotionError>,
    /// The explanation fitted and judged again with other motions held out; empty where there are
    /// fewer than three, and where the model as given explains the measurement.
    pub folds: Vec<Fold>,
    /// Pairs of parameters the data hardly tell apart: addresses and correlation.
    pub collinear: Vec<(String, String, f64)>,
    /// Sentences for a student: what is missing, its size, how the error falls.
    pub summary: Vec<String>,
    /// What to do next.
    pub next: Vec<String>,
    /// Things to be wary of: values on bounds, placebos that rank, data warnings.
    pub warnings: Vec<String>,
    /// Seconds of the windows in which effects were searched for; absent for whole motions.
    pub search_horizon_s: Option<f64>,
    /// Seconds of the longest windows on which the judgement may rest; absent for whole motions.
    pub horizon_s: Option<f64>,
    /// The integration step of the explanation, s, where it needs a shorter one than the file has.
    pub shorter_step_s: Option<f64>,
    /// How long the windows of each motion are.
    pub windows: Vec<MotionWindow>,
    /// How the search ended.
    pub search_ended: SearchEnded,
    /// What was not examined because the time was over or the user took what there was, in words.
    pub left_out: Vec<String>,
    /// Motions that alone show what was found: held out, while the others leave only noise, they
    /// were learned from, and no motion is left to prove it.
    pub shows_alone: Vec<String>,
}

impl FittedEffect {
    /// The effect as `handstand add` takes it: `coulomb@1`, `delay@all`.
    pub fn address(&self) -> String {
        match self.joint {
            Some(joint) => format!("{}@{joint}", self.kind),
            None => format!("{}{}", self.kind, effects::at_all(&self.kind)),
        }
    }

    /// The effect at its joint as a candidate; `None` where the model has no such place.
    pub fn candidate(&self, model: &Model) -> Option<Candidate> {
        let joint = self.joint.map(|joint| joint - 1);
        // The model's own laws first: another model may define a law of the same name.
        let mut laws = model.laws.iter().copied();
        let own = laws.find(|law| law.info().id == self.kind);
        let effect = own.or_else(|| effects::named(&self.kind))?;
        let effect = effect_on(effect, joint, &model.joints)?;
        Some(Candidate { effect, joint })
    }
}

impl Diagnosis {
    /// The model with the effects added and the base values refitted.
    pub fn applied_to(&self, model: &Model) -> Model {
        let mut model = model.clone();
        for value in self
            .base
            .iter()
            .chain(self.wrong_values.iter().map(|wrong| &wrong.fitted))
        {
            if let Ok(path) = value.path.parse::<ParameterPath>() {
                // A value that is not the model's is none to set.
                let _ = path.set(&mut model, value.value);
            }
        }
        let found = self.effects.iter().filter_map(|effect| {
            let values: Vec<f64> = effect.parameters.iter().map(|value| value.value).collect();
            Some(effect.candidate(&model)?.instance(&values))
        });
        let found: Vec<_> = found.collect();
        model.effects.extend(found);
        model.step_s = self.shorter_step_s.unwrap_or(model.step_s);
        model
    }

    /// The model as it is and, where anything was found, with it; each with a name.
    pub fn models(&self, model: &Model) -> Vec<(String, Model)> {
        let mut models = vec![("the model as it is".to_string(), model.clone())];
        if let Some(found) = words::what_was_found(&self.effects, &self.wrong_values) {
            models.push((format!("the model with {found}"), self.applied_to(model)));
        }
        models
    }

    /// The diagnosis of logs that were refused: the findings say why.
    pub fn unfit(findings: &[LogFinding]) -> Diagnosis {
        let refused = || findings.iter().filter(|f| f.severity == Severity::Refuse);
        let said = "The logs cannot be learned from.".to_string();
        let mut next: Vec<String> = Vec::new();
        for finding in refused() {
            if !next.contains(&finding.remedy) {
                next.push(finding.remedy.clone());
            }
        }
        Diagnosis {
            verdict: Verdict::Unfit,
            effects: Vec::new(),
            wrong_values: Vec::new(),
            error: ErrorReduction {
                quantity: MeasuredSignal::Angle,
                before_rad: f64::NAN,
                refitted_rad: None,
                after_rad: f64::NAN,
                floor_rad: f64::NAN,
                floor_interval_rad: None,
                held_out: false,
                reduction: None,
            },
            budget: Vec::new(),
            alternatives: Vec::new(),
            base: Vec::new(),
            ruled_out: Vec::new(),
            residual_structure: None,
            motions: Vec::new(),
            folds: Vec::new(),
            collinear: Vec::new(),
            summary: std::iter::once(said)
                .chain(refused().map(LogFinding::statement))
                .collect(),
            next,
            warnings: Vec::new(),
            search_horizon_s: None,
            horizon_s: None,
            shorter_step_s: None,
            windows: Vec::new(),
            search_ended: SearchEnded::Complete,
            left_out: Vec::new(),
            shows_alone: Vec::new(),
        }
    }
}
