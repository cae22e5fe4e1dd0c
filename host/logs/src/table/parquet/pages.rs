//! Pages of a Parquet column, decompressed in bounded memory by libraries that are Rust.

use super::footer::judge_header;
use bytes::buf::Reader;
use bytes::{Buf as _, Bytes};
use parquet::basic::{Compression, Encoding};
use parquet::column::page::{Page, PageReader};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::ColumnChunkMetaData;
use parquet::file::reader::{ChunkReader, Length};
use parquet::file::serialized_reader::SerializedPageReader;
use std::io::Read;
use std::sync::Arc;

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

/// The pages of one column in one group of rows.
pub(super) struct ParquetPages {
    /// Reads them as they stand in the file.
    stored: SerializedPageReader<JudgedBytes>,
    compression: Compression,
    /// Most bytes that a page may become.
    most: usize,
    /// Whether levels stand before the values: of repetition, of definition.
    has_levels: [bool; 2],
}

/// A page, decompressed.
pub(super) enum PlainPage {
    /// Values that others name by their places.
    Dictionary { count: usize, values: Bytes },
    /// Values, and gaps between them.
    Data {
        /// Values and gaps.
        entries: usize,
        /// Levels of repetition and of definition, in runs; empty where the column has none.
        levels: [Bytes; 2],
        values: Bytes,
        encoding: Encoding,
    },
}

impl ParquetPages {
    /// The pages of a column chunk.
    ///
    /// # Errors
    /// A chunk that does not begin in the file.
    pub fn of(file: Arc<JudgedBytes>, chunk: &ColumnChunkMetaData, rows: usize) -> Result<Self> {
        let start = chunk
            .dictionary_page_offset()
            .unwrap_or(chunk.data_page_offset());
        if start < 0 || chunk.compressed_size() < 0 {
            return Err(broken("a column lies before the file"));
        }
        let column = chunk.column_descr();
        let most = usize::try_from(chunk.uncompressed_size()).unwrap_or(0);
        let compression = chunk.compression();
        // What it reads is not compressed as far as it knows.
        let plain = chunk.clone().into_builder();
        let plain = plain.set_compression(Compression::UNCOMPRESSED).build()?;
        Ok(ParquetPages {
            stored: SerializedPageReader::new(file, &plain, rows, None)?,
            compression,
            most: most.min(LARGEST_PAGE),
            has_levels: [column.max_rep_level() > 0, column.max_def_level() > 0],
        })
    }

    /// The next page.
    ///
    /// # Errors
    /// One that is broken, or compressed by what is not read.
    pub fn next(&mut self) -> Result<Option<PlainPage>> {
        let page = self.stored.get_next_page()?;
        page.map(|page| self.plain(page)).transpose()
    }

    fn plain(&self, page: Page) -> Result<PlainPage> {
        Ok(match page {
            Page::DictionaryPage {
                buf, num_values, ..
            } => PlainPage::Dictionary {
                count: num_values as usize,
                values: self.decompressed(&buf)?,
            },
            Page::DataPage {
                buf,
                num_values,
                encoding,
                def_level_encoding,
                rep_level_encoding,
                ..
            } => {
                let mut values = self.decompressed(&buf)?;
                let mut levels = [Bytes::new(), Bytes::new()];
                let encodings = [rep_level_encoding, def_level_encoding];
                for (place, encoding) in encodings.into_iter().enumerate() {
                    if self.has_levels[place] {
                        if encoding != Encoding::RLE {
                            return Err(broken("a page's levels are not in runs"));
                        }
                        levels[place] = with_length(&mut values)?;
                    }
                }
                PlainPage::Data {
                    entries: num_values as usize,
                    levels,
                    values,
                    encoding,
                }
            }
            Page::DataPageV2 {
                mut buf,
                num_values,
                encoding,
                def_levels_byte_len,
                rep_levels_byte_len,
                is_compressed,
                ..
            } => {
                let lengths = [rep_levels_byte_len, def_levels_byte_len];
                let mut levels = [Bytes::new(), Bytes::new()];
                for (level, length) in levels.iter_mut().zip(lengths) {
                    *level = first(&mut buf, length as usize)?;
                }
                PlainPage::Data {
                    entries: num_values as usize,
                    levels,
                    values: match is_compressed {
                        true => self.decompressed(&buf)?,
                        false => buf,
                    },
                    encoding,
                }
            }
        })
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
            Compression::GZIP(_) => {
                let unpacked = flate2::read::MultiGzDecoder::new(&bytes[..]);
                at_most(unpacked, most)?
            }
            Compression::LZ4_RAW => {
                // A byte more of length stands for 255 bytes.
                let most = most.min(255 * bytes.len() + 64);
                let plain = lz4_flex::block::decompress(bytes, most);
                let mut plain = plain.map_err(failed)?;
                plain.shrink_to_fit();
                plain
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
    match plain.len() <= most {
        true => Ok(plain),
        false => Err(broken("a page is longer than it says")),
    }
}

/// Levels with four bytes before them that say how many.
fn with_length(page: &mut Bytes) -> Result<Bytes> {
    let length = first(page, 4)?;
    let length = length.iter().rev();
    let length = length.fold(0, |length, byte| length << 8 | usize::from(*byte));
    first(page, length)
}

/// Takes so many bytes off the page.
fn first(page: &mut Bytes, length: usize) -> Result<Bytes> {
    match length <= page.len() {
        true => Ok(page.split_to(length)),
        false => Err(broken("a page is shorter than its levels")),
    }
}
