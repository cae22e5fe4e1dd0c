//! What the options of `handstand gains` ask of a design.

use super::super::weight_arg::WeightArg;
use super::super::{Console, page};
use super::GainsArgs;
use handstand::fitting::effect_ids;
use handstand::model::Model;
use handstand::sim::closed_loop::Velocity;
use handstand::synth::export::Provenance;
use handstand::synth::{
    CostWeights, Format, Readings, Request, Sensors, Time, Weight, balanced, upright,
};
use handstand::{Error, Result, output};
use handstand_shared::raw::Position;
use std::path::Path;

/// Where the robot is balanced.
#[derive(Debug, Clone)]
pub(super) enum Pose {
    /// All links straight up.
    Upright,
    /// Angles of the joints, rad.
    Angles(Vec<f64>),
}

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

/// `--pose`.
pub(super) fn pose(text: &str) -> Result<Pose, String> {
    if text == "upright" {
        return Ok(Pose::Upright);
    }
    let angles: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    angles
        .map(Pose::Angles)
        .map_err(|_| "give angles in rad between commas, or `upright`".into())
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
    let (request, balance) = request(args, &model)?;
    if let Some(said) = balance {
        console.say(&said);
    }
    Ok((model, request, provenance(&args.model, console)?))
}

/// Takes these effects out of the model; which ones they were.
fn leave_out(model: &mut Model, without: &[String]) -> Result<Vec<String>> {
    let without = effect_ids(without)?;
    for id in &without {
        let before = model.effects.len();
        model.effects.retain(|e| e.effect.info().id != id);
        if model.effects.len() == before {
            let held: Vec<&str> = model.effects.iter().map(|e| e.effect.info().id).collect();
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

/// The request, and where the pose was moved to if it was.
fn request(args: &GainsArgs, model: &Model) -> Result<(Request, Option<String>)> {
    let mut pose_rad = match &args.pose {
        Pose::Upright => upright(model),
        Pose::Angles(angles) => angles.clone(),
    };
    let mut moved = None;
    if args.balance {
        pose_rad = balanced(model, &pose_rad)?;
        let said: Vec<String> = pose_rad.iter().map(|angle| format!("{angle:.6}")).collect();
        let mut units: Vec<&str> = model.joints.iter().map(|joint| joint.units()[0]).collect();
        if !model.slides() {
            units.truncate(1);
        }
        let (said, units) = (said.join(", "), units.join(", "));
        moved = Some(format!("balanced at q = [{said}] {units}"));
    }
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
    Ok((request, moved))
}

fn provenance(model: &Path, console: &Console) -> Result<Provenance> {
    let file = page::hashed(model)?;
    Ok(Provenance {
        model: file.name,
        sha256: file.sha256,
        command: console.command.clone(),
    })
}
