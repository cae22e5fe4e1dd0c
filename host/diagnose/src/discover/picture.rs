//! A term beside what the motions say: the law as a curve, and points that owe nothing to it.
//!
//! Where a term depends on one variable, a polygon of free torques over that variable is fitted to
//! what the whole law leaves, by ridge regression on the linearised simulation, other values held.
//! The law plus that polygon are the points: they lie on the curve where its shape is right.

use super::findings::DiscoveredTerm;
use crate::diagnose::{JointRange, independent_share};
use crate::effects::{Effect, FrictionState, JointState, ProbeVariable, Signals};
use crate::fitting::{
    Candidate, Fit, FitOptions, FitProblem, Horizon, Projector, change, fit, fit_start_states,
};
use crate::model::{EffectInstance, Model};
use crate::motion::Motion;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Corners of the polygon.
const CORNERS: usize = 13;
/// Points of the curve.
const POINTS: usize = 121;
/// A corner that is not known to this share of the law's size is not shown.
const KNOWN: f64 = 0.5;
/// Half the 95 % interval of a normal distribution, in standard deviations.
const TWO_SIGMA: f64 = 1.96;

/// What a term depends on, where that is one thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TermVariable {
    /// Angle of the joint, rad.
    Angle,
    /// Speed of the joint, rad/s.
    Speed,
    /// Torque of the drive, N m.
    Drive,
}

/// A term beside what the motions say.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TermPicture {
    /// The term's name.
    pub kind: String,
    /// Joint counted from 1.
    pub joint: usize,
    /// What it depends on.
    pub variable: TermVariable,
    /// Whether the joint slides: then rad is m, and N m is N.
    #[serde(default)]
    pub slides: bool,
    /// Whether y is a friction against the motion; else a torque on the joint. Friction that
    /// depends on the speed is drawn as the torque that it makes.
    pub is_friction: bool,
    /// The law: variable and N m.
    pub curve: Vec<[f64; 2]>,
    /// What the motions say: variable, N m, lower and upper end of its 95 % interval.
    pub points: Vec<[f64; 4]>,
}

/// Pictures of the terms of which there can be one. `model` holds the law, `horizon` is that of the
/// windows in which it was searched.
pub(super) fn pictures(
    terms: &[DiscoveredTerm],
    model: &Model,
    training: &[Motion],
    horizon: Horizon,
) -> Vec<TermPicture> {
    if terms.is_empty() || training.is_empty() {
        return Vec::new();
    }
    let data = FitProblem::new(model, training.to_vec(), horizon);
    let settled = fit_start_states(model, &data);
    let (starts, options) = (Some(&settled.window_starts[..]), FitOptions::iterations(0));
    let left = fit(model, &[], &data, starts, options);
    let pictures = terms.iter().filter_map(|term| picture(term, &left, &data));
    pictures.collect()
}

fn picture(term: &DiscoveredTerm, left: &Fit, data: &FitProblem) -> Option<TermPicture> {
    let joint = term.joint?.checked_sub(1)?;
    let variable = variable(&term.expression)?;
    let mut effects = left.model.effects.iter();
    let instance = effects.find(|e| e.effect.info().id == term.kind && e.joint == Some(joint))?;
    let law = TermLaw::new(instance, variable, term.site == "friction")?;
    let range = JointRange::of(&left.model, data, joint);
    let (low, high) = match variable {
        TermVariable::Angle => (range.low_rad, range.high_rad),
        TermVariable::Speed => (-range.speed_rad_s, range.speed_rad_s),
        TermVariable::Drive => (-range.drive_nm, range.drive_nm),
    };
    let place = |k: usize, count: usize| low + (high - low) * k as f64 / (count - 1) as f64;
    let curve: Vec<[f64; 2]> = (0..POINTS)
        .map(|k| place(k, POINTS))
        .map(|x| [x, law.at(x)])
        .collect();
    let size = curve
        .iter()
        .fold(0.0, |most: f64, [_, y]| most.max(y.abs()));
    if size == 0.0 || low >= high {
        return None;
    }
    let corners: Vec<f64> = (0..CORNERS).map(|k| place(k, CORNERS)).collect();
    let width = (high - low) / (CORNERS - 1) as f64;
    let columns = law.columns((&corners, width, 0.01 * size), joint, left, data);
    let free = polygon(&columns, size, left, data)?;
    let points = corners.iter().zip(free).filter_map(|(&x, [by, sigma])| {
        let (y, half) = (law.at(x) + by, TWO_SIGMA * sigma);
        (half < KNOWN * size).then_some([x, y, y - half, y + half])
    });
    Some(TermPicture {
        kind: term.kind.clone(),
        joint: joint + 1,
        variable,
        slides: left.model.joints[joint].slide.is_some(),
        is_friction: law.is_friction,
        points: points.collect(),
        curve,
    })
}

/// The one variable that an expression depends on, its direction told by the speed.
fn variable(expression: &str) -> Option<TermVariable> {
    let is_letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let names: Vec<&str> = expression.split(|c| !is_letter(c)).collect();
    let has = |name: &str| names.contains(&name);
    let speed = has("w") || has("dir");
    match (has("q"), speed, has("tau")) {
        _ if ["input", "supply", "time"].into_iter().any(has) => None,
        (true, false, false) => Some(TermVariable::Angle),
        (false, true, false) => Some(TermVariable::Speed),
        (false, false, true) => Some(TermVariable::Drive),
        _ => None,
    }
}

/// A term over its variable.
struct TermLaw<'a> {
    instance: &'a EffectInstance,
    variable: TermVariable,
    is_friction: bool,
    probe: ProbeVariable,
}

impl<'a> TermLaw<'a> {
    /// None where no free form stands beside it.
    fn new(
        instance: &'a EffectInstance,
        variable: TermVariable,
        friction: bool,
    ) -> Option<TermLaw<'a>> {
        let probe = match (variable, friction) {
            (TermVariable::Angle, true) => ProbeVariable::FrictionInAngle,
            (TermVariable::Angle, false) => ProbeVariable::Angle,
            (TermVariable::Speed, _) => ProbeVariable::Speed,
            (TermVariable::Drive, false) => ProbeVariable::DriveTorque,
            (TermVariable::Drive, true) => return None,
        };
        Some(TermLaw {
            instance,
            variable,
            is_friction: friction && variable == TermVariable::Angle,
            probe,
        })
    }

    /// The law there, N m.
    fn at(&self, x: f64) -> f64 {
        let (effect, values): (Effect, &[f64]) = (self.instance.effect, &self.instance.values);
        let mut state = JointState::undriven(0.0, 0.0);
        match self.variable {
            TermVariable::Angle => state.angle_rad = x,
            TermVariable::Speed => state.speed_rad_s = x,
            TermVariable::Drive => state.drive_nm = x,
        }
        let direction = if x < 0.0 { -1.0 } else { 1.0 };
        let slide = FrictionState {
            angle_rad: state.angle_rad,
            speed_rad_s: state.speed_rad_s.abs(),
            direction: match self.variable {
                TermVariable::Speed => direction,
                _ => 1.0,
            },
            gear_load_nm: 0.0,
            motor_nm: state.drive_nm,
            outside_nm: 0.0,
            bearing_load_n: 0.0,
            signals: Signals::NONE,
        };
        let friction = effect.friction(values, &slide);
        if self.is_friction {
            friction
        } else {
            effect.torque(values, &state) - direction * friction
        }
    }

    /// What each corner of the polygon changes in the prediction per N m.
    fn columns(
        &self,
        (corners, width, amplitude): (&[f64], f64, f64),
        joint: usize,
        left: &Fit,
        data: &FitProblem,
    ) -> Vec<DVector<f64>> {
        let candidate = Candidate {
            effect: self.probe.probe(),
            joint: Some(joint),
        };
        let projector = Projector::off_start_states(left);
        let before = &left.residuals.windows;
        let column = |corner: &f64| {
            let values = [amplitude, self.probe.index(), *corner, width];
            let starts = &left.window_starts;
            let moved = change(&left.model, candidate, &values, data, starts, before);
            flat(&projector.off(&moved)) / amplitude
        };
        corners.par_iter().map(column).collect()
    }
}

/// Height and standard deviation of each corner, N m: ridge regression with a law's `size` as what
/// is known of it beforehand.
fn polygon(
    columns: &[DVector<f64>],
    size: f64,
    left: &Fit,
    data: &FitProblem,
) -> Option<Vec<[f64; 2]>> {
    let residual = flat(&Projector::off_start_states(left).off(&left.residuals.windows));
    // Neighbouring residuals are alike: fewer of them are independent.
    let noise = left.residuals.mean_square().max(1.0) / independent_share(left, data);
    let count = columns.len();
    let mut normal = DMatrix::from_fn(count, count, |r, c| columns[r].dot(&columns[c]) / noise);
    for k in 0..count {
        normal[(k, k)] += size.powi(-2);
    }
    let right = DVector::from_fn(count, |r, _| columns[r].dot(&residual) / noise);
    let covariance = normal.cholesky()?.inverse();
    let heights = &covariance * right;
    let corners = (0..count).map(|k| [heights[k], covariance[(k, k)].sqrt()]);
    Some(corners.collect())
}

fn flat(windows: &[Vec<f64>]) -> DVector<f64> {
    let length = windows.iter().map(Vec::len).sum();
    DVector::from_iterator(length, windows.iter().flatten().copied())
}
