//! MATLAB files of version 5 (`save -v6` and `-v7`): elements, compressed ones among them.

use super::element::{Elements, MatElement, kind};
use super::variables::MatVariables;
use super::{DEEPEST, HEADER, REMEDY, broken};
use crate::error::Result;
use crate::table::{Broken, TableFile};

/// Most bytes that compressed variables may become.
const LARGEST: usize = 2 << 30;
/// Classes of arrays.
const CELL: u32 = 1;
const STRUCTURE: u32 = 2;
const TEXT: u32 = 4;
const SPARSE: u32 = 5;
const DOUBLE: u32 = 6;
const LAST_INTEGER: u32 = 15;
const IS_COMPLEX: u32 = 0x0800;

struct MatReader {
    found: MatVariables,
    /// Bytes that may still be inflated.
    left: usize,
}

pub(super) fn read(bytes: &[u8], file: TableFile) -> Result<MatVariables> {
    let big_endian = match bytes.get(HEADER - 2..HEADER) {
        Some(b"IM") => false,
        Some(b"MI") => true,
        _ => return Err(file.wrong("not a MATLAB file of version 5 or 7.3", REMEDY)),
    };
    let mut reader = MatReader {
        found: MatVariables::default(),
        left: LARGEST,
    };
    let elements = Elements {
        bytes: &bytes[HEADER..],
        big_endian,
    };
    reader.all(elements, 0).map_err(|why| broken(file, why))?;
    Ok(reader.found)
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
        let holds = match flags & 0xff {
            STRUCTURE if count == 1 && depth < DEEPEST => {
                return self.structure(parts, &name, depth);
            }
            STRUCTURE if count > 1 => {
                self.found.leave_out_structures(&name, count);
                return Ok(());
            }
            STRUCTURE => "no structure, or one too deep in others",
            CELL => "cells",
            TEXT => "text",
            SPARSE => "a sparse matrix",
            DOUBLE..=LAST_INTEGER => match (flags & IS_COMPLEX == 0, &sizes[..]) {
                (true, &[rows, columns]) => {
                    return self.numbers(parts.required()?, name, [rows, columns]);
                }
                (false, _) => "complex numbers",
                _ => "more than two dimensions",
            },
            _ => "an object",
        };
        self.found.leave_out(name, holds);
        Ok(())
    }

    fn numbers(
        &mut self,
        element: MatElement,
        name: String,
        [rows, columns]: [usize; 2],
    ) -> Result<(), Broken> {
        let Some(values) = element.numbers() else {
            self.found.leave_out(name, "no numbers");
            return Ok(());
        };
        // Their product does not overflow: it was computed.
        if values.len() != rows * columns {
            return Err("a variable holds another count of numbers than it says");
        }
        self.found.spend(values.len())?;
        self.found.push(name, rows, columns, values);
        Ok(())
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
}
