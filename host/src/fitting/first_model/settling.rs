//! A first model's values settled: what its log determines told from what it does not, with room
//! for the links' inertia.

use super::values::is_friction;
use super::{ON, fit};
use crate::fitting::covariance::{Interval, intervals};
use crate::fitting::data::FitData;
use crate::fitting::fit::{Fit, FitOptions};
use crate::model::{Link, LinkField, Model, ParameterPath};

/// A value is told by the log where its interval reaches no further than so many times its size.
const TOLD: f64 = 3.0;
/// Friction is shown where its interval reaches less than so many times its size, and not to zero.
const SHOWN: f64 = 0.9;
/// Friction without which the error is so many times as large is there, whatever its interval:
/// beside what the model lacks intervals are wide.
const NEEDED: f64 = 1.05;
/// Levers that are shortened, in all.
const LEVERS: usize = 6;
/// A lever this near, as a share, to the one of the fastest swing is held there by the inertia.
const AT_SHORTEST: f64 = 0.1;
/// The inertia is then taken so many times as large.
const LESS_INERT: f64 = 0.25;
/// A lever is lengthened to so many times itself.
const LONGER: f64 = 1.3;
/// Least inertia about a link's own centre of mass, over that of its mass there about the joint.
const ROOM: f64 = 0.7;
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
    pub data: &'a FitData,
    pub mass_is_known: bool,
}

impl Settling<'_> {
    /// The model fitted from where it began. Friction stays where the log shows some. A drive's or
    /// a link's value that the log hardly determines stays free for all that: it is a guess, and
    /// held wrong it bends whatever is looked for beside it.
    pub fn settle(&self, begun: &Model, mut free: Vec<ParameterPath>) -> Settled {
        let mut model = begun.clone();
        let (mut levers, mut held) = (0, Vec::new());
        loop {
            let found = fit(&model, &free, self.data, None, FitOptions::iterations(ON));
            if levers < LEVERS
                && let Some(link) = self.crowded(&found.model, &free)
            {
                levers += 1;
                model = found.model;
                self.make_room(&mut model.links[link]);
                continue;
            }
            if levers < LEVERS
                && let Some(link) = too_long(&found.model, &free)
            {
                levers += 1;
                model = found.model;
                model.links[link].inertia_kg_m2 *= LESS_INERT;
                continue;
            }
            if levers < LEVERS
                && let Some(outer) = self.too_heavy(&found)
            {
                levers += 1;
                model = found.model;
                lighten(&mut model.links[outer]);
                continue;
            }
            let Some(intervals) = intervals(&found, self.data).map(|(intervals, _)| intervals)
            else {
                // The least important stands last.
                let Some(path) = free.pop() else {
                    return settled(model, Vec::new(), held);
                };
                forget(&mut model, &path, self.drafted);
                continue;
            };
            if let Some((index, without)) = self.untold_friction(&found, &free, &intervals) {
                free.remove(index);
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
            return settled(found.model, values, held);
        }
    }

    /// A link whose lever leaves its inertia little room below what was fitted.
    fn crowded(&self, model: &Model, free: &[ParameterPath]) -> Option<usize> {
        free.iter().find_map(|path| match path {
            ParameterPath::Link {
                index,
                field: LinkField::Inertia,
            } => {
                let link = &model.links[*index];
                let about_mass_kg_m2 = link.mass_kg * link.com_m * link.com_m;
                (link.inertia_kg_m2 < ROOM * about_mass_kg_m2).then_some(*index)
            }
            _ => None,
        })
    }

    /// Shortens a link's lever to half the length of the pendulum that swings alike, or to half of
    /// itself, at the same pull of gravity unless its mass is known, and the same inertia about its
    /// joint.
    fn make_room(&self, link: &mut Link) {
        let pull_kg_m = link.mass_kg * link.com_m;
        let about_joint_kg_m2 = link.inertia_kg_m2 + pull_kg_m * link.com_m;
        let alike_m = about_joint_kg_m2 / pull_kg_m;
        link.com_m = (0.5 * alike_m).clamp(0.5 * link.com_m, link.com_m);
        if !self.mass_is_known {
            link.mass_kg = pull_kg_m / link.com_m;
        }
        link.inertia_kg_m2 = about_joint_kg_m2 - link.mass_kg * link.com_m * link.com_m;
    }

    /// The link behind one that was left no mass: at the lever it has it weighs too much there.
    fn too_heavy(&self, found: &Fit) -> Option<usize> {
        let links = found.model.links.len();
        let on_bound = found.on_bound();
        let mut on_bound = found.free.iter().zip(on_bound).filter(|(_, on)| *on);
        on_bound.find_map(|(path, _)| match path {
            ParameterPath::Link {
                index,
                field: LinkField::Mass,
            } if index + 1 < links && !self.mass_is_known => Some(index + 1),
            _ => None,
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

/// A link whose lever is free and its inertia not, where no lever swings faster: as long as its
/// radius of gyration.
fn too_long(model: &Model, free: &[ParameterPath]) -> Option<usize> {
    let is_free =
        |index: usize, field: LinkField| free.contains(&ParameterPath::Link { index, field });
    (0..model.links.len()).find(|&index| {
        let link = &model.links[index];
        let shortest_m = (link.inertia_kg_m2 / link.mass_kg).sqrt();
        is_free(index, LinkField::Com)
            && !is_free(index, LinkField::Inertia)
            && (link.com_m / shortest_m - 1.0).abs() < AT_SHORTEST
    })
}

/// Lengthens a link's lever at the same pull of gravity and, as far as there is any, the same
/// inertia about its joint.
fn lighten(link: &mut Link) {
    let pull_kg_m = link.mass_kg * link.com_m;
    let about_joint_kg_m2 = link.inertia_kg_m2 + pull_kg_m * link.com_m;
    link.com_m *= LONGER;
    link.mass_kg = pull_kg_m / link.com_m;
    let left_kg_m2 = about_joint_kg_m2 - pull_kg_m * link.com_m;
    link.inertia_kg_m2 = left_kg_m2.max(0.1 * pull_kg_m * link.com_m);
}

/// What was held at its guess stays free, untold.
fn settled(
    model: Model,
    mut values: Vec<(ParameterPath, Option<Interval>)>,
    held: Vec<ParameterPath>,
) -> Settled {
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
    match path {
        ParameterPath::Effect { .. } => true,
        _ => (guess / FAR..=guess * FAR).contains(&value),
    }
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
