//! The handstand's figures: 12, 13 and 14, from our own closed loop.

use super::computed::Computed;
use super::figure::{Curve, Figure, Holds, Ink, Panel};
use crate::closed_loop::{
    ClosedLoop, Conditions, Gyro, Outcome, Plant, Start, StateFeedback, Velocity, stream,
};
use crate::effects;
use crate::error::Result;
use crate::model::{EffectInstance, Model};
use crate::number::short;
use crate::synth::upright;
use nalgebra::DMatrix;
use std::path::Path;

/// Sampling time of the discrete gains, s.
pub const TS_S: f64 = 0.01;
/// Sampling time that stands for the continuous gains, s.
const CONTINUOUS_S: f64 = 0.001;
/// Length of a run, s.
const SECONDS: f64 = 10.0;
/// Random starts behind a share.
const STARTS: u64 = 100;
/// Constant torque that disturbs the arms, N m.
const DISTURBANCE_NM: f64 = 0.01;
/// Lean of the arms a run begins with, rad.
const LEAN_RAD: f64 = 1.0 * std::f64::consts::PI / 180.0;
/// How far each link's centre of mass lies off its line, rad: forward, as the robot's servos and batteries do.
const ECCENTRIC_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;

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
    /// Sensor, drives, clock.
    pub conditions: Conditions,
    /// Constant torque on the arms, N m.
    pub disturbance_nm: f64,
    /// Gains, m x n.
    pub gains: DMatrix<f64>,
}

/// A run in curves.
pub(super) struct Seen {
    pub outcome: Outcome,
    angles: [Vec<(f64, f64)>; 3],
    torques: [Vec<(f64, f64)>; 2],
}

impl Seen {
    /// Largest torque of any drive, N m.
    fn peak_nm(&self) -> f64 {
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
            conditions: Conditions::ideal(period_s),
            disturbance_nm: 0.0,
            gains: gains.clone(),
        }
    }

    fn loop_and_controller(&self) -> Result<(ClosedLoop, StateFeedback, Vec<f64>)> {
        let model = eccentric(self.eccentric_rad)?;
        let mut plant = Plant::new(&model, &upright(&model))?;
        plant.disturbance_nm[0] = self.disturbance_nm;
        let balance = plant.balanced_rad();
        let rows = self.gains.row_iter();
        let rows = rows.map(|r| r.iter().copied().collect()).collect();
        let mut controller = StateFeedback::new(plant.joints(), rows);
        if self.compensated {
            controller = controller.holding(&balance);
        }
        let mut closed = ClosedLoop::ideal(plant, self.conditions.clock.period_s);
        closed.conditions = self.conditions;
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
            &Start::at(start),
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
        let starts: Vec<Start> = (0..STARTS)
            .map(|index| {
                let mut start = Start::random(balance.len(), spread_rad, &mut stream(2, index));
                for (angle, balance) in start.angle_rad.iter_mut().zip(&balance) {
                    *angle += balance;
                }
                start
            })
            .collect();
        Ok(closed.run_all(&controller, &starts, SECONDS, 3))
    }
}

/// Figures 12, 13, 14.
pub(super) fn figures(computed: &Computed) -> Result<Vec<Figure>> {
    Ok(vec![
        eccentric_masses(computed)?,
        resolution(computed)?,
        gyro(computed)?,
        dead_zone(computed)?,
    ])
}

fn end(outcome: &Outcome) -> String {
    match (outcome.fell_s, outcome.limit_cycle_rad) {
        (Some(fell), _) => format!("falls after {fell:.2} s"),
        (None, Some(cycle)) if cycle > 1e-3 => {
            format!("stands, swinging by {} deg", short(cycle.to_degrees()))
        }
        _ => "stands still".to_string(),
    }
}

/// Angles above, torques below, of runs side by side; of one run, side by side.
fn panels(runs: &[(&str, &Seen)]) -> Vec<Panel> {
    let inks = [Ink::Blue, Ink::Orange, Ink::Green];
    let joints = ["q1 arms", "q2 shoulder", "q3 hip"];
    let angle = |(name, seen): &(&str, &Seen)| Panel {
        title: format!("{name}: {}", end(&seen.outcome)),
        x_label: "time, s",
        y_label: "angle, deg",
        curves: (0..3)
            .map(|i| Curve::line(joints[i], inks[i], seen.angles[i].clone()))
            .collect(),
    };
    let torque = |(name, seen): &(&str, &Seen)| Panel {
        title: format!("{name}: {} N m RMS", short(seen.outcome.rms_torque_nm)),
        x_label: "time, s",
        y_label: "torque, N m",
        curves: (0..2)
            .map(|i| Curve::line(joints[i + 1], inks[i + 1], seen.torques[i].clone()))
            .collect(),
    };
    runs.iter()
        .map(angle)
        .chain(runs.iter().map(torque))
        .collect()
}

fn eccentric_masses(computed: &Computed) -> Result<Figure> {
    let case = |eccentric_rad: f64, compensated: bool| Case {
        eccentric_rad,
        compensated,
        ..Case::ideal(&computed.lqr.k, CONTINUOUS_S)
    };
    let without = case(ECCENTRIC_RAD, false).run_upright()?;
    let with = case(ECCENTRIC_RAD, true).run_upright()?;
    let falls = |angle: f64| Ok(case(angle, false).run_upright()?.outcome.fell_s.is_some());
    let limit = edge(falls, 0.0, ECCENTRIC_RAD)?;
    let below = case(0.5 * limit, false).run_upright()?.outcome;
    let holds = without.outcome.fell_s.is_some() && with.outcome.survived();
    Ok(Figure {
        number: "12",
        title: "LQR without and with angle compensation",
        claim: "LQR does not stabilise the robot whose centres of mass are eccentric; with angle compensation it does",
        holds: if holds { Holds::Yes } else { Holds::No },
        sentence: format!(
            "Upright, with every centre of mass {:.0} deg off its link's line, the robot {} without compensation and {} with it; \
             without, it falls from {:.1} deg on, and at half of that leans by up to {} deg.",
            ECCENTRIC_RAD.to_degrees(),
            end(&without.outcome),
            end(&with.outcome),
            limit.to_degrees(),
            short(below.largest_rad.to_degrees())
        ),
        panels: panels(&[("without", &without), ("with", &with)]),
    })
}

/// Where `fails` turns true between `low` (false) and `high` (true), to a thousandth of the span; `high` if it never
/// does.
pub(super) fn edge(
    fails: impl Fn(f64) -> Result<bool>,
    mut low: f64,
    mut high: f64,
) -> Result<f64> {
    if !fails(high)? {
        return Ok(high);
    }
    let close = (high - low) / 1000.0;
    while high - low > close {
        let middle = 0.5 * (low + high);
        match fails(middle)? {
            true => high = middle,
            false => low = middle,
        }
    }
    Ok(high)
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
    case.conditions.sensor.position_resolution_rad = super::servo::STEP_RAD;
    case
}

/// As [`stepped`], the arms' speed in the gyro's steps.
pub(super) fn with_gyro(computed: &Computed) -> Case {
    let mut case = stepped(computed);
    case.conditions.sensor.gyro = Some(Gyro {
        resolution_rad_s: 10f64.to_radians(),
        noise_rad_s: 0.0,
    });
    case
}

/// As [`with_gyro`], with the drives' dead zone and limit.
pub(super) fn with_dead_zone(computed: &Computed) -> Case {
    let mut case = with_gyro(computed);
    case.conditions.actuator.dead_zone = 0.1;
    case.conditions.actuator.saturates = true;
    case
}

fn resolution(computed: &Computed) -> Result<Figure> {
    let exact = sampled(computed).run(LEAN_RAD)?;
    let coarse = stepped(computed).run(LEAN_RAD)?;
    let continuous = Case {
        eccentric_rad: 0.1 * ECCENTRIC_RAD,
        ..Case::ideal(&computed.lqr.k, CONTINUOUS_S)
    };
    let continuous = continuous.run(LEAN_RAD)?;
    let mut differenced = stepped(computed);
    differenced.conditions.sensor.velocity = Velocity::Difference;
    let differenced = differenced.run(LEAN_RAD)?.outcome;
    let chatters = coarse
        .outcome
        .limit_cycle_rad
        .is_some_and(|cycle| cycle > 1e-3);
    let smaller = exact.peak_nm() < continuous.peak_nm();
    let holds = exact.outcome.survived() && coarse.outcome.survived() && chatters && smaller;
    Ok(Figure {
        number: "13",
        title: "DLQR at 0.01 s, and with the servos' position resolution",
        claim: "sampled at 0.01 s with compensation the loop is stable and its torque smaller than in continuous time; \
                with 300 deg / 2^10 it chatters and stays up",
        holds: if holds { Holds::Yes } else { Holds::No },
        sentence: format!(
            "From a lean of 1 deg the sampled loop {} and asks for {} N m at most (continuous: {}); with the position \
             steps it {} with {} N m RMS instead of {}. If speeds too are differences of those steps, it {} with {}.",
            end(&exact.outcome),
            short(exact.peak_nm()),
            short(continuous.peak_nm()),
            end(&coarse.outcome),
            short(coarse.outcome.rms_torque_nm),
            short(exact.outcome.rms_torque_nm),
            end(&differenced),
            short(differenced.rms_torque_nm)
        ),
        panels: panels(&[("exact", &exact), ("300 deg / 2^10", &coarse)]),
    })
}

/// Runs that stood, and the median swing of those.
fn tally(outcomes: &[Outcome]) -> (usize, f64) {
    let mut swings: Vec<f64> = outcomes.iter().filter_map(|o| o.limit_cycle_rad).collect();
    swings.sort_by(f64::total_cmp);
    let median = swings.get(swings.len() / 2).copied().unwrap_or(f64::NAN);
    let stood = outcomes.iter().filter(|o| o.survived()).count();
    (stood, median.to_degrees())
}

fn gyro(computed: &Computed) -> Result<Figure> {
    let before = stepped(computed).run(LEAN_RAD)?.outcome;
    let mut disturbed = with_gyro(computed);
    disturbed.disturbance_nm = DISTURBANCE_NM;
    let seen = disturbed.run(LEAN_RAD)?;
    let larger = seen.outcome.rms_torque_nm > before.rms_torque_nm;
    Ok(Figure {
        number: "14 a,c,e",
        title: "Gyro resolution and a constant perturbation",
        claim: "with the gyro's 10 deg/s and a constant perturbation the control is larger and the robot stays up",
        holds: match larger && seen.outcome.survived() {
            true => Holds::Yes,
            false => Holds::No,
        },
        sentence: format!(
            "With the gyro's steps and {DISTURBANCE_NM} N m on the arms the robot {} with {} N m RMS instead of {}.",
            end(&seen.outcome),
            short(seen.outcome.rms_torque_nm),
            short(before.rms_torque_nm)
        ),
        panels: panels(&[("gyro, perturbed", &seen)]),
    })
}

fn dead_zone(computed: &Computed) -> Result<Figure> {
    let direct = with_dead_zone(computed);
    let mut differenced = direct.clone();
    differenced.conditions.sensor.velocity = Velocity::Difference;
    let (seen, fallen) = (direct.run(LEAN_RAD)?, differenced.run(LEAN_RAD)?);
    let (stood, swing) = tally(&direct.share(LEAN_RAD)?);
    let (differenced_stood, _) = tally(&differenced.share(LEAN_RAD)?);
    let rests = seen
        .outcome
        .limit_cycle_rad
        .is_some_and(|cycle| cycle.to_degrees() < 0.5);
    let saturates = seen.peak_nm() >= 2.0 - 1e-9;
    Ok(Figure {
        number: "14 b,d,f",
        title: "Dead zone and limit of the servos",
        claim: "with a dead zone of 10 % and 2 N m the robot is not stabilised, and the torques saturate",
        holds: match (rests, saturates, stood) {
            (false, true, 0) => Holds::Yes,
            (false, true, _) => Holds::InPart,
            _ => Holds::No,
        },
        sentence: format!(
            "It never comes to rest and its torques saturate, but of {STARTS} starts within 1 deg {stood} stand for \
             {SECONDS:.0} s, swinging by {swing:.1} deg (median), as long as the speeds of shoulder and hip are exact; with \
             speeds from differences of the position steps, as the servos give them, {differenced_stood} of {STARTS} stand."
        ),
        panels: panels(&[("exact speeds", &seen), ("differenced", &fallen)]),
    })
}
