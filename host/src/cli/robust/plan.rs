//! Gains of a file.

use handstand::error::Place;
use handstand::synth::Discrete;
use handstand::{Error, Result};
use nalgebra::DMatrix;
use std::path::Path;

/// The gains K of u = -K x that `handstand gains --json` wrote into `file`, for this plant; gains
/// that know nothing of its past inputs have no part in them.
///
/// # Errors
/// A file that cannot be read, or gains for another robot.
pub fn gain(file: &Path, plant: &Discrete) -> Result<DMatrix<f64>> {
    let text = std::fs::read_to_string(file).map_err(|error| Error::file(file, "read", error))?;
    let refused = |line: usize, what: String| {
        let remedy = "give what `handstand gains MODEL --json` prints for this model";
        Error::data(Place::at(file, line, 1), what, remedy)
    };
    let data: serde_json::Value = serde_json::from_str(&text)
        .map_err(|error| refused(error.line(), format!("this is no JSON: {error}")))?;
    let rows: Option<Vec<Vec<f64>>> = serde_json::from_value(data["k"].clone()).ok();
    let rows = rows.ok_or_else(|| refused(1, "there are no gains `k`, a list of rows".into()))?;
    let (inputs, size) = (plant.b.ncols(), plant.a.nrows());
    let states = size - inputs * plant.delayed_inputs;
    let columns = rows.first().map_or(0, Vec::len);
    let is_even = rows.iter().all(|row| row.len() == columns);
    if rows.len() != inputs || !is_even || (columns != states && columns != size) {
        return Err(refused(
            1,
            format!(
                "`k` has {} rows of {columns}; this model has {inputs} inputs and {states} states, \
                 with its past inputs {size}",
                rows.len()
            ),
        ));
    }
    let k = DMatrix::from_fn(inputs, columns, |i, j| rows[i][j]);
    Ok(k.resize_horizontally(size, 0.0))
}
