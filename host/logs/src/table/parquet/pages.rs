//! Pages of a Parquet column, judged, counted and decompressed in bounded memory by libraries that
//! are Rust; the library reads the values in them.

use super::judge::judge_header;
use bytes::buf::Reader;
use bytes::{Buf as _, Bytes};
use parquet::basic::Compression;
use parquet::column::page::{Page, PageMetadata, PageReader};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::{ChunkReader, Length};
use parquet::file::serialized_reader::SerializedPageReader;
use std::io::Read;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Largest page, bytes; writers make them of a few MB.
const LARGEST_PAGE: usize = 512 << 20;

/// The file's bytes, of which no header of a page is read that was not judged.
pub(super) struct JudgedBytes(pub Bytes);

impl Length for JudgedBytes {
    fn len(&self) -> u64 {
        self.0.len() as u64
    }
}

impl ChunkReader for JudgedBytes {
    type T = Reader<Bytes>;

    /// From the header of a page on.
    fn get_read(&self, start: u64) -> Result<Reader<Bytes>> {
        let start = usize::try_from(start).unwrap_or(usize::MAX);
        let page = self.0.get(start..).unwrap_or_default();
        judge_header(page).map_err(broken)?;
        Ok(self.0.slice(start..).reader())
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes> {
        self.0.get_bytes(start, length)
    }
}

/// How many numbers a file may still hold.
#[derive(Clone)]
pub(super) struct CellsLeft(Arc<AtomicUsize>);

impl CellsLeft {
    pub fn new(cells: usize) -> Self {
        CellsLeft(Arc::new(cells.into()))
    }

    /// Counts numbers that are held.
    pub fn spend(&self, cells: usize) -> Result<()> {
        let left = |left: usize| left.checked_sub(cells);
        let spent = self
            .0
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, left);
        spent.map_err(|_| broken("it holds more numbers than a file of its length can"))?;
        Ok(())
    }
}

/// The pages of one column in one group of rows.
pub(super) struct ParquetPages {
    /// Reads them as they stand in the file.
    stored: SerializedPageReader<JudgedBytes>,
    /// A page that was looked at. The library itself would read on from behind its header, which
    /// is then taken for one.
    ahead: Option<Page>,
    compression: Compression,
    /// Most bytes that a page may become.
    most: usize,
    cells_left: CellsLeft,
}

impl ParquetPages {
    /// The pages of a column chunk.
    ///
    /// # Errors
    /// A chunk that does not begin in the file.
    pub fn of(
        file: Arc<JudgedBytes>,
        chunk: &ColumnChunkMetaData,
        rows: usize,
        cells_left: CellsLeft,
    ) -> Result<Self> {
        let start = chunk
            .dictionary_page_offset()
            .unwrap_or(chunk.data_page_offset());
        if start < 0 || chunk.compressed_size() < 0 {
            return Err(broken("a column lies before the file"));
        }
        let most = usize::try_from(chunk.uncompressed_size()).unwrap_or(0);
        // What it reads is not compressed as far as it knows.
        let plain = chunk.clone().into_builder();
        let plain = plain.set_compression(Compression::UNCOMPRESSED).build()?;
        Ok(ParquetPages {
            stored: SerializedPageReader::new(file, &plain, rows, None)?,
            ahead: None,
            compression: chunk.compression(),
            most: most.min(LARGEST_PAGE),
            cells_left,
        })
    }

    fn plain(&self, mut page: Page) -> Result<Page> {
        match &mut page {
            Page::DictionaryPage {
                buf, num_values, ..
            } => {
                *buf = self.decompressed(buf)?;
                if *num_values as usize > buf.len() {
                    return Err(broken("a dictionary is shorter than it says"));
                }
            }
            Page::DataPage {
                buf, num_values, ..
            } => {
                self.cells_left.spend(*num_values as usize)?;
                *buf = self.decompressed(buf)?;
            }
            Page::DataPageV2 {
                buf,
                num_values,
                rep_levels_byte_len,
                def_levels_byte_len,
                is_compressed,
                ..
            } => {
                self.cells_left.spend(*num_values as usize)?;
                let levels = *rep_levels_byte_len as usize + *def_levels_byte_len as usize;
                if levels > buf.len() {
                    return Err(broken("a page is shorter than its levels"));
                }
                if *is_compressed {
                    let values = self.decompressed(&buf.slice(levels..))?;
                    *buf = [&buf[..levels], &values].concat().into();
                }
            }
        }
        Ok(page)
    }

    fn decompressed(&self, bytes: &Bytes) -> Result<Bytes> {
        let most = self.most;
        if bytes.is_empty() {
            return Ok(Bytes::new());
        }
        let plain = match self.compression {
            Compression::UNCOMPRESSED => return Ok(bytes.clone()),
            Compression::SNAPPY => {
                let length = snap::raw::decompress_len(bytes).map_err(failed)?;
                // A copy of 64 bytes takes three.
                if length > most.min(64 * bytes.len()) {
                    return Err(broken("a page is longer than it can be"));
                }
                let plain = snap::raw::Decoder::new().decompress_vec(bytes);
                plain.map_err(failed)?
            }
            Compression::GZIP(_) => at_most(flate2::read::MultiGzDecoder::new(&bytes[..]), most)?,
            Compression::LZ4_RAW => {
                // A byte more of length stands for 255 bytes.
                let most = most.min(255 * bytes.len() + 64);
                lz4_flex::block::decompress(bytes, most).map_err(failed)?
            }
            Compression::ZSTD(_) => {
                let unpacked = ruzstd::decoding::StreamingDecoder::new(&bytes[..]);
                at_most(unpacked.map_err(failed)?, most)?
            }
            other => {
                let name = format!("{other:?}");
                let name = name.split('(').next().unwrap_or_default();
                return Err(broken(format!("columns are compressed by {name}")));
            }
        };
        Ok(Bytes::from(plain))
    }
}

impl PageReader for ParquetPages {
    fn get_next_page(&mut self) -> Result<Option<Page>> {
        match self.ahead.take() {
            Some(page) => Ok(Some(page)),
            None => {
                let page = self.stored.get_next_page()?;
                page.map(|page| self.plain(page)).transpose()
            }
        }
    }

    fn peek_next_page(&mut self) -> Result<Option<PageMetadata>> {
        self.ahead = self.get_next_page()?;
        Ok(self.ahead.as_ref().map(|page| PageMetadata {
            num_rows: match page {
                Page::DataPageV2 { num_rows, .. } => Some(*num_rows as usize),
                _ => None,
            },
            num_levels: Some(page.num_values() as usize),
            is_dict: page.is_dictionary_page(),
        }))
    }

    fn skip_next_page(&mut self) -> Result<()> {
        self.get_next_page().map(drop)
    }
}

impl Iterator for ParquetPages {
    type Item = Result<Page>;

    fn next(&mut self) -> Option<Result<Page>> {
        self.get_next_page().transpose()
    }
}

/// What is wrong with the file.
pub(super) fn broken(why: impl Into<String>) -> ParquetError {
    ParquetError::General(why.into())
}

fn failed(why: impl std::fmt::Display) -> ParquetError {
    broken(format!("a page: {why}"))
}

/// Everything that a decompressor gives, if it is not more than `most` bytes.
fn at_most(unpacked: impl Read, most: usize) -> Result<Vec<u8>> {
    let mut plain = Vec::new();
    let read = unpacked.take(most as u64 + 1).read_to_end(&mut plain);
    read.map_err(failed)?;
    if plain.len() <= most {
        Ok(plain)
    } else {
        Err(broken("a page is longer than it says"))
    }
}
