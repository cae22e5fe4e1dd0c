//! A Parquet file's footer and the headers of its pages, judged before the library reads them.
//!
//! The library reserves memory for as many children as a group states, descends into groups by
//! recursion, and passes over as many truth values as a list states: a few bytes could ask for
//! gigabytes, overflow the stack or take seconds.

use super::varint::{varint, zigzag};
use crate::table::Broken;

/// Deepest nesting of groups; lists of structures of lists take six.
const DEEPEST: usize = 32;
/// Fields of the file's metadata: its version, and the elements of its schema.
const VERSION: i64 = 1;
const SCHEMA: i64 = 2;
/// Fields of an element: its name, the count of its children, its logical type, which is the last.
const NAME: i64 = 4;
const CHILDREN: i64 = 5;
const LOGICAL: i64 = 10;
/// Types of Thrift's compact protocol.
const TRUE: u8 = 1;
const FALSE: u8 = 2;
const BYTE: u8 = 3;
const I16: u8 = 4;
const I64: u8 = 6;
const I32: u8 = 5;
const DOUBLE: u8 = 7;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const STRUCTURE: u8 = 12;

/// Why types are refused that Parquet does not use.
const STRANGE: Broken = "its description holds what no file does";

/// Judges the metadata of a file.
///
/// # Errors
/// What is cut short; a schema that does not come first, is too deep, or states more children than
/// it has.
pub(super) fn judge(metadata: &[u8]) -> Result<(), Broken> {
    let mut footer = Footer { left: metadata };
    let mut id = 0;
    let mut has_schema = false;
    while let Some(kind) = footer.field(&mut id)? {
        match (id, kind) {
            (SCHEMA, LIST) if !has_schema => {
                nested(&footer.children()?)?;
                has_schema = true;
            }
            (VERSION, I32) => footer.skip(kind, 0)?,
            _ if has_schema => footer.skip(kind, 0)?,
            _ => return Err("its schema does not come first"),
        }
    }
    match has_schema {
        true => Ok(()),
        false => Err("it holds no schema"),
    }
}

/// Judges the header of a page, which begins there.
///
/// # Errors
/// What is cut short, or holds what no header does.
pub(super) fn judge_header(page: &[u8]) -> Result<(), Broken> {
    Footer { left: page }.skip(STRUCTURE, 0)
}

/// Whether so many children, element after element in preorder, are no deeper and no more than the
/// elements there are.
fn nested(children: &[i64]) -> Result<(), Broken> {
    let mut open: Vec<i64> = Vec::new();
    for count in children {
        while open.last() == Some(&0) {
            open.pop();
        }
        if let Some(left) = open.last_mut() {
            *left -= 1;
        }
        if *count > children.len() as i64 || *count < 0 {
            return Err("its schema states more columns than it names");
        }
        if *count > 0 {
            open.push(*count);
        }
        if open.len() > DEEPEST {
            return Err("its columns are nested too deeply");
        }
    }
    Ok(())
}

/// The bytes not yet read.
struct Footer<'a> {
    left: &'a [u8],
}

impl Footer<'_> {
    /// For each element of the schema how many children it states.
    fn children(&mut self) -> Result<Vec<i64>, Broken> {
        match self.list()? {
            (STRUCTURE, count) => (0..count).map(|_| self.element()).collect(),
            _ => Err("its schema is none"),
        }
    }

    /// The type of a list's elements, and how many there are; each takes a byte at least.
    fn list(&mut self) -> Result<(u8, u64), Broken> {
        let head = self.byte()?;
        let count = match head >> 4 {
            15 => varint(&mut self.left)?,
            count => u64::from(count),
        };
        match count <= self.left.len() as u64 {
            true => Ok((head & 0xf, count)),
            false => Err("its description is cut short"),
        }
    }

    fn element(&mut self) -> Result<i64, Broken> {
        let (mut id, mut children) = (0, 0);
        while let Some(kind) = self.field(&mut id)? {
            // The library does not look at the type of a field that it knows.
            match (id, kind) {
                (CHILDREN, I32) => children = zigzag(&mut self.left)?.max(children),
                (NAME, BINARY) | (LOGICAL, STRUCTURE) => self.skip(kind, 0)?,
                (1..LOGICAL, I32) if id != NAME => self.skip(kind, 0)?,
                (1..=LOGICAL, _) => return Err("a column is described by other types of fields"),
                _ => self.skip(kind, 0)?,
            }
        }
        Ok(children)
    }

    /// The type of the next field, and its number; none at the end of the structure.
    fn field(&mut self, id: &mut i64) -> Result<Option<u8>, Broken> {
        let head = self.byte()?;
        if head == 0 {
            return Ok(None);
        }
        *id = match head >> 4 {
            0 => zigzag(&mut self.left)?,
            step => id.saturating_add(i64::from(step)),
        };
        Ok(Some(head & 0xf))
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Result<(), Broken> {
        match kind {
            TRUE | FALSE => Ok(()),
            BYTE => self.byte().map(drop),
            I16 | I32 | I64 => varint(&mut self.left).map(drop),
            DOUBLE => self.bytes(8),
            BINARY => {
                let length = varint(&mut self.left)?;
                self.bytes(length)
            }
            STRUCTURE if depth < DEEPEST => {
                let mut id = 0;
                while let Some(kind) = self.field(&mut id)? {
                    self.skip(kind, depth + 1)?;
                }
                Ok(())
            }
            LIST if depth < DEEPEST => match self.list()? {
                (TRUE | FALSE, _) => Err(STRANGE),
                (kind, count) => (0..count).try_for_each(|_| self.skip(kind, depth + 1)),
            },
            _ => Err(STRANGE),
        }
    }

    fn byte(&mut self) -> Result<u8, Broken> {
        let (first, rest) = self
            .left
            .split_first()
            .ok_or("its description is cut short")?;
        self.left = rest;
        Ok(*first)
    }

    fn bytes(&mut self, count: u64) -> Result<(), Broken> {
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        self.left = self
            .left
            .get(count..)
            .ok_or("its description is cut short")?;
        Ok(())
    }
}
