//! MATLAB files, version 5 (`save -v6` and `-v7`): every numeric variable is a column, or several.
//!
//! A vector is a column of its name; a matrix with as many rows gives `q_1`, `q_2`, .. for its
//! columns. A scalar is a constant. Fields of a structure come as `data.q`. Variables of another
//! length than most, text, cells, complex and sparse numbers are left out.

use super::mat_element::{Broken, DEEPEST, Elements, MatElement, kind};
use super::{MOST_CELLS, Table, TableFile};
use crate::error::Result;
use std::collections::BTreeMap;

/// Before the first element.
const HEADER: usize = 128;
/// Most bytes that compressed variables may become.
const LARGEST: usize = 2 << 30;
/// Classes of arrays.
const CELL: u32 = 1;
const STRUCTURE: u32 = 2;
const DOUBLE: u32 = 6;
const LAST_INTEGER: u32 = 15;
const IS_COMPLEX: u32 = 0x0800;

/// A variable's numbers, column by column.
struct Variable {
    name: String,
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

struct MatReader {
    variables: Vec<Variable>,
    /// Bytes that may still be inflated.
    left: usize,
    cells: usize,
}

pub(super) fn read(bytes: &[u8], file: TableFile) -> Result<Table> {
    let remedy = "save it from MATLAB by save(\"log.mat\", .., \"-v7\"), from Python by \
                  scipy.io.savemat";
    if bytes.get(1..4) == Some(b"HDF") || bytes.starts_with(b"MATLAB 7.3") {
        return Err(file.wrong("a MATLAB file of version 7.3, which is HDF5", remedy));
    }
    let big_endian = match bytes.get(HEADER - 2..HEADER) {
        Some(b"IM") => false,
        Some(b"MI") => true,
        _ => return Err(file.wrong("not a MATLAB file of version 5", remedy)),
    };
    let mut reader = MatReader {
        variables: Vec::new(),
        left: LARGEST,
        cells: 0,
    };
    let elements = Elements {
        bytes: &bytes[HEADER..],
        big_endian,
    };
    reader
        .all(elements, 0)
        .map_err(|why| file.wrong(format!("broken: {why}"), remedy))?;
    reader.table().ok_or_else(|| {
        file.wrong(
            "no variable is a column of numbers",
            "save time and angles as vectors",
        )
    })
}

impl MatReader {
    fn all(&mut self, mut elements: Elements, depth: usize) -> Result<(), Broken> {
        if depth > DEEPEST {
            return Err("compressed too often");
        }
        while let Some(element) = elements.next()? {
            match element.kind {
                kind::COMPRESSED => {
                    let plain = miniz_oxide::inflate::decompress_to_vec_zlib_with_limit(
                        element.data,
                        self.left,
                    );
                    let plain = plain.map_err(|_| "a compressed variable does not inflate")?;
                    self.left -= plain.len();
                    let within = Elements {
                        bytes: &plain,
                        big_endian: elements.big_endian,
                    };
                    self.all(within, depth + 1)?;
                }
                kind::MATRIX => self.array(element, "", 0)?,
                _ => {}
            }
        }
        Ok(())
    }

    fn array(&mut self, array: MatElement, within: &str, depth: usize) -> Result<(), Broken> {
        let mut parts = array.within();
        let Some(flags) = parts.next()? else {
            // An empty field.
            return Ok(());
        };
        let flags = flags
            .words()
            .first()
            .copied()
            .ok_or("a variable lacks its flags")?;
        let sizes: Vec<usize> = parts
            .required()?
            .words()
            .iter()
            .map(|size| *size as usize)
            .collect();
        let own = parts.required()?.text();
        let name = match (within, own.as_str()) {
            ("", own) => own.to_string(),
            (within, _) => within.to_string(),
        };
        let count = sizes
            .iter()
            .try_fold(1usize, |all, size| all.checked_mul(*size));
        let count = count.ok_or("a variable is larger than any memory")?;
        match flags & 0xff {
            STRUCTURE if count == 1 && depth < DEEPEST => self.structure(parts, &name, depth),
            CELL | STRUCTURE => Ok(()),
            DOUBLE..=LAST_INTEGER if flags & IS_COMPLEX == 0 && sizes.len() == 2 => {
                let Some(values) = parts.required()?.numbers() else {
                    return Ok(());
                };
                if values.len() != count {
                    return Err("a variable holds another count of numbers than it says");
                }
                self.cells += count;
                if self.cells > MOST_CELLS {
                    return Err("more than 200 million numbers");
                }
                let (rows, columns) = match sizes[..] {
                    [1, length] => (length, 1),
                    [rows, columns] => (rows, columns),
                    _ => return Ok(()),
                };
                self.variables.push(Variable {
                    name,
                    rows,
                    columns,
                    values,
                });
                Ok(())
            }
            _ => Ok(()),
        }
    }

    fn structure(&mut self, mut parts: Elements, name: &str, depth: usize) -> Result<(), Broken> {
        let length = parts.required()?.words().first().copied().unwrap_or(0) as usize;
        let names = parts.required()?;
        if length == 0 {
            return Ok(());
        }
        for field in names.data.chunks_exact(length) {
            let end = field.iter().position(|byte| *byte == 0).unwrap_or(length);
            let field = String::from_utf8_lossy(&field[..end]);
            let element = parts.required()?;
            if element.kind == kind::MATRIX {
                self.array(element, &format!("{name}.{field}"), depth + 1)?;
            }
        }
        Ok(())
    }

    /// Columns as long as most variables are.
    fn table(self) -> Option<Table> {
        let mut lengths: BTreeMap<usize, usize> = BTreeMap::new();
        for variable in self.variables.iter().filter(|variable| variable.rows > 1) {
            *lengths.entry(variable.rows).or_default() += variable.columns;
        }
        let rows = lengths.into_iter().max_by_key(|(_, count)| *count)?.0;
        let mut table = Table::default();
        for mut variable in self.variables {
            if variable.rows == 1 && variable.columns == 1 {
                table.constants.push((variable.name, variable.values[0]));
            } else if variable.rows == rows && variable.columns == 1 {
                table.names.push(variable.name);
                table.columns.push(variable.values);
            } else if variable.rows == rows {
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
