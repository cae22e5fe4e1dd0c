//! The robot's closed loop under the paper's circumstances: what a run is made of, and what is seen
//! of it.

use crate::error::Result;
use crate::sim::closed_loop::{
    Controller, Drives, Gyro, InitialState, Outcome, StateFeedback, stream,
};
use crate::study::{Case, Uncertain, handstand};
use crate::synth::controllers::{ControllerDesign, ControllerInfo, DEFAULT, DesignModel, Speeds};
use crate::synth::lqr;
use nalgebra::DMatrix;

/// Sampling time of the discrete gains, s.
pub const TS_S: f64 = 0.01;
/// Sampling time that stands for the continuous gains, s.
const CONTINUOUS_S: f64 = 0.001;
/// Length of a run, s.
pub(super) const SECONDS: f64 = 10.0;
/// Random starts behind a share.
pub(super) const STARTS: u64 = 100;
/// How far each link's centre of mass lies off its line, rad: forward, as the robot's servos and
/// batteries do.
pub(super) const ECCENTRIC_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// The paper's continuous regulator, Q = I and R = I.
#[derive(Debug)]
struct ContinuousLqr;

static LQR: ControllerInfo = ControllerInfo {
    id: "lqr",
    title: "LQR of the paper",
    law: "u = -K x",
    speeds: Speeds::True,
    known_equilibrium: false,
    reference: "the paper, section IV, Figure 12",
};

impl ControllerDesign for ContinuousLqr {
    fn info(&self) -> &ControllerInfo {
        &LQR
    }

    fn build(&self, known: &DesignModel) -> Result<Box<dyn Controller>> {
        let (states, inputs) = known.plant.b.shape();
        let (q, r) = (
            DMatrix::identity(states, states),
            DMatrix::identity(inputs, inputs),
        );
        let k = lqr(&known.plant, &q, &r)?.k;
        let rows = k.row_iter().map(|row| row.iter().copied().collect());
        Ok(Box::new(StateFeedback::new(known.joints(), rows.collect())))
    }
}

/// A run in curves.
pub(super) struct RunCurves {
    pub outcome: Outcome,
    pub angles: [Vec<(f64, f64)>; 3],
    pub torques: [Vec<(f64, f64)>; 2],
}

impl RunCurves {
    /// Largest torque of any drive, N m.
    pub fn peak_nm(&self) -> f64 {
        let torques = self.torques.iter().flatten();
        torques.fold(0.0, |most: f64, (_, torque)| most.max(torque.abs()))
    }

    /// From rest, the arms leaning by `lean_rad` from the balance.
    pub fn leaning(case: &Case, lean_rad: f64) -> Result<RunCurves> {
        RunCurves::from(case, |balance| balance[0] += lean_rad)
    }

    /// From rest in the upright pose, all links in a line.
    pub fn upright(case: &Case) -> Result<RunCurves> {
        RunCurves::from(case, |balance| balance.fill(0.0))
    }

    fn from(case: &Case, start_at: impl Fn(&mut Vec<f64>)) -> Result<RunCurves> {
        let (designed, closed) = (case.designed()?, case.closed_loop()?);
        let controller = case.controller(&designed, &closed);
        let mut start = closed.plant.balanced_rad();
        start_at(&mut start);
        let start = InitialState::at(start);
        let mut angles: [Vec<_>; 3] = Default::default();
        let mut torques: [Vec<_>; 2] = Default::default();
        let outcome = closed.watch(&*controller, &start, SECONDS, stream(1, 0), |sample| {
            for (curve, angle) in angles.iter_mut().zip(sample.angle_rad) {
                curve.push((sample.time_s, angle.to_degrees()));
            }
            for (curve, torque) in torques.iter_mut().zip(sample.torque_nm) {
                curve.push((sample.time_s, *torque));
            }
        });
        Ok(RunCurves {
            outcome,
            angles,
            torques,
        })
    }
}

/// Outcomes from random starts around the balance, each joint within `spread_rad`.
pub(super) fn outcomes(case: &Case, spread_rad: f64) -> Result<Vec<Outcome>> {
    let (designed, closed) = (case.designed()?, case.closed_loop()?);
    let controller = case.controller(&designed, &closed);
    let balance = closed.plant.balanced_rad();
    let start = |index| {
        let random = InitialState::random(balance.len(), spread_rad, &mut stream(2, index));
        let angles = random.angle_rad.iter().zip(&balance);
        InitialState::at(
            angles
                .map(|(angle, balance)| angle + balance)
                .collect::<Vec<f64>>(),
        )
    };
    let starts: Vec<InitialState> = (0..STARTS).map(start).collect();
    Ok(closed.run_all(&*controller, &starts, SECONDS, 3))
}

/// The robot with every centre of mass turned off its link's line by `eccentric_rad`, which the
/// controller compensates if `known`.
fn eccentric(
    design: &'static dyn ControllerDesign,
    period_s: f64,
    eccentric_rad: f64,
    known: bool,
) -> Result<Case> {
    let mut case = Case::ideal(handstand()?, design, period_s);
    case.control.known_equilibrium = known;
    for angle in Uncertain::uniform("com_angle", eccentric_rad, case.robot.link_count()) {
        angle.apply(&mut case, eccentric_rad);
    }
    Ok(case)
}

/// The continuous loop.
pub(super) fn continuous(eccentric_rad: f64, known: bool) -> Result<Case> {
    eccentric(&ContinuousLqr, CONTINUOUS_S, eccentric_rad, known)
}

/// The sampled loop with compensation, masses slightly eccentric.
pub(super) fn sampled() -> Result<Case> {
    eccentric(DEFAULT, TS_S, 0.1 * ECCENTRIC_RAD, true)
}

/// As [`sampled`], angles in the servo's steps.
pub(super) fn stepped() -> Result<Case> {
    let mut case = sampled()?;
    case.sensor.position_resolution_rad = handstand_shared::raw::Position::LSB_RAD;
    Ok(case)
}

/// As [`stepped`], the arms' speed in the gyro's steps.
pub(super) fn with_gyro() -> Result<Case> {
    let mut case = stepped()?;
    case.sensor.gyro = Some(Gyro {
        resolution_rad_s: 10f64.to_radians(),
        noise_rad_s: 0.0,
    });
    Ok(case)
}

/// As [`with_gyro`], with the drives' dead zone and limit.
pub(super) fn with_dead_zone() -> Result<Case> {
    let mut case = with_gyro()?;
    case.drives = Drives {
        delay_periods: 0.0,
        ..Drives::PAPER
    };
    Ok(case)
}
