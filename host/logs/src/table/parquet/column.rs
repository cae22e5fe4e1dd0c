//! The values of one column of a Parquet file, through all its groups of rows.

use super::leaf::{LeafMeaning, ParquetLeaf};
use super::pages::{CellsLeft, JudgedBytes, ParquetPages, broken};
use crate::table::from_integers;
use bytes::Bytes;
use parquet::column::reader::ColumnReader::*;
use parquet::column::reader::{ColumnReaderImpl, get_column_reader};
use parquet::data_type::DataType;
use parquet::errors::Result;
use parquet::file::metadata::ParquetMetaData;
use std::sync::Arc;

/// The file, and how many numbers it may still hold.
pub(super) struct ParquetSource {
    pub bytes: Bytes,
    pub metadata: ParquetMetaData,
    pub cells_left: CellsLeft,
}

/// A column, or one for each place of its lists; or why it is left out.
pub(super) type ParquetColumns = Result<std::result::Result<Vec<Vec<f64>>, &'static str>>;

/// Reads column `index` of the file.
///
/// # Errors
/// What is broken.
pub(super) fn columns(source: &ParquetSource, leaf: &ParquetLeaf, index: usize) -> ParquetColumns {
    let meaning = match leaf.meaning {
        Ok(meaning) => meaning,
        Err(why) => return Ok(Err(why)),
    };
    // Whole numbers keep their last digit until it is known from where they count.
    let (mut real, mut whole, mut lengths) = (Vec::new(), Vec::new(), Vec::new());
    for group in source.metadata.row_groups() {
        let rows = usize::try_from(group.num_rows()).unwrap_or(0);
        let chunk = group.columns().get(index);
        let chunk = chunk.ok_or_else(|| broken("a group of rows lacks a column"))?;
        if chunk.file_path().is_some() {
            return Err(broken("its columns are in other files"));
        }
        let bytes = Arc::new(JudgedBytes(source.bytes.clone()));
        let pages = ParquetPages::of(bytes, chunk, rows, source.cells_left.clone())?;
        let mut taken = Taken {
            leaf,
            rows,
            lengths: &mut lengths,
        };
        match get_column_reader(chunk.column_descr_ptr(), Box::new(pages)) {
            FloatColumnReader(reader) => taken.all(reader, &mut real, f64::NAN, |v| (*v).into()),
            DoubleColumnReader(reader) => taken.all(reader, &mut real, f64::NAN, |v| *v),
            BoolColumnReader(reader) => taken.all(reader, &mut whole, None, |v| Some((*v).into())),
            Int32ColumnReader(reader) if meaning == LeafMeaning::Unsigned => {
                taken.all(reader, &mut whole, None, |v| Some((*v as u32).into()))
            }
            Int32ColumnReader(reader) => taken.all(reader, &mut whole, None, |v| Some((*v).into())),
            Int64ColumnReader(reader) => taken.all(reader, &mut whole, None, |v| Some(*v)),
            Int96ColumnReader(reader) => {
                taken.all(reader, &mut whole, None, |v| Some(v.to_nanos()))
            }
            ByteArrayColumnReader(_) | FixedLenByteArrayColumnReader(_) => {
                Err(broken("a column changes its type"))
            }
        }?;
    }
    let values = if whole.is_empty() {
        real
    } else {
        meant(&whole, meaning)
    };
    if leaf.element_level.is_none() {
        return Ok(Ok(vec![values]));
    }
    let length = lengths.iter().copied().max().unwrap_or(0);
    if lengths.iter().any(|own| *own != 0 && *own != length) {
        return Ok(Err("lists of different lengths"));
    }
    source
        .cells_left
        .spend(lengths.len().saturating_mul(length))?;
    Ok(Ok(in_places(&values, length, &lengths)))
}

/// A column in a group of rows.
struct Taken<'a> {
    leaf: &'a ParquetLeaf,
    rows: usize,
    /// How many values belong to each row, where rows are lists.
    lengths: &'a mut Vec<usize>,
}

impl Taken<'_> {
    /// Appends its rows; `gap` stands where none was measured.
    fn all<T: DataType, N: Copy>(
        &mut self,
        mut reader: ColumnReaderImpl<T>,
        series: &mut Vec<N>,
        gap: N,
        number: impl Fn(&T::T) -> N,
    ) -> Result<()> {
        let (mut defined, mut repeated, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let (rows, ..) = reader.read_records(
            self.rows,
            Some(&mut defined),
            Some(&mut repeated),
            &mut values,
        )?;
        if rows < self.rows {
            return Err(broken("a column holds fewer rows than its group"));
        }
        let mut values = values.iter().map(number);
        let full = self.leaf.value_level;
        if full == 0 {
            series.extend(values);
            return Ok(());
        }
        let mut value = |level: i16| (level == full).then(|| values.next()).flatten();
        let Some(element_level) = self.leaf.element_level else {
            series.extend(defined.iter().map(|level| value(*level).unwrap_or(gap)));
            return Ok(());
        };
        for (level, repeated) in defined.into_iter().zip(repeated) {
            if repeated == 0 {
                self.lengths.push(0);
            }
            if level >= element_level {
                if let Some(length) = self.lengths.last_mut() {
                    *length += 1;
                }
                series.push(value(level).unwrap_or(gap));
            }
        }
        Ok(())
    }
}

/// Whole numbers as what they mean; gaps are not numbers.
fn meant(whole: &[Option<i64>], meaning: LeafMeaning) -> Vec<f64> {
    let first = whole.iter().flatten().next().copied().unwrap_or(0);
    let since_first = |value: i64| value.wrapping_sub(first) as f64;
    let known = || whole.iter().flatten();
    let each = |number: &dyn Fn(i64) -> f64| {
        let values = whole.iter().map(|value| value.map_or(f64::NAN, number));
        values.collect()
    };
    match meaning {
        LeafMeaning::Unsigned if known().any(|value| *value < 0) => each(&since_first),
        LeafMeaning::Number | LeafMeaning::Unsigned => {
            let known: Vec<i64> = known().copied().collect();
            let mut numbers = from_integers(&known).into_iter();
            let number = |value: &Option<i64>| value.and_then(|_| numbers.next());
            whole
                .iter()
                .map(number)
                .map(|n| n.unwrap_or(f64::NAN))
                .collect()
        }
        LeafMeaning::Over(parts) => each(&|value| value as f64 / parts),
        LeafMeaning::Moment(per_s) => each(&|value| since_first(value) / per_s),
    }
}

/// One column for each place of lists that are as long as each other; a list that is not there is a
/// gap.
fn in_places(values: &[f64], length: usize, lengths: &[usize]) -> Vec<Vec<f64>> {
    let mut columns = vec![Vec::new(); length];
    let mut lists = values.chunks_exact(length.max(1));
    for own in lengths {
        let list = if *own == 0 { None } else { lists.next() };
        for (place, column) in columns.iter_mut().enumerate() {
            column.push(list.map_or(f64::NAN, |list| list[place]));
        }
    }
    columns
}
