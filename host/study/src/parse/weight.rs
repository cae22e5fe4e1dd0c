//! Weights in a study's file: a number, a diagonal, or a matrix.

use crate::error::Result;
use crate::model::Limits;
use crate::model::reader::Table;
use crate::synth::Weight;
use nalgebra::DMatrix;

/// The weight under `key`, if there is one: a number within `limits`, or a list, which the design
/// checks against the plant.
pub(super) fn weight(
    table: &Table<'_>,
    key: &'static str,
    limits: Limits,
) -> Result<Option<Weight>> {
    if !table.is_list(key) {
        return Ok(table.number(key, limits)?.map(Weight::Scalar));
    }
    let Some(rows) = table.rows(key)? else {
        return Ok(None);
    };
    let size = rows.len();
    Ok(Some(match &rows[..] {
        [row] => Weight::Diagonal(row.clone()),
        rows if rows.iter().all(|row| row.len() == size) => {
            Weight::Matrix(DMatrix::from_fn(size, size, |i, j| rows[i][j]))
        }
        _ => {
            return Err(table.bad(
                key,
                format!("`{key}` is no square matrix"),
                "give a number, a diagonal such as [100, 100, 1, 1], or as many rows as columns",
            ));
        }
    }))
}
