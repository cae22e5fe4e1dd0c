//! Verification of a design: the loop simulated with every effect of the model, those that the
//! design leaves out included.

use super::judge::{Figures, STABILISED_SHARE};
use super::region::largest;
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
    /// Half-width of the largest cube of starting angles of which 95 % are stabilised, rad; 0 if
    /// there is none.
    pub region_rad: f64,
    /// The same without the effects that the design leaves out.
    pub region_as_designed_rad: f64,
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
pub struct LeftOut {
    /// Which one.
    pub effect: &'static dyn Effect,
    /// Its joint, counted from 0; none for the whole rig.
    pub joint: Option<usize>,
}

/// Effects of `model` that the design of `designed_for`, the model or a part of it, leaves out.
pub fn left_out(model: &Model, designed_for: &Model, design: &Design) -> Vec<LeftOut> {
    let omitted = |e: &EffectInstance| {
        let is = |o: &crate::synth::OmittedEffect| o.effect == e.effect && Some(o.joint) == e.joint;
        design.omitted.iter().any(is)
    };
    let instances = model.effects.iter();
    let mut left_out: Vec<LeftOut> = instances
        .filter(|e| omitted(e) || !designed_for.effects.contains(e))
        .map(|e| LeftOut {
            effect: e.effect,
            joint: e.joint,
        })
        .collect();
    left_out.dedup();
    left_out
}

/// Simulates the loop of a design from random starts around its pose, the same every time. The
/// plant is `model` with all its effects.
///
/// # Errors
/// Models that cannot be simulated.
pub fn verify(
    model: &Model,
    design: &Design,
    request: &Request,
    left_out: &[LeftOut],
) -> Result<Verification> {
    let tested = Tested {
        model,
        design,
        request,
    };
    let (near, region_rad) = tested.whole()?;
    let mut without = Vec::new();
    for one in left_out {
        without.push(Without {
            effect: one.effect.info().id,
            joint: one.joint.map(|joint| joint + 1),
            region_rad: tested.region_rad(&[*one])?,
        });
    }
    Ok(Verification {
        stabilised: near.stabilised_share >= STABILISED_SHARE,
        near,
        region_rad,
        region_as_designed_rad: match without.as_slice() {
            [] => region_rad,
            [one] => one.region_rad,
            _ => tested.region_rad(left_out)?,
        },
        without,
    })
}

struct Tested<'a> {
    model: &'a Model,
    design: &'a Design,
    request: &'a Request,
}

impl Tested<'_> {
    fn whole(&self) -> Result<(Figures, f64)> {
        let closed = self.closed_loop(&[])?;
        let controller = self.controller();
        let outcomes = closed.run_all(&controller, &self.starts(NEAR_RAD), SECONDS, 1);
        Ok((Figures::of(&outcomes), self.region_rad(&[])?))
    }

    /// The loop of the model without these effects.
    fn closed_loop(&self, without: &[LeftOut]) -> Result<ClosedLoop> {
        let mut model = self.model.clone();
        let is = |e: &EffectInstance, one: &LeftOut| one.effect == e.effect && one.joint == e.joint;
        model
            .effects
            .retain(|e| !without.iter().any(|one| is(e, one)));
        let period_s = match self.request.time {
            Time::Continuous => continuous_period_s(&self.design.gains.poles),
            Time::Sampled { ts_s, delay_s } => {
                if let Some(delay_s) = delay_s {
                    set_delay(&mut model, delay_s);
                }
                ts_s
            }
        };
        ClosedLoop::new(&model, &self.request.pose_rad, Commands::Own, period_s)
    }

    fn controller(&self) -> StateFeedback {
        let joints = self.model.link_count();
        StateFeedback::new(joints, rows(&self.design.gains.k)).feeding(&self.design.u0)
    }

    fn starts(&self, spread_rad: f64) -> Vec<InitialState> {
        let joints = self.model.link_count();
        let start = |run| InitialState {
            command: self.design.u0.clone(),
            ..InitialState::random(joints, spread_rad, &mut stream(1, run))
        };
        (0..RUNS).map(start).collect()
    }

    fn region_rad(&self, without: &[LeftOut]) -> Result<f64> {
        let closed = self.closed_loop(without)?;
        let controller = self.controller();
        let region = largest(|spread_rad| {
            let outcomes = closed.run_all(&controller, &self.starts(spread_rad), SECONDS, 1);
            Ok(Figures::of(&outcomes).stabilised_share >= STABILISED_SHARE)
        })?;
        Ok(region.spread_rad)
    }
}
