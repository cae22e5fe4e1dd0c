//! Compare a model with measured motions: how far is its prediction off, and where?
//!
//! ```sh
//! cargo run --release --example compare
//! ```

use handstand::challenge::{Hidden, generate};
use handstand::compare::{Comparison, compare, text};
use handstand::log::{LogRequest, read};
use handstand::model::JointNames;
use handstand::{Error, Model, Result};
use std::path::Path;

fn main() -> Result<()> {
    let compared = backlash_missing()?;
    println!("{}", text(&[compared], &JointNames::default()));
    Ok(())
}

/// A bench arm with backlash against its model, which has none.
pub fn backlash_missing() -> Result<Comparison> {
    // A simulated bench stands in for yours: it writes the logs and the model its owner believes
    // in.
    let bench = generate(1, Hidden::Effect("backlash"));
    let folder =
        tempfile::tempdir().map_err(|error| Error::file(Path::new("/tmp"), "create", error))?;
    let (name, content) = &bench.logs[0];
    let log = folder.path().join(name);
    std::fs::write(&log, content).map_err(|error| Error::file(&log, "write", error))?;

    // The model says which columns the log has, in which units.
    let model = Model::parse(&bench.model_toml, Path::new("model.toml"))?;
    let motions = read(&[LogRequest::whole(log)], &model.log)?;

    // Nothing is fitted but the state in which each run starts. Without a horizon the model runs
    // freely over whole motions where a small start error does not swamp it.
    Ok(compare(&model, "model.toml", &motions, None))
}
