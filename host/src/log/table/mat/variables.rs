//! Variables of a MATLAB file, and the columns that they are.

use crate::log::table::{Broken, LogTable, MOST_CELLS};
use std::collections::BTreeMap;

/// A variable's numbers, column by column.
struct Variable {
    name: String,
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

/// All of a file.
#[derive(Default)]
pub(super) struct MatVariables {
    variables: Vec<Variable>,
    left_out: Vec<(String, &'static str)>,
    cells: usize,
}

impl MatVariables {
    /// Counts the numbers of a variable before they are read.
    ///
    /// # Errors
    /// More than a table may have.
    pub fn spend(&mut self, count: usize) -> Result<(), Broken> {
        self.cells = self.cells.saturating_add(count);
        match self.cells > MOST_CELLS {
            true => Err("more than 200 million numbers"),
            false => Ok(()),
        }
    }

    /// A matrix, column by column; of one row it is a vector as one of one column is.
    pub fn push(&mut self, name: String, rows: usize, columns: usize, values: Vec<f64>) {
        let (rows, columns) = match rows {
            1 => (columns, 1),
            rows => (rows, columns),
        };
        match values.is_empty() {
            true => self.leave_out(name, "nothing"),
            false => self.variables.push(Variable {
                name,
                rows,
                columns,
                values,
            }),
        }
    }

    /// A variable that holds no numbers of the kind that a log has.
    pub fn leave_out(&mut self, name: String, holds: &'static str) {
        self.left_out.push((name, holds));
    }

    /// Columns as long as most variables are.
    pub fn table(self) -> Option<LogTable> {
        let mut lengths: BTreeMap<usize, usize> = BTreeMap::new();
        for variable in self.variables.iter().filter(|variable| variable.rows > 1) {
            *lengths.entry(variable.rows).or_default() += variable.columns;
        }
        let rows = lengths.into_iter().max_by_key(|(_, count)| *count)?.0;
        let mut table = LogTable {
            left_out: self.left_out,
            ..LogTable::default()
        };
        for mut variable in self.variables {
            if variable.rows == 1 && variable.columns == 1 {
                table.constants.push((variable.name, variable.values[0]));
            } else if variable.rows != rows {
                let holds = "another number of rows than most variables";
                table.left_out.push((variable.name, holds));
            } else if variable.columns == 1 {
                table.names.push(variable.name);
                table.columns.push(variable.values);
            } else {
                for column in 1..=variable.columns {
                    let rest = variable.values.split_off(rows);
                    table.names.push(format!("{}_{column}", variable.name));
                    table
                        .columns
                        .push(std::mem::replace(&mut variable.values, rest));
                }
            }
        }
        Some(table)
    }
}
