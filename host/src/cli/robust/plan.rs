//! Gains of a file.

use handstand::error::Place;
use handstand::synth::controllers::GivenGains;
use handstand::synth::{Discrete, StateFeedbackPlan};
use handstand::{Error, Model, Result};
use nalgebra::DMatrix;
use std::path::Path;

/// The gains K of u = -K x, N m, that `handstand gains --json` wrote into `file`, for this plant,
/// sampled every `period_s`; gains that know nothing of its past inputs have no part in them.
///
/// # Errors
/// A file that cannot be read, or gains for another robot, pose or sampling time.
pub fn gain(file: &Path, model: &Model, plant: &Discrete, period_s: f64) -> Result<DMatrix<f64>> {
    let plan = StateFeedbackPlan::load(file, model)?;
    let given = GivenGains::new(&plan, model, period_s)?;
    let (inputs, size) = (plant.b.ncols(), plant.a.nrows());
    let states = size - inputs * plant.delayed_inputs;
    let k = given.k();
    let columns = k.first().map_or(0, Vec::len);
    if columns != states && columns != size {
        let what = format!(
            "`k` has {columns} columns; this model has {states} states, with its past inputs {size}"
        );
        let remedy = "give what `handstand gains MODEL --json` prints for this model";
        return Err(Error::data(Place::file(file), what, remedy));
    }
    let k = DMatrix::from_fn(k.len(), columns, |i, j| k[i][j]);
    Ok(k.resize_horizontally(size, 0.0))
}
