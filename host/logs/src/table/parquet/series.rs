//! The values of one column of a Parquet file, through all its groups of rows.

use super::decode::{self, StoredAs, StoredNumber, plain, runs};
use super::leaf::{LeafMeaning, ParquetLeaf};
use super::pages::{JudgedBytes, ParquetPages, PlainPage, broken};
use crate::table::from_integers;
use parquet::basic::Type as Physical;
use parquet::errors::Result;
use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData, RowGroupMetaData};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The file, and how many numbers it may still hold.
pub(super) struct ParquetSource {
    pub bytes: Arc<JudgedBytes>,
    pub metadata: ParquetMetaData,
    pub cells_left: AtomicUsize,
}

impl ParquetSource {
    /// Counts numbers that are held.
    fn spend(&self, cells: usize) -> Result<()> {
        let left = |left: usize| left.checked_sub(cells);
        let spent = self
            .cells_left
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, left);
        spent.map_err(|_| broken("it holds more numbers than a file of its length can"))?;
        Ok(())
    }
}

/// Values as they stand, one after the other.
#[derive(Default)]
struct Series<N> {
    values: Vec<N>,
    /// Places among them where none was measured.
    gaps: Vec<usize>,
    /// How many belong to each row, where rows are lists.
    lengths: Vec<u32>,
}

/// What is read of a column: whole numbers keep their last digit until it is known from where they
/// count.
enum Numbers {
    Real(Series<f64>),
    Whole(Series<i64>),
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
    let mut numbers = Numbers::of(source, index)?;
    for group in source.metadata.row_groups() {
        let rows = usize::try_from(group.num_rows()).unwrap_or(0);
        let chunk = chunk(group, index)?;
        if chunk.file_path().is_some() {
            return Err(broken("its columns are in other files"));
        }
        let taken = Taken {
            leaf,
            stored: stored(chunk, meaning)?,
            source,
            pages: ParquetPages::of(Arc::clone(&source.bytes), chunk, rows)?,
        };
        match &mut numbers {
            Numbers::Real(series) => taken.all(rows, series)?,
            Numbers::Whole(series) => taken.all(rows, series)?,
        }
    }
    let (values, lengths) = match numbers {
        Numbers::Real(series) => {
            let mut values = series.values;
            for gap in &series.gaps {
                values[*gap] = f64::NAN;
            }
            (values, series.lengths)
        }
        Numbers::Whole(series) => {
            let values = meant(series.values, &series.gaps, meaning);
            (values, series.lengths)
        }
    };
    if leaf.element_level.is_none() {
        return Ok(Ok(vec![values]));
    }
    let length = lengths.iter().copied().max().unwrap_or(0) as usize;
    if lengths
        .iter()
        .any(|own| *own != 0 && *own as usize != length)
    {
        return Ok(Err("lists of different lengths"));
    }
    source.spend(lengths.len().saturating_mul(length))?;
    Ok(Ok(in_places(&values, length, &lengths)))
}

impl Numbers {
    /// As the column's type is in the first group.
    fn of(source: &ParquetSource, index: usize) -> Result<Numbers> {
        let column = source.metadata.file_metadata().schema_descr().columns();
        let column = column.get(index);
        Ok(match column.map(|column| column.physical_type()) {
            Some(Physical::FLOAT | Physical::DOUBLE) => Numbers::Real(Series::default()),
            _ => Numbers::Whole(Series::default()),
        })
    }
}

fn chunk(group: &RowGroupMetaData, index: usize) -> Result<&ColumnChunkMetaData> {
    let chunk = group.columns().get(index);
    chunk.ok_or_else(|| broken("a group of rows lacks a column"))
}

fn stored(chunk: &ColumnChunkMetaData, meaning: LeafMeaning) -> Result<StoredAs> {
    Ok(match chunk.column_type() {
        Physical::BOOLEAN => StoredAs::Bit,
        Physical::INT32 if meaning == LeafMeaning::Unsigned => StoredAs::Uint32,
        Physical::INT32 => StoredAs::Int32,
        Physical::INT64 => StoredAs::Int64,
        Physical::INT96 => StoredAs::Int96,
        Physical::FLOAT => StoredAs::Float,
        Physical::DOUBLE => StoredAs::Double,
        Physical::BYTE_ARRAY | Physical::FIXED_LEN_BYTE_ARRAY => {
            return Err(broken("a column changes its type"));
        }
    })
}

/// A column in a group of rows.
struct Taken<'a> {
    leaf: &'a ParquetLeaf,
    stored: StoredAs,
    source: &'a ParquetSource,
    pages: ParquetPages,
}

impl Taken<'_> {
    /// Appends its rows.
    fn all<N: StoredNumber>(mut self, rows: usize, series: &mut Series<N>) -> Result<()> {
        let mut dictionary = Vec::new();
        let mut left = rows;
        // A list may go on in a page that begins no row.
        loop {
            match self.pages.next()? {
                None if left == 0 => return Ok(()),
                None => return Err(broken("a column holds fewer rows than its group")),
                Some(PlainPage::Dictionary { count, values }) => {
                    dictionary = plain(&values, count, self.stored)?;
                }
                Some(PlainPage::Data {
                    entries,
                    levels: [repetition, definition],
                    values,
                    encoding,
                }) => {
                    self.source.spend(entries)?;
                    let levels = |bytes: &[u8], highest: i16| {
                        let width = 16 - highest.leading_zeros() as usize;
                        runs(bytes, width, entries)
                    };
                    let full = self.leaf.value_level;
                    let defined = match full {
                        0 => Vec::new(),
                        _ => levels(&definition, full)?,
                    };
                    let repeated = match self.leaf.element_level {
                        None => Vec::new(),
                        Some(_) => levels(&repetition, 1)?,
                    };
                    let gaps = defined
                        .iter()
                        .filter(|level| **level != full as u32)
                        .count();
                    let values = decode::values(
                        &values,
                        entries - gaps,
                        encoding,
                        self.stored,
                        &dictionary,
                    )?;
                    let page = PageEntries {
                        defined,
                        repeated,
                        values,
                    };
                    let read = page.append(self.leaf, gaps, series);
                    left = left
                        .checked_sub(read)
                        .ok_or_else(|| broken("a column holds more rows than its group"))?;
                }
            }
        }
    }
}

/// A page's levels, empty where the column has none, and the values that are there.
struct PageEntries<N> {
    defined: Vec<u32>,
    repeated: Vec<u32>,
    values: Vec<N>,
}

impl<N: StoredNumber> PageEntries<N> {
    /// Appends what the page holds, and returns in how many new rows.
    fn append(self, leaf: &ParquetLeaf, gaps: usize, series: &mut Series<N>) -> usize {
        let Some(element_level) = leaf.element_level else {
            let rows = self.values.len() + gaps;
            if gaps == 0 {
                series.values.extend(self.values);
                return rows;
            }
            let mut values = self.values.into_iter();
            for level in self.defined {
                series.push(level, leaf, &mut values);
            }
            return rows;
        };
        let before = series.lengths.len();
        let mut values = self.values.into_iter();
        for (level, repeated) in self.defined.into_iter().zip(self.repeated) {
            if repeated == 0 {
                series.lengths.push(0);
            }
            if level >= element_level as u32 {
                if let Some(length) = series.lengths.last_mut() {
                    *length += 1;
                }
                series.push(level, leaf, &mut values);
            }
        }
        series.lengths.len() - before
    }
}

impl<N: StoredNumber> Series<N> {
    /// The next value, or a gap.
    fn push(&mut self, level: u32, leaf: &ParquetLeaf, values: &mut impl Iterator<Item = N>) {
        let is_there = level == leaf.value_level as u32;
        match is_there.then(|| values.next()).flatten() {
            Some(value) => self.values.push(value),
            None => {
                self.gaps.push(self.values.len());
                self.values.push(N::default());
            }
        }
    }
}

/// Whole numbers as what they mean; gaps are not numbers.
fn meant(mut whole: Vec<i64>, gaps: &[usize], meaning: LeafMeaning) -> Vec<f64> {
    let mut unknown = gaps.iter().copied().peekable();
    let first = (0..whole.len()).find(|place| unknown.next_if_eq(place).is_none());
    let first = first.map_or(0, |place| whole[place]);
    for gap in gaps {
        whole[*gap] = first;
    }
    let mut values: Vec<f64> = match meaning {
        LeafMeaning::Number => from_integers(&whole),
        LeafMeaning::Unsigned if whole.iter().all(|value| *value >= 0) => from_integers(&whole),
        LeafMeaning::Unsigned => {
            let from_first = |value: &i64| (*value as u64).wrapping_sub(first as u64) as i64 as f64;
            whole.iter().map(from_first).collect()
        }
        LeafMeaning::Over(parts) => whole.iter().map(|value| *value as f64 / parts).collect(),
        LeafMeaning::Moment(per_s) => {
            let since = |value: &i64| value.wrapping_sub(first) as f64 / per_s;
            whole.iter().map(since).collect()
        }
    };
    for gap in gaps {
        values[*gap] = f64::NAN;
    }
    values
}

/// One column for each place of lists that are as long as each other; a list that is not there is a
/// gap.
fn in_places(values: &[f64], length: usize, lengths: &[u32]) -> Vec<Vec<f64>> {
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
