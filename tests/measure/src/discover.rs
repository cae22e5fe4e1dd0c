//! Arms whose law is outside the library, and arms that hide nothing: what `handstand discover`
//! finds, beside the true law.

use handstand::challenge::{Bench, Motions, UnknownLaw, bench, unknown_law_arm};
use handstand::compare::compare;
use handstand::diagnose::DiagnoseOptions;
use handstand::diagnose::conventions::ModelFile;
use handstand::discover::{Discovery, DiscoveryVerdict, MOST_TERMS, discover_logs};
use handstand::fitting::Horizon;
use handstand::log::{LogRequest, LogSet, read};
use handstand::motion::Motion;
use handstand::{Error, Model};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// How many times the true law's error what a discovered one leaves may be.
pub const MOST_LEFT: f64 = 1.5;

/// An arm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DiscoverCase {
    /// The law that it hides; none: nothing is missing.
    pub law: Option<&'static str>,
    /// Its seed.
    pub seed: u64,
}

/// What was found of an arm.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DiscoverOutcome {
    /// The name of the law that it hides, if it hides one.
    pub law: Option<String>,
    /// Its seed.
    pub seed: u64,
    /// The law with its values.
    pub hidden: String,
    /// What the discovery ended in.
    pub verdict: DiscoveryVerdict,
    /// The terms found, with their values.
    pub found: Vec<String>,
    /// Error of the model as it was on the motion held out, rad.
    pub before_rad: f64,
    /// With the law that was found.
    pub after_rad: f64,
    /// Of the true model.
    pub true_rad: f64,
    /// How long the discovery took.
    pub seconds: f64,
}

impl DiscoverOutcome {
    /// Whether the law leaves little more than the true one; of an arm that lacks nothing, whether
    /// no law was found.
    pub fn is_right(&self) -> bool {
        match self.law {
            Some(_) => !self.found.is_empty() && self.after_rad <= MOST_LEFT * self.true_rad,
            None => self.found.is_empty(),
        }
    }
}

/// Makes the arm, discovers what it lacks as a user would, compares. Its files stay in a folder of
/// `rigs`, if one is given.
///
/// # Errors
/// Files that cannot be written or are refused.
pub fn try_discover(case: DiscoverCase, rigs: Option<&Path>) -> Result<DiscoverOutcome, String> {
    let passing = tempfile::tempdir().map_err(|error| error.to_string())?;
    let name = format!("{}-{}", case.law.unwrap_or("nothing"), case.seed);
    let kept = rigs.map(|rigs| rigs.join(name));
    if let Some(dir) = &kept {
        std::fs::create_dir_all(dir).map_err(|error| format!("{}: {error}", dir.display()))?;
    }
    let (bench, law) = made(case).ok_or("there is no such law")?;
    let dir = kept.as_deref().unwrap_or(passing.path());
    tried(case, &bench, law.as_ref(), dir).map_err(|error| error.to_string())
}

fn made(case: DiscoverCase) -> Option<(Bench, Option<UnknownLaw>)> {
    match case.law {
        Some(law) => unknown_law_arm(case.seed, law).map(|(bench, law)| (bench, Some(law))),
        None => bench(Motions::Arm, case.seed, &[]).map(|bench| (bench, None)),
    }
}

fn tried(
    case: DiscoverCase,
    bench: &Bench,
    law: Option<&UnknownLaw>,
    dir: &Path,
) -> handstand::Result<DiscoverOutcome> {
    let write = |name: &str, content: &str| {
        let path = dir.join(name);
        std::fs::write(&path, content).map_err(|error| Error::file(&path, "write", error))?;
        Ok::<PathBuf, Error>(path)
    };
    let nominal = write("nominal.toml", &bench.model_toml)?;
    let truth = Model::load(&write("true.toml", &bench.true_model_toml)?)?;
    let mut logs = LogSet::default();
    for log in &bench.logs {
        let request = LogRequest::whole(write(&log.name, &log.csv)?);
        if log.held_out {
            logs.held_out.push(request);
        } else {
            logs.training.push(request);
        }
    }
    let model = Model::load(&nominal)?;
    let file = ModelFile {
        path: &nominal,
        text: &bench.model_toml,
    };
    let options = DiagnoseOptions {
        most_effects: MOST_TERMS,
        ..DiagnoseOptions::default()
    };
    let begun = Instant::now();
    let found = discover_logs(&model, file, &logs, &options, &|_| {})?;
    let seconds = begun.elapsed().as_secs_f64();
    let held_out = read(&logs.held_out, &model.log)?;
    let (discovery, with_terms) = (&found.discovery, &found.model);
    let horizon = discovery.diagnosis.horizon_s.map(Horizon::Seconds);
    let left = |model: &Model| left_rad(model, &held_out, horizon);
    Ok(DiscoverOutcome {
        law: case.law.map(str::to_string),
        seed: case.seed,
        hidden: law.map_or(String::new(), UnknownLaw::said),
        verdict: discovery.verdict,
        found: said(discovery),
        before_rad: left(&model),
        after_rad: left(&discovery.diagnosis.applied_to(with_terms)),
        true_rad: left(&truth),
        seconds,
    })
}

/// The terms, where there is a law.
fn said(discovery: &Discovery) -> Vec<String> {
    if !discovery.has_law() {
        return Vec::new();
    }
    let terms = discovery.terms.iter();
    terms
        .map(|term| format!("{} = {}", term.site, term.with_values))
        .collect()
}

/// Root-mean-square error over all motions, rad.
fn left_rad(model: &Model, motions: &[Motion], horizon: Option<Horizon>) -> f64 {
    let compared = compare(model, "model", motions, horizon);
    let squares = compared.pooled().map(|signal| signal.rms.powi(2));
    let mean = squares.sum::<f64>() / compared.pooled().count() as f64;
    mean.sqrt()
}
