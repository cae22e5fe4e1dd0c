//! MATLAB files of version 7.3 (`save -v7.3`): HDF5, whose groups are structures.
//!
//! HDF5 counts dimensions the other way round, so a matrix stands there column by column. The
//! attribute `MATLAB_class` says what a variable is.

use super::number::MatNumber;
use super::variables::MatVariables;
use super::{DEEPEST, broken};
use crate::error::Result;
use crate::table::TableFile;
use bytes::Bytes;
use hdf5_reader::error::{ByteOrder, Error as Hdf5Error};
use hdf5_reader::group::Group;
use hdf5_reader::{Attribute, Dataset, Datatype, Hdf5File, OpenOptions};

/// Bytes that the variables of any file may have, and that they may have per byte of it: no packing
/// of MATLAB's makes more.
const FEW_BYTES: usize = 8 << 20;
const BYTES_PER_BYTE: usize = 1032;
/// A variable takes more bytes of its file than this.
const LEAST_OBJECT: usize = 32;
/// Most bytes of an object's description.
const LARGEST_HEADER: usize = 16 << 20;

/// Why a file is not read.
type Refused = String;

pub(super) fn read(bytes: Bytes, file: TableFile) -> Result<MatVariables> {
    let most = FEW_BYTES.saturating_add(bytes.len().saturating_mul(BYTES_PER_BYTE));
    let mut walk = Hdf5Walk {
        found: MatVariables::default(),
        bytes_left: most,
        objects_left: bytes.len() / LEAST_OBJECT,
    };
    let options = OpenOptions {
        // Each variable is read once.
        chunk_cache_bytes: 0,
        max_chunk_bytes: most,
        max_read_bytes: most,
        max_object_header_bytes: LARGEST_HEADER,
        ..OpenOptions::default()
    };
    let read = Hdf5File::from_owner(bytes, options)
        .and_then(|file| file.root_group())
        .map_err(said)
        .and_then(|root| walk.group(&root, "", 0));
    read.map_err(|why| broken(file, why))?;
    Ok(walk.found)
}

/// What a variable is.
enum Hdf5Class {
    Numbers,
    LeftOut(&'static str),
}

struct Hdf5Walk {
    found: MatVariables,
    /// Bytes of variables that may still be read.
    bytes_left: usize,
    /// Variables and fields that there may still be: a damaged group may hold itself.
    objects_left: usize,
}

impl Hdf5Walk {
    fn group(&mut self, group: &Group, within: &str, depth: usize) -> Result<(), Refused> {
        let (groups, datasets) = group.members().map_err(said)?;
        let left = self.objects_left.checked_sub(groups.len() + datasets.len());
        self.objects_left = left.ok_or("more variables than its bytes hold")?;
        let full = |name: &str| match within {
            "" => name.to_string(),
            within => format!("{within}.{name}"),
        };
        for dataset in &datasets {
            // The fields of an array of structures refer to what each of them holds.
            let refers = matches!(dataset.dtype(), Datatype::Reference { .. });
            if refers && !within.is_empty() && matches!(class(dataset)?, Hdf5Class::LeftOut(FIELD))
            {
                let count = dataset.shape().iter().product::<u64>();
                self.found
                    .leave_out_structures(within, usize::try_from(count).unwrap_or(usize::MAX));
                continue;
            }
            self.dataset(dataset, full(dataset.name()))?;
        }
        for inner in &groups {
            // What cells and objects refer to.
            if inner.name().starts_with('#') {
                continue;
            }
            let name = full(inner.name());
            let attribute = |key| attribute(inner.attribute(key));
            let holds = match attribute("MATLAB_class")?.map(text).transpose()?.as_deref() {
                _ if attribute("MATLAB_sparse")?.is_some() => "a sparse matrix",
                Some("struct") if depth < DEEPEST => {
                    self.group(inner, &name, depth + 1)?;
                    continue;
                }
                Some("struct") => "structures too deep in others",
                Some(_) => "an object",
                None => NO_CLASS,
            };
            self.found.leave_out(name, holds);
        }
        Ok(())
    }

    fn dataset(&mut self, dataset: &Dataset, name: String) -> Result<(), Refused> {
        let number = number(dataset.dtype());
        let holds = match (class(dataset)?, number, dataset.shape()) {
            (Hdf5Class::LeftOut(holds), ..) => holds,
            (_, None, _) if matches!(dataset.dtype(), Datatype::Compound { .. }) => {
                "complex numbers"
            }
            (_, None, _) => "numbers of another kind than MATLAB has",
            (_, Some(number), &[columns, rows]) => {
                return self.numbers(dataset, name, [rows, columns], number);
            }
            _ => "more than two dimensions",
        };
        self.found.leave_out(name, holds);
        Ok(())
    }

    /// A matrix: for HDF5 a row is what for MATLAB is a column.
    fn numbers(
        &mut self,
        dataset: &Dataset,
        name: String,
        sizes: [u64; 2],
        (number, big_endian): (MatNumber, bool),
    ) -> Result<(), Refused> {
        let left = self
            .bytes_left
            .checked_sub(dataset.raw_byte_len().map_err(said)?);
        self.bytes_left = left.ok_or_else(|| format!("'{name}' is larger than its bytes hold"))?;
        let [rows, columns] = sizes.map(|size| usize::try_from(size).unwrap_or(usize::MAX));
        let count = rows.saturating_mul(columns);
        self.found.spend(count)?;
        let bytes = dataset.read_raw_bytes().map_err(said)?;
        let values = number.all(&bytes, big_endian);
        if values.len() != count {
            return Err(format!(
                "'{name}' holds another count of numbers than it says"
            ));
        }
        self.found.push(name, rows, columns, values);
        Ok(())
    }
}

/// What holds no class, as other programs than MATLAB write it.
const NO_CLASS: &str = "no variable of MATLAB (it lacks the attribute MATLAB_class)";

/// What each of several structures holds.
const FIELD: &str = "a field of structures in an array";

fn class(dataset: &Dataset) -> Result<Hdf5Class, Refused> {
    let attribute = |key| attribute(dataset.attribute(key));
    let class = attribute("MATLAB_class")?.map(text).transpose()?;
    Ok(match class.as_deref() {
        // The sizes of an array that has none of its numbers.
        _ if attribute("MATLAB_empty")?.is_some_and(is_set) => Hdf5Class::LeftOut("nothing"),
        _ if attribute("MATLAB_object_decode")?.is_some() => Hdf5Class::LeftOut("an object"),
        Some(
            "double" | "single" | "logical" | "int8" | "uint8" | "int16" | "uint16" | "int32"
            | "uint32" | "int64" | "uint64",
        ) => Hdf5Class::Numbers,
        Some("char") => Hdf5Class::LeftOut("text"),
        Some("cell") => Hdf5Class::LeftOut("cells"),
        Some(_) => Hdf5Class::LeftOut("an object"),
        None if matches!(dataset.dtype(), Datatype::Reference { .. }) => Hdf5Class::LeftOut(FIELD),
        None => Hdf5Class::LeftOut(NO_CLASS),
    })
}

/// How its numbers are stored, and whether big-endian.
fn number(datatype: &Datatype) -> Option<(MatNumber, bool)> {
    let (number, order) = match *datatype {
        Datatype::FloatingPoint { size, byte_order } => match size {
            4 => (MatNumber::F32, byte_order),
            8 => (MatNumber::F64, byte_order),
            _ => return None,
        },
        Datatype::FixedPoint {
            size,
            signed,
            byte_order,
        } => match (size, signed) {
            (1, true) => (MatNumber::I8, byte_order),
            (1, false) => (MatNumber::U8, byte_order),
            (2, true) => (MatNumber::I16, byte_order),
            (2, false) => (MatNumber::U16, byte_order),
            (4, true) => (MatNumber::I32, byte_order),
            (4, false) => (MatNumber::U32, byte_order),
            (8, true) => (MatNumber::I64, byte_order),
            (8, false) => (MatNumber::U64, byte_order),
            _ => return None,
        },
        _ => return None,
    };
    Some((number, order == ByteOrder::BigEndian))
}

/// An attribute, if there is one.
fn attribute(found: Result<Attribute, Hdf5Error>) -> Result<Option<Attribute>, Refused> {
    match found {
        Ok(attribute) => Ok(Some(attribute)),
        Err(Hdf5Error::AttributeNotFound(_)) => Ok(None),
        Err(error) => Err(said(error)),
    }
}

fn text(attribute: Attribute) -> Result<String, Refused> {
    let text = attribute.read_string().map_err(said)?;
    Ok(text.trim_end_matches('\0').to_string())
}

/// Whether a number is another than zero.
fn is_set(attribute: Attribute) -> bool {
    attribute.raw_data.iter().any(|byte| *byte != 0)
}

/// What is wrong, without the place within the library.
fn said(error: Hdf5Error) -> Refused {
    match error {
        Hdf5Error::Context { path, source } => format!("'{path}': {}", said(*source)),
        other => other.to_string(),
    }
}
