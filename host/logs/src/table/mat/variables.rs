//! Variables of a MATLAB file, and the columns that they are.

use crate::init::{Role, name_guess};
use crate::output::shortened;
use crate::table::{Broken, LogTable, MOST_CELLS};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Most columns of a matrix: a name and a list for each of millions take more memory than numbers.
const MOST_COLUMNS: usize = 4096;

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
    left_out: Vec<(String, Cow<'static, str>)>,
    /// Arrays of structures, and how many each holds.
    structures: Vec<(String, usize)>,
    cells: usize,
}

impl MatVariables {
    /// Counts the numbers of a variable before they are read.
    ///
    /// # Errors
    /// More than a table may have.
    pub fn spend(&mut self, count: usize) -> Result<(), Broken> {
        self.cells = self.cells.saturating_add(count);
        if self.cells > MOST_CELLS {
            Err("more than 200 million numbers")
        } else {
            Ok(())
        }
    }

    /// A matrix, column by column; of one row it is a vector as one of one column is.
    pub fn push(&mut self, name: String, rows: usize, columns: usize, values: Vec<f64>) {
        let (rows, columns) = match rows {
            1 => (columns, 1),
            rows => (rows, columns),
        };
        if values.is_empty() {
            self.leave_out(name, "nothing");
        } else if columns > MOST_COLUMNS {
            self.leave_out(name, "more than 4096 columns");
        } else {
            self.variables.push(Variable {
                name,
                rows,
                columns,
                values,
            });
        }
    }

    /// A variable that holds no numbers of the kind that a log has.
    pub fn leave_out(&mut self, name: String, holds: &'static str) {
        self.left_out.push((name, holds.into()));
    }

    /// An array of structures, of which none is the log.
    pub fn leave_out_structures(&mut self, name: &str, count: usize) {
        if self.structures.iter().all(|(known, _)| known != name) {
            let holds = format!("an array of {count} structures");
            self.left_out.push((name.to_string(), holds.into()));
            self.structures.push((name.to_string(), count));
        }
    }

    /// What to say of a file without a column of numbers, and what to do.
    pub fn without_columns(&self) -> (String, String) {
        let Some((name, count)) = self.structures.first() else {
            let holds = self.left_out.iter().take(5);
            let holds: Vec<String> = holds
                .map(|(name, holds)| format!("; `{}` holds {holds}", shortened(name)))
                .collect();
            let what = format!("no variable is a column of numbers{}", holds.concat());
            return (what, "save time and angles as vectors".into());
        };
        let what = format!("`{}` is an array of {count} structures", shortened(name));
        let remedy = format!("save one of them: s = {name}(1); save('log.mat', '-struct', 's')");
        (what, remedy)
    }

    /// Columns as long as the variable `time`, where there is one of that name; else as the longest
    /// one that is a time by its name and only grows, else as those that hold most numbers.
    pub fn table(self, time: Option<&str>) -> Option<LogTable> {
        let rows = self.rows(time)?;
        let mut table = LogTable {
            left_out: self.left_out,
            ..LogTable::default()
        };
        for variable in self.variables {
            if variable.rows == 1 && variable.columns == 1 {
                table.constants.push((variable.name, variable.values[0], 1));
            } else if variable.rows != rows {
                let own = variable.rows;
                let holds =
                    format!("{own} rows, another number of rows than the {rows} of the log");
                table.left_out.push((variable.name, holds.into()));
            } else if variable.columns == 1 {
                table.names.push(variable.name);
                table.columns.push(variable.values);
            } else {
                for (column, values) in (1..).zip(variable.values.chunks_exact(rows)) {
                    table.names.push(format!("{}_{column}", variable.name));
                    table.columns.push(values.to_vec());
                }
            }
        }
        Some(table)
    }

    fn rows(&self, time: Option<&str>) -> Option<usize> {
        let long = || self.variables.iter().filter(|variable| variable.rows > 1);
        let is_time = |variable: &&Variable| {
            variable.columns == 1
                && name_guess(&variable.name).role == Some(Role::Time)
                && variable.values.is_sorted_by(|a, b| a < b)
        };
        let named = long().find(|variable| {
            let numbered = |time: &str| {
                let number = time.strip_prefix(&variable.name)?.strip_prefix('_')?;
                number.parse::<usize>().ok()
            };
            time.is_some_and(|time| variable.name == time || numbered(time).is_some())
        });
        let longest = || long().filter(is_time).map(|time| time.rows).max();
        if let Some(rows) = named.map(|variable| variable.rows).or_else(longest) {
            return Some(rows);
        }
        let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
        for variable in long() {
            *numbers.entry(variable.rows).or_default() += variable.values.len();
        }
        numbers
            .into_iter()
            .max_by_key(|(_, count)| *count)
            .map(|(rows, _)| rows)
    }
}
