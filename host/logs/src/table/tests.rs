//! Files that other programs wrote (`tests/peers/write_logs.py`), read to the last bit; and what is
//! left of them after damage.

use super::*;
use serde_json::Value;
use std::path::PathBuf;

const FILES: [&str; 15] = [
    "states_none.mcap",
    "states_lz4.mcap",
    "states_zstd.mcap",
    "states.db3",
    "many.db3",
    "v6.mat",
    "v7.mat",
    "v73.mat",
    "v73_packed.mat",
    "v73_latest.mat",
    "arrow.parquet",
    "arrow_v2.parquet",
    "arrow_old.parquet",
    "arrow_lz4.parquet",
    "polars.parquet",
];

pub(super) fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../tests/data/logs")
        .join(name)
}

pub(super) fn table(name: &str) -> LogTable {
    LogTable::read(&path(name), LogFormat::of(&path(name)), None).unwrap()
}

pub(super) fn of(name: &str, bytes: &[u8]) -> Result<LogTable> {
    let path = path(name);
    LogTable::of(
        Bytes::copy_from_slice(bytes),
        TableFile { path: &path },
        LogFormat::of(&path),
        None,
    )
}

/// What a file must say, by column.
pub(super) fn expected(group: &str) -> Vec<(String, Vec<f64>)> {
    let text = std::fs::read_to_string(path("expected.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    let columns = all[group].as_object().unwrap().iter();
    let numbers = |values: &Value| -> Vec<f64> {
        let values = values.as_array().unwrap().iter();
        values
            .map(|value| value.as_f64().unwrap_or(f64::NAN))
            .collect()
    };
    columns
        .map(|(name, values)| (name.clone(), numbers(values)))
        .collect()
}

pub(super) fn assert_bits(table: &LogTable, name: &str, expected: &[f64]) {
    let index = table.names.iter().position(|own| own == name);
    let index = index.unwrap_or_else(|| panic!("{name} is none of {:?}", table.names));
    assert_eq!(table.columns[index].len(), expected.len(), "{name}");
    for (row, (read, wanted)) in table.columns[index].iter().zip(expected).enumerate() {
        let same = read.to_bits() == wanted.to_bits() || (read.is_nan() && wanted.is_nan());
        assert!(same, "{name}, row {row}: {read} instead of {wanted}");
    }
}

#[test]
fn joint_states_of_mcap_and_rosbag2_are_read_to_the_last_bit() {
    let expected = expected("states");
    for name in ["states_none.mcap", "states_lz4.mcap", "states_zstd.mcap"] {
        let table = table(name);
        for (column, values) in &expected {
            assert_bits(&table, column, values);
        }
        assert_eq!(
            table.names.len(),
            expected.len(),
            "{name}: {:?}",
            table.names
        );
    }
    let own = |column: &&(String, Vec<f64>)| !column.0.contains('/');
    for name in ["states.db3", "many.db3"] {
        let table = table(name);
        for (column, values) in expected.iter().filter(own) {
            assert_bits(&table, column, &values[..table.rows()]);
        }
    }
    assert_eq!(table("states.db3").names.len(), expected.len() - 1);
    assert_eq!(
        (table("many.db3").names.len(), table("many.db3").rows()),
        (301, 8)
    );
}

#[test]
fn matlab_files_are_read_to_the_last_bit() {
    for name in ["v6.mat", "v7.mat"] {
        let table = table(name);
        let expected = expected("mat");
        for (column, values) in &expected {
            assert_bits(&table, column, values);
        }
        assert_eq!(table.names.len(), expected.len(), "{:?}", table.names);
        assert_eq!(table.constants, [("supply_v".to_string(), 11.7, 1)]);
    }
}

#[test]
fn parquet_files_are_read_to_the_last_bit() {
    let expected = expected("parquet");
    let left_out = [
        "note",
        "ragged",
        "grid",
        "by_name.key_value.key",
        "by_name.key_value.value",
    ];
    for name in FILES.iter().filter(|name| name.ends_with(".parquet")) {
        let table = table(name);
        // Polars knows neither maps nor decimals that are whole numbers.
        let is_polars = *name == "polars.parquet";
        let wanted = |column: &&(String, Vec<f64>)| !(is_polars && column.0 == "goal");
        for (column, values) in expected.iter().filter(wanted) {
            assert_bits(&table, column, values);
        }
        let count = expected.iter().filter(wanted).count();
        assert_eq!(table.names.len(), count, "{name}: {:?}", table.names);
        let names = table.left_out.iter().map(|(name, _)| name.as_str());
        let maps = |name: &&str| !(is_polars && name.starts_with("by_name"));
        assert!(names.eq(left_out.into_iter().filter(maps)), "{name}");
    }
}

#[test]
fn what_is_not_read_of_parquet_is_said() {
    let said = |bytes: &[u8]| of("a.parquet", bytes).unwrap_err().to_string();
    let brotli = std::fs::read(path("brotli.parquet")).unwrap();
    assert!(
        said(&brotli).contains("compressed by BROTLI"),
        "{}",
        said(&brotli)
    );
    let torn = &brotli[..brotli.len() - 1];
    assert!(
        said(torn).contains("not a whole Parquet file"),
        "{}",
        said(torn)
    );
    let encrypted = [&brotli[..brotli.len() - 1], b"E"].concat();
    assert!(
        said(&encrypted).contains("encrypted"),
        "{}",
        said(&encrypted)
    );
    let columns = table("arrow.parquet");
    let missing = columns.cell(&path("a"), "ragged").unwrap_err().to_string();
    assert!(
        missing.contains("'ragged' holds lists of different lengths"),
        "{missing}"
    );
}

/// A file of no rows whose schema's elements state so many children.
fn schema(children: &[u32]) -> Vec<u8> {
    // Version 2, then a list of structures: name "q", children, repetition "required".
    let mut metadata = vec![0x15, 0x04, 0x19, 0xfc, children.len() as u8];
    for count in children {
        metadata.extend([0x48, 1, b'q', 0x15]);
        let mut zigzag = 2 * u64::from(*count);
        while zigzag > 0x7f {
            metadata.push(0x80 | (zigzag & 0x7f) as u8);
            zigzag >>= 7;
        }
        metadata.extend([zigzag as u8, 0x05, 6, 0, 0]);
    }
    metadata.push(0);
    let length = (metadata.len() as u32).to_le_bytes();
    [b"PAR1", &metadata[..], &length, b"PAR1"].concat()
}

#[test]
fn schemas_that_no_file_bears_are_refused() {
    let said = |children: &[u32]| {
        let refused = of("a.parquet", &schema(children));
        refused.unwrap_err().to_string()
    };
    // Two to the power of 31 children would reserve 16 GB; groups are entered by recursion.
    let wide = said(&[i32::MAX as u32]);
    assert!(wide.contains("more columns than it names"), "{wide}");
    let deep = said(&[1; 100]);
    assert!(deep.contains("too deeply"), "{deep}");
}

#[test]
fn a_torn_mcap_is_read_as_far_as_it_is_whole() {
    let bytes = std::fs::read(path("states_none.mcap")).unwrap();
    let whole = table("states_none.mcap");
    let torn = of("states_none.mcap", &bytes[..bytes.len() / 2]).unwrap();
    assert!(torn.rows() > 5 && torn.rows() < whole.rows());
    // Not without a word.
    assert!(torn.warning.unwrap().0.contains("broken off"));
    assert_eq!(whole.warning, None);
    let none = of("states_none.mcap", &bytes[..bytes.len() / 100]).unwrap_err();
    assert!(
        none.to_string().contains("before its first chunk"),
        "{none}"
    );
    let index = |table: &LogTable| {
        table
            .names
            .iter()
            .position(|n| n == "elbow.position")
            .unwrap()
    };
    assert_eq!(
        torn.columns[index(&torn)],
        whole.columns[index(&whole)][..torn.rows()]
    );
}

#[test]
fn damage_is_refused_or_read_but_never_a_panic() {
    for name in FILES {
        let bytes = std::fs::read(path(name)).unwrap();
        let stride = bytes.len() / 150 + 1;
        for cut in (0..bytes.len()).step_by(stride) {
            if let Err(error) = of(name, &bytes[..cut]) {
                assert!(error.remedy().is_some(), "{name} cut at {cut}");
            }
        }
        for at in (0..bytes.len()).step_by(stride / 3 + 1) {
            for value in [0, 0x7f, 0xff, bytes[at] ^ 1] {
                let mut damaged = bytes.clone();
                damaged[at] = value;
                let _ = of(name, &damaged);
            }
        }
        assert!(of(name, b"").is_err());
        assert!(of(name, &[0xff; 4096]).is_err());
    }
}

#[test]
fn sizes_that_no_file_bears_are_refused() {
    // A compressed chunk that says it becomes 2^40 bytes, a variable of 2^31 x 2^31 numbers.
    let mut mat = vec![b' '; 124];
    mat.extend([0, 1, b'I', b'M']);
    let word = |value: u32| value.to_le_bytes();
    for value in [
        14,
        56,
        6,
        8,
        6,
        0,
        5,
        8,
        u32::MAX >> 1,
        u32::MAX >> 1,
        1,
        1,
        u32::from(b'q'),
        0,
        9,
        0,
    ] {
        mat.extend(word(value));
    }
    let said = of("a.mat", &mat).unwrap_err().to_string();
    assert!(said.contains("another count"), "{said}");
    // Zeros that inflate a thousandfold, over and over, end at the limit rather than in memory.
    let hdf = [b"MATLAB 7.3 MAT-file".as_slice(), &[b' '; 200]].concat();
    assert!(of("a.mat", &hdf).unwrap_err().to_string().contains("HDF5"));
    assert!(
        of("a.parquet", b"PAR1")
            .unwrap_err()
            .to_string()
            .contains("Parquet")
    );
}

#[test]
fn whole_numbers_too_long_for_a_double_count_from_the_first() {
    let first = 1_772_366_400_123_456_789;
    assert_eq!(
        from_integers(&[first, first + 1, first + 10]),
        [0.0, 1.0, 10.0]
    );
    assert_eq!(from_integers(&[3, -4]), [3.0, -4.0]);
    let largest = u64::MAX - 1;
    assert_eq!(from_unsigned(&[largest, u64::MAX, 1]), [0.0, 1.0, 3.0]);
    assert_eq!(from_unsigned(&[3, 4]), [3.0, 4.0]);
}
