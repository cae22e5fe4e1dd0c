//! The closed loop of a model and a known controller beside the measured one.

mod series;

use crate::compare::{ClosedLoopComparison, LoopMotion, speed_rad_s};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::motion::Motion;
use crate::sim::closed_loop::{
    ClosedLoop, InitialState, PosedPlant, Sensor, StateFeedback, Velocity, set_delay, stream,
};
use crate::synth::{StateFeedbackPlan, continuous_period_s, linearise, poles};
use nalgebra::DMatrix;
use series::{DeviationSeries, MotionSeries, pooled};

/// Simulates the loop of `model`, with all its effects, and the plan's law from the first sample of
/// each motion, and compares angles at the samples.
///
/// The law is given what the log declares: angles in the coarsest of its resolutions, exact speeds
/// if every joint has a velocity column, else the differences of angles. A model without a delay of
/// its own gets the one that the plan compensates. Motions without a sample of all joints, or with
/// a single sample, are left out.
///
/// # Errors
/// A plan of another number of joints or drives than the model's; joints that slide.
pub fn compare_closed_loop(
    model: &Model,
    plan: &StateFeedbackPlan,
    motions: &[Motion],
) -> Result<ClosedLoopComparison> {
    model.hinges_only("the measured loop is compared in angles")?;
    let mut model = model.clone();
    if !model.effects.iter().any(|e| e.effect.info().id == "delay") {
        set_delay(&mut model, plan.delay_s);
    }
    let mut compared = Vec::new();
    for (index, motion) in motions.iter().enumerate() {
        let closed = closed_loop(&model, plan, motion)?;
        compared.extend(one_motion(&closed, plan, motion, index as u64));
    }
    let joints = 0..model.link_count();
    Ok(ClosedLoopComparison {
        signals: joints.map(|joint| pooled(&compared, joint)).collect(),
        motions: compared.into_iter().map(|both| both.motion).collect(),
    })
}

fn closed_loop(model: &Model, plan: &StateFeedbackPlan, motion: &Motion) -> Result<ClosedLoop> {
    let plant = PosedPlant::of_motion(model, &plan.pose_rad, motion)?;
    if plan.u0.len() != plant.drives() {
        return Err(Error::design(
            format!("{} inputs for {} drives", plan.u0.len(), plant.drives()),
            "give the plan that was made for this robot",
        ));
    }
    let columns = &model.log.joints;
    let logs_speeds = columns.iter().all(|joint| joint.velocity.is_some());
    let mut closed = ClosedLoop::around(plant, period_s(model, plan)?);
    closed.sensor = Sensor {
        position_resolution_rad: model.position_step_rad(),
        velocity: if logs_speeds {
            Velocity::Direct
        } else {
            Velocity::Difference
        },
        ..Sensor::EXACT
    };
    Ok(closed)
}

/// The plan's sampling time, s, or what stands for it in continuous time.
fn period_s(model: &Model, plan: &StateFeedbackPlan) -> Result<f64> {
    if let Some(ts_s) = plan.ts_s {
        return Ok(ts_s);
    }
    let plant = linearise(model, &plan.pose_rad)?.plant;
    let k = DMatrix::from_fn(plan.k.len(), plant.a.nrows(), |i, j| plan.k[i][j]);
    Ok(continuous_period_s(&poles(&(plant.a - plant.b * k))?))
}

fn one_motion(
    closed: &ClosedLoop,
    plan: &StateFeedbackPlan,
    motion: &Motion,
    index: u64,
) -> Option<MotionSeries> {
    let angles = &motion.position_rad;
    let first = (0..motion.len()).find(|&k| angles.iter().all(|joint| joint[k].is_finite()))?;
    let time_s: Vec<f64> = motion.time_s[first..]
        .iter()
        .map(|time| time - motion.time_s[first])
        .collect();
    let duration_s = *time_s.last().filter(|last| **last > 0.0)?;
    let measured = measured(closed, motion, first, &time_s);
    let start = initial_state(closed, plan, motion, first);
    let simulated = simulated(closed, plan, &start, &time_s, index);
    let mut both = MotionSeries {
        motion: LoopMotion {
            motion: motion.name.clone(),
            duration_s,
            measured_fell_s: measured.fell_s,
            simulated_fell_s: simulated.fell_s,
            signals: Vec::new(),
        },
        time_s,
        measured,
        simulated,
    };
    let joints = 0..angles.len();
    both.motion.signals = joints
        .map(|joint| pooled(std::slice::from_ref(&both), joint))
        .collect();
    Some(both)
}

/// The first sample's angles, with its speeds and inputs where they are logged.
fn initial_state(
    closed: &ClosedLoop,
    plan: &StateFeedbackPlan,
    motion: &Motion,
    first: usize,
) -> InitialState {
    let finite = |values: &Option<Vec<f64>>| {
        let value = values.as_ref().map(|values| values[first]);
        value.filter(|value| value.is_finite())
    };
    let positions = motion.position_rad.iter().zip(&motion.velocity_rad_s);
    let (reading_rad, rate_rad_s): (Vec<f64>, Vec<f64>) = positions
        .map(|(position, velocity)| {
            let slope = || speed_rad_s(&motion.time_s, position)[first];
            let rate = finite(velocity).unwrap_or_else(slope);
            (position[first], if rate.is_finite() { rate } else { 0.0 })
        })
        .unzip();
    let (angle_rad, speed_rad_s) = closed.plant.deviations(&reading_rad, &rate_rad_s);
    let inputs = closed.plant.driven_joints().zip(&plan.u0);
    InitialState {
        angle_rad,
        speed_rad_s,
        command: inputs
            .map(|(joint, u0)| finite(&motion.input[joint]).unwrap_or(*u0))
            .collect(),
    }
}

fn measured(closed: &ClosedLoop, motion: &Motion, first: usize, time_s: &[f64]) -> DeviationSeries {
    let pose_rad = closed.plant.pose_reading_rad();
    let still = vec![0.0; pose_rad.len()];
    let fallen = |k: usize| {
        let angles = motion.position_rad.iter();
        let reading_rad: Vec<f64> = angles.map(|joint| joint[first + k]).collect();
        let (angle_rad, _) = closed.plant.deviations(&reading_rad, &still);
        let known = angle_rad.iter().all(|angle| angle.is_finite());
        known && closed.limits.has_fallen(&closed.plant, &angle_rad, &still)
    };
    let fell = (0..time_s.len()).find(|&k| fallen(k));
    let end = first + fell.unwrap_or(time_s.len());
    let joints = motion.position_rad.iter().zip(&pose_rad);
    DeviationSeries {
        angle_rad: joints
            .map(|(joint, pose)| joint[first..end].iter().map(|angle| angle - pose).collect())
            .collect(),
        fell_s: fell.map(|k| time_s[k]),
    }
}

/// What the simulated controller reads, on straight lines between its samples.
fn simulated(
    closed: &ClosedLoop,
    plan: &StateFeedbackPlan,
    start: &InitialState,
    time_s: &[f64],
    index: u64,
) -> DeviationSeries {
    let joints = plan.pose_rad.len();
    let law = StateFeedback::new(joints, plan.k.clone()).feeding(&plan.u0);
    let seconds = time_s.last().copied().unwrap_or(0.0);
    let mut samples_s = Vec::new();
    let mut readings: Vec<Vec<f64>> = vec![Vec::new(); joints];
    let outcome = closed.watch(&law, start, seconds, stream(1, index), |sample| {
        samples_s.push(sample.time_s);
        for (joint, angle) in readings.iter_mut().zip(sample.measured.angle_rad) {
            joint.push(*angle);
        }
    });
    let last_s = samples_s.last().copied().unwrap_or(f64::NEG_INFINITY);
    let known = time_s.partition_point(|time| *time <= last_s + 1e-9);
    let at = |joint: &[f64], time: f64| {
        let after = samples_s.partition_point(|sample| *sample <= time);
        let before = after.saturating_sub(1);
        let after = after.min(samples_s.len() - 1);
        let span_s = samples_s[after] - samples_s[before];
        let share = if span_s > 0.0 {
            (time - samples_s[before]) / span_s
        } else {
            0.0
        };
        joint[before] + share * (joint[after] - joint[before])
    };
    DeviationSeries {
        angle_rad: readings
            .iter()
            .map(|joint| {
                time_s[..known]
                    .iter()
                    .map(|time| at(joint, *time))
                    .collect()
            })
            .collect(),
        fell_s: outcome.fell_s,
    }
}
