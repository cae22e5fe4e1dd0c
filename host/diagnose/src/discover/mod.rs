//! The law that the library lacks: which terms in a joint's angle, speed, load, supply and time
//! make the torque that a model misses.
//!
//! Sparse regression over a library of terms, as SINDy does it (Brunton, Proctor, Kutz, PNAS 113
//! (2016) 3932), but on the trajectories: no measured angle is differentiated. Each term is an
//! effect of one joint; alone, in pairs and in threes they are fitted with the model's free values
//! and start states and judged on motions held out, as a diagnosis does with effects it has names
//! for, by the same search, floor, placebos and intervals.

mod findings;
mod picture;
mod scales;
mod vocabulary;

pub use findings::{DiscoveredTerm, Discovery, DiscoveryVerdict, OtherLaw};
pub use picture::{TermPicture, TermVariable};

use crate::diagnose::conventions::ModelFile;
use crate::diagnose::words::{HELD_OUT, LOGS, MODEL};
use crate::diagnose::{DiagnoseOptions, LogDiagnosis, diagnose, diagnose_logs, with_names};
use crate::effects::expression::{DefinitionFault, LawDefinition, effect};
use crate::effects::{EFFECTS, Effect};
use crate::error::Result;
use crate::fitting::{Horizon, Progress};
use crate::log::LogSet;
use crate::model::Model;
use crate::motion::{Motion, Split};
use picture::pictures;
use scales::Scales;
use vocabulary::vocabulary;

/// Most terms of a law that is not asked for more.
pub const MOST_TERMS: usize = 2;

/// Effects of the library that a law may need beside its terms.
const PLAIN: [&str; 2] = ["coulomb", "viscous"];

/// A discovery, and the motions it was made from.
#[derive(Debug, Clone)]
pub struct LogDiscovery {
    /// What was found.
    pub discovery: Discovery,
    /// The model with every term that was tried as a law of its own.
    pub model: Model,
    /// What was fitted and what was held out; nothing where the logs were refused.
    pub split: Split,
}

/// Looks for the torque that the model of `file` lacks in logs: as
/// [`diagnose_logs`], with terms in the place of the library's effects.
///
/// # Errors
/// As [`diagnose_logs`].
pub fn discover_logs(
    model: &Model,
    file: ModelFile,
    logs: &LogSet,
    options: &DiagnoseOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<LogDiscovery> {
    let named = logs.read(&model.log)?;
    let motions: Vec<Motion> = named.training.into_iter().chain(named.held_out).collect();
    let terms = Terms::of(model, &motions)?;
    let found = diagnose_logs(&terms.model, file, logs, &of_terms(options), progress)?;
    let mut found = terms.discovery(found);
    if let Some(lines) = next(&found.discovery) {
        let lines = lines.iter().map(|line| with_names(line, file.path, logs));
        found.discovery.diagnosis.next = lines.collect();
    }
    Ok(found)
}

/// The same of motions, of which those held out judge.
///
/// # Errors
/// More laws than one run of the program keeps.
pub fn discover(
    model: &Model,
    split: Split,
    options: &DiagnoseOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<LogDiscovery> {
    let motions: Vec<Motion> = split
        .training
        .iter()
        .chain(&split.held_out)
        .cloned()
        .collect();
    let terms = Terms::of(model, &motions)?;
    let Split { training, held_out } = split.clone();
    let options = of_terms(options);
    let mut diagnosis = diagnose(&terms.model, training, held_out, &options, progress);
    diagnosis.next.clear();
    Ok(terms.discovery(LogDiagnosis { diagnosis, split }))
}

/// A model with every term as a law of its own.
struct Terms {
    model: Model,
    definitions: Vec<LawDefinition>,
}

impl Terms {
    /// Scaled by what these motions cover.
    fn of(model: &Model, motions: &[Motion]) -> Result<Terms> {
        let mut definitions = vocabulary(&Scales::of(model, motions));
        let mut model = model.clone();
        definitions
            .iter_mut()
            .for_each(|term| rename(term, &model.laws));
        model.laws.extend(defined(&definitions)?);
        Ok(Terms { model, definitions })
    }

    /// What a diagnosis by these terms says of a law.
    fn discovery(self, found: LogDiagnosis) -> LogDiscovery {
        let Terms { model, definitions } = self;
        let LogDiagnosis { diagnosis, split } = found;
        let mut discovery = Discovery::new(diagnosis, &definitions);
        if discovery.has_law() {
            let diagnosis = &discovery.diagnosis;
            let horizon = diagnosis.search_horizon_s.map(Horizon::Seconds);
            discovery.pictures = pictures(
                &discovery.terms,
                &diagnosis.applied_to(&model),
                &split.training,
                horizon.unwrap_or(Horizon::Whole),
            );
        }
        LogDiscovery {
            discovery,
            model,
            split,
        }
    }
}

/// What to do next: how a law comes into a model, and where one fails that has none; none where a
/// diagnosis has said so already.
fn next(discovery: &Discovery) -> Option<Vec<String>> {
    let again = format!("handstand discover {MODEL} {LOGS} --holdout {HELD_OUT}");
    if discovery.has_law() {
        return Some(vec![
            format!("Add it: {again} -o better.toml"),
            format!("See what it gains: handstand compare {MODEL} {HELD_OUT} --model better.toml"),
        ]);
    }
    if discovery.verdict != DiscoveryVerdict::NotFound {
        return None;
    }
    let to_the_end = discovery
        .is_cut_short()
        .then(|| format!("Search to the end: {again}"));
    let see = format!("See where it fails: handstand compare {MODEL} {LOGS}");
    Some(to_the_end.into_iter().chain([see]).collect())
}

/// Gives a term a name that none of the model's own laws has.
fn rename(term: &mut LawDefinition, laws: &[Effect]) {
    let name = term.name.clone();
    let is_taken = |name: &str| laws.iter().any(|law| law.info().id == name);
    let free = (2..).map(|number| format!("{name}_{number}"));
    let mut free = std::iter::once(name.clone()).chain(free);
    term.name = free.find(|name| !is_taken(name)).unwrap_or(name.clone());
}

/// The effects of these terms.
///
/// # Errors
/// More laws than one run of the program keeps.
fn defined(terms: &[LawDefinition]) -> Result<Vec<Effect>> {
    let of = |fault| match fault {
        DefinitionFault::Name(problem) | DefinitionFault::Parameter(_, problem) => problem,
        DefinitionFault::Expression(misplaced) => misplaced.problem,
    };
    let defined = terms
        .iter()
        .map(|term| effect(term).map_err(|fault| of(fault).usage()));
    defined.collect()
}

/// The options of a diagnosis whose candidates are the terms.
fn of_terms(options: &DiagnoseOptions) -> DiagnoseOptions {
    let library = EFFECTS.iter().map(|effect| effect.info().id);
    let others = library.filter(|id| !PLAIN.contains(id));
    let mut options = options.clone();
    options.without.extend(others.map(str::to_string));
    options
}

#[cfg(test)]
mod tests;
