//! A square matrix as people give it: one number, a diagonal, or all of it.

use super::error::DesignError;
use super::weights::other_size;
use nalgebra::DMatrix;
use std::fmt;

/// What mends a list of another length.
const ONE_FOR_EACH: &str = "give one number for all, or one for each";

/// One number stands for that times the identity.
#[derive(Debug, Clone, PartialEq)]
pub enum Weight {
    /// Times the identity.
    Scalar(f64),
    /// The diagonal; nothing beside it.
    Diagonal(Vec<f64>),
    /// All of it.
    Matrix(DMatrix<f64>),
}

impl Weight {
    /// The size it has of its own.
    pub fn size(&self) -> Option<usize> {
        match self {
            Weight::Scalar(_) => None,
            Weight::Diagonal(values) => Some(values.len()),
            Weight::Matrix(matrix) => Some(matrix.nrows()),
        }
    }

    /// The matrix for so many states (inputs, ..); `name` is what errors call it.
    ///
    /// # Errors
    /// Another size.
    pub fn matrix(
        &self,
        name: &'static str,
        size: usize,
        of: &'static str,
    ) -> Result<DMatrix<f64>, DesignError> {
        match self {
            Weight::Scalar(value) => Ok(DMatrix::from_diagonal_element(size, size, *value)),
            Weight::Diagonal(values) if values.len() == size => {
                Ok(DMatrix::from_diagonal(&values.clone().into()))
            }
            Weight::Matrix(matrix) if matrix.shape() == (size, size) => Ok(matrix.clone()),
            Weight::Diagonal(values) => Err(DesignError::request(
                format!(
                    "{name} has {} values, but there are {size} {of}",
                    values.len()
                ),
                ONE_FOR_EACH,
            )),
            Weight::Matrix(matrix) => Err(other_size(name, matrix, size, of)),
        }
    }

    /// One value for each of so many.
    ///
    /// # Errors
    /// Another number of them, or a whole matrix.
    pub fn diagonal(&self, name: &'static str, size: usize) -> Result<Vec<f64>, DesignError> {
        match self {
            Weight::Scalar(value) => Ok(vec![*value; size]),
            Weight::Diagonal(values) if values.len() == size => Ok(values.clone()),
            _ => Err(DesignError::request(
                format!(
                    "{name} has {} values, but {size} are needed",
                    self.size().unwrap_or(1)
                ),
                ONE_FOR_EACH,
            )),
        }
    }
}

impl fmt::Display for Weight {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |values: &[f64]| {
            let values: Vec<String> = values.iter().map(f64::to_string).collect();
            values.join(",")
        };
        match self {
            Weight::Scalar(value) => write!(f, "{value}"),
            Weight::Diagonal(values) => f.write_str(&list(values)),
            Weight::Matrix(matrix) => {
                let row = |row| list(matrix.row(row).transpose().as_slice());
                let rows: Vec<String> = (0..matrix.nrows()).map(row).collect();
                f.write_str(&rows.join(";"))
            }
        }
    }
}
