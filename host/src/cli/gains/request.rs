//! What the options of `handstand gains` ask of a design.

use super::super::weight_arg::WeightArg;
use super::super::{Console, page};
use super::GainsArgs;
use handstand::fitting::effect_ids;
use handstand::model::{JointNames, Model};
use handstand::sim::closed_loop::Velocity;
use handstand::synth::export::Provenance;
use handstand::synth::{
    CostWeights, Format, Readings, Request, Sensors, Time, Weight, balanced, default_pose,
};
use handstand::{Error, Result, output};
use handstand_shared::raw::Position;
use std::path::Path;

/// What the simulated law takes for speeds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum SpeedsArg {
    /// The true ones
    True,
    /// Differences of the measured angles over the sampling time
    Difference,
}

impl SpeedsArg {
    fn velocity(self) -> Velocity {
        match self {
            SpeedsArg::True => Velocity::Direct,
            SpeedsArg::Difference => Velocity::Difference,
        }
    }
}

/// The model without the effects left out, what is asked of its design, and where it came from.
pub(in crate::cli) fn requested(
    args: &GainsArgs,
    console: &Console,
) -> Result<(Model, Request, Provenance)> {
    let files = [
        &args.rust,
        &args.c,
        &args.csv,
        &args.state_space,
        &args.report,
    ];
    for file in files.into_iter().flatten() {
        output::vacant(file, args.force)?;
    }
    let mut model = Model::load(&args.model)?;
    for id in leave_out(&mut model, &args.without)? {
        console.say(&format!("designed without {id}; the simulated loop has it"));
    }
    let pose_rad = posed(args, &model, console)?;
    let request = request(args, &model, pose_rad)?;
    Ok((model, request, provenance(&args.model, console)?))
}

/// Takes these effects out of the model; which ones they were.
fn leave_out(model: &mut Model, without: &[String]) -> Result<Vec<String>> {
    let without = effect_ids(without)?;
    for id in &without {
        let before = model.effects.len();
        model.effects.retain(|e| e.effect.info().id != id);
        if model.effects.len() == before {
            let mut held: Vec<&str> = model.effects.iter().map(|e| e.effect.info().id).collect();
            held.sort_unstable();
            held.dedup();
            let held = match held.as_slice() {
                [] => "none at all".to_string(),
                held => held.join(", "),
            };
            return Err(Error::usage(
                format!("`{}` holds no effect `{id}`", model.name),
                format!("it holds {held}"),
            ));
        }
    }
    Ok(without)
}

/// The pose that is asked for, and what of it the options do not say, on stderr.
fn posed(args: &GainsArgs, model: &Model, console: &Console) -> Result<Vec<f64>> {
    let mut pose_rad = match &args.pose {
        Some(pose) => {
            let pose_rad = pose.resolve(model)?;
            let open = pose.left_open(model);
            if !open.is_empty() {
                let open = joints_at(model, &pose_rad, &open);
                console.say(&format!("not named by --pose: {open}"));
            }
            pose_rad
        }
        None => {
            let pose_rad = default_pose(model);
            if model.is_in_space() {
                let all: Vec<usize> = (0..pose_rad.len()).collect();
                let all = joints_at(model, &pose_rad, &all);
                console.say(&format!("no --pose: {all}"));
            }
            pose_rad
        }
    };
    if args.balance {
        pose_rad = balanced(model, &pose_rad)?;
        let said = if model.is_in_space() {
            let all: Vec<usize> = (0..pose_rad.len()).collect();
            format!("balanced at {}", joints_at(model, &pose_rad, &all))
        } else {
            let said: Vec<String> = pose_rad.iter().map(|angle| format!("{angle:.6}")).collect();
            let mut units: Vec<&str> = model.joints.iter().map(|joint| joint.units()[0]).collect();
            if !model.slides() {
                units.truncate(1);
            }
            let (said, units) = (said.join(", "), units.join(", "));
            format!("balanced at q = [{said}] {units}")
        };
        console.say(&said);
    }
    Ok(pose_rad)
}

/// These joints, counted from 0, by name or number, and where the pose has them.
fn joints_at(model: &Model, pose_rad: &[f64], joints: &[usize]) -> String {
    let names = JointNames::of(model);
    let said = joints.iter().map(|&joint| {
        let (at, unit) = (pose_rad[joint] + 0.0, model.joints[joint].units()[0]);
        let at = format!("{at:.6}");
        let at = at.trim_end_matches('0').trim_end_matches('.');
        format!("{} {at} {unit}", names.label(joint))
    });
    said.collect::<Vec<String>>().join(", ")
}

fn request(args: &GainsArgs, model: &Model, pose_rad: Vec<f64>) -> Result<Request> {
    let time = if args.continuous {
        Time::Continuous
    } else {
        Time::Sampled {
            ts_s: args.ts,
            delay_s: args.delay,
        }
    };
    let joints = model.link_count();
    let driven = model.joints.iter().filter(|joint| joint.drive.is_driven());
    let inputs = driven.count();
    let list = |given: &Option<WeightArg>, name, size| {
        let list = given.as_ref().map(|given| given.list(name, size));
        list.transpose()
    };
    let read = |given: &Option<WeightArg>| given.as_ref().map(WeightArg::read).transpose();
    let standard = Request::standard(model);
    let sensors = Sensors {
        position_step_rad: args.position_step.unwrap_or(Position::LSB_RAD),
        gyro_step_rad_s: args
            .gyro_step
            .unwrap_or(10.0 * std::f64::consts::PI / 180.0),
        process: read(&args.process)?,
        recovery: args.recovery.unwrap_or(0.0),
    };
    let request = Request {
        pose_rad,
        weights: match read(&args.q)? {
            Some(q) => CostWeights::Given {
                q,
                r: read(&args.r)?.unwrap_or(Weight::Scalar(1.0)),
            },
            None => standard.weights,
        },
        integral: read(&args.integral)?,
        time,
        sensors: args.lqg.then_some(sensors),
        readings: Readings {
            position_step_rad: args.position_step,
            speeds: args.speeds.velocity(),
        },
        state_range: read(&args.range)?.unwrap_or(standard.state_range),
        input_range: read(&args.limit)?,
        format: Format {
            state_step: list(&args.state_step, "--state-step", 2 * joints)?,
            input_step: list(&args.input_step, "--input-step", inputs)?,
            ..standard.format
        },
    };
    Ok(request)
}

fn provenance(model: &Path, console: &Console) -> Result<Provenance> {
    let file = page::hashed(model)?;
    Ok(Provenance {
        model: file.name,
        sha256: file.sha256,
        command: console.command.clone(),
    })
}
