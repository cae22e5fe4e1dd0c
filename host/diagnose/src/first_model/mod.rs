//! A drafted model made usable: what a log tells of its guesses is estimated from the log.
//!
//! A draft of guesses alone may be so far from its log that no comparison says anything: an arm
//! without friction whirls away. Here plain friction is added, and what the rig's drives determine
//! (mass times lever, friction, gain or limit of speed) is fitted roughly to short windows, from
//! starts an order of magnitude apart. Of a driven arm other zeros of the angles and other signs of
//! the inputs are tried, too. What the log hardly determines stays free all the same, and is said
//! to be a guess: held wrong, it bends what is looked for beside it.

mod course;
mod levers;
mod settling;
#[cfg(test)]
mod tests;
mod values;

use crate::error::Result;
use crate::fitting::{
    Fit, FitOptions, FitProblem, Horizon, Progress, StopSwitch, best_fit, coarsened, fit,
};
use crate::log::init::{Draft, Estimate};
use crate::log::{LogRequest, read};
use crate::model::{AngleZero, Drive, LinkField, Model, ParameterPath};
use crate::motion::{Motion, excerpts};
use crate::output::number::{measured, mrad};
use course::{Course, Stage};
use levers::with_levers;
use rayon::prelude::*;
use settling::{Settled, Settling};
use std::path::Path;
use values::{free_of, is_friction, rubbing, starts};

/// Length of the windows, s, that the best is fitted to: little friction shows in them, too.
const WINDOW_S: f64 = 2.0;
/// Length of those that starts are compared on: from a guess that is far off the way back is found.
const SHORT_S: f64 = 0.5;
/// Samples that starts are compared on, and that the best is fitted to.
const FEW: usize = 2000;
const SAMPLES: usize = 6000;
/// Joints whose values are estimated at once: what a fit of all takes grows with the fourth power
/// of their number, to hours for ten and more.
const MOST_JOINTS: usize = 8;
/// Iterations that tell a promising start from a hopeless one.
const SCREENING: usize = 6;
/// Iterations that the most promising goes on for.
const ON: usize = 12;
/// Another zero or sign must leave less than this share of the error.
const CLEARLY: f64 = 0.7;
/// A joint that moves less than so many standard deviations of its reading tells nothing.
const MOVES: f64 = 20.0;

/// How an arm's log may be meant: where its angles are zero, and which inputs count the other way.
#[derive(Debug, Clone, PartialEq)]
struct Meaning {
    zero: AngleZero,
    reversed: Vec<bool>,
}

/// A meaning with the model fitted roughly to it.
struct FittedMeaning {
    meaning: Meaning,
    model: Model,
    rms_rad: f64,
}

/// Replaces a draft's guesses by what its log tells, adds plain friction, and notes each estimate
/// with its 95 % interval among the draft's guesses. A log that is refused, or in which nothing
/// moves, or of more than eight joints leaves the draft as it is, and a note says why.
///
/// `stop` abandons it, `heard` hears how far it has come.
///
/// # Errors
/// Figures that make no model.
pub fn estimate(
    draft: &mut Draft,
    request: &LogRequest,
    stop: &StopSwitch,
    heard: &(dyn Fn(Progress) + Sync),
) -> Result<()> {
    let drafted = Model::parse(&draft.toml()?, Path::new("model.toml"))?;
    let motions = match read(std::slice::from_ref(request), &drafted.log) {
        Ok(motions) => motions,
        Err(error) => {
            draft.note(
                "values",
                "guesses alone",
                &format!("the log is refused: {error}"),
            );
            return Ok(());
        }
    };
    if drafted.link_count() > MOST_JOINTS {
        let joints = drafted.link_count();
        let why = format!(
            "{joints} joints are too many to estimate at once: free a few values at a time and \
             `handstand fit`"
        );
        draft.note("values", "guesses alone", &why);
        return Ok(());
    }
    let mut rubbing = rubbing(&drafted, &motions);
    let course = Course::new(stop, heard);
    let Some(best) = best_meaning(&rubbing, draft, &motions, &course) else {
        draft.note("values", "guesses alone", "nothing moves in the log");
        return Ok(());
    };
    let Meaning { zero, reversed } = &best.meaning;
    if *zero != drafted.angle_zero {
        let why = format!(
            "no other zero lets a model follow the log, {} mrad",
            mrad(best.rms_rad)
        );
        draft.conclude_zero(zero.name(), &why);
    }
    for joint in (0..reversed.len()).filter(|joint| reversed[*joint]) {
        draft.reverse_input(joint);
    }
    let few = excerpts(&read_so(&motions, reversed), SAMPLES);
    let data = windows(&best.model, few, WINDOW_S).halted_by(&course.halt);
    let free = free_of(&rubbing, draft);
    let with_levers = with_levers(&free, &mut rubbing);
    // Short windows may lead astray where they show little: a swing of seconds.
    let mut begun = if drafted.driven_joints().is_empty() {
        starts(&rubbing, &with_levers)
    } else {
        vec![rubbing]
    };
    begun.iter_mut().for_each(|model| model.angle_zero = *zero);
    begun.push(best.model);
    let count = begun.len();
    let fitted = begun.par_iter().map(|model| {
        let fit = best_fit(model, &with_levers, &data);
        course.step(Stage::Fitting, count);
        fit
    });
    let Some(best) = fitted.min_by(|a, b| cost(a).total_cmp(&cost(b))) else {
        return Ok(());
    };
    course.begin(Stage::Settling);
    let settled = Settling {
        drafted: &drafted,
        data: &data,
        mass_is_known: draft.columns.knows_links || draft.is_known("mass"),
    }
    .settle(&best.model, free);
    write_down(draft, &drafted, settled);
    Ok(())
}

/// Puts what was found into the draft, with a note of each value.
fn write_down(draft: &mut Draft, drafted: &Model, settled: Settled) {
    let Settled { model, values } = settled;
    let friction = model.effects.iter().filter(|effect| is_friction(effect));
    draft.friction = friction.cloned().collect();
    draft.free = Some(values.iter().map(|(path, _)| path.to_string()).collect());
    let states_torque = |drive: &Drive| drive.name() == "torque";
    if !values.is_empty() && !drafted.joints.iter().any(|j| states_torque(&j.drive)) {
        let why = match (draft.columns.knows_links, draft.is_known("mass")) {
            (true, _) => "the log says it",
            (false, true) => "as you say",
            (false, false) => "a guess: weigh it, --mass",
        };
        draft.note(
            "scale",
            "all torques and inertias go with the last link's mass",
            why,
        );
    }
    for (index, link) in model.links.iter().enumerate() {
        let at = |field: LinkField| ParameterPath::Link { index, field };
        let is_fitted = |field: LinkField| values.iter().any(|(path, _)| *path == at(field));
        let drafted_kg_m2 = drafted.links[index].inertia_kg_m2;
        if !is_fitted(LinkField::Inertia) && link.inertia_kg_m2 != drafted_kg_m2 {
            draft.take(&at(LinkField::Inertia), link.inertia_kg_m2);
        }
        if !is_fitted(LinkField::Com) && link.com_m != drafted.links[index].com_m {
            draft.take(&at(LinkField::Com), link.com_m);
            draft.take(&at(LinkField::Mass), link.mass_kg);
            let lever = format!("{} m", rounded(link.com_m));
            let why = "a guess: no log tells a lever beside its mass and inertia";
            if is_fitted(LinkField::Mass) {
                draft.note(&format!("lever of link {}", index + 1), &lever, why);
            } else {
                let words = format!("{} kg at {lever}", rounded(link.mass_kg));
                draft.note(&format!("mass of link {}", index + 1), &words, why);
            }
        }
    }
    for (path, interval) in values {
        let Some(value) = path.get(&model) else {
            continue;
        };
        let name = path.to_string();
        match interval {
            Some(told) => {
                let words = measured(value, told.low, told.high, path.unit());
                draft.note(&name, &words, "estimated from the log");
                let (low, high) = (told.low, told.high);
                draft.estimates.push(Estimate { path, low, high });
            }
            None => {
                let words = format!("{} {}", rounded(value), path.unit());
                draft.note(&name, words.trim_end(), "a guess: the log hardly tells it");
            }
        }
        draft.take(&path, value);
    }
}

fn windows(model: &Model, motions: Vec<Motion>, seconds: f64) -> FitProblem {
    let horizon = Horizon::Seconds(seconds);
    FitProblem::new(model, motions, horizon).cut_evenly(horizon)
}

/// The meaning of the log that a rough fit explains best; the drafted one unless another is clearly
/// better. None where nothing moves.
fn best_meaning(
    model: &Model,
    draft: &Draft,
    motions: &[Motion],
    course: &Course,
) -> Option<FittedMeaning> {
    let few = windows(model, excerpts(motions, FEW), SHORT_S).halted_by(&course.halt);
    if few.windows.is_empty() || !moves(&few) {
        return None;
    }
    let mut model = coarsened(model, &few);
    let free = with_levers(&free_of(&model, draft), &mut model);
    let model = &model;
    let meanings = meanings(model, draft);
    let count = meanings.len();
    let fitted = |meaning: Meaning| {
        let data = few
            .clone()
            .measured_in(read_so(&few.motions, &meaning.reversed));
        let begun = Model {
            angle_zero: meaning.zero,
            ..model.clone()
        };
        let screened = starts(&begun, &free).into_par_iter().map(|start| {
            let options = FitOptions::iterations(SCREENING).rough();
            fit(&start, &free, &data, None, options)
        });
        let best = screened.min_by(|a, b| cost(a).total_cmp(&cost(b)))?;
        let best = best.resume(&data, FitOptions::iterations(ON).rough());
        let rms_rad = best.rms(&data);
        course.step(Stage::Screening, count);
        Some(FittedMeaning {
            meaning,
            model: best.model,
            rms_rad,
        })
    };
    let all = meanings.into_par_iter().filter_map(fitted);
    let mut all: Vec<FittedMeaning> = all.collect();
    all.retain(|candidate| candidate.rms_rad.is_finite());
    let drafted = all.first()?.rms_rad;
    let by_error = |a: &FittedMeaning, b: &FittedMeaning| a.rms_rad.total_cmp(&b.rms_rad);
    let best = all.iter().min_by(|a, b| by_error(a, b))?;
    let chosen = if best.rms_rad < CLEARLY * drafted {
        best.meaning.clone()
    } else {
        all.first()?.meaning.clone()
    };
    all.into_iter()
        .find(|candidate| candidate.meaning == chosen)
}

fn cost(fit: &Fit) -> f64 {
    let cost = fit.residuals.cost();
    if cost.is_finite() {
        cost
    } else {
        f64::INFINITY
    }
}

/// Whether some joint moves beyond its noise.
fn moves(data: &FitProblem) -> bool {
    (0..data.joints()).any(|joint| {
        let values = || {
            let motions = 0..data.motions.len();
            let values = motions.flat_map(|motion| data.measured(motion, joint));
            values.copied().filter(|value| value.is_finite())
        };
        let low = values().fold(f64::INFINITY, f64::min);
        let high = values().fold(f64::NEG_INFINITY, f64::max);
        high - low > MOVES * data.sigma[joint]
    })
}

/// The drafted meaning first. Of a driven arm the zero may lie elsewhere, and an input that is no
/// goal may count the other way round.
fn meanings(model: &Model, draft: &Draft) -> Vec<Meaning> {
    let joints = model.link_count();
    let drafted = Meaning {
        zero: model.angle_zero,
        reversed: vec![false; joints],
    };
    let driven = model.driven_joints();
    if driven.is_empty() {
        return vec![drafted];
    }
    let mut all = vec![drafted.clone()];
    if !draft.is_known("angle zero") {
        let zeros = [
            AngleZero::Hanging,
            AngleZero::Upright,
            AngleZero::Horizontal,
        ];
        let others = zeros.into_iter().filter(|zero| *zero != model.angle_zero);
        all.extend(others.map(|zero| Meaning {
            zero,
            ..drafted.clone()
        }));
    }
    let is_goal = |joint: usize| ["position", "speed"].contains(&model.joints[joint].drive.name());
    for joint in driven.into_iter().filter(|joint| !is_goal(*joint)) {
        let mut meaning = drafted.clone();
        meaning.reversed[joint] = true;
        all.push(meaning);
    }
    all
}

/// The motions with the inputs of some joints the other way round.
fn read_so(motions: &[Motion], reversed: &[bool]) -> Vec<Motion> {
    let mut motions = motions.to_vec();
    for motion in &mut motions {
        for (input, _) in motion.input.iter_mut().zip(reversed).filter(|(_, r)| **r) {
            input
                .iter_mut()
                .flatten()
                .for_each(|value| *value = -*value);
        }
    }
    motions
}

fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}
