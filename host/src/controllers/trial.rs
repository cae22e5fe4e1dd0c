//! Robots by lot, let go near their pose: how many does a controller hold?
//!
//! Robot i is the same in every trial of a seed, so that controllers and conditions meet the same robots. Held is who
//! never leans a link more than 45 deg and keeps every joint within 10 deg of the pose over the last two seconds.

use super::conditions::{DEAD_ZONE, DEAD_ZONE_ERROR, ECCENTRIC_M};
use super::servo::Through;
use super::{Condition, Design, Known, Uncertain};
use crate::closed_loop::{ClosedLoop, Controller, Limits, Outcome, Plant, Seen, Start, stream};
use crate::effects;
use crate::error::Result;
use crate::model::{EffectInstance, Model};
use rand::Rng as _;
use rayon::prelude::*;
use serde::Serialize;

/// A link that leans further has fallen, rad.
const FALL_RAD: f64 = 45.0 * std::f64::consts::PI / 180.0;

/// Every joint has to stay this near to its pose at the end, rad ..
const NEAR_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;

/// .. for this long, s.
const NEAR_S: f64 = 2.0;

/// Share of the robots that have to be held for a region to count as held.
const HELD_SHARE: f64 = 0.95;

/// Largest region that is searched, rad.
const LARGEST_REGION_RAD: f64 = 16.0 * std::f64::consts::PI / 180.0;

/// Halvings of the interval in which a region ends.
const HALVINGS: usize = 6;

/// Which robots are let go, and for how long.
#[derive(Debug, Clone)]
pub struct Robots<'a> {
    /// The model the controllers know.
    pub model: &'a Model,
    /// The pose that is held, in the model's own convention, rad.
    pub pose_rad: &'a [f64],
    /// Sampling time, s.
    pub period_s: f64,
    /// How many.
    pub count: usize,
    /// They start at rest, each joint evenly anywhere within this of its pose, rad.
    pub spread_rad: f64,
    /// How long each runs, s; above 2.
    pub seconds: f64,
    /// Whose chances.
    pub seed: u64,
}

/// What became of them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// How many were let go.
    pub robots: usize,
    /// Share that was held.
    pub held: f64,
    /// Share that fell; the rest stood but swung or leant too far.
    pub fell: f64,
    /// Root mean square angle of the held ones over their whole runs, rad.
    pub rms_angle_rad: Option<f64>,
    /// Median, over the held ones, of the peak-to-peak swing in the last second, rad.
    pub swing_rad: Option<f64>,
    /// Root mean square torque of the held ones, N m.
    pub rms_torque_nm: Option<f64>,
}

/// Largest spread of starts of which a controller holds 95 %, rad.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Region {
    /// Half-width of the cube of angles; 0 if it holds too few from anywhere.
    pub spread_rad: f64,
    /// Whether it may be larger still: the search ends at 16 deg.
    pub open: bool,
}

/// Lets the robots go; `done` is called after each.
///
/// # Errors
/// A model the closed loop does not have, or a controller that cannot be made.
pub fn try_out(
    robots: &Robots<'_>,
    design: &dyn Design,
    condition: &Condition,
    known: &Known,
    done: &(dyn Fn() + Sync),
) -> Result<Tried> {
    let controller = design.build(known)?;
    let outcomes: Result<Vec<Outcome>> = (0..robots.count)
        .into_par_iter()
        .map(|index| {
            let outcome = robots.run(index, design, controller.as_ref(), condition, known);
            done();
            outcome
        })
        .collect();
    Ok(robots.sum(&outcomes?))
}

/// Searches the largest cube of starts that is held.
///
/// # Errors
/// As [`try_out`].
pub fn region(
    robots: &Robots<'_>,
    design: &dyn Design,
    condition: &Condition,
    known: &Known,
    done: &(dyn Fn() + Sync),
) -> Result<Region> {
    let holds = |spread_rad: f64| -> Result<bool> {
        let robots = Robots {
            spread_rad,
            ..robots.clone()
        };
        Ok(try_out(&robots, design, condition, known, done)?.held >= HELD_SHARE)
    };
    let (mut held, mut lost) = (0.0, LARGEST_REGION_RAD);
    if holds(lost)? {
        return Ok(Region {
            spread_rad: lost,
            open: true,
        });
    }
    for _ in 0..HALVINGS {
        let middle = (held + lost) / 2.0;
        if holds(middle)? {
            held = middle;
        } else {
            lost = middle;
        }
    }
    Ok(Region {
        spread_rad: held,
        open: false,
    })
}

/// How many runs [`region`] takes at most for each robot.
pub const REGION_RUNS: usize = HALVINGS + 1;

impl Robots<'_> {
    /// Lets robot `index` go.
    fn run(
        &self,
        index: usize,
        design: &dyn Design,
        controller: &dyn Controller,
        condition: &Condition,
        known: &Known,
    ) -> Result<Outcome> {
        let card = design.card();
        let joints = self.model.link_count();
        // Drawn in this order whatever the condition, so that the robot stays the same.
        let mut rng = stream(self.seed, index as u64);
        let start = Start::random(joints, self.spread_rad, &mut rng);
        let aside: Vec<f64> = (0..joints)
            .map(|_| ECCENTRIC_M * rng.random_range(-1.0..=1.0))
            .collect();
        let dead_zone = DEAD_ZONE * (1.0 + DEAD_ZONE_ERROR * rng.random_range(-1.0..=1.0));
        let mut model = self.model.clone();
        if condition.masses {
            let uncertain = Uncertain {
                mass: 0.1,
                with_inertia: false,
                period_s: self.period_s,
                delay_s: 0.0,
            };
            model = uncertain.model(&model, &uncertain.share(&model, self.seed, index));
        }
        if condition.eccentric {
            lean(&mut model, &aside);
        }
        let plant = Plant::new(&model, self.pose_rad)?;
        let balance = plant.balanced_rad();
        let closed = ClosedLoop {
            plant,
            conditions: condition.conditions(known, dead_zone),
            limits: Limits {
                fall_rad: FALL_RAD,
                settle_rad: NEAR_RAD,
            },
        };
        let compensated;
        let mut controller = controller;
        if card.told_balance {
            compensated = Compensated {
                inner: controller,
                balance,
            };
            controller = &compensated;
        }
        let through;
        if let Some(servo) = known.servo {
            through = Through {
                inner: controller,
                servo,
                drives: known.drives(),
                limit_nm: known.limit_nm,
            };
            controller = &through;
        }
        Ok(closed.run(controller, &start, self.seconds, rng))
    }

    fn held(&self, outcome: &Outcome) -> bool {
        outcome
            .settle_s
            .is_some_and(|settled| settled <= self.seconds - NEAR_S)
    }

    fn sum(&self, outcomes: &[Outcome]) -> Tried {
        let held: Vec<&Outcome> = outcomes
            .iter()
            .filter(|outcome| self.held(outcome))
            .collect();
        let share = |count: usize| count as f64 / outcomes.len().max(1) as f64;
        let root = |of: fn(&Outcome) -> f64| {
            let squares: f64 = held.iter().map(|outcome| of(outcome).powi(2)).sum();
            (!held.is_empty()).then(|| (squares / held.len() as f64).sqrt())
        };
        let mut swings: Vec<f64> = held
            .iter()
            .filter_map(|outcome| outcome.limit_cycle_rad)
            .collect();
        swings.sort_by(f64::total_cmp);
        Tried {
            robots: outcomes.len(),
            held: share(held.len()),
            fell: share(
                outcomes
                    .iter()
                    .filter(|outcome| !outcome.survived())
                    .count(),
            ),
            rms_angle_rad: root(|outcome| outcome.rms_angle_rad),
            swing_rad: swings.get(swings.len() / 2).copied(),
            rms_torque_nm: root(|outcome| outcome.rms_torque_nm),
        }
    }
}

/// Moves each link's centre of mass `aside_m` to the side.
fn lean(model: &mut Model, aside_m: &[f64]) {
    let Some(effect) = effects::named("com_angle") else {
        return;
    };
    for (joint, aside) in aside_m.iter().enumerate() {
        let angle = (aside / model.links[joint].com_m).atan();
        model.effects.push(EffectInstance {
            effect,
            joint: Some(joint),
            values: vec![angle],
        });
    }
}

/// A controller that is told where the robot balances: it sees deviations from there.
#[derive(Debug)]
struct Compensated<'a> {
    inner: &'a dyn Controller,
    balance: Vec<f64>,
}

impl Controller for Compensated<'_> {
    fn memory_len(&self) -> usize {
        self.balance.len() + self.inner.memory_len()
    }

    fn reset(&self, memory: &mut [f64]) {
        self.inner.reset(&mut memory[self.balance.len()..]);
    }

    fn control(&self, memory: &mut [f64], seen: Seen<'_>, torque_nm: &mut [f64]) {
        let (angles, inner) = memory.split_at_mut(self.balance.len());
        for ((angle, seen), balance) in angles.iter_mut().zip(seen.angle_rad).zip(&self.balance) {
            *angle = seen - balance;
        }
        let seen = Seen {
            angle_rad: angles,
            speed_rad_s: seen.speed_rad_s,
        };
        self.inner.control(inner, seen, torque_nm);
    }
}
