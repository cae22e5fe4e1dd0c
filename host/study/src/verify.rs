//! Verification of a design: the loop simulated with every effect of the model, those that the
//! design leaves out included.

use super::ellipsoid::{ELLIPSOID_JUDGEMENTS, Ellipsoid};
use super::judge::{Figures, STABILISED_SHARE};
use super::lasting::Lasting;
use super::region::{REGION_JUDGEMENTS, Region};
use super::verified_loop::{DOUBLINGS, VerifiedLaw, VerifiedLoop};
use crate::effects::Effect;
use crate::error::Result;
use crate::model::{EffectInstance, Model};
use crate::sim::closed_loop::Velocity;
use crate::synth::{Design, Request};
use serde::Serialize;

/// A region counts as larger from this ratio on: 40 runs and a bisection to 0.25 deg tell no less.
const LARGER: f64 = 1.2;

/// A limit cycle counts as smaller below this share, ..
const CALMER: f64 = 0.5;

/// .. if it is larger than this at all, rad: 0.2 deg.
const LEAST_SWING_RAD: f64 = 0.2 * std::f64::consts::PI / 180.0;

/// A torque counts as smaller below this share.
const EASIER: f64 = 0.8;

/// What the simulated loop does.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verification {
    /// The verdict: 95 % of the starts near the pose ([`Verification::near_rad`]) are stabilised,
    /// and stay so for longer ([`Verification::lasting`]), by the law and not by friction
    /// ([`Verification::held`]).
    pub stabilised: bool,
    /// Which law ran.
    pub law: VerifiedLaw,
    /// Step of the measured angles, rad; 0 where they are exact.
    pub position_step_rad: f64,
    /// Whether its speeds were differences of the measured angles; else they are exact, or a
    /// filter's.
    pub differences: bool,
    /// Largest departure of a joint in those starts, rad: half a degree, or more where friction
    /// alone holds a robot there that would fall by itself.
    pub near_rad: f64,
    /// Figures of those starts.
    pub near: Figures,
    /// Longer runs from the same starts: in which manner the robot stands.
    pub lasting: Lasting,
    /// Whether 95 % of the same starts stay so with all gains at zero: then friction or the drives'
    /// own loops hold the robot, and its staying says nothing of the gains.
    pub stays_uncontrolled: bool,
    /// Whether that is friction's doing, for the linear plant would fall. Such a robot does not
    /// count as stabilised.
    pub held: bool,
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
    /// Whether 95 % of the starts near the pose are stabilised without it.
    pub stabilised: bool,
    /// Median limit cycle of those, peak to peak, rad.
    pub limit_cycle_rad: Option<f64>,
    /// Median torque of those, root mean square, N m.
    pub rms_torque_nm: Option<f64>,
    /// Region without it, rad.
    pub region_rad: f64,
    /// Whether it may be larger still.
    pub region_open: bool,
}

/// A figure of a loop that an effect may limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LimitedFigure {
    /// The cube of starts.
    Region,
    /// The limit cycle.
    Swing,
    /// The torque.
    Torque,
}

impl Verification {
    /// The effect that limits a figure with these gains: the one that lifts it most when it, and it
    /// alone, is taken out. None where none does: then there are several, or none at all.
    pub fn limiting(&self, figure: LimitedFigure) -> Option<&Without> {
        let lifts = self.without.iter().filter_map(|without| {
            let ratio = self.lift(figure, without)?;
            Some((ratio, without))
        });
        let most = lifts.max_by(|(one, _), (other, _)| one.total_cmp(other));
        most.map(|(_, without)| without)
    }

    /// By which factor a figure is better without an effect; none if that is not significant.
    fn lift(&self, figure: LimitedFigure, without: &Without) -> Option<f64> {
        let both = self.near.stabilised_share >= STABILISED_SHARE && without.stabilised;
        let smaller = |with: Option<f64>, less: Option<f64>, share: f64, least: f64| {
            let (with, less) = (with?, less?);
            (both && with >= least && less < share * with)
                .then(|| with / less.max(f64::MIN_POSITIVE))
        };
        match figure {
            LimitedFigure::Region => {
                let lifted = without.region_rad >= LARGER * self.region_rad
                    && without.region_rad > self.region_rad;
                lifted.then(|| without.region_rad / self.region_rad.max(f64::MIN_POSITIVE))
            }
            LimitedFigure::Swing => {
                let near = self.near.limit_cycle_rad;
                smaller(near, without.limit_cycle_rad, CALMER, LEAST_SWING_RAD)
            }
            LimitedFigure::Torque => {
                let near = self.near.rms_torque_nm;
                smaller(near, without.rms_torque_nm, EASIER, 0.0)
            }
        }
    }
}

/// An effect of the model that a design does not have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UndesignedEffect {
    /// Which one.
    pub effect: Effect,
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
    4 + DOUBLINGS as usize + left_out.len() + regions * REGION_JUDGEMENTS + ELLIPSOID_JUDGEMENTS
}

/// Simulates the loop of a design from random starts around its pose, the same every time: the law
/// that is exported, bit for bit, on what the sensors tell it; with `--lqg` gains and filter. The
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
    let tested = VerifiedLoop::new(model, design, request, done);
    let closed = tested.closed_loop(&[])?;
    let near_rad = tested.near_rad(&closed);
    let near = tested.figures(&closed, tested.law(), near_rad);
    let uncontrolled = tested.figures(&closed, &tested.no_law(), near_rad);
    let lasting = tested.lasting(&closed, near_rad);
    let region = tested.region(&[])?;
    let ellipsoid = tested.ellipsoid(&closed)?;
    let without: Vec<Without> = left_out
        .iter()
        .map(|one| loop_without(&tested, one, near_rad))
        .collect::<Result<_>>()?;
    let as_designed = match without.as_slice() {
        [] => region,
        [one] => Region {
            spread_rad: one.region_rad,
            open: one.region_open,
        },
        _ => tested.region(left_out)?,
    };
    let stays_uncontrolled = uncontrolled.stabilised_share >= STABILISED_SHARE;
    let held = stays_uncontrolled && tested.falls();
    let stays = near.stabilised_share >= STABILISED_SHARE && lasting.is_stable();
    Ok(Verification {
        stabilised: stays && !held,
        law: VerifiedLaw::of(design),
        position_step_rad: closed.sensor.position_resolution_rad,
        differences: closed.sensor.velocity == Velocity::Difference,
        near_rad,
        near,
        lasting,
        stays_uncontrolled,
        held,
        uncontrolled,
        region_rad: region.spread_rad,
        region_open: region.open,
        ellipsoid,
        region_as_designed_rad: as_designed.spread_rad,
        region_as_designed_open: as_designed.open,
        without,
    })
}

/// The loop without one effect.
fn loop_without(
    tested: &VerifiedLoop<'_>,
    one: &UndesignedEffect,
    near_rad: f64,
) -> Result<Without> {
    let closed = tested.closed_loop(&[*one])?;
    let near = tested.figures(&closed, tested.law(), near_rad);
    let region = tested.region(&[*one])?;
    Ok(Without {
        effect: one.effect.info().id,
        joint: one.joint.map(|joint| joint + 1),
        stabilised: near.stabilised_share >= STABILISED_SHARE,
        limit_cycle_rad: near.limit_cycle_rad,
        rms_torque_nm: near.rms_torque_nm,
        region_rad: region.spread_rad,
        region_open: region.open,
    })
}

/// Figures of the starts near the pose.
///
/// # Errors
/// As [`verify`].
pub(super) fn figures_near(model: &Model, design: &Design, request: &Request) -> Result<Figures> {
    let tested = VerifiedLoop::new(model, design, request, &|| ());
    let closed = tested.closed_loop(&[])?;
    let near_rad = tested.near_rad(&closed);
    Ok(tested.figures(&closed, tested.law(), near_rad))
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
    let tested = VerifiedLoop::new(model, design, request, &|| ());
    let closed = tested.closed_loop(&[])?;
    let near_rad = tested.near_rad(&closed);
    let near = tested.figures(&closed, tested.law(), near_rad);
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
