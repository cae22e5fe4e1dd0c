//! A first model's values settled: what its log determines told from what it does not, with room
//! for the links' inertia.

use super::values::{VISCOUS_NM_S_RAD, is_friction};
use super::{ON, fit};
use crate::fitting::FitProblem;
use crate::fitting::{Fit, FitOptions};
use crate::fitting::{Interval, intervals};
use crate::model::{EffectInstance, LinkField, Model, ParameterPath};

/// A value is told by the log where its interval reaches no further than so many times its size.
const TOLD: f64 = 3.0;
/// Friction is shown where its interval reaches less than so many times its size, and not to zero.
const SHOWN: f64 = 0.9;
/// Friction without which the error is so many times as large is there, whatever its interval:
/// beside what the model lacks intervals are wide. Other levers may raise it no more than so.
const NEEDED: f64 = 1.05;
/// Levers that are changed, in all.
const LEVERS: usize = 6;
/// A model is far from its log where it leaves more than so many times the noise.
const FAR_OFF: f64 = 3.0;
/// Estimates beyond so many times a guess, either way, are none.
const FAR: f64 = 30.0;

/// What a first model is given.
pub(super) struct Settled {
    pub model: Model,
    /// What every later fit may change, with the interval of what the log determines.
    pub values: Vec<(ParameterPath, Option<Interval>)>,
}

/// Tells what a log determines from what it does not.
pub(super) struct Settling<'a> {
    pub drafted: &'a Model,
    pub data: &'a FitProblem,
    pub mass_is_known: bool,
}

impl Settling<'_> {
    /// The model fitted from where it began. Friction stays where the log shows some. A drive's or
    /// a link's value that the log hardly determines stays free for all that: it is a guess, and
    /// held wrong it bends whatever is looked for beside it.
    pub fn settle(&self, begun: &Model, mut free: Vec<ParameterPath>) -> Settled {
        let mut model = begun.clone();
        let (mut levers, mut held, mut hidden) = (0, Vec::new(), Vec::new());
        loop {
            let found = fit(&model, &free, self.data, None, FitOptions::iterations(ON));
            if levers < LEVERS
                && let Some(roomier) = self.improved_levers(&found, &free)
            {
                levers += 1;
                model = roomier;
                continue;
            }
            let Some(intervals) = intervals(&found, self.data).map(|(intervals, _)| intervals)
            else {
                // The least important stands last.
                let Some(path) = free.pop() else {
                    return settled(model, Vec::new(), held, hidden);
                };
                forget(&mut model, &path, self.drafted);
                continue;
            };
            if let Some((index, without)) = self.untold_friction(&found, &free, &intervals) {
                let path = free.remove(index);
                if let Some(friction) = hidden_friction(&found, &path) {
                    hidden.push(friction);
                    held.push(path);
                }
                model = without;
                continue;
            }
            if let Some(index) = self.strange(&found, &free) {
                model = found.model;
                let path = free.remove(index);
                forget(&mut model, &path, self.drafted);
                if let ParameterPath::Link { index, .. } = path {
                    model.links[index].com_m = self.drafted.links[index].com_m;
                    // Its guesses go together, and no more room is made for what they do not
                    // follow.
                    levers = LEVERS;
                }
                held.push(path);
                continue;
            }
            let is_told = |index: usize| reach(&found, &intervals, index) <= TOLD;
            let told = (0..free.len()).map(|index| is_told(index).then(|| intervals[index]));
            let values = free.iter().cloned().zip(told).collect();
            return settled(found.model, values, held, hidden);
        }
    }

    /// The first of the models with more room that follows the log as well.
    fn improved_levers(&self, found: &Fit, free: &[ParameterPath]) -> Option<Model> {
        let limit_rad = NEEDED * found.rms(self.data);
        self.roomier(found).into_iter().find_map(|roomier| {
            let options = FitOptions::iterations(ON);
            let refitted = fit(&roomier, free, self.data, None, options);
            (refitted.rms(self.data) <= limit_rad).then_some(refitted.model)
        })
    }

    /// Friction of which the log does not show that there is some, with the model without it: what
    /// lies on its bound, else the least certain without which the error hardly rises.
    fn untold_friction(
        &self,
        found: &Fit,
        free: &[ParameterPath],
        intervals: &[Interval],
    ) -> Option<(usize, Model)> {
        let on_bound = found.on_bound();
        let friction = (0..free.len())
            .filter(|index| matches!(free[*index], ParameterPath::Effect { .. }))
            .filter(|index| on_bound[*index] || reach(found, intervals, *index) > SHOWN);
        let mut untold: Vec<usize> = friction.collect();
        let uncertainty = |index: &usize| {
            if on_bound[*index] {
                f64::INFINITY
            } else {
                reach(found, intervals, *index)
            }
        };
        untold.sort_by(|a, b| uncertainty(b).total_cmp(&uncertainty(a)));
        untold.into_iter().find_map(|index| {
            let mut without = found.model.clone();
            forget(&mut without, &free[index], self.drafted);
            let mut rest = free.to_vec();
            rest.remove(index);
            let options = FitOptions::iterations(ON);
            let refitted = fit(&without, &rest, self.data, None, options);
            let is_needed = refitted.rms(self.data) > NEEDED * found.rms(self.data);
            (on_bound[index] || !is_needed).then_some((index, refitted.model))
        })
    }

    /// A value that no bench has, or that fled to its bound.
    fn strange(&self, found: &Fit, free: &[ParameterPath]) -> Option<usize> {
        let on_bound = found.on_bound();
        (0..free.len()).find(|index| {
            let value = free[*index].get(&found.model).unwrap_or(0.0);
            let guess = free[*index].get(self.drafted).unwrap_or(value);
            on_bound[*index] || !is_plausible(&free[*index], value, guess)
        })
    }
}

/// Viscous friction that was taken out of a model that is far from its log: what is missing there
/// may hide it, for every joint has some.
fn hidden_friction(found: &Fit, path: &ParameterPath) -> Option<EffectInstance> {
    let is_far = found.residuals.mean_square().sqrt() > FAR_OFF;
    let of_path =
        |effect: &&EffectInstance| ParameterPath::of_effect(effect).any(|own| own == *path);
    let friction = found.model.effects.iter().find(of_path)?;
    (is_far && friction.effect.info().id == "viscous").then(|| EffectInstance {
        values: vec![VISCOUS_NM_S_RAD],
        ..friction.clone()
    })
}

/// What was held at its guess stays free, untold; friction that may be hidden does, too.
fn settled(
    mut model: Model,
    mut values: Vec<(ParameterPath, Option<Interval>)>,
    held: Vec<ParameterPath>,
    hidden: Vec<EffectInstance>,
) -> Settled {
    model.effects.extend(hidden);
    values.extend(held.into_iter().map(|path| (path, None)));
    Settled { model, values }
}

/// Half an interval's width over its value.
fn reach(found: &Fit, intervals: &[Interval], index: usize) -> f64 {
    let interval = &intervals[index];
    let size = found.free[index].get(&found.model).unwrap_or(0.0).abs();
    0.5 * (interval.high - interval.low) / size.max(1e-12)
}

/// Whether an estimate is one that a bench has: a mass of 60 kg on a servo tells of a motion that
/// the model does not follow.
fn is_plausible(path: &ParameterPath, value: f64, guess: f64) -> bool {
    let far = match path {
        ParameterPath::Effect { .. } => return true,
        // It goes with the square of the length.
        ParameterPath::Link {
            field: LinkField::Inertia,
            ..
        } => FAR * FAR,
        _ => FAR,
    };
    (guess / far..=guess * far).contains(&value)
}

/// Takes a value back: friction out, another to its guess.
fn forget(model: &mut Model, path: &ParameterPath, guessed: &Model) {
    let before = model.effects.len();
    model.effects.retain(|effect| {
        !is_friction(effect) || ParameterPath::of_effect(effect).all(|own| own != *path)
    });
    if model.effects.len() == before
        && let Some(value) = path.get(guessed)
    {
        let _ = path.set(model, value);
    }
}
