//! The loop that a verification simulates: the model with its effects and sensors, and the law that
//! is exported.

use super::ellipsoid::{Ellipsoid, ellipsoid};
use super::judge::{Figures, STABILISED_SHARE};
use super::lasting::Lasting;
use super::region::{Region, largest};
use super::verify::UndesignedEffect;
use crate::error::Result;
use crate::model::{EffectInstance, Model};
use crate::sim::closed_loop::{
    ClosedLoop, Commands, Controller, Gyro, InitialState, Outcome, Sensor, StateFeedback,
    set_delay, stream,
};
use crate::synth::controllers::{CompensatorLaw, FixedPointFeedback};
use crate::synth::{Design, Request, Time, continuous_period_s, rows};
use serde::Serialize;

/// Runs from random starts behind each figure.
const RUNS: u64 = 40;

/// Those of them that are run for longer.
const LASTING_RUNS: u64 = 20;

/// Length of a run, s.
const SECONDS: f64 = 5.0;

/// Starts of the runs whose figures are given, rad: within half a degree, ..
pub const NEAR_RAD: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// .. or this many times doubled, to 8 deg.
pub(super) const DOUBLINGS: u32 = 4;

/// A pole of the plant beyond this grows, 1/s: slides along a level rail have theirs at 0.
const FALLS_1_S: f64 = 1e-6;

/// Which law of a design is simulated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum VerifiedLaw {
    /// The table that is exported, bit for bit.
    FixedPoint,
    /// Gains and Kalman filter, in floating point; the table that is exported is that of the gains
    /// alone.
    GainsAndFilter,
    /// Gains in continuous time, in floating point and sampled fast.
    Continuous,
}

impl VerifiedLaw {
    pub(super) fn of(design: &Design) -> VerifiedLaw {
        match (&design.estimator, &design.fixed) {
            (Some(_), _) => VerifiedLaw::GainsAndFilter,
            (None, Some(_)) => VerifiedLaw::FixedPoint,
            (None, None) => VerifiedLaw::Continuous,
        }
    }
}

/// The law that a design states, as it runs in a loop about its pose.
pub(super) fn law(design: &Design) -> Box<dyn Controller> {
    let joints = design.plant.a.nrows() / 2;
    match (&design.estimator, &design.fixed) {
        (Some(estimation), Some(fixed)) => Box::new(CompensatorLaw {
            compensator: estimation.compensator.clone(),
            u0: design.u0.clone(),
            limit: fixed.ranges.input.clone(),
        }),
        (_, Some(fixed)) => Box::new(FixedPointFeedback::new(
            fixed.law.clone(),
            fixed.sums.clone(),
            &design.x0,
            joints,
        )),
        _ => Box::new(StateFeedback::new(joints, rows(&design.gains.k)).feeding(&design.u0)),
    }
}

/// A design with the model that it shall hold.
pub(super) struct VerifiedLoop<'a> {
    model: &'a Model,
    design: &'a Design,
    request: &'a Request,
    law: Box<dyn Controller>,
    /// Called after each judgement.
    done: &'a dyn Fn(),
}

impl<'a> VerifiedLoop<'a> {
    pub fn new(
        model: &'a Model,
        design: &'a Design,
        request: &'a Request,
        done: &'a dyn Fn(),
    ) -> VerifiedLoop<'a> {
        VerifiedLoop {
            law: law(design),
            model,
            design,
            request,
            done,
        }
    }

    /// The law that is verified.
    pub fn law(&self) -> &dyn Controller {
        &*self.law
    }

    /// The inputs of the pose, whatever the robot does.
    pub fn no_law(&self) -> StateFeedback {
        let joints = self.model.link_count();
        let none = vec![vec![0.0; 2 * joints]; self.design.u0.len()];
        StateFeedback::new(joints, none).feeding(&self.design.u0)
    }

    /// The loop of the model without these effects; gears among them are rigid, not gone, as the
    /// design has them.
    pub fn closed_loop(&self, without: &[UndesignedEffect]) -> Result<ClosedLoop> {
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

    /// With this law, from random starts within a spread.
    pub fn figures(&self, closed: &ClosedLoop, law: &dyn Controller, spread_rad: f64) -> Figures {
        let starts = self.starts(spread_rad, RUNS);
        let figures = Figures::of(&closed.run_all(law, &starts, SECONDS, 1));
        (self.done)();
        figures
    }

    /// Spread of the starts that the verdict is from, rad: half a degree; of a plant that falls by
    /// itself and that friction holds there, the least of its doublings where friction does not.
    /// Half a degree again where it holds the robot wherever it looks.
    pub fn near_rad(&self, closed: &ClosedLoop) -> f64 {
        let held = |spread_rad: f64| {
            let figures = self.figures(closed, &self.no_law(), spread_rad);
            figures.stabilised_share >= STABILISED_SHARE
        };
        if !self.falls() {
            return NEAR_RAD;
        }
        let spreads = (0..=DOUBLINGS).map(|times| NEAR_RAD * f64::from(1 << times));
        spreads
            .into_iter()
            .find(|spread_rad| !held(*spread_rad))
            .unwrap_or(NEAR_RAD)
    }

    /// Whether the linear plant would fall.
    pub fn falls(&self) -> bool {
        self.design.poles.iter().any(|pole| pole.re > FALLS_1_S)
    }

    /// Longer runs from the first of the starts within a spread.
    pub fn lasting(&self, closed: &ClosedLoop, spread_rad: f64) -> Lasting {
        let starts = self.starts(spread_rad, LASTING_RUNS);
        let lasting = Lasting::of(self.model, closed, self.law(), &starts);
        (self.done)();
        lasting
    }

    pub fn region(&self, without: &[UndesignedEffect]) -> Result<Region> {
        let closed = self.closed_loop(without)?;
        largest(|spread_rad| {
            let figures = self.figures(&closed, self.law(), spread_rad);
            Ok(figures.stabilised_share >= STABILISED_SHARE)
        })
    }

    pub fn ellipsoid(&self, closed: &ClosedLoop) -> Result<Option<Ellipsoid>> {
        ellipsoid(self.model, self.design, |starts| {
            let starts = starts.iter().cloned().map(|start| self.fed(start));
            let starts: Vec<InitialState> = starts.collect();
            let outcomes = closed.run_all(self.law(), &starts, SECONDS, 1);
            (self.done)();
            Ok(outcomes)
        })
    }

    /// From each of these departures, rad, at rest.
    pub fn outcomes(&self, closed: &ClosedLoop, angles: &[Vec<f64>]) -> Vec<Outcome> {
        let starts = angles
            .iter()
            .map(|angles| self.fed(InitialState::at(angles.clone())));
        let starts: Vec<InitialState> = starts.collect();
        closed.run_all(self.law(), &starts, SECONDS, 1)
    }

    fn starts(&self, spread_rad: f64, runs: u64) -> Vec<InitialState> {
        let joints = self.model.link_count();
        let start = |run| InitialState::random(joints, spread_rad, &mut stream(1, run));
        (0..runs).map(|run| self.fed(start(run))).collect()
    }

    /// The drives obey the pose's inputs before the first command arrives.
    fn fed(&self, start: InitialState) -> InitialState {
        InitialState {
            command: self.design.u0.clone(),
            ..start
        }
    }
}

/// The loop of `model` at the request's pose and period, with its delay and sensors.
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
    let mut closed = ClosedLoop::new(&model, &request.pose_rad, Commands::Own, period_s)?;
    closed.sensor = sensor(&model, request);
    Ok(closed)
}

/// What the law is given: the filter's own sensors; else angles in steps of the request's or the
/// model's, speeds as the request says. Gains in continuous time are given everything exactly.
fn sensor(model: &Model, request: &Request) -> Sensor {
    if let Some(sensors) = &request.sensors {
        return Sensor {
            position_resolution_rad: sensors.position_step_rad,
            gyro: Some(Gyro {
                resolution_rad_s: sensors.gyro_step_rad_s,
                noise_rad_s: 0.0,
            }),
            ..Sensor::EXACT
        };
    }
    match request.time {
        Time::Continuous => Sensor::EXACT,
        Time::Sampled { .. } => Sensor {
            position_resolution_rad: request
                .readings
                .position_step_rad
                .unwrap_or_else(|| model.position_step_rad()),
            velocity: request.readings.speeds,
            ..Sensor::EXACT
        },
    }
}
