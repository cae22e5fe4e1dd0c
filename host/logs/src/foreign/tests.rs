//! Each foreign file under names of all readers.

use crate::{LogRequest, RawLog, read};
use handstand_model::fixture::columns;

/// What each reader says of a file of these bytes.
fn said(name: &str, bytes: &[u8]) -> [String; 2] {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let request = LogRequest::whole(&path);
    let errors = [
        RawLog::read_request(&request).unwrap_err(),
        read(&[request], &columns()).unwrap_err(),
    ];
    errors.map(|error| format!("{error} | {}", error.remedy().unwrap()))
}

#[test]
fn a_foreign_file_is_named_with_its_way_by_every_reader() {
    let npz = [&b"PK\x03\x04"[..], &[0; 22], &[5, 0, 0, 0], b"q.npy"].concat();
    let cases: [(&str, &[u8], &str, &str); 18] = [
        (
            "a.csv.gz",
            b"\x1f\x8b\x08",
            "a file packed by gzip",
            "gunzip -k a.csv.gz",
        ),
        (
            "b.db3.zstd",
            b"\x28\xb5\x2f\xfd..",
            "a rosbag2 packed by zstd",
            "zstd -d b.db3.zstd",
        ),
        ("a.h5", b"\x89HDF\r\n\x1a\n", "an HDF5 file", "a.csv"),
        (
            "a.npy",
            b"\x93NUMPY\x01",
            "an array of NumPy",
            "numpy.load(\"a.npy\")",
        ),
        (
            "a.npz",
            &npz,
            "an archive of NumPy arrays",
            "numpy.load(\"a.npz\")",
        ),
        (
            "a.xlsx",
            b"PK\x03\x04....",
            "an Excel workbook",
            "CSV UTF-8",
        ),
        ("a.zip", b"PK\x03\x04....", "a zip archive", "unzip a.zip"),
        (
            "a.bag",
            b"#ROSBAG V2.0\n",
            "a bag of ROS 1",
            "rosbags-convert --src a.bag",
        ),
        ("a.csv", b"\xff\xfet\0", "UTF-16 text", "iconv"),
        // Under the ending of another format.
        (
            "a.json",
            b"PAR1\x15...",
            "an Apache Parquet file",
            "name it a.parquet",
        ),
        ("a.mat", b"PK\x03\x04....", "a zip archive", "unzip a.mat"),
        (
            "a.mcap",
            b"SQLite format 3\0",
            "a SQLite file",
            "name it a.db3",
        ),
        (
            "a.db3",
            b"\x28\xb5\x2f\xfd..",
            "packed by zstd",
            "zstd -d a.db3",
        ),
        (
            "a.parquet",
            b"version https://git-lfs.github.com/spec/v1\n",
            "Git LFS",
            "git lfs",
        ),
        // Records of no bench that is known.
        (
            "a.jsonl",
            b"{\"t\": 0, \"q\": 1}\n",
            "this is JSON",
            "pandas.read_json(\"a.jsonl\")",
        ),
        (
            "a.json",
            b"[{\"t\": 0}]",
            "no list 'entries'",
            "pandas.read_json",
        ),
        // What no mark tells.
        ("a.blf", b"LOGG\x90\0\0\0", "this is no text", "as CSV"),
        ("a.bin", b"\xa3\x95\x80\x01\n", "this is no text", "as CSV"),
    ];
    for (name, bytes, what, way) in cases {
        for said in said(name, bytes) {
            assert!(said.contains(what) && said.contains(way), "{name}: {said}");
        }
    }
}

#[test]
fn names_of_columns_are_no_marks() {
    for name in ["PAR1", "BZh", "MDF", "ARROW1", "TDS", "Rar"] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, format!("{name},q\n1,2\n")).unwrap();
        assert_eq!(RawLog::read(&path).unwrap().names, [name, "q"]);
    }
}
