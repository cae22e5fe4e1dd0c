//! Rigs with their models and logs: bundled, public, simulated.

use handstand::challenge::{Motions, bench};
use handstand::log::{LogRequest, read};
use handstand::motion::Motion;
use handstand::{Model, Result};
use std::path::{Path, PathBuf};

/// A model, and a log as it reads it.
#[derive(Debug, Clone)]
pub struct Rig {
    /// The log's name.
    pub name: String,
    /// The model.
    pub model: Model,
    /// The motions of the log.
    pub motions: Vec<Motion>,
    /// Whether the log holds a run that failed: a position that stands still.
    pub failed_run: bool,
}

/// Model of `host/models`, and the log of `HANDSTAND_DATA`.
const PUBLIC: &[(&str, &str)] = &[
    ("mx106_drop", "mx106_drop/drop.csv:26-139"),
    ("htd45h", "htd45h/sin_sin.csv"),
    ("htd45h", "htd45h/sin_time_square.csv"),
    ("htd45h", "htd45h/up_and_down.csv"),
    ("htd45h", "htd45h/lift_and_drop.csv"),
    ("htd45h_off", "htd45h/lift_and_drop.csv:33-77"),
    ("multiarm_single", "multiarm/single_id.csv"),
    ("multiarm_double", "multiarm/double_id.csv"),
    ("multiarm_triple", "multiarm/triple_id.csv"),
    ("dfki_pendulum", "dfki_pendulum/pd_sysid_measured.csv"),
    ("dfki_pendulum", "dfki_pendulum/ddp_measured.csv"),
    ("dfki_pendulum", FAILED),
    (
        "dfki_pendulum_fft",
        "dfki_pendulum/fft_excitation_measured.csv",
    ),
    (
        "dfki_double",
        "dfki_double/design_A.0_20220815_sys_id_trajectory_00.csv",
    ),
    (
        "dfki_double",
        "dfki_double/design_A.0_20220815_sys_id_trajectory_05.csv",
    ),
    (
        "dfki_double_c",
        "dfki_double/design_C.0_20220914_172144_acrobot_lqr_video_trajectory.csv",
    ),
];

/// The run that failed: its position stands still for 20 s.
const FAILED: &str = "dfki_pendulum/pd_1nm_fail_measured.csv";

fn host() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../host")
}

/// The log that comes with the project.
///
/// # Errors
/// Files that cannot be read.
pub fn bundled() -> Result<Rig> {
    let data = host().join("tests/data");
    rig(
        "arm.csv",
        &data.join("arm.toml"),
        &data.join("arm.csv").to_string_lossy(),
    )
}

/// The public logs of the folder.
///
/// # Errors
/// Files that cannot be read.
pub fn public(folder: &Path) -> Result<Vec<Rig>> {
    let rigs = PUBLIC.iter().map(|(model, log)| {
        let model = host().join(format!("models/{model}.toml"));
        let name = log.rsplit('/').next().unwrap_or(log);
        let mut rig = rig(name, &model, &folder.join(log).to_string_lossy())?;
        rig.failed_run = *log == FAILED;
        Ok(rig)
    });
    rigs.collect()
}

fn rig(name: &str, model: &Path, log: &str) -> Result<Rig> {
    let model = Model::load(model)?;
    let motions = read(&[log.parse::<LogRequest>()?], &model.log)?;
    Ok(Rig {
        name: name.to_string(),
        model,
        motions,
        failed_run: false,
    })
}

/// A virtual rig of this seed that hides one effect: the model its owner believes in, and the
/// first of its logs. None where its files cannot be made.
pub fn simulated(motions: Motions, kind: &'static str, seed: u64) -> Option<Rig> {
    let bench = bench(motions, seed, &[kind])?;
    let folder = tempfile::tempdir().ok()?;
    let model = folder.path().join("model.toml");
    std::fs::write(&model, &bench.model_toml).ok()?;
    let log = bench.logs.iter().find(|log| !log.held_out)?;
    let path = folder.path().join(&log.name);
    std::fs::write(&path, &log.csv).ok()?;
    let name = format!("{} {seed} with {kind}", motions_name(motions));
    rig(&name, &model, &path.to_string_lossy()).ok()
}

fn motions_name(motions: Motions) -> &'static str {
    match motions {
        Motions::Arm => "bench arm",
        Motions::Hanging => "hanging robot",
        Motions::Balancing => "balancing robot",
    }
}
