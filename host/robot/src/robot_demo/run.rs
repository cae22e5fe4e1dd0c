//! The circle itself: attempt, measurement, diagnosis, second attempt, score.

use super::hidden::{HiddenRobot, NOMINAL, RobotEffect};
use super::learning::Learned;
use super::{page, recording};
use crate::challenge::seal;
use crate::deploy::rehearsal::{BalanceAttempt, Setting};
use crate::deploy::{Board, PlanBasis, ToldDrives};
use crate::diagnose::{Diagnosis, Verdict};
use crate::error::{Error, Result};
use crate::fitting::{Candidate, Progress};
use crate::log::{LogRequest, LogSet};
use crate::model::Model;
use crate::output::number::exact;
use crate::output::write_new;
use crate::synth::controllers::BoardTiming;
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
    /// Motions that were learned from, as a command takes them.
    pub training: Vec<String>,
    /// Motions that judged.
    pub held_out: Vec<String>,
    /// Verdict of the diagnosis.
    pub verdict: Verdict,
    /// Effects that were added.
    pub added: Vec<String>,
    /// The values of the hidden effects.
    pub effects: Vec<ScoredEffect>,
    /// Whether the verdict names all of them, and no others: not where it leaves open what is
    /// missing.
    pub named: bool,
}

/// A value of a hidden effect, and what was estimated of it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScoredEffect {
    /// The effect as `delay@all`.
    pub address: String,
    /// Key of the value.
    pub key: String,
    /// The truth.
    pub true_value: f64,
    /// The estimate, where the effect was added.
    pub estimate: Option<f64>,
    /// The 95 % interval that the diagnosis gave, where it found the effect.
    pub interval: Option<[f64; 2]>,
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

    let nominal = attempt(&robot, &Model::parse(NOMINAL, &file)?)?;
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
    let learned = attempt(&robot, &model)?;
    hear(DemoStep::Second(&learned));

    let demo = RobotDemo {
        seed,
        nominal,
        learned,
        training: logs.training.iter().map(LogRequest::name).collect(),
        held_out: logs.held_out.iter().map(LogRequest::name).collect(),
        verdict: taught.diagnosis.verdict,
        named: taught.diagnosis.verdict == Verdict::Named
            && are_all(&robot.answer.effects, &taught.added),
        effects: (robot.answer.effects.iter())
            .flat_map(|effect| ScoredEffect::of(effect, &model, &taught.diagnosis))
            .collect(),
        added: taught.added,
    };
    write_new(&dir.join("page.html"), &page::html(&demo), false)?;
    Ok(demo)
}

/// Safety limits of the demonstration, wider than those of a robot that can break: on its way back
/// it moves far and fast.
const LIMITS: Board = Board {
    joint_range_rad: 1.5,
    joint_speed_rad_s: 12.0,
    ..Board::BIOLOID
};

/// The same for the command line.
pub const LIMIT_OPTIONS: &str = "--fallen 0.8 --joint-range 1.5 --joint-speed 12";

/// Balances the robot with the plan that `handstand deploy` makes of this model.
fn attempt(robot: &HiddenRobot, model: &Model) -> Result<BalanceAttempt> {
    let timing = BoardTiming::HOST_ATTITUDE;
    let plan = PlanBasis::of(model, &LIMITS, &timing, &ToldDrives::default())?.plan(model)?;
    let setting = Setting {
        start_deg: robot.start_deg,
        ..Setting::default()
    };
    BalanceAttempt::run(&robot.model()?, &plan, &setting)
}

/// Whether exactly the hidden effects were added, in whatever order.
fn are_all(hidden: &[RobotEffect], added: &[String]) -> bool {
    hidden.len() == added.len() && hidden.iter().all(|effect| added.contains(&effect.address))
}

impl ScoredEffect {
    /// Each value of a hidden effect.
    fn of(hidden: &RobotEffect, model: &Model, diagnosis: &Diagnosis) -> Vec<ScoredEffect> {
        let mut effects = model.effects.iter();
        let found = effects.find(|effect| Candidate::from(*effect).to_string() == hidden.address);
        let mut told = diagnosis.effects.iter();
        let told = told.find(|effect| effect.address() == hidden.address);
        let values = hidden.parameters.iter().enumerate();
        let scored = values.map(|(index, (key, true_value))| {
            let fitted = told.and_then(|effect| effect.parameters.get(index));
            ScoredEffect {
                address: hidden.address.clone(),
                key: key.clone(),
                true_value: *true_value,
                estimate: found.and_then(|effect| effect.values.get(index).copied()),
                interval: fitted.map(|fitted| [fitted.low, fitted.high]),
            }
        });
        scored.collect()
    }

    /// The interval in words; a dash where there is none.
    pub fn interval_words(&self) -> String {
        self.interval.map_or("-".to_string(), |[low, high]| {
            format!("{} to {}", exact(low), exact(high))
        })
    }
}
