//! Diagnose which physical effect a model lacks, from motions that were measured.
//!
//! ```sh
//! cargo run --release --example diagnose
//! ```

use handstand::challenge::{Hidden, generate};
use handstand::diagnose::{DiagnoseOptions, Diagnosis, diagnose};
use handstand::log::{LogRequest, read};
use handstand::model::JointNames;
use handstand::motion::Motion;
use handstand::report::diagnosis_text;
use handstand::{Error, Model, Result};
use std::path::Path;

fn main() -> Result<()> {
    let diagnosis = viscous_friction_missing()?;
    println!("{}", diagnosis_text(&diagnosis, &JointNames::default()));
    Ok(())
}

/// Diagnoses a bench arm whose model lacks viscous friction; it names the effect, with its value
/// and interval.
pub fn viscous_friction_missing() -> Result<Diagnosis> {
    let bench = generate(2, Hidden::Effect("viscous"));
    let model = Model::parse(&bench.model_toml, Path::new("model.toml"))?;
    let mut motions = motions(&bench.logs, &model)?;

    // An effect counts only if it predicts motions that took no part in its fit: the last one is
    // held out.
    let held_out = motions.split_off(2);
    let options = DiagnoseOptions::default();
    Ok(diagnose(&model, motions, held_out, &options, &|_| {}))
}

/// Reads logs, given as names and contents, as the model declares their columns.
fn motions(logs: &[(String, String)], model: &Model) -> Result<Vec<Motion>> {
    let folder =
        tempfile::tempdir().map_err(|error| Error::file(Path::new("/tmp"), "create", error))?;
    let mut requests = Vec::new();
    for (name, content) in logs {
        let log = folder.path().join(name);
        std::fs::write(&log, content).map_err(|error| Error::file(&log, "write", error))?;
        requests.push(LogRequest::whole(log));
    }
    read(&requests, &model.log)
}
