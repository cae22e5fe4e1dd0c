//! The circle itself: attempt, measurement, diagnosis, second attempt, score.

use super::attempt::BalanceAttempt;
use super::hidden::{HiddenRobot, NOMINAL, RobotEffect};
use super::learning::{Learned, plan_for};
use super::{page, recording};
use crate::challenge::seal;
use crate::diagnose::{Diagnosis, Verdict};
use crate::error::{Error, Result};
use crate::fitting::{Candidate, Progress};
use crate::log::LogSet;
use crate::model::Model;
use crate::output::write_new;
use serde::Serialize;
use std::path::Path;

/// What was done last.
#[derive(Debug)]
pub enum DemoStep<'a> {
    /// The robot was drawn, its answer sealed, and the model of its owner written.
    Drawn,
    /// The plan of the nominal model was tried.
    First(&'a BalanceAttempt),
    /// The hanging robot was recorded.
    Recorded(&'a LogSet),
    /// The diagnosis goes on.
    Diagnosing(Progress),
    /// The recordings were diagnosed, and what is missing was added.
    Diagnosed(&'a Diagnosis),
    /// The plan of the learned model was tried.
    Second(&'a BalanceAttempt),
}

/// What came of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RobotDemo {
    /// Seed of the robot.
    pub seed: u64,
    /// With the plan of the nominal model.
    pub nominal: BalanceAttempt,
    /// With the plan of what was learned.
    pub learned: BalanceAttempt,
    /// Verdict of the diagnosis.
    pub verdict: Verdict,
    /// Effects that were added.
    pub added: Vec<String>,
    /// The hidden effects.
    pub effects: Vec<ScoredEffect>,
    /// Whether all of them were added, and no others.
    pub named: bool,
}

/// A hidden effect, and what was estimated of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScoredEffect {
    /// As `delay@all`.
    pub address: String,
    /// Its first value, with the key.
    pub key: String,
    /// The truth.
    pub true_value: f64,
    /// The estimate, where the effect was added; of a delay without the recording's own.
    pub estimate: Option<f64>,
}

/// Runs the whole circle with the robot of this seed; everything is written to `dir`, which must be
/// there and hold none of it: `nominal.toml`, `answer.sealed`, `goals_a.csv` and `a.csv` to
/// `e.csv`, `learned.toml`, `page.html`.
///
/// # Errors
/// A file that cannot be written, a firmware that refuses, a model that cannot be balanced.
pub fn run(seed: u64, dir: &Path, hear: &(dyn Fn(DemoStep) + Sync)) -> Result<RobotDemo> {
    let robot = HiddenRobot::draw(seed)?;
    let file = dir.join("nominal.toml");
    write_new(&file, NOMINAL, false)?;
    write_new(&dir.join("answer.sealed"), &seal(&robot.answer), false)?;
    hear(DemoStep::Drawn);

    let nominal = BalanceAttempt::run(&robot, &plan_for(&Model::parse(NOMINAL, &file)?)?)?;
    hear(DemoStep::First(&nominal));

    let logs = recording::record(&robot, dir)?;
    hear(DemoStep::Recorded(&logs));

    let progress = |progress| hear(DemoStep::Diagnosing(progress));
    let taught = Learned::from_logs(NOMINAL, &file, &logs, &progress)?;
    if taught.diagnosis.verdict == Verdict::Unfit {
        return Err(Error::design(
            format!("the recordings of seed {seed} cannot be learned from"),
            taught.diagnosis.summary.join(" "),
        ));
    }
    let file = dir.join("learned.toml");
    write_new(&file, &taught.model_toml, false)?;
    hear(DemoStep::Diagnosed(&taught.diagnosis));

    let model = Model::parse(&taught.model_toml, &file)?;
    let learned = BalanceAttempt::run(&robot, &plan_for(&model)?)?;
    hear(DemoStep::Second(&learned));

    let demo = RobotDemo {
        seed,
        nominal,
        learned,
        verdict: taught.diagnosis.verdict,
        named: names_all(&robot.answer.effects, &taught.added),
        effects: (robot.answer.effects.iter())
            .map(|effect| ScoredEffect::of(effect, &model))
            .collect(),
        added: taught.added,
    };
    write_new(&dir.join("page.html"), &page::html(&demo), false)?;
    Ok(demo)
}

/// Whether exactly the hidden effects were added, in whatever order.
fn names_all(hidden: &[RobotEffect], added: &[String]) -> bool {
    hidden.len() == added.len() && hidden.iter().all(|effect| added.contains(&effect.address))
}

impl ScoredEffect {
    fn of(hidden: &RobotEffect, model: &Model) -> ScoredEffect {
        let mut effects = model.effects.iter();
        let found = effects.find(|effect| Candidate::from(*effect).to_string() == hidden.address);
        let estimate = found.and_then(|effect| effect.values.first().copied());
        let (key, true_value) = hidden.parameters.first().cloned().unwrap_or_default();
        ScoredEffect {
            address: hidden.address.clone(),
            key,
            true_value,
            estimate,
        }
    }
}
