//! Messages of an MCAP file, in the order in which they lie there.
//!
//! The format: mcap.dev/spec. Kept beside the crate `mcap`, which writes recordings: its reader
//! trusts what lengths say. Version 0.26 reserves 4 GB for a name whose length is damaged, and
//! panics on a short attachment. Here every length is held against what is there. Its
//! `LinearReader` bounds records, not the names in them: `parse_record` reserves what a name's
//! length says, and a reservation that fails ends the program. With chunks unpacked here, for its
//! packings build C, it would frame records alone, in 51 lines for the 37 of [`messages`] and
//! `record`.

use ::mcap::MAGIC;
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Read as _;

/// Largest chunk, bytes; recorders write some MB.
const LARGEST_CHUNK: u64 = 1 << 30;

/// Kinds of records.
const SCHEMA: u8 = 3;
const CHANNEL: u8 = 4;
const MESSAGE: u8 = 5;
const CHUNK: u8 = 6;

/// A message and its channel.
#[derive(Debug, Clone, Copy)]
pub struct McapMessage<'a> {
    /// Its topic.
    pub topic: &'a str,
    /// Name of its schema; empty where it has none.
    pub schema: &'a str,
    /// How its messages are written: `cdr`, `json`.
    pub encoding: &'a str,
    /// The message's number in its channel.
    pub sequence: u32,
    /// When it was recorded, ns.
    pub log_time_ns: u64,
    /// What it holds.
    pub data: &'a [u8],
}

/// How a file ends.
#[derive(Debug, Clone, PartialEq)]
pub enum McapEnd {
    /// As its writer ended it.
    Complete,
    /// In the midst of a record: the writer was stopped.
    Torn,
    /// A chunk cannot be unpacked, for this reason; nothing behind it was read.
    Broken(String),
    /// A chunk is packed in this way, which is not known here.
    Unknown(String),
}

/// Takes every message of a file, until one is refused or the file ends.
///
/// # Errors
/// What `take` refuses with.
pub fn messages<E>(
    bytes: &[u8],
    mut take: impl FnMut(McapMessage) -> Result<(), E>,
) -> Result<McapEnd, E> {
    let mut directory = Directory::default();
    let mut rest = bytes.strip_prefix(MAGIC).unwrap_or_default();
    while rest != MAGIC {
        let Some((kind, body)) = record(&mut rest) else {
            return Ok(McapEnd::Torn);
        };
        if kind != CHUNK {
            if directory.take(kind, body, &mut take)?.is_none() {
                return Ok(McapEnd::Torn);
            }
            continue;
        }
        let plain = match Chunk::of(body).map(|chunk| chunk.plain()) {
            None => return Ok(McapEnd::Torn),
            Some(Err(end)) => return Ok(end),
            Some(Ok(plain)) => plain,
        };
        let mut inside = &*plain;
        while !inside.is_empty() {
            let record = record(&mut inside);
            let taken = record.map(|(kind, body)| directory.take(kind, body, &mut take));
            if taken.transpose()?.flatten().is_none() {
                return Ok(McapEnd::Broken("its last record is cut".into()));
            }
        }
    }
    Ok(McapEnd::Complete)
}

/// The next record's kind and content, if it is whole.
fn record<'a>(rest: &mut &'a [u8]) -> Option<(u8, &'a [u8])> {
    let [kind] = fixed(rest)?;
    let length = u64::from_le_bytes(fixed(rest)?);
    Some((kind, some(rest, length)?))
}

/// Schemas and channels so far.
#[derive(Default)]
struct Directory {
    schemas: HashMap<u16, String>,
    channels: HashMap<u16, Channel>,
}

struct Channel {
    topic: String,
    schema: String,
    encoding: String,
}

impl Directory {
    /// Notes a schema or a channel, passes a message on; none where a record is not what its kind
    /// says. Messages of channels that the file does not name are left out.
    fn take<E>(
        &mut self,
        kind: u8,
        mut body: &[u8],
        take: &mut impl FnMut(McapMessage) -> Result<(), E>,
    ) -> Result<Option<()>, E> {
        let rest = &mut body;
        if kind != MESSAGE {
            return Ok(self.note(kind, rest));
        }
        let Some((channel, sequence, log_time_ns)) = message_header(rest) else {
            return Ok(None);
        };
        if let Some(known) = self.channels.get(&channel) {
            take(McapMessage {
                topic: &known.topic,
                schema: &known.schema,
                encoding: &known.encoding,
                sequence,
                log_time_ns,
                data: rest,
            })?;
        }
        Ok(Some(()))
    }

    fn note(&mut self, kind: u8, rest: &mut &[u8]) -> Option<()> {
        match kind {
            SCHEMA => {
                let id = u16::from_le_bytes(fixed(rest)?);
                self.schemas.insert(id, text(rest)?.into());
            }
            CHANNEL => {
                let id = u16::from_le_bytes(fixed(rest)?);
                let schema = u16::from_le_bytes(fixed(rest)?);
                let channel = Channel {
                    schema: self.schemas.get(&schema).cloned().unwrap_or_default(),
                    topic: text(rest)?.into(),
                    encoding: text(rest)?.into(),
                };
                self.channels.insert(id, channel);
            }
            _ => {}
        }
        Some(())
    }
}

/// A message's channel, number and time; the time of publishing is left out.
fn message_header(rest: &mut &[u8]) -> Option<(u16, u32, u64)> {
    let channel = u16::from_le_bytes(fixed(rest)?);
    let sequence = u32::from_le_bytes(fixed(rest)?);
    let log_time_ns = u64::from_le_bytes(fixed(rest)?);
    some(rest, 8)?;
    Some((channel, sequence, log_time_ns))
}

/// Records packed together.
struct Chunk<'a> {
    size: u64,
    checksum: u32,
    packing: &'a str,
    data: &'a [u8],
}

impl<'a> Chunk<'a> {
    fn of(mut body: &'a [u8]) -> Option<Chunk<'a>> {
        let rest = &mut body;
        // Times of its first and last message.
        some(rest, 16)?;
        let size = u64::from_le_bytes(fixed(rest)?);
        let checksum = u32::from_le_bytes(fixed(rest)?);
        let packing = text(rest)?;
        let length = u64::from_le_bytes(fixed(rest)?);
        Some(Chunk {
            size,
            checksum,
            packing,
            data: some(rest, length)?,
        })
    }

    /// Its records, unpacked and checked.
    fn plain(&self) -> Result<Cow<'a, [u8]>, McapEnd> {
        let broken = |why: &str| McapEnd::Broken(why.to_string());
        if self.size > LARGEST_CHUNK {
            return Err(broken("it says that it is larger than 1 GiB"));
        }
        let plain = match self.packing {
            "" => Cow::Borrowed(self.data),
            "lz4" => self.unpacked(lz4_flex::frame::FrameDecoder::new(self.data))?,
            "zstd" => {
                let decoder = ruzstd::decoding::StreamingDecoder::new(self.data);
                self.unpacked(decoder.map_err(|error| broken(&error.to_string()))?)?
            }
            other => return Err(McapEnd::Unknown(other.to_string())),
        };
        if plain.len() as u64 != self.size {
            return Err(broken("it is not as long as it says"));
        }
        // 0 says that none was computed.
        if self.checksum != 0 && self.checksum != crc32fast::hash(&plain) {
            return Err(broken("its checksum does not match"));
        }
        Ok(plain)
    }

    /// What a decoder gives: a byte more tells a chunk that is longer than it says.
    fn unpacked(&self, decoder: impl std::io::Read) -> Result<Cow<'a, [u8]>, McapEnd> {
        let mut out = Vec::new();
        match decoder.take(self.size + 1).read_to_end(&mut out) {
            Ok(_) => Ok(Cow::Owned(out)),
            Err(error) => Err(McapEnd::Broken(error.to_string())),
        }
    }
}

/// So many bytes, if there are.
fn some<'a>(rest: &mut &'a [u8], length: u64) -> Option<&'a [u8]> {
    let (taken, left) = rest.split_at_checked(usize::try_from(length).ok()?)?;
    *rest = left;
    Some(taken)
}

fn fixed<const N: usize>(rest: &mut &[u8]) -> Option<[u8; N]> {
    some(rest, N as u64)?.try_into().ok()
}

fn text<'a>(rest: &mut &'a [u8]) -> Option<&'a str> {
    let length = u32::from_le_bytes(fixed(rest)?);
    std::str::from_utf8(some(rest, length.into())?).ok()
}

#[cfg(test)]
mod tests;
