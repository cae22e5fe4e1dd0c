//! `handstand excite MOTION.csv --joints 1+2/11+12`: the motions that a measurement needs, for
//! `replay`.
//!
//! ```console
//! $ handstand excite train.csv --joints 1+2/11+12 --angles -0.6..0.6 --speed 2 --seed 1
//! $ handstand replay train.csv --stream --record train_log.csv
//! ```
//!
//! Multisine, steps, slow triangles, holds, then a drop with torque off, one after the other, each
//! from and to the middle of the ranges. Servos of one joint are joined by `+`, those after the
//! first face the other way; joints are parted by `/`, as are their angles where they differ. The
//! file is CSV: `time_s`, `goal1_rad` for each servo, and `torque_on` where torque goes off. Equal
//! arguments give equal bytes.
//!
//! Limits that no servo can be held within are refused, and so is too little time.
//!
//! `--json` prints `file`, `seconds`, `samples`, `hz`, `seed`, `motions` (`kind`, `begin_s`,
//! `end_s`), `joints` (`servos`, `lowest_rad`, `highest_rad`, `fastest_rad_s`).

use super::input::{positive, range};
use super::{Console, ExitStatus};
use handstand::experiment::excite::{
    EXCITATION_KINDS, Excitation, ExcitationKind, ExcitePlan, JointLimits, excite,
};
use handstand::{Error, Result, output};
use handstand_shared::dynamixel::ids;
use serde_json::json;
use std::path::PathBuf;

/// Which motions, within which limits.
#[derive(Debug, clap::Args)]
pub struct ExciteArgs {
    /// File to write, .csv
    file: PathBuf,
    /// Servos of each joint, from the base outwards
    #[arg(long, value_name = "1+2/11+12")]
    joints: String,
    /// Lowest and highest angle, rad: for all joints, or for each
    #[arg(long, value_name = "LOW..HIGH[/..]", default_value = "-0.5..0.5")]
    #[arg(allow_hyphen_values = true)]
    angles: String,
    /// Fastest change of a goal, rad/s
    #[arg(long, value_name = "RAD_S", default_value = "2", value_parser = positive)]
    speed: f64,
    /// Kinds of motion: multisine, steps, triangles, holds, drop
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

fn kind(text: &str) -> Result<ExcitationKind, String> {
    let found = EXCITATION_KINDS
        .into_iter()
        .find(|kind| kind.name() == text);
    let names = EXCITATION_KINDS.map(ExcitationKind::name).join(", ");
    found.ok_or_else(|| format!("`{text}` is no kind of motion: {names}"))
}

impl ExciteArgs {
    fn plan(&self) -> Result<ExcitePlan> {
        let joints: Vec<&str> = self.joints.split('/').collect();
        let angles: Vec<&str> = self.angles.split('/').collect();
        if angles.len() != 1 && angles.len() != joints.len() {
            return Err(Error::usage(
                format!("{} ranges for {} joints", angles.len(), joints.len()),
                "give one range for all joints, or one for each",
            ));
        }
        let limits = joints.iter().enumerate().map(|(at, text)| {
            let servos: Option<Vec<u8>> = ids(text).collect();
            let servos = servos.ok_or_else(|| {
                Error::usage(
                    format!("--joints: `{text}` names no servos"),
                    "join those of a joint by +, part joints by /: 1+2/11+12",
                )
            })?;
            let (low_rad, high_rad) = range("angles", angles.get(at).unwrap_or(&angles[0]))?;
            Ok(JointLimits {
                servos,
                low_rad,
                high_rad,
                speed_rad_s: self.speed,
            })
        });
        let mut kinds = match self.motions.as_slice() {
            [] => EXCITATION_KINDS.to_vec(),
            named => named.to_vec(),
        };
        kinds.sort_unstable();
        Ok(ExcitePlan {
            joints: limits.collect::<Result<_>>()?,
            kinds,
            each_s: self.seconds,
            hz: self.hz,
            band_hz: range("band", &self.band)?,
            seed: self.seed,
        })
    }
}

/// Writes the motions.
pub fn run(args: &ExciteArgs, console: &Console) -> Result<ExitStatus> {
    output::vacant(&args.file, args.force)?;
    let plan = args.plan()?;
    let excitation = excite(&plan)?;
    output::write_new(&args.file, &excitation.to_csv(), args.force)?;
    let data = json!({
        "file": args.file.display().to_string(),
        "seconds": excitation.seconds(),
        "samples": excitation.time_s.len(),
        "hz": plan.hz,
        "seed": plan.seed,
        "motions": excitation.motions,
        "joints": excitation.extents(),
    });
    console.result(&data, || text(args, &excitation))?;
    Ok(ExitStatus::Done)
}

fn text(args: &ExciteArgs, excitation: &Excitation) -> String {
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
        let servos: Vec<String> = joint.servos.iter().map(u8::to_string).collect();
        lines.push(format!(
            "  servos {}: {:.2} to {:.2} rad, up to {:.2} rad/s",
            servos.join("+"),
            joint.lowest_rad,
            joint.highest_rad,
            joint.fastest_rad_s
        ));
    }
    lines.join("\n")
}
