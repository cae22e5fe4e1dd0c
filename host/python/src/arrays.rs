//! Arrays in and out: a row per joint.

use crate::errors::usage;
use numpy::{AllowTypeChange, PyArray1, PyArray2, PyArrayLike1, PyArrayLike2};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

/// Numbers, one after the other; a column or a row of a table is that, too.
pub fn numbers(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    if let Ok(row) = given.extract::<PyArrayLike1<'_, f64, AllowTypeChange>>() {
        return Ok(row.as_array().iter().copied().collect());
    }
    if let Ok(table) = given.extract::<PyArrayLike2<'_, f64, AllowTypeChange>>() {
        let table = table.as_array();
        if let [1, _] | [_, 1] = table.shape() {
            return Ok(table.iter().copied().collect());
        }
    }
    Err(usage(
        format!("`{name}` is not a row of numbers"),
        "give a one-dimensional array or a list of numbers",
    ))
}

/// A row per joint; a single row is that of one joint, and so is a column of so many samples.
pub fn rows(
    name: &str,
    given: &Bound<'_, PyAny>,
    samples: Option<usize>,
) -> PyResult<Vec<Vec<f64>>> {
    if let Ok(array) = given.extract::<PyArrayLike2<'_, f64, AllowTypeChange>>() {
        let table = array.as_array();
        let [height, width] = [table.nrows(), table.ncols()];
        if samples.is_some_and(|samples| height == samples && width != samples) {
            if width == 1 {
                return Ok(vec![table.iter().copied().collect()]);
            }
            return Err(usage(
                format!("`{name}` has shape ({height}, {width}): a row per sample"),
                format!("give a row per joint, its transpose `{name}.T`"),
            ));
        }
        let rows = table.outer_iter();
        return Ok(rows.map(|row| row.iter().copied().collect()).collect());
    }
    if let Ok(row) = numbers(name, given) {
        return Ok(vec![row]);
    }
    Err(usage(
        format!("`{name}` is neither a row of numbers nor a row per joint"),
        "give an array of shape (samples,) or (joints, samples)",
    ))
}

/// A row per joint, `None` for joints without; without anything no joint has one.
pub fn rows_or_none(
    name: &str,
    given: Option<&Bound<'_, PyAny>>,
    joints: usize,
    samples: usize,
) -> PyResult<Vec<Option<Vec<f64>>>> {
    let Some(given) = given else {
        return Ok(vec![None; joints]);
    };
    let is_list = given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>();
    let items: Vec<Bound<'_, PyAny>> = if is_list {
        given.try_iter()?.collect::<PyResult<_>>()?
    } else {
        Vec::new()
    };
    if !items.iter().any(|item| item.is_none()) {
        let rows = rows(name, given, Some(samples))?;
        return Ok(rows.into_iter().map(Some).collect());
    }
    let row = |item: &Bound<'_, PyAny>| {
        if item.is_none() {
            Ok(None)
        } else {
            numbers(name, item).map(Some)
        }
    };
    items.iter().map(row).collect()
}

/// Rows of equal length as an array.
pub fn matrix<'py>(py: Python<'py>, rows: &[Vec<f64>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    Ok(PyArray2::from_vec2(py, rows)?)
}

/// Rows of joints, `None` for those without.
pub fn per_joint<'py>(
    py: Python<'py>,
    rows: &[Option<Vec<f64>>],
) -> Vec<Option<Bound<'py, PyArray1<f64>>>> {
    let array = |row: &Option<Vec<f64>>| row.as_ref().map(|row| PyArray1::from_slice(py, row));
    rows.iter().map(array).collect()
}
