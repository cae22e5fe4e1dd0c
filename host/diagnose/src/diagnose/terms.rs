//! The probes of which a free form is made: bumps, sines and shifts, each scaled to what the
//! motions cover.

use crate::effects::ProbeVariable;
use crate::fitting::Candidate;
use crate::fitting::FitProblem;
use crate::model::{Drive, Link, MeasuredSignal, Model};
use std::f64::consts::PI;

/// A probe with the amplitude at which its effect is measured.
#[derive(Debug, Clone, Copy)]
pub(super) struct Term {
    pub variable: ProbeVariable,
    pub candidate: Candidate,
    pub values: [f64; 4],
}

/// The probes of every joint, scaled to the range its motions cover.
pub(super) fn terms(model: &Model, data: &FitProblem) -> Vec<Term> {
    let mut terms = Vec::new();
    for joint in 0..model.link_count() {
        let range = JointRange::of(model, data, joint);
        let mut add = |variable: ProbeVariable, amplitude: f64, centre: f64, width: f64| {
            terms.push(Term {
                variable,
                candidate: Candidate {
                    effect: variable.probe(),
                    joint: Some(joint),
                },
                values: [amplitude, variable.index(), centre, width],
            });
        };
        let torque = 0.01 * range.torque_nm;
        for share in [-1.0, -0.6, -0.3, -0.12, 0.0, 0.12, 0.3, 0.6, 1.0] {
            add(
                ProbeVariable::Speed,
                torque,
                share * range.speed_rad_s,
                0.35 * range.speed_rad_s,
            );
        }
        let span = (range.high_rad - range.low_rad) / 6.0;
        for step in 0..7 {
            let centre = range.low_rad + f64::from(step) * span;
            add(ProbeVariable::Angle, torque, centre, span);
            add(ProbeVariable::FrictionInAngle, torque, centre, span);
            add(ProbeVariable::Reading, 1e-3, centre, span);
        }
        for periods in [
            4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0, 22.0, 24.0,
        ] {
            add(ProbeVariable::SineOfAngle, 0.3 * torque, periods, 1.0);
            add(ProbeVariable::CosineOfAngle, 0.3 * torque, periods, 1.0);
        }
        let link = &model.links[joint];
        let moment = match model.joints[joint].slide {
            Some(_) => model.links[joint..].iter().map(|link| link.mass_kg).sum(),
            None => link.inertia_kg_m2 + link.mass_kg * link.com_m.powi(2),
        };
        add(ProbeVariable::Inertia, 0.02 * moment, 0.0, 1.0);
        add(
            ProbeVariable::Mass,
            0.02 * model.links[joint].mass_kg,
            0.0,
            1.0,
        );
        add(ProbeVariable::Tilt, 3e-3, 0.0, 1.0);
        add(ProbeVariable::ReadingLag, 1e-3, 0.0, 1.0);
        add(ProbeVariable::ReadingBacklash, 1e-3, 0.0, 1.0);
        if model.joints[joint].drive != Drive::Passive {
            for share in [-1.0, -0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 1.0] {
                add(
                    ProbeVariable::DriveTorque,
                    torque,
                    share * range.drive_nm,
                    0.3 * range.drive_nm,
                );
            }
            add(ProbeVariable::FrictionUnderLoad, 0.02, 0.0, 1.0);
            add(ProbeVariable::Supply, 0.02, 0.0, 1.0);
            add(ProbeVariable::BackEmf, 0.01 / range.speed_rad_s, 0.0, 1.0);
            add(ProbeVariable::Delay, 1e-3, 0.0, 1.0);
        }
    }
    terms
}

/// What a joint's motions cover.
pub(crate) struct JointRange {
    pub low_rad: f64,
    pub high_rad: f64,
    pub speed_rad_s: f64,
    pub drive_nm: f64,
    pub torque_nm: f64,
}

impl JointRange {
    pub fn of(model: &Model, data: &FitProblem, joint: usize) -> JointRange {
        let measured = || {
            let positions = data.motions.iter().flat_map(|m| &m.position_rad[joint]);
            positions.copied().filter(|angle| angle.is_finite())
        };
        let rates = || {
            let rate_alone = data.signals[joint] == MeasuredSignal::Rate;
            let motions = data.motions.iter().filter(move |_| rate_alone);
            motions
                .filter_map(|m| m.velocity_rad_s[joint].as_ref())
                .flatten()
        };
        let mut speeds: Vec<f64> = data
            .motions
            .iter()
            .flat_map(|m| {
                let (time, position) = (&m.time_s, &m.position_rad[joint]);
                (3..position.len().saturating_sub(3)).map(move |k| {
                    ((position[k + 3] - position[k - 3]) / (time[k + 3] - time[k - 3])).abs()
                })
            })
            .chain(rates().map(|rate| rate.abs()))
            .filter(|w| w.is_finite())
            .collect();
        speeds.sort_by(f64::total_cmp);
        let fast = speeds.get(speeds.len() * 97 / 100).copied().unwrap_or(1.0);
        let full = match &model.joints[joint].drive {
            Drive::Passive => 0.0,
            Drive::Torque => 1.0,
            drive => drive.motor().map_or(0.0, |m| m.stall_torque_nm),
        };
        let largest = data
            .motions
            .iter()
            .filter_map(|m| m.input[joint].as_ref())
            .flatten()
            .fold(0.0, |most: f64, u| most.max(u.abs()));
        let drive = match &model.joints[joint].drive {
            Drive::Torque | Drive::Duty(_) => full * largest,
            _ => full,
        };
        let slides = model.joints[joint].slide.is_some();
        let lever_m = |l: &Link| {
            if slides {
                1.0
            } else {
                l.com_m.abs() + 0.3 * l.length_m
            }
        };
        let outer = model.links[joint..].iter();
        let outer: f64 = outer.map(|l| l.mass_kg * lever_m(l)).sum();
        // An angle that is not measured may be anywhere.
        let (low_rad, high_rad) = match measured().next() {
            Some(_) => (
                measured().fold(f64::INFINITY, f64::min),
                measured().fold(f64::NEG_INFINITY, f64::max),
            ),
            None => (-PI, PI),
        };
        JointRange {
            low_rad,
            high_rad,
            speed_rad_s: fast.max(1e-3),
            drive_nm: drive.max(1e-6),
            torque_nm: (outer * model.gravity_m_s2).max(1e-6),
        }
    }
}
