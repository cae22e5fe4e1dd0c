//! The choice of an experiment among all that were simulated.

use super::candidates::{Experiment, experiments, with_payload_place};
use super::condition::usual_mass_kg;
use super::limits::ExperimentLimits;
use super::prediction::predicted_motion;
use super::proposal::{
    ExperimentProposal, MeasuredValue, ProposedExperiment, RivalName, Separation,
};
use super::rival::{Rival, rivals};
use super::separation::{Separations, by_derivatives, by_fits, pairs};
use super::tighten::{Criterion, tightened};
use crate::diagnose::{Diagnosis, Verdict, how_to_measure};
use crate::error::Result;
use crate::fitting::{FitProblem, Horizon};
use crate::model::{Model, ParameterPath};
use crate::motion::Motion;
use rayon::prelude::*;

/// Standard errors from which a diagnosis tells two explanations apart: an explanation is replaced
/// only where an interval over blocks, and a criterion that counts values, agree.
const PARTED: f64 = 8.0;
/// Standard errors from which more is not worth more effort.
const AMPLE: f64 = 3.0 * PARTED;
/// Standard errors below which two explanations are one law: a diagnosis sees nothing of it.
const ALIKE: f64 = 1.0;
/// Experiments whose separation is confirmed by fits.
const CONFIRMED: usize = 4;

/// What a proposal may be told.
#[derive(Debug, Clone)]
pub struct ProposeOptions {
    /// Limits of the motion.
    pub limits: ExperimentLimits,
    /// Known mass that can be bolted on, kg; chosen from the last link's where absent.
    pub mass_kg: Option<f64>,
    /// What tightening makes small.
    pub criterion: Criterion,
    /// Seed of random motions.
    pub seed: u64,
}

/// An experiment with what it does for each pair of rivals.
type Judged<'a> = (&'a Experiment, Separations);

/// The experiment that parts what a diagnosis leaves open; where it leaves nothing open, the one
/// that tightens the values of its explanation and the model's free ones.
///
/// # Errors
/// Limits that no motion can be held in.
pub fn propose(
    model: &Model,
    diagnosis: &Diagnosis,
    motions: Vec<Motion>,
    options: &ProposeOptions,
) -> Result<ExperimentProposal> {
    let horizon = Horizon::from_seconds(diagnosis.horizon_s);
    let model = with_payload_place(model);
    let logs = FitProblem::new(&model, motions, horizon);
    let rivals = rivals(&model, diagnosis, &logs);
    let verdict = Some(diagnosis.verdict);
    match (diagnosis.verdict, rivals.as_slice()) {
        (Verdict::Unexplained | Verdict::Unfit, _) | (_, []) => Ok(ExperimentProposal {
            verdict,
            ..nothing(&rivals)
        }),
        (_, [rival]) => {
            let places: Vec<usize> = (0..rival.fit.free.len()).collect();
            let proposal = tightened(rival, &places, &logs, horizon, options)?;
            Ok(ExperimentProposal {
                verdict,
                ..proposal
            })
        }
        _ => {
            let proposal = parted(&rivals, &logs, horizon, options)?;
            Ok(ExperimentProposal {
                verdict,
                ..proposal
            })
        }
    }
}

/// The experiment that tightens these values of a model; its own free values are refitted along.
///
/// # Errors
/// As [`propose`].
pub fn propose_values(
    model: &Model,
    values: &[ParameterPath],
    motions: Vec<Motion>,
    horizon: Horizon,
    options: &ProposeOptions,
) -> Result<ExperimentProposal> {
    let model = with_payload_place(model);
    let logs = FitProblem::new(&model, motions, horizon);
    let mut free = values.to_vec();
    free.extend(model.free.iter().filter(|path| !values.contains(path)));
    let rival = Rival::fitted(RivalName::of(&[], &[]), &model, &free, &logs);
    let places: Vec<usize> = (0..values.len()).collect();
    tightened(&rival, &places, &logs, horizon, options)
}

pub(super) fn nothing(rivals: &[Rival]) -> ExperimentProposal {
    ExperimentProposal {
        verdict: None,
        rivals: rivals.iter().map(|rival| rival.name.clone()).collect(),
        experiment: None,
        separations: Vec::new(),
        alike: Vec::new(),
        values: Vec::new(),
        measure: Vec::new(),
        simulated: 0,
        within_limits: 0,
    }
}

pub(super) fn all_experiments(rival: &Rival, options: &ProposeOptions) -> Result<Vec<Experiment>> {
    let model = &rival.fit.model;
    let mass_kg = options.mass_kg.unwrap_or_else(|| usual_mass_kg(model));
    experiments(model, &options.limits, mass_kg, options.seed)
}

/// The experiment that puts the closest two rivals farthest apart, of those that any can part.
pub(super) fn parted(
    rivals: &[Rival],
    logs: &FitProblem,
    horizon: Horizon,
    options: &ProposeOptions,
) -> Result<ExperimentProposal> {
    let limits = &options.limits;
    let experiments = all_experiments(&rivals[0], options)?;
    let judged = experiments.par_iter().filter_map(|experiment| {
        let apart = by_derivatives(rivals, experiment, limits, logs, horizon)?;
        Some((experiment, apart))
    });
    let judged: Vec<Judged> = judged.collect();
    let mut proposal = ExperimentProposal {
        simulated: experiments.len(),
        within_limits: judged.len(),
        ..nothing(rivals)
    };
    let farthest = |pair: usize| {
        let apart = judged.iter().map(|(_, apart)| apart.of_pairs[pair]);
        apart.fold(0.0, f64::max)
    };
    let all_pairs = pairs(rivals.len());
    let farthest: Vec<f64> = (0..all_pairs.len()).map(farthest).collect();
    let possible: Vec<bool> = farthest.iter().map(|apart| *apart >= PARTED).collect();
    if !judged.is_empty() {
        let pairs = all_pairs.into_iter().zip(&farthest);
        let alike = pairs.filter(|(_, apart)| **apart < ALIKE);
        proposal.alike = alike.map(|(pair, _)| pair).collect();
    }
    let mut leaders = ranked(judged, &possible);
    leaders.truncate(CONFIRMED);
    let confirmed = leaders.into_iter().filter_map(|(experiment, _)| {
        let apart = by_fits(rivals, experiment, limits, logs, horizon)?;
        Some((experiment, apart))
    });
    // The order stays: the first that does is the one of least effort.
    let mut best: Option<Judged> = None;
    for (experiment, apart) in confirmed {
        let least = closest(&apart, &possible);
        if best
            .as_ref()
            .is_none_or(|(_, held)| least > closest(held, &possible))
        {
            best = Some((experiment, apart));
        }
        if least >= PARTED {
            break;
        }
    }
    if let Some((experiment, apart)) = best {
        proposal.separations = separations(&apart, rivals.len());
        if proposal.separations.iter().any(|pair| pair.parted) {
            proposal.experiment = Some(proposed(experiment, &rivals[0], limits));
        }
    }
    proposal.measure = measured(&proposal, rivals);
    Ok(proposal)
}

/// Smallest separation among the pairs that some experiment parts.
fn closest(apart: &Separations, possible: &[bool]) -> f64 {
    let pairs = apart.of_pairs.iter().zip(possible);
    let pairs = pairs
        .filter(|(_, possible)| **possible)
        .map(|(apart, _)| *apart);
    pairs.reduce(f64::min).unwrap_or(0.0)
}

/// The best first: those that part amply by their effort, then the others by how far they part.
fn ranked<'a>(mut judged: Vec<Judged<'a>>, possible: &[bool]) -> Vec<Judged<'a>> {
    judged.retain(|(_, apart)| closest(apart, possible) > 0.0);
    judged.sort_by(|(a, apart_a), (b, apart_b)| {
        let (least_a, least_b) = (closest(apart_a, possible), closest(apart_b, possible));
        let ample = (least_b >= AMPLE).cmp(&(least_a >= AMPLE));
        let changes = if least_a >= AMPLE && least_b >= AMPLE {
            a.effort().0.cmp(&b.effort().0)
        } else {
            std::cmp::Ordering::Equal
        };
        let farther = least_b.total_cmp(&least_a);
        ample
            .then(changes)
            .then(farther)
            .then(a.effort().cmp(&b.effort()))
    });
    judged
}

fn separations(apart: &Separations, rivals: usize) -> Vec<Separation> {
    let pairs = pairs(rivals).into_iter().zip(&apart.of_pairs);
    let separation = pairs.map(|(rivals, &standard_errors)| Separation {
        rivals,
        standard_errors,
        parted: standard_errors >= PARTED,
    });
    separation.collect()
}

/// Values of the file whose measurement parts what the experiment does not.
fn measured(proposal: &ExperimentProposal, rivals: &[Rival]) -> Vec<MeasuredValue> {
    let every_pair = pairs(proposal.rivals.len());
    let open = every_pair.iter().filter(|pair| {
        let mut known = proposal.separations.iter();
        proposal.experiment.is_none() || known.any(|s| s.rivals == **pair && !s.parted)
    });
    let mut found: Vec<MeasuredValue> = Vec::new();
    for &(a, b) in open {
        let (a, b) = (&rivals[a].measurable, &rivals[b].measurable);
        let only_a = a.iter().filter(|path| !b.contains(path));
        let only_b = b.iter().filter(|path| !a.contains(path));
        let measured = only_a.chain(only_b).find_map(|path| {
            Some(MeasuredValue {
                path: path.clone(),
                instruction: how_to_measure(path)?,
            })
        });
        found.extend(measured.filter(|measured| !found.contains(measured)));
    }
    found
}

pub(super) fn proposed(
    experiment: &Experiment,
    rival: &Rival,
    limits: &ExperimentLimits,
) -> ProposedExperiment {
    let motion = predicted_motion(&rival.fit.model, experiment);
    ProposedExperiment {
        motions: experiment.kinds.clone(),
        seconds: motion.duration_s(),
        hz: limits.hz,
        width: experiment.width,
        condition: experiment.condition,
        instructions: experiment.condition.instructions(&rival.fit.model),
        motion,
    }
}
