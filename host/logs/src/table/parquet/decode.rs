//! Numbers of a Parquet page, taken apart as the format says: runs, dictionaries, differences,
//! streams of bytes. Here and not in the library, which panics on damaged runs and trusts counts.

use super::pages::broken;
use super::varint::{varint, zigzag};
use parquet::basic::Encoding;
use parquet::errors::Result;

/// Largest block of differences; writers make them of 128 values.
const LARGEST_BLOCK: u64 = 1 << 16;
/// Day of 1970-01-01 in days of the Julian calendar.
const EPOCH_DAY: i64 = 2_440_588;
/// Length of a day, ns.
const DAY_NS: i64 = 86_400_000_000_000;

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StoredAs {
    Bit,
    Int32,
    Uint32,
    Int64,
    /// Nanoseconds of a day, and the day.
    Int96,
    Float,
    Double,
}

impl StoredAs {
    /// Bytes of one number; 0 for bits.
    fn bytes(self) -> usize {
        match self {
            StoredAs::Bit => 0,
            StoredAs::Int32 | StoredAs::Uint32 | StoredAs::Float => 4,
            StoredAs::Int64 | StoredAs::Double => 8,
            StoredAs::Int96 => 12,
        }
    }
}

/// A number as a column holds it: whole, or with a fraction.
pub(super) trait StoredNumber: Copy + Default {
    /// The numbers that stand one after the other.
    fn all(bytes: &[u8], stored: StoredAs) -> Vec<Self>;
    /// A whole number, if it is one.
    fn whole(value: i64) -> Option<Self>;
}

impl StoredNumber for f64 {
    fn all(bytes: &[u8], stored: StoredAs) -> Vec<f64> {
        match stored {
            StoredAs::Float => {
                let values = bytes.as_chunks::<4>().0.iter();
                values
                    .map(|value| f64::from(f32::from_le_bytes(*value)))
                    .collect()
            }
            _ => {
                let values = bytes.as_chunks::<8>().0.iter();
                values.map(|value| f64::from_le_bytes(*value)).collect()
            }
        }
    }

    fn whole(_: i64) -> Option<f64> {
        None
    }
}

impl StoredNumber for i64 {
    fn all(bytes: &[u8], stored: StoredAs) -> Vec<i64> {
        let words = || bytes.as_chunks::<4>().0.iter();
        match stored {
            StoredAs::Int32 => words()
                .map(|value| i64::from(i32::from_le_bytes(*value)))
                .collect(),
            StoredAs::Uint32 => words()
                .map(|value| i64::from(u32::from_le_bytes(*value)))
                .collect(),
            StoredAs::Int96 => {
                let values = bytes.as_chunks::<12>().0.iter();
                values.map(nanoseconds).collect()
            }
            _ => {
                let values = bytes.as_chunks::<8>().0.iter();
                values.map(|value| i64::from_le_bytes(*value)).collect()
            }
        }
    }

    fn whole(value: i64) -> Option<i64> {
        Some(value)
    }
}

/// Since 1970.
fn nanoseconds(bytes: &[u8; 12]) -> i64 {
    let [word0, word1, word2] = [0, 4, 8].map(|at| {
        let word = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
        i64::from(u32::from_le_bytes(word))
    });
    let days = (word2 - EPOCH_DAY).wrapping_mul(DAY_NS);
    days.wrapping_add(word1 << 32 | word0)
}

/// `count` values of a page.
///
/// # Errors
/// Fewer than that, and encodings that numbers do not have.
pub(super) fn values<N: StoredNumber>(
    bytes: &[u8],
    count: usize,
    encoding: Encoding,
    stored: StoredAs,
    dictionary: &[N],
) -> Result<Vec<N>> {
    // A page of gaps alone may hold nothing else.
    if count == 0 {
        return Ok(Vec::new());
    }
    let wholes = |wholes: Vec<i64>| {
        let all = wholes.into_iter().map(N::whole).collect::<Option<Vec<N>>>();
        all.ok_or_else(|| broken("fractions are stored as whole numbers"))
    };
    match (encoding, stored) {
        (Encoding::PLAIN, StoredAs::Bit) => {
            let bits = packed(bytes, 1, count).ok_or_else(few)?;
            wholes(bits.map(|bit| bit as i64).collect())
        }
        (Encoding::RLE, StoredAs::Bit) => {
            let bits = runs(bytes.get(4..).ok_or_else(few)?, 1, count)?;
            wholes(bits.into_iter().map(i64::from).collect())
        }
        (Encoding::PLAIN, _) => plain(bytes, count, stored),
        #[allow(deprecated)]
        (Encoding::RLE_DICTIONARY | Encoding::PLAIN_DICTIONARY, _) => {
            let (width, bytes) = bytes.split_first().ok_or_else(few)?;
            let places = runs(bytes, usize::from(*width), count)?;
            let value = |place: u32| dictionary.get(place as usize).copied();
            let all = places.into_iter().map(value).collect::<Option<Vec<N>>>();
            all.ok_or_else(|| broken("a value is not in its dictionary"))
        }
        (Encoding::DELTA_BINARY_PACKED, StoredAs::Int32) => {
            let narrow = differences(bytes, count)?.into_iter();
            wholes(narrow.map(|value| i64::from(value as i32)).collect())
        }
        (Encoding::DELTA_BINARY_PACKED, StoredAs::Uint32) => {
            let narrow = differences(bytes, count)?.into_iter();
            wholes(narrow.map(|value| i64::from(value as u32)).collect())
        }
        (Encoding::DELTA_BINARY_PACKED, _) => wholes(differences(bytes, count)?),
        (Encoding::BYTE_STREAM_SPLIT, _) if stored.bytes() > 0 => {
            let size = stored.bytes();
            let stride = bytes.len() / size;
            let byte = |at: usize| bytes[at % size * stride + at / size];
            let whole: Vec<u8> = (0..size * stride).map(byte).collect();
            plain(&whole, count, stored)
        }
        (other, _) => Err(broken(format!("numbers are encoded as {other}"))),
    }
}

/// `count` values that stand one after the other.
///
/// # Errors
/// Fewer than that.
pub(super) fn plain<N: StoredNumber>(
    bytes: &[u8],
    count: usize,
    stored: StoredAs,
) -> Result<Vec<N>> {
    let bytes = bytes.get(..count.saturating_mul(stored.bytes()));
    Ok(N::all(bytes.ok_or_else(few)?, stored))
}

/// `count` small numbers, each `width` bits, as runs of one value and as groups of eight values.
///
/// # Errors
/// Fewer than that.
pub(super) fn runs(bytes: &[u8], width: usize, count: usize) -> Result<Vec<u32>> {
    if width > 32 {
        return Err(broken("runs of numbers longer than 32 bits"));
    }
    let mut left = bytes;
    let mut values = Vec::with_capacity(count);
    while values.len() < count {
        let wanted = count - values.len();
        let head = varint(&mut left).map_err(broken)?;
        let length = usize::try_from(head >> 1).unwrap_or(usize::MAX);
        if head & 1 == 1 {
            let wanted = wanted.min(length.saturating_mul(8));
            let group = packed(left, width, wanted).ok_or_else(few)?;
            values.extend(group.map(|value| value as u32));
            // The last group may be cut where its values end.
            left = &left[length.saturating_mul(width).min(left.len())..];
        } else {
            let (value, rest) = left.split_at_checked(width.div_ceil(8)).ok_or_else(few)?;
            let mut word = [0; 4];
            word[..value.len()].copy_from_slice(value);
            values.resize(values.len() + wanted.min(length), u32::from_le_bytes(word));
            left = rest;
        }
    }
    Ok(values)
}

/// `count` whole numbers that are stored as differences.
fn differences(bytes: &[u8], count: usize) -> Result<Vec<i64>> {
    let mut left = bytes;
    let (block, parts) = (
        varint(&mut left).map_err(broken)?,
        varint(&mut left).map_err(broken)?,
    );
    let stated = varint(&mut left).map_err(broken)?;
    let mut last = zigzag(&mut left).map_err(broken)?;
    if block > LARGEST_BLOCK || parts == 0 || block % parts != 0 || stated < count as u64 {
        return Err(broken("blocks of differences that no file has"));
    }
    let length = (block / parts) as usize;
    let mut values = Vec::with_capacity(count);
    values.push(last);
    while values.len() < count {
        let least = zigzag(&mut left).map_err(broken)?;
        let (widths, rest) = left.split_at_checked(parts as usize).ok_or_else(few)?;
        left = rest;
        for width in widths.iter().map(|width| usize::from(*width)) {
            let wanted = length.min(count - values.len());
            if wanted == 0 {
                break;
            }
            let part = packed(left, width, wanted).ok_or_else(few)?;
            values.extend(part.map(|step| {
                last = last.wrapping_add(least).wrapping_add(step as i64);
                last
            }));
            left = &left[(length * width / 8).min(left.len())..];
        }
        if length == 0 {
            return Err(few());
        }
    }
    Ok(values)
}

/// `count` numbers of `width` bits each, the lowest first; none if there are fewer.
fn packed(bytes: &[u8], width: usize, count: usize) -> Option<impl Iterator<Item = u64> + '_> {
    let bits = count.checked_mul(width).filter(|_| width <= 64)?;
    let mask = u64::MAX.checked_shr(64 - width as u32).unwrap_or(0);
    (bits.div_ceil(8) <= bytes.len()).then(|| {
        (0..count).map(move |place| {
            let at = place * width;
            let part = &bytes[at / 8..];
            let mut wide = [0; 16];
            let length = part.len().min(9);
            wide[..length].copy_from_slice(&part[..length]);
            (u128::from_le_bytes(wide) >> (at % 8)) as u64 & mask
        })
    })
}

fn few() -> parquet::errors::ParquetError {
    broken("a page holds fewer values than it says")
}

#[cfg(test)]
mod tests {
    use super::differences;

    /// The format lets the widths of parts that hold no value be anything.
    #[test]
    fn widths_of_parts_without_values_do_not_count() {
        let head = [0x80, 0x01, 4, 2, 2];
        let block = [0, 1, 255, 255, 255, 0b1, 0, 0, 0];
        let page = [head.as_slice(), &block].concat();
        assert_eq!(differences(&page, 2).unwrap(), [1, 2]);
        assert!(differences(&page[..9], 2).is_err());
    }
}
