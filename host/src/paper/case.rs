//! The robot's closed loop under the paper's circumstances: what a run is made of, and what is seen
//! of it.

use super::computed::Computed;
use crate::controllers::KnownEquilibrium;
use crate::effects;
use crate::error::Result;
use crate::model::{EffectInstance, Model};
use crate::sim::closed_loop::{
    ClosedLoop, Commands, Drives, Gyro, InitialState, Outcome, Sensor, StateFeedback, stream,
};
use crate::synth::{rows, upright};
use nalgebra::DMatrix;
use std::path::Path;

/// Sampling time of the discrete gains, s.
pub const TS_S: f64 = 0.01;
/// Length of a run, s.
pub(super) const SECONDS: f64 = 10.0;
/// Random starts behind a share.
pub(super) const STARTS: u64 = 100;
/// How far each link's centre of mass lies off its line, rad: forward, as the robot's servos and
/// batteries do.
pub(super) const ECCENTRIC_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// The paper's robot: the model file with its Table 1.
///
/// # Errors
/// None is known: the file is the project's own.
pub fn handstand() -> Result<Model> {
    let text = include_str!("../../models/handstand.toml");
    Model::parse(text, Path::new("handstand.toml"))
}

/// The robot with every centre of mass turned off its link's line by `angle_rad`.
pub(super) fn eccentric(angle_rad: f64) -> Result<Model> {
    let mut model = handstand()?;
    if let Some(effect) = effects::named("com_angle") {
        let of = |joint| EffectInstance {
            effect,
            joint: Some(joint),
            values: vec![angle_rad],
        };
        model.effects = (0..model.link_count()).map(of).collect();
    }
    Ok(model)
}

/// A run of the loop.
#[derive(Debug, Clone)]
pub(super) struct Case {
    /// How far the masses lie off, rad.
    pub eccentric_rad: f64,
    /// Whether the controller knows.
    pub compensated: bool,
    /// How it is measured.
    pub sensor: Sensor,
    /// What limits its drives.
    pub drives: Drives,
    /// Sampling time, s.
    pub period_s: f64,
    /// Constant torque on the arms, N m.
    pub disturbance_nm: f64,
    /// Gains, m x n.
    pub gains: DMatrix<f64>,
}

/// A run in curves.
pub(super) struct Seen {
    pub outcome: Outcome,
    pub angles: [Vec<(f64, f64)>; 3],
    pub torques: [Vec<(f64, f64)>; 2],
}

impl Seen {
    /// Largest torque of any drive, N m.
    pub fn peak_nm(&self) -> f64 {
        let torques = self.torques.iter().flatten();
        torques.fold(0.0, |most: f64, (_, torque)| most.max(torque.abs()))
    }
}

impl Case {
    /// Under ideal circumstances, centred masses.
    pub(super) fn ideal(gains: &DMatrix<f64>, period_s: f64) -> Case {
        Case {
            eccentric_rad: 0.0,
            compensated: true,
            sensor: Sensor::EXACT,
            drives: Drives::IDEAL,
            period_s,
            disturbance_nm: 0.0,
            gains: gains.clone(),
        }
    }

    fn loop_and_controller(&self) -> Result<(ClosedLoop, KnownEquilibrium<'static>, Vec<f64>)> {
        let model = self
            .drives
            .on(&eccentric(self.eccentric_rad)?, self.period_s);
        let pose_rad = upright(&model);
        let mut closed = ClosedLoop::new(&model, &pose_rad, Commands::Torque, self.period_s)?;
        closed.plant.disturbance_nm[0] = self.disturbance_nm;
        closed.sensor = self.sensor;
        let balance = closed.plant.balanced_rad();
        let known_rad = match self.compensated {
            true => balance.clone(),
            false => vec![0.0; balance.len()],
        };
        let law = StateFeedback::new(balance.len(), rows(&self.gains));
        let controller = KnownEquilibrium::new(Box::new(law), known_rad);
        Ok((closed, controller, balance))
    }

    /// From rest, the arms leaning by `lean_rad` from the balance.
    pub(super) fn run(&self, lean_rad: f64) -> Result<Seen> {
        self.run_from(|balance| balance[0] += lean_rad)
    }

    /// From rest in the upright pose, all links in a line.
    pub(super) fn run_upright(&self) -> Result<Seen> {
        self.run_from(|balance| balance.fill(0.0))
    }

    fn run_from(&self, start_at: impl Fn(&mut Vec<f64>)) -> Result<Seen> {
        let (closed, controller, mut start) = self.loop_and_controller()?;
        start_at(&mut start);
        let mut seen = Seen {
            outcome: Outcome {
                fell_s: None,
                stabilised: false,
                rms_angle_rad: 0.0,
                rms_torque_nm: 0.0,
                largest_rad: 0.0,
                limit_cycle_rad: None,
                settle_s: None,
            },
            angles: Default::default(),
            torques: Default::default(),
        };
        let (angles, torques) = (&mut seen.angles, &mut seen.torques);
        seen.outcome = closed.watch(
            &controller,
            &InitialState::at(start),
            SECONDS,
            stream(1, 0),
            |sample| {
                for (curve, angle) in angles.iter_mut().zip(sample.angle_rad) {
                    curve.push((sample.time_s, angle.to_degrees()));
                }
                for (curve, torque) in torques.iter_mut().zip(sample.torque_nm) {
                    curve.push((sample.time_s, *torque));
                }
            },
        );
        Ok(seen)
    }

    /// Outcomes from random starts around the balance, each joint within `spread_rad`.
    pub(super) fn share(&self, spread_rad: f64) -> Result<Vec<Outcome>> {
        let (closed, controller, balance) = self.loop_and_controller()?;
        let starts: Vec<InitialState> = (0..STARTS)
            .map(|index| {
                let mut start =
                    InitialState::random(balance.len(), spread_rad, &mut stream(2, index));
                for (angle, balance) in start.angle_rad.iter_mut().zip(&balance) {
                    *angle += balance;
                }
                start
            })
            .collect();
        Ok(closed.run_all(&controller, &starts, SECONDS, 3))
    }
}

/// The sampled loop with compensation, masses slightly eccentric.
pub(super) fn sampled(computed: &Computed) -> Case {
    Case {
        eccentric_rad: 0.1 * ECCENTRIC_RAD,
        ..Case::ideal(&computed.dlqr.k, TS_S)
    }
}

/// As [`sampled`], angles in the servo's steps.
pub(super) fn stepped(computed: &Computed) -> Case {
    let mut case = sampled(computed);
    case.sensor.position_resolution_rad = handstand_shared::raw::Position::LSB_RAD;
    case
}

/// As [`stepped`], the arms' speed in the gyro's steps.
pub(super) fn with_gyro(computed: &Computed) -> Case {
    let mut case = stepped(computed);
    case.sensor.gyro = Some(Gyro {
        resolution_rad_s: 10f64.to_radians(),
        noise_rad_s: 0.0,
    });
    case
}

/// As [`with_gyro`], with the drives' dead zone and limit.
pub(super) fn with_dead_zone(computed: &Computed) -> Case {
    let mut case = with_gyro(computed);
    case.drives = Drives {
        delay_periods: 0.0,
        ..Drives::PAPER
    };
    case
}
