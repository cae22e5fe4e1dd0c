//! Whether one experiment settles what the logs of a bench arm leave open.
//!
//! An arm hides one effect. Its owner has one log of it, bare and as it stands; the first two
//! thirds are fitted, the last is held out. Where the diagnosis is ambiguous, an experiment is
//! proposed, the true arm plays it by equations that are not the library's, and the diagnosis is
//! repeated with both logs. A value that is proposed to be measured is right in the owner's file,
//! but for a torque that is hidden in it.

use handstand::challenge::{ArmInputs, BenchEffect, Motions, bench, play};
use handstand::diagnose::{
    DiagnoseOptions, Diagnosis, FittedEffect, Verdict, diagnose, values_behind,
};
use handstand::experiment::{
    Criterion, ExperimentLimits, ExperimentProposal, ProposeOptions, propose,
};
use handstand::fitting::Candidate;
use handstand::log::{LogRequest, read};
use handstand::model::ParameterPath;
use handstand::motion::Motion;
use handstand::{Error, Model};
use rayon::prelude::*;
use serde::Serialize;
use std::path::Path;
use std::time::Instant;

/// Row of the log from which it is held out, of 2001.
const HELD_OUT_FROM: usize = 1334;
/// Duration of an experiment, s.
const SECONDS: f64 = 20.0;

/// An arm that hides an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExperimentCase {
    /// What it hides.
    pub kind: &'static str,
    /// Its seed.
    pub seed: u64,
}

/// What became of a case whose first diagnosis was ambiguous.
#[derive(Debug, Clone, Serialize)]
pub struct Settled {
    /// Whether exactly what is hidden was named in the end, or the value behind it was measured and
    /// nothing else is missing.
    pub settled: bool,
    /// Whether no experiment could settle it, for the explanations are one law of this rig, and
    /// whether that was said.
    pub one_law: bool,
    /// What was proposed, in words.
    pub proposed: String,
    /// Predicted separation of the closest two explanations that are parted, in standard errors.
    pub separation: Option<f64>,
    /// Verdict in the end.
    pub verdict: Verdict,
    /// Sets of the last diagnosis, the chosen one first.
    pub sets: Vec<String>,
    /// How long the proposal took beyond the diagnosis, s.
    pub seconds: f64,
}

/// What was said of a case.
#[derive(Debug, Clone, Serialize)]
pub struct ExperimentOutcome {
    /// What was hidden.
    pub kind: &'static str,
    /// Seed of the arm.
    pub seed: u64,
    /// Verdict of the first diagnosis.
    pub first_verdict: Verdict,
    /// Its sets, the chosen one first.
    pub first_sets: Vec<String>,
    /// What became of it, where it was ambiguous and held what is hidden.
    pub settled: Option<Settled>,
}

/// Tries every case; failures are told with their case.
pub fn try_experiments(
    cases: &[ExperimentCase],
    done: &(dyn Fn(&ExperimentOutcome) + Sync),
) -> Vec<Result<ExperimentOutcome, String>> {
    let tried = cases.par_iter().map(|case| {
        let outcome = try_experiment(*case)
            .map_err(|error| format!("{}, seed {}: {error}", case.kind, case.seed))?;
        done(&outcome);
        Ok(outcome)
    });
    tried.collect()
}

/// Diagnoses, proposes, plays and diagnoses again.
///
/// # Errors
/// Files that cannot be written or are refused.
pub fn try_experiment(case: ExperimentCase) -> Result<ExperimentOutcome, Error> {
    let dir = tempfile::tempdir().map_err(|error| Error::file("the bench", "make", error))?;
    let Some(bench) = bench(Motions::Arm, case.seed, &[case.kind]) else {
        return Err(Error::usage(
            "the bench cannot be made",
            "take another seed",
        ));
    };
    let model_file = dir.path().join("nominal.toml");
    let model = Model::parse(&bench.model_toml, &model_file)?;
    let hidden: Vec<String> = bench
        .effects
        .iter()
        .map(|e| address(e.kind, e.joint))
        .collect();
    let logs = read_halves(&dir.path().join("a.csv"), &bench.logs[0].csv, &model)?;
    let options = DiagnoseOptions::default();
    let first = diagnosed(&model, &[&logs], &options);
    let first_sets = sets(&first);
    let mut outcome = ExperimentOutcome {
        kind: case.kind,
        seed: case.seed,
        first_verdict: first.verdict,
        settled: None,
        first_sets,
    };
    let is_open = first.verdict == Verdict::Ambiguous && outcome.first_sets.contains(&hidden[0]);
    if !is_open {
        return Ok(outcome);
    }
    let begun = Instant::now();
    let motions = logs.concat();
    let propose_options = ProposeOptions {
        limits: ExperimentLimits::of_logs(&model, &motions, SECONDS),
        mass_kg: None,
        criterion: Criterion::D,
        seed: 1,
    };
    let proposal = propose(&model, &first, motions, &propose_options)?;
    let seconds = begun.elapsed().as_secs_f64();
    let played = played(case, &proposal, &model, dir.path())?;
    let known = proposal
        .measure
        .iter()
        .map(|measured| measured.path.parse());
    let again = DiagnoseOptions {
        known: known.collect::<Result<_, _>>()?,
        ..options
    };
    let all: Vec<&[Vec<Motion>; 2]> = std::iter::once(&logs).chain(&played).collect();
    let measured = measured(&model, &bench.effects, &again.known);
    let second = diagnosed(measured.as_ref().unwrap_or(&model), &all, &again);
    let parted = proposal.separations.iter().filter(|pair| pair.parted);
    let last = sets(&second);
    let truth = Model::parse(&bench.true_model_toml, &dir.path().join("true.toml"))?;
    outcome.settled = Some(Settled {
        settled: match measured {
            Some(_) => second.effects.is_empty() && second.verdict != Verdict::Unexplained,
            None => is_settled(&second, &last, &hidden[0], &model),
        },
        one_law: proposal.all_alike() && is_one_law(&truth, &outcome.first_sets),
        proposed: words(&proposal),
        separation: parted.map(|pair| pair.standard_errors).reduce(f64::min),
        verdict: second.verdict,
        sets: last,
        seconds,
    });
    Ok(outcome)
}

/// The owner's model with what was measured, where that is what the rig hides: who holds a known
/// mass with the drive measures its torque as it is.
fn measured(model: &Model, hidden: &[BenchEffect], known: &[ParameterPath]) -> Option<Model> {
    let path: ParameterPath = "joint1.stall_torque_nm".parse().ok()?;
    let scale = hidden.iter().find(|e| e.kind == "torque_scale")?;
    let (_, factor) = scale.parameters.first()?;
    let mut model = model.clone();
    let right_nm = factor * path.get(&model)?;
    (known.contains(&path) && path.set(&mut model, right_nm)).then_some(model)
}

/// Whether nothing is left but what is hidden, and the value of the file that it changes.
fn is_settled(last: &Diagnosis, sets: &[String], hidden: &str, model: &Model) -> bool {
    let candidate = Candidate::named(hidden, model).ok();
    let behind = candidate.map_or(Vec::new(), |candidate| values_behind(&candidate, model));
    let behind: Vec<String> = behind.iter().map(ToString::to_string).collect();
    let is_it = |set: &String| {
        let mut parts = set.split(" + ");
        set == hidden || parts.any(|part| behind.iter().any(|path| path == part))
    };
    let is_said = matches!(last.verdict, Verdict::Named | Verdict::Ambiguous);
    is_said && sets.iter().any(|set| set == hidden) && sets.iter().all(is_it)
}

/// Whether these explanations of an arm are one law: friction that differs by direction does what a
/// constant torque does as long as it resists both ways.
fn is_one_law(truth: &Model, sets: &[String]) -> bool {
    let value = |id: &str| {
        let effect = truth.effects.iter().find(|e| e.effect.info().id == id);
        effect.map_or(0.0, |effect| effect.values[0])
    };
    let one_sided_nm = value("direction_asymmetry") + value("torque_offset");
    let known = ["direction_asymmetry@1", "torque_offset@1"];
    sets.iter().all(|set| known.contains(&set.as_str()))
        && one_sided_nm.abs() <= value("coulomb").abs()
}

/// A log's motions to fit, and those held out.
fn read_halves(path: &Path, csv: &str, model: &Model) -> Result<[Vec<Motion>; 2], Error> {
    std::fs::write(path, csv).map_err(|error| Error::file(path, "write", error))?;
    let rows = csv.lines().filter(|line| !line.starts_with('#')).count() - 1;
    let from = rows * HELD_OUT_FROM / 2001;
    let part = |range: String| {
        let request: LogRequest = format!("{}:{range}", path.display()).parse()?;
        read(&[request], &model.log)
    };
    Ok([
        part(format!("0-{}", from - 1))?,
        part(format!("{from}-{}", rows - 1))?,
    ])
}

fn diagnosed(model: &Model, logs: &[&[Vec<Motion>; 2]], options: &DiagnoseOptions) -> Diagnosis {
    let of = |half: usize| logs.iter().flat_map(|log| log[half].clone()).collect();
    diagnose(model, of(0), of(1), options, &|_| {})
}

/// The log of the experiment, where there is one.
fn played(
    case: ExperimentCase,
    proposal: &ExperimentProposal,
    model: &Model,
    dir: &Path,
) -> Result<Option<[Vec<Motion>; 2]>, Error> {
    let Some(experiment) = &proposal.experiment else {
        return Ok(None);
    };
    let motion = &experiment.motion;
    let inputs = ArmInputs {
        time_s: motion.time_s.clone(),
        duty: motion.input[0].clone().unwrap_or_default(),
        torque_on: match &motion.torque_on {
            Some(on) => on.clone(),
            None => vec![true; motion.len()],
        },
        supply_v: experiment.condition.supply_v,
        payload_kg: experiment.condition.payload_kg,
        turned: experiment.condition.turned,
    };
    let csv = play(case.seed, &[case.kind], &inputs);
    read_halves(&dir.join("next.csv"), &csv, model).map(Some)
}

fn words(proposal: &ExperimentProposal) -> String {
    let mut parts = Vec::new();
    if let Some(experiment) = &proposal.experiment {
        let condition = experiment.condition;
        let kinds = experiment.motions.iter().map(|kind| kind.name());
        parts.push(kinds.collect::<Vec<_>>().join(", "));
        if condition.payload_kg > 0.0 {
            parts.push(format!("add {} kg", condition.payload_kg));
        }
        if condition.turned {
            parts.push("turn the rig".to_string());
        }
        if let Some(volts) = condition.supply_v {
            parts.push(format!("supply {volts:.1} V"));
        }
    }
    let measured = proposal.measure.iter();
    parts.extend(measured.map(|measured| format!("measure {}", measured.path)));
    if parts.is_empty() {
        "nothing".to_string()
    } else {
        parts.join("; ")
    }
}

fn address(kind: &str, joint: Option<usize>) -> String {
    match joint {
        Some(joint) => format!("{kind}@{joint}"),
        None => kind.to_string(),
    }
}

/// The chosen set and its rivals, each as one text; wrong values stand where there is no effect.
fn sets(diagnosis: &Diagnosis) -> Vec<String> {
    let own = (&diagnosis.effects, &diagnosis.wrong_values);
    let others = diagnosis.alternatives.iter();
    let all = std::iter::once(own).chain(others.map(|o| (&o.effects, &o.wrong_values)));
    let text = |(effects, wrong): (&Vec<FittedEffect>, &Vec<_>)| {
        let wrong: &Vec<handstand::diagnose::WrongValue> = wrong;
        let paths = wrong.iter().map(|wrong| wrong.fitted.path.clone());
        let parts: Vec<String> = if effects.is_empty() {
            paths.collect()
        } else {
            effects.iter().map(FittedEffect::address).collect()
        };
        parts.join(" + ")
    };
    all.map(text).collect()
}
