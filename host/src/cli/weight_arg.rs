//! Weights as arguments: `100`, `1,1,0.1`, or a CSV file of a matrix.

use super::input;
use handstand::error::Place;
use handstand::synth::Weight;
use handstand::{Error, Result};
use nalgebra::DMatrix;
use std::path::{Path, PathBuf};

/// A weight as given: numbers, or a file to be read.
#[derive(Debug, Clone)]
pub enum WeightArg {
    /// As they stand.
    Numbers(Weight),
    /// A matrix to be read.
    File(PathBuf),
}

/// Numbers between commas, or a CSV file.
pub fn weight(text: &str) -> Result<WeightArg, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers {
        Ok(numbers) => Ok(WeightArg::Numbers(match numbers[..] {
            [one] => Weight::Scalar(one),
            _ => Weight::Diagonal(numbers),
        })),
        Err(_) if Path::new(text).is_file() => Ok(WeightArg::File(text.into())),
        Err(_) => Err("give a number, numbers between commas, or a CSV file that exists".into()),
    }
}

impl WeightArg {
    /// The weight, its file read.
    ///
    /// # Errors
    /// A file that cannot be read or is no matrix.
    pub fn read(&self) -> Result<Weight> {
        match self {
            WeightArg::Numbers(weight) => Ok(weight.clone()),
            WeightArg::File(path) => matrix(path).map(Weight::Matrix),
        }
    }

    /// One number for each of so many.
    ///
    /// # Errors
    /// As [`WeightArg::read`], or another number of them.
    pub fn list(&self, name: &'static str, size: usize) -> Result<Vec<f64>> {
        Ok(self.read()?.diagonal(name, size)?)
    }
}

/// A matrix from a CSV file, without header.
fn matrix(path: &Path) -> Result<DMatrix<f64>> {
    let text = input::text(path)?;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    for (line, row) in text
        .lines()
        .enumerate()
        .filter(|(_, row)| !row.trim().is_empty())
    {
        let mut values = Vec::new();
        for (column, field) in row.split(',').enumerate() {
            let value = field.trim().parse().map_err(|_| {
                Error::data(
                    Place::at(path, line + 1, column + 1),
                    format!("`{}` is no number", field.trim()),
                    "give a matrix of numbers, a row per line, commas between them, no header",
                )
            })?;
            values.push(value);
        }
        if rows
            .first()
            .is_some_and(|first| first.len() != values.len())
        {
            return Err(Error::data(
                Place::at(path, line + 1, 1),
                format!(
                    "{} numbers where the first row has {}",
                    values.len(),
                    rows[0].len()
                ),
                "give every row the same number of values",
            ));
        }
        rows.push(values);
    }
    let columns = rows.first().map_or(0, Vec::len);
    Ok(DMatrix::from_row_slice(rows.len(), columns, &rows.concat()))
}
