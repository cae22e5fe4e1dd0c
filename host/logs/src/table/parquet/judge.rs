//! Descriptions in a Parquet file, its footer and the headers of its pages, judged before the
//! library reads them.
//!
//! The library reserves memory for as many children as a group states and for bytes of any length,
//! and descends into groups by recursion: a few bytes could ask for gigabytes or overflow the
//! stack, which no unwinding catches.

use crate::table::Broken;

/// Deepest nesting; lists of structures of lists take six.
const DEEPEST: usize = 32;
/// Field of the file's metadata: the elements of its schema.
const SCHEMA: i64 = 2;
/// Field of an element: the count of its children.
const CHILDREN: i64 = 5;
/// Types of Thrift's compact protocol.
const TRUE: u8 = 1;
const FALSE: u8 = 2;
const BYTE: u8 = 3;
const I16: u8 = 4;
const I32: u8 = 5;
const I64: u8 = 6;
const DOUBLE: u8 = 7;
const BINARY: u8 = 8;
const LIST: u8 = 9;
const STRUCTURE: u8 = 12;

const CUT: Broken = "its description is cut short";
const STRANGE: Broken = "its description holds what no file does";

/// Judges the metadata of a file.
///
/// # Errors
/// What is cut short; a schema that is too deep, or states more children than it has.
pub(super) fn judge(metadata: &[u8]) -> Result<(), Broken> {
    let mut left = Description(metadata);
    left.fields(|left, id, kind| match (id, kind) {
        (SCHEMA, LIST) => nested(&left.children()?),
        (SCHEMA, _) => Err(STRANGE),
        _ => left.skip(kind, 0),
    })
}

/// Judges the header of a page, which begins there.
///
/// # Errors
/// What is cut short, or holds what no header does.
pub(super) fn judge_header(page: &[u8]) -> Result<(), Broken> {
    Description(page).skip(STRUCTURE, 0)
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
struct Description<'a>(&'a [u8]);

impl Description<'_> {
    /// Hands over number and type of each field of a structure.
    fn fields(
        &mut self,
        mut take: impl FnMut(&mut Self, i64, u8) -> Result<(), Broken>,
    ) -> Result<(), Broken> {
        let mut id = 0;
        loop {
            let head = self.byte()?;
            id = match head >> 4 {
                _ if head == 0 => return Ok(()),
                0 => self.zigzag()?,
                step => i64::saturating_add(id, step.into()),
            };
            take(self, id, head & 0xf)?;
        }
    }

    /// For each element of the schema how many children it states.
    fn children(&mut self) -> Result<Vec<i64>, Broken> {
        let (kind, count) = self.list()?;
        let mut element = || {
            let mut children = 0;
            self.fields(|left, id, kind| match (id, kind) {
                (CHILDREN, I32) => left.zigzag().map(|count| children = count.max(children)),
                // The library does not look at the type of a field that it knows.
                (CHILDREN, _) => Err(STRANGE),
                _ => left.skip(kind, 0),
            })?;
            Ok(children)
        };
        match kind {
            STRUCTURE => (0..count).map(|_| element()).collect(),
            _ => Err(STRANGE),
        }
    }

    /// The type of a list's elements, and how many there are; each takes a byte at least.
    fn list(&mut self) -> Result<(u8, u64), Broken> {
        let head = self.byte()?;
        let count = match head >> 4 {
            15 => self.varint()?,
            count => count.into(),
        };
        if count <= self.0.len() as u64 {
            Ok((head & 0xf, count))
        } else {
            Err(CUT)
        }
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Result<(), Broken> {
        match kind {
            TRUE | FALSE => Ok(()),
            BYTE => self.byte().map(drop),
            I16 | I32 | I64 => self.varint().map(drop),
            DOUBLE => self.bytes(8),
            BINARY => {
                let length = self.varint()?;
                self.bytes(length)
            }
            STRUCTURE if depth < DEEPEST => self.fields(|left, _, kind| left.skip(kind, depth + 1)),
            LIST if depth < DEEPEST => match self.list()? {
                // Truth values that a field would hold in its own type.
                (TRUE | FALSE, _) => Err(STRANGE),
                (kind, count) => (0..count).try_for_each(|_| self.skip(kind, depth + 1)),
            },
            _ => Err(STRANGE),
        }
    }

    fn byte(&mut self) -> Result<u8, Broken> {
        let (first, rest) = self.0.split_first().ok_or(CUT)?;
        self.0 = rest;
        Ok(*first)
    }

    fn bytes(&mut self, count: u64) -> Result<(), Broken> {
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        self.0 = self.0.get(count..).ok_or(CUT)?;
        Ok(())
    }

    fn varint(&mut self) -> Result<u64, Broken> {
        let mut value = 0;
        for place in 0..10 {
            let byte = self.byte()?;
            value |= u64::from(byte & 0x7f) << (7 * place);
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err(STRANGE)
    }

    fn zigzag(&mut self) -> Result<i64, Broken> {
        let value = self.varint()?;
        Ok((value >> 1) as i64 ^ -((value & 1) as i64))
    }
}
