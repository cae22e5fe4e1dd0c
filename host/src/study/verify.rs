//! Verification of a design: the loop simulated with every effect of the model, those that the
//! design leaves out included.

use super::ellipsoid::{ELLIPSOID_JUDGEMENTS, Ellipsoid, ellipsoid};
use super::judge::{Figures, STABILISED_SHARE};
use super::region::{REGION_JUDGEMENTS, Region, largest};
use crate::effects::Effect;
use crate::error::Result;
use crate::model::{EffectInstance, Model};
use crate::sim::closed_loop::{
    ClosedLoop, Commands, InitialState, StateFeedback, set_delay, stream,
};
use crate::synth::{Design, Request, Time, continuous_period_s, rows};
use serde::Serialize;

/// Runs from random starts behind each figure.
const RUNS: u64 = 40;

/// Length of a run, s.
const SECONDS: f64 = 5.0;

/// Starts of the run whose figures are given, rad: within half a degree.
const NEAR_RAD: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// What the simulated loop does.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verification {
    /// Whether 95 % of the starts within half a degree of the pose are stabilised.
    pub stabilised: bool,
    /// Figures of those starts.
    pub near: Figures,
    /// Whether 95 % of the same starts stay so with all gains at zero: then friction or the drives'
    /// own loops hold the robot, and `stabilised` says nothing of the gains.
    pub stays_uncontrolled: bool,
    /// Figures of those starts with all gains at zero.
    pub uncontrolled: Figures,
    /// Half-width of the largest cube of starting angles of which 95 % are stabilised, rad; 0 if
    /// there is none.
    pub region_rad: f64,
    /// Whether it may be larger still: the search ends there.
    pub region_open: bool,
    /// The ellipsoid of starts, in the shape that the Riccati equation gives it; none if there is
    /// none.
    pub ellipsoid: Option<Ellipsoid>,
    /// The cube without the effects that the design leaves out.
    pub region_as_designed_rad: f64,
    /// Whether that may be larger still.
    pub region_as_designed_open: bool,
    /// The same without one of them, each in turn.
    pub without: Vec<Without>,
}

/// The loop without one of the effects that the design leaves out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Without {
    /// Its id.
    pub effect: &'static str,
    /// Its joint, counted from 1; none for the whole rig.
    pub joint: Option<usize>,
    /// Region without it, rad.
    pub region_rad: f64,
    /// Whether it may be larger still.
    pub region_open: bool,
}

impl Verification {
    /// The effect that limits the loop: the one without which the region grows most, if it grows.
    pub fn limiting(&self) -> Option<&Without> {
        let grows = |without: &&Without| without.region_rad > self.region_rad;
        let without = self.without.iter().filter(grows);
        without.max_by(|a, b| a.region_rad.total_cmp(&b.region_rad))
    }
}

/// An effect of the model that a design does not have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UndesignedEffect {
    /// Which one.
    pub effect: &'static dyn Effect,
    /// Its joint, counted from 0; none for the whole rig.
    pub joint: Option<usize>,
}

/// Effects of `model` that the design of `designed_for`, the model or a part of it, leaves out.
pub fn left_out(model: &Model, designed_for: &Model, design: &Design) -> Vec<UndesignedEffect> {
    let omitted = |e: &EffectInstance| {
        let is = |o: &crate::synth::OmittedEffect| {
            let acts_on = |joint: usize| e.acts_on(joint, &model.joints[joint]);
            o.effect == e.effect && o.joint.map_or(e.joint.is_none(), acts_on)
        };
        design.omitted.iter().any(is)
    };
    let instances = model.effects.iter();
    let mut left_out: Vec<UndesignedEffect> = instances
        .filter(|e| omitted(e) || !designed_for.effects.contains(e))
        .map(|e| UndesignedEffect {
            effect: e.effect,
            joint: e.joint,
        })
        .collect();
    left_out.dedup();
    left_out
}

/// Shares that [`verify`] simulates at most.
pub fn verification_steps(left_out: &[UndesignedEffect]) -> usize {
    let regions = match left_out.len() {
        count @ 0..2 => 1 + count,
        count => 2 + count,
    };
    2 + regions * REGION_JUDGEMENTS + ELLIPSOID_JUDGEMENTS
}

/// Simulates the loop of a design from random starts around its pose, the same every time. The
/// plant is `model` with all its effects. `done` is called after each of up to
/// [`verification_steps`].
///
/// # Errors
/// Models that cannot be simulated.
pub fn verify(
    model: &Model,
    design: &Design,
    request: &Request,
    left_out: &[UndesignedEffect],
    done: &dyn Fn(),
) -> Result<Verification> {
    let tested = Tested {
        model,
        design,
        request,
        done,
    };
    let closed = tested.closed_loop(&[])?;
    let gains = rows(&design.gains.k);
    let near = tested.figures(&closed, &gains, NEAR_RAD);
    let none: Vec<Vec<f64>> = gains.iter().map(|row| vec![0.0; row.len()]).collect();
    let uncontrolled = tested.figures(&closed, &none, NEAR_RAD);
    let region = tested.region(&[])?;
    let ellipsoid = tested.ellipsoid(&closed, &gains)?;
    let mut without = Vec::new();
    for one in left_out {
        let region = tested.region(&[*one])?;
        without.push(Without {
            effect: one.effect.info().id,
            joint: one.joint.map(|joint| joint + 1),
            region_rad: region.spread_rad,
            region_open: region.open,
        });
    }
    let as_designed = match without.as_slice() {
        [] => region,
        [one] => Region {
            spread_rad: one.region_rad,
            open: one.region_open,
        },
        _ => tested.region(left_out)?,
    };
    Ok(Verification {
        stabilised: near.stabilised_share >= STABILISED_SHARE,
        near,
        stays_uncontrolled: uncontrolled.stabilised_share >= STABILISED_SHARE,
        uncontrolled,
        region_rad: region.spread_rad,
        region_open: region.open,
        ellipsoid,
        region_as_designed_rad: as_designed.spread_rad,
        region_as_designed_open: as_designed.open,
        without,
    })
}

/// Figures of the starts near the pose, and the region, empty if those are not stabilised.
///
/// # Errors
/// As [`verify`].
pub(super) fn stabilised_from(
    model: &Model,
    design: &Design,
    request: &Request,
) -> Result<(Figures, Region)> {
    let tested = Tested {
        model,
        design,
        request,
        done: &|| (),
    };
    let closed = tested.closed_loop(&[])?;
    let near = tested.figures(&closed, &rows(&design.gains.k), NEAR_RAD);
    let region = if near.stabilised_share >= STABILISED_SHARE {
        tested.region(&[])?
    } else {
        Region {
            spread_rad: 0.0,
            open: false,
        }
    };
    Ok((near, region))
}

struct Tested<'a> {
    model: &'a Model,
    design: &'a Design,
    request: &'a Request,
    done: &'a dyn Fn(),
}

impl Tested<'_> {
    /// The loop of the model without these effects; gears among them are rigid, not gone, as the
    /// design has them.
    fn closed_loop(&self, without: &[UndesignedEffect]) -> Result<ClosedLoop> {
        let mut model = self.model.clone();
        let is = |e: &EffectInstance, one: &UndesignedEffect| {
            one.effect == e.effect && one.joint == e.joint
        };
        let stays = |e: &EffectInstance| !without.iter().any(|one| is(e, one));
        let (kept, gone): (Vec<_>, Vec<_>) = model.effects.into_iter().partition(stays);
        model.effects = kept;
        model.effects.extend(gone.iter().filter_map(|e| e.rigid()));
        closed_loop(model, self.design, self.request)
    }

    /// With these gains, from random starts within a spread.
    fn figures(&self, closed: &ClosedLoop, gains: &[Vec<f64>], spread_rad: f64) -> Figures {
        let (joints, u0) = (self.model.link_count(), &self.design.u0);
        let controller = StateFeedback::new(joints, gains.to_vec()).feeding(u0);
        let start = |run| InitialState {
            command: u0.clone(),
            ..InitialState::random(joints, spread_rad, &mut stream(1, run))
        };
        let starts: Vec<InitialState> = (0..RUNS).map(start).collect();
        let figures = Figures::of(&closed.run_all(&controller, &starts, SECONDS, 1));
        (self.done)();
        figures
    }

    fn ellipsoid(&self, closed: &ClosedLoop, gains: &[Vec<f64>]) -> Result<Option<Ellipsoid>> {
        let u0 = &self.design.u0;
        let controller = StateFeedback::new(self.model.link_count(), gains.to_vec()).feeding(u0);
        ellipsoid(self.model, self.design, |starts| {
            let starts = starts.iter().cloned().map(|start| InitialState {
                command: u0.clone(),
                ..start
            });
            let starts: Vec<InitialState> = starts.collect();
            let outcomes = closed.run_all(&controller, &starts, SECONDS, 1);
            (self.done)();
            Ok(outcomes)
        })
    }

    fn region(&self, without: &[UndesignedEffect]) -> Result<Region> {
        let closed = self.closed_loop(without)?;
        let gains = rows(&self.design.gains.k);
        largest(|spread_rad| {
            let figures = self.figures(&closed, &gains, spread_rad);
            Ok(figures.stabilised_share >= STABILISED_SHARE)
        })
    }
}

/// The loop of `model` at the request's pose and period, with its delay.
pub(super) fn closed_loop(
    mut model: Model,
    design: &Design,
    request: &Request,
) -> Result<ClosedLoop> {
    let period_s = match request.time {
        Time::Continuous => continuous_period_s(&design.gains.poles),
        Time::Sampled { ts_s, delay_s } => {
            if let Some(delay_s) = delay_s {
                set_delay(&mut model, delay_s);
            }
            ts_s
        }
    };
    ClosedLoop::new(&model, &request.pose_rad, Commands::Own, period_s)
}
