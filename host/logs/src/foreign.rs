//! Files of other programs, known by their first bytes: what they are, and how they become a log.

use super::format::LogFormat;
use crate::error::{Error, Place};
use std::path::Path;

/// So many bytes tell what a file is.
pub(super) const HEAD: usize = 4096;

/// A kind of file.
struct FileKind {
    /// Where its mark stands, and the mark.
    mark: (usize, &'static [u8]),
    what: &'static str,
    /// The format that reads it, or what makes a log of it; `FILE` is its name, `STEM` that without
    /// its ending.
    way: Way,
}

enum Way {
    Read(LogFormat),
    Convert(&'static str),
}
use Way::{Convert, Read};

const UTF_16: &str = "UTF-16 text";

const fn kind(mark: &'static [u8], what: &'static str, way: Way) -> FileKind {
    FileKind {
        mark: (0, mark),
        what,
        way,
    }
}

/// Marks that are begins of others come later.
static KINDS: &[FileKind] = &[
    kind(b"\x89MCAP0\r\n", "an MCAP file", Read(LogFormat::Mcap)),
    kind(
        b"MATLAB 5.0 MAT-file",
        "a MATLAB file",
        Read(LogFormat::Mat),
    ),
    kind(
        b"MATLAB 7.3 MAT-file",
        "a MATLAB file",
        Read(LogFormat::Mat),
    ),
    kind(
        b"PAR1\x15",
        "an Apache Parquet file",
        Read(LogFormat::Parquet),
    ),
    kind(
        b"SQLite format 3\0",
        "a SQLite file, as a rosbag2 is",
        Read(LogFormat::Rosbag),
    ),
    kind(
        b"\x89HDF\r\n\x1a\n",
        "an HDF5 file",
        Convert(
            "save its columns as CSV, in Python: pandas.DataFrame({name: data[:] for name, data in \
             h5py.File(\"FILE\").items()}).to_csv(\"STEM.csv\", index=False)",
        ),
    ),
    kind(
        b"\x93NUMPY",
        "an array of NumPy (.npy)",
        Convert(
            "save it as CSV with the names of its columns, in Python: numpy.savetxt(\"STEM.csv\", \
             numpy.load(\"FILE\"), delimiter=\",\", header=\"time_s,angle_rad\", comments=\"\")",
        ),
    ),
    kind(
        b"#ROSBAG V",
        "a bag of ROS 1",
        Convert(
            "convert it to ROS 2: pip install rosbags; rosbags-convert --src FILE --dst STEM; the \
             folder STEM then is the log",
        ),
    ),
    kind(
        b"\x28\xb5\x2f\xfd",
        "packed by zstd",
        Convert("unpack it first: zstd -d FILE"),
    ),
    kind(
        b"\x1f\x8b",
        "packed by gzip",
        Convert("unpack it first: gunzip -k FILE"),
    ),
    FileKind {
        mark: (4, b"1AY&SY"),
        what: "packed by bzip2",
        way: Convert("unpack it first: bunzip2 -k FILE"),
    },
    kind(
        b"\xfd7zXZ\0",
        "packed by xz",
        Convert("unpack it first: unxz -k FILE"),
    ),
    kind(
        b"\x04\x22\x4d\x18",
        "packed by lz4",
        Convert("unpack it first: lz4 -d FILE"),
    ),
    kind(
        b"7z\xbc\xaf\x27\x1c",
        "a 7-Zip archive",
        Convert("unpack it first: 7z x FILE"),
    ),
    kind(
        b"Rar!\x1a\x07",
        "a RAR archive",
        Convert("unpack it first: unrar x FILE"),
    ),
    FileKind {
        mark: (257, b"ustar"),
        what: "a tar archive",
        way: Convert("unpack it first: tar xf FILE"),
    },
    kind(
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
        "an Excel workbook (.xls)",
        Convert("save its sheet from Excel or LibreOffice as CSV UTF-8"),
    ),
    kind(
        b"ARROW1\0\0",
        "an Arrow file (Feather)",
        Convert(
            "convert it, in Python: pandas.read_feather(\"FILE\").to_parquet(\"STEM.parquet\")",
        ),
    ),
    kind(
        b"TDSm",
        "a file of LabVIEW (TDMS)",
        Convert(
            "convert it, in Python: nptdms.TdmsFile.read(\"FILE\").as_dataframe()\
             .to_csv(\"STEM.csv\", index=False)",
        ),
    ),
    kind(
        b"ULog\x01\x12\x35",
        "a log of PX4 (ULog)",
        Convert("convert it: pip install pyulog; ulog2csv FILE"),
    ),
    kind(
        b"MDF     ",
        "a measurement file of ASAM (MDF)",
        Convert("convert it, in Python: asammdf.MDF(\"FILE\").export(\"csv\", \"STEM.csv\")"),
    ),
    kind(
        b"\x80\x04\x95",
        "an object of Python (pickle)",
        Convert("save it as CSV, in Python: pandas.read_pickle(\"FILE\").to_csv(\"STEM.csv\")"),
    ),
    kind(
        b"\x80\x05\x95",
        "an object of Python (pickle)",
        Convert("save it as CSV, in Python: pandas.read_pickle(\"FILE\").to_csv(\"STEM.csv\")"),
    ),
    kind(
        b"%PDF-",
        "a PDF",
        Convert("give the numbers that it was made of"),
    ),
    kind(
        b"\x89PNG\r\n",
        "a picture",
        Convert("give the numbers that it was made of"),
    ),
    kind(
        b"\xff\xd8\xff",
        "a picture",
        Convert("give the numbers that it was made of"),
    ),
    kind(
        b"\x7fELF",
        "a program",
        Convert("name the log that it writes"),
    ),
    kind(b"\xff\xfe", UTF_16, Convert(UTF_8)),
    kind(b"\xfe\xff", UTF_16, Convert(UTF_8)),
    kind(
        b"version https://git-lfs.github.com/spec/",
        "a pointer of Git LFS, not the file itself",
        Convert("fetch the file: git lfs pull"),
    ),
    kind(b"<!DOCTYPE html", "a web page", Convert(DOWNLOAD)),
    kind(b"<!doctype html", "a web page", Convert(DOWNLOAD)),
    kind(b"<html", "a web page", Convert(DOWNLOAD)),
    kind(b"{\"", JSON, Convert(RECORDS)),
    kind(b"{\n", JSON, Convert(RECORDS)),
    kind(b"[{", JSON, Convert(RECORDS)),
    kind(b"[\n", JSON, Convert(RECORDS)),
];

const JSON: &str = "JSON";
const RECORDS: &str = "save its records as CSV, in Python: pandas.read_json(\"FILE\")\
                       .to_csv(\"STEM.csv\", index=False), with lines=True where each line is \
                       one; a log of BAM is named STEM.json";

const UTF_8: &str = "save it as UTF-8 (Excel: \"CSV UTF-8\"), or: iconv -f UTF-16 -t UTF-8 FILE > \
                     STEM-utf8.csv";
const DOWNLOAD: &str = "download the file itself, not the page that shows it";

/// Archives that are zip files, by the name of their first member, and what it is for.
const ZIP: &[u8] = b"PK\x03\x04";

/// Why a file that begins so is not read as this format, where the bytes tell what it is.
pub(super) fn foreign(path: &Path, head: &[u8], format: LogFormat) -> Option<Error> {
    let (what, remedy) = known(path, head, format)?;
    Some(Error::data(Place::file(path), what, remedy))
}

/// Why a file that should be text is none, though no mark tells what it is: its first line holds
/// bytes that no text has.
pub(super) fn unknown_binary(path: &Path, head: &[u8]) -> Option<Error> {
    let line = head.split(|byte| b"\r\n".contains(byte)).next()?;
    // Terminals begin their colours with an escape.
    let is_control = |byte: &&u8| **byte < b' ' && !b"\t\x0b\x0c\x1b".contains(byte);
    let byte = line.iter().find(is_control)?;
    Some(Error::data(
        Place::at(path, 1, 1),
        format!("this is no text: its first line holds the byte 0x{byte:02x}"),
        "save the log as CSV from the program that wrote it; where a serial line left the byte, \
         delete the line",
    ))
}

/// What a file is that no format of logs reads; none of what no bytes tell.
pub(super) fn foreign_file(path: &Path) -> Option<(String, String)> {
    use std::io::Read as _;
    let mut head = Vec::new();
    let file = std::fs::File::open(path).ok()?;
    file.take(HEAD as u64).read_to_end(&mut head).ok()?;
    known(path, &head, LogFormat::Csv)
}

fn known(path: &Path, head: &[u8], format: LogFormat) -> Option<(String, String)> {
    let name = |path: &Path| path.file_name().map(|n| n.to_string_lossy().into_owned());
    let file = name(path).unwrap_or_default();
    let stem = name(&path.with_extension("")).unwrap_or_default();
    let filled = |way: &str| way.replace("FILE", &file).replace("STEM", &stem);
    if head.starts_with(ZIP) {
        let (what, way) = zipped(head, &file);
        return Some((format!("this is {what}"), filled(way)));
    }
    let is = |kind: &&FileKind| {
        let (at, mark) = kind.mark;
        head.get(at..).is_some_and(|rest| rest.starts_with(mark))
    };
    let kind = KINDS.iter().find(is)?;
    // MATLAB's version 7.3 is HDF5, also without its own first bytes.
    let own = match kind.way {
        Read(own) => own == format,
        Convert(_) if kind.what == JSON => format == LogFormat::Bam,
        Convert(_) => format == LogFormat::Mat && kind.what == "an HDF5 file",
    };
    if own {
        return None;
    }
    let remedy = match &kind.way {
        Convert(way) => filled(way),
        Read(own) => format!(
            "name it {stem}.{}: the ending says how a log is read",
            own.ending()
        ),
    };
    Some((format!("this is {}", packed_bag(kind.what, &file)), remedy))
}

/// A rosbag2 or a recording that is packed as a whole.
fn packed_bag(what: &str, file: &str) -> String {
    let bag = file.to_lowercase();
    let within = bag.rsplit_once('.').map_or("", |(within, _)| within);
    match what.starts_with("packed by") {
        true if within.ends_with(".db3") => format!("a rosbag2 {what}"),
        true if within.ends_with(".mcap") => format!("an MCAP file {what}"),
        true => format!("a file {what}"),
        false => what.to_string(),
    }
}

/// What a zip file is, by its first member and its own ending, and the way to a log.
fn zipped(head: &[u8], file: &str) -> (&'static str, &'static str) {
    let length = head
        .get(26..28)
        .map_or(0, |l| usize::from(u16::from_le_bytes([l[0], l[1]])));
    let member = head.get(30..30 + length).unwrap_or_default();
    let file = file.to_lowercase();
    let holds = |part: &[u8]| head.windows(part.len()).any(|bytes| bytes == part);
    if member.ends_with(b".npy") {
        return (
            "an archive of NumPy arrays (.npz)",
            "save its columns as CSV, in Python: pandas.DataFrame(dict(numpy.load(\"FILE\")))\
             .to_csv(\"STEM.csv\", index=False)",
        );
    }
    if member == b"mimetype" && holds(b"opendocument.spreadsheet") {
        return (
            "a workbook of LibreOffice (.ods)",
            "save its sheet as CSV, in UTF-8",
        );
    }
    if file.ends_with(".xlsx") || file.ends_with(".xlsm") || holds(b"xl/w") {
        return (
            "an Excel workbook (.xlsx)",
            "save its sheet as CSV UTF-8, or in Python: pandas.read_excel(\"FILE\")\
             .to_csv(\"STEM.csv\", index=False)",
        );
    }
    ("a zip archive", "unpack it first: unzip FILE")
}

#[cfg(test)]
mod tests;
