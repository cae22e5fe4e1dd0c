//! `handstand excite MOTION.csv --joints 1+2/11+12`: the motions that a measurement needs, for
//! `replay`; with `--model ROBOT.toml` for the drives of a model.
//!
//! ```console
//! $ handstand excite train.csv --joints 1+2/11+12 --angles -0.6..0.6 --speed 2 --seed 1
//! $ handstand replay train.csv --stream --record train_log.csv
//! $ handstand excite reach.csv --model so101.toml --speed 1.5
//! ```
//!
//! Multisine, steps, slow triangles, holds, then a drop with torque off, one after the other, each
//! from and to the middle of the ranges. Servos of one joint are joined by `+`, those after the
//! first face the other way; joints are parted by `/`, as are their angles where they differ. The
//! file is CSV: `time_s`, `goal1_rad` for each servo, and `torque_on` where torque goes off. Equal
//! arguments give equal bytes.
//!
//! A model's motions hold what its drives take, in the columns of its log: the widest on which it
//! stays within angles and speed, a robot in space within its end stops, too, clear of itself and
//! of the plane that it stands on.
//!
//! Limits that no servo can be held within are refused, and so is too little time.
//!
//! `--json` prints `file`, `seconds`, `samples`, `hz`, `seed`, `motions` (`kind`, `begin_s`,
//! `end_s`), `joints` (`servos`, `lowest_rad`, `highest_rad`, `fastest_rad_s`), and, of a model,
//! `joint` in the place of `servos` and `width`, the share of the ranges.

use super::input::{self, positive, range, ranges};
use super::{Console, ExitStatus};
use handstand::experiment::excite::{
    EXCITATION_KINDS, Excitation, ExcitationKind, ExcitePlan, JointExtent, JointLimits, excite,
};
use handstand::experiment::{ExperimentLimits, FirstMotions, first_motions, inputs_alone};
use handstand::log::to_csv;
use handstand::output::number::percent;
use handstand::{Error, Model, Result, output};
use handstand_shared::dynamixel::ids;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Which motions, within which limits.
#[derive(Debug, clap::Args)]
pub struct ExciteArgs {
    /// File to write, .csv
    file: PathBuf,
    /// Servos of each joint, from the base outwards
    #[arg(long, value_name = "1+2/11+12", required_unless_present = "model")]
    joints: Option<String>,
    /// Model whose drives are moved, in place of servos
    #[arg(long, value_name = "MODEL.toml", conflicts_with = "joints")]
    model: Option<PathBuf>,
    /// Lowest and highest angle, rad: for all joints, or for each [default: -0.5..0.5, or the end
    /// stops of a robot in space]
    #[arg(long, value_name = "LOW..HIGH[/..]", allow_hyphen_values = true)]
    angles: Option<String>,
    /// Height of the plane that a robot in space stands on, over its base's origin, m; `none` where
    /// there is none
    #[arg(
        long,
        value_name = "M",
        default_value = "0",
        allow_hyphen_values = true
    )]
    #[arg(value_parser = floor, requires = "model")]
    floor: Floor,
    /// Fastest change of a goal, rad/s
    #[arg(long, value_name = "RAD_S", default_value = "2", value_parser = positive)]
    speed: f64,
    /// Kinds of motion: multisine, steps, triangles, holds, drop [default: all, but of a robot in
    /// space no drop]
    #[arg(long, value_name = "KIND,..", value_delimiter = ',', value_parser = kind)]
    motions: Vec<ExcitationKind>,
    /// Duration of each kind, s
    #[arg(long, default_value = "12", value_parser = positive)]
    seconds: f64,
    /// Samples per second
    #[arg(long, default_value = "100", value_parser = positive)]
    hz: f64,
    /// Lowest and highest frequency of the multisine, Hz
    #[arg(long, value_name = "LOW..HIGH", default_value = "0.2..3")]
    band: String,
    /// Seed of phases, levels and poses
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Height of a plane, m, or none.
#[derive(Debug, Clone, Copy)]
struct Floor(Option<f64>);

fn floor(text: &str) -> Result<Floor, String> {
    let height = || text.parse().ok().filter(|height: &f64| height.is_finite());
    match text {
        "none" => Ok(Floor(None)),
        _ => height().map_or(Err("write a height in m, or none".to_string()), |height| {
            Ok(Floor(Some(height)))
        }),
    }
}

fn kind(text: &str) -> Result<ExcitationKind, String> {
    let found = EXCITATION_KINDS
        .into_iter()
        .find(|kind| kind.name() == text);
    let names = EXCITATION_KINDS.map(ExcitationKind::name).join(", ");
    found.ok_or_else(|| format!("`{text}` is no kind of motion: {names}"))
}

impl ExciteArgs {
    fn kinds(&self) -> Vec<ExcitationKind> {
        let mut kinds = match self.motions.as_slice() {
            [] => EXCITATION_KINDS.to_vec(),
            named => named.to_vec(),
        };
        kinds.sort_unstable();
        kinds
    }

    fn plan(&self, joints: &str) -> Result<ExcitePlan> {
        let joints: Vec<&str> = joints.split('/').collect();
        let angles = self.angles.as_deref().unwrap_or(ANGLES);
        let angles = ranges("angles", angles, joints.len())?;
        let limits = joints
            .iter()
            .zip(angles)
            .map(|(text, (low_rad, high_rad))| {
                let servos: Option<Vec<u8>> = ids(text).collect();
                let servos = servos.ok_or_else(|| {
                    Error::usage(
                        format!("--joints: `{text}` names no servos"),
                        "join those of a joint by +, part joints by /: 1+2/11+12",
                    )
                })?;
                Ok(JointLimits {
                    servos,
                    low_rad,
                    high_rad,
                    speed_rad_s: self.speed,
                })
            });
        Ok(ExcitePlan {
            joints: limits.collect::<Result<_>>()?,
            kinds: self.kinds(),
            each_s: self.seconds,
            hz: self.hz,
            band_hz: range("band", &self.band)?,
            seed: self.seed,
        })
    }

    /// Motions for the drives of a model.
    fn of_model(&self, model: &Model) -> Result<FirstMotions> {
        let (_, reach_rad) = range("angles", ANGLES)?;
        let mut limits = ExperimentLimits::of_model(model, (reach_rad, self.speed), self.hz);
        limits.clearance = limits.clearance.map(|all| all.over(self.floor.0));
        if let Some(text) = &self.angles {
            let angles = ranges("angles", text, model.link_count())?;
            (limits.low_rad, limits.high_rad) = angles.into_iter().unzip();
        }
        let (mut kinds, band_hz) = (self.kinds(), range("band", &self.band)?);
        // Whatever falls there falls onto what it stands on.
        if self.motions.is_empty() && model.is_in_space() {
            kinds.retain(|kind| *kind != ExcitationKind::Drop);
        }
        first_motions(model, &limits, (&kinds, self.seconds), band_hz, self.seed)
    }

    fn data(&self, excitation: &Excitation) -> Value {
        json!({
            "file": self.file.display().to_string(),
            "seconds": excitation.seconds(),
            "samples": excitation.time_s.len(),
            "hz": self.hz,
            "seed": self.seed,
            "motions": excitation.motions,
        })
    }
}

/// Angles of joints of which nothing is known, rad.
const ANGLES: &str = "-0.5..0.5";

/// Writes the motions.
pub fn run(args: &ExciteArgs, console: &Console) -> Result<ExitStatus> {
    output::vacant(&args.file, args.force)?;
    if let Some(file) = &args.model {
        return run_model(args, &input::model(file)?, console);
    }
    let excitation = excite(&args.plan(args.joints.as_deref().unwrap_or_default())?)?;
    output::write_new(&args.file, &excitation.to_csv(), args.force)?;
    let mut data = args.data(&excitation);
    data["joints"] = json!(excitation.extents());
    let called = |joint: &JointExtent| {
        let servos: Vec<String> = joint.servos.iter().map(u8::to_string).collect();
        format!("servos {}", servos.join("+"))
    };
    console.result(&data, || text(args, &excitation, called))?;
    Ok(ExitStatus::Done)
}

/// The same for the drives of a model.
fn run_model(args: &ExciteArgs, model: &Model, console: &Console) -> Result<ExitStatus> {
    model.hinges_only("motions are for servos that turn")?;
    let found = args.of_model(model)?;
    let called = |joint: &JointExtent| {
        let number = usize::from(joint.servos[0]);
        let name = model.joint_name(number - 1);
        name.map_or_else(|| format!("joint {number}"), str::to_string)
    };
    let comments = ["Move the rig slowly to the first goals before this plays.".to_string()];
    let csv = to_csv(&found.motion, &inputs_alone(model), &comments);
    output::write_new(&args.file, &csv, args.force)?;
    let mut data = args.data(&found.excitation);
    data["width"] = json!(found.width);
    let joints = found.excitation.extents().into_iter().map(|joint| {
        json!({
            "joint": called(&joint),
            "lowest_rad": joint.lowest_rad,
            "highest_rad": joint.highest_rad,
            "fastest_rad_s": joint.fastest_rad_s,
        })
    });
    data["joints"] = joints.collect();
    console.result(&data, || {
        let width = percent(found.width);
        text(args, &found.excitation, called)
            + &format!(
                "\nover {width} of the ranges, the widest on which the model keeps its limits"
            )
    })?;
    Ok(ExitStatus::Done)
}

fn text(
    args: &ExciteArgs,
    excitation: &Excitation,
    called: impl Fn(&JointExtent) -> String,
) -> String {
    let mut lines = vec![format!(
        "{}: {:.1} s",
        args.file.display(),
        excitation.seconds()
    )];
    for motion in &excitation.motions {
        let (kind, begin_s, end_s) = (motion.kind.name(), motion.begin_s, motion.end_s);
        lines.push(format!("  {kind:10} {begin_s:6.1} to {end_s:6.1} s"));
    }
    for joint in excitation.extents() {
        lines.push(format!(
            "  {}: {:.2} to {:.2} rad, up to {:.2} rad/s",
            called(&joint),
            joint.lowest_rad,
            joint.highest_rad,
            joint.fastest_rad_s
        ));
    }
    lines.join("\n")
}
