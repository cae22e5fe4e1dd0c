//! Files of version 7.3 that hdf5storage and h5py wrote (`tests/peers/write_logs.py`), read to the
//! last bit, and what is left of them after damage.

use super::variables::MatVariables;
use crate::table::tests::{assert_bits, expected, of, path, table};
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Written by hdf5storage; by h5py with chunks in trees; and by h5py with HDF5's newest structures.
const FILES: [&str; 3] = ["v73.mat", "v73_packed.mat", "v73_latest.mat"];

#[test]
fn files_of_version_73_are_read_to_the_last_bit() {
    for name in FILES {
        let table = table(name);
        let expected = expected("mat73");
        for (column, values) in &expected {
            assert_bits(&table, column, values);
        }
        assert_eq!(table.names.len(), expected.len(), "{:?}", table.names);
        let supply = ("supply_v".to_string(), 11.7, 1);
        assert!(table.constants.contains(&supply), "{:?}", table.constants);
    }
    // A group of many variables, which is stored in another way than one of few.
    for name in &FILES[1..] {
        let constants = table(name).constants;
        assert_eq!(constants.len(), 41);
        assert!(constants.contains(&("data.k39".to_string(), 19.5, 1)));
    }
}

#[test]
fn a_file_without_words_at_its_begin_is_read() {
    let bytes = std::fs::read(path("v73_latest.mat")).unwrap();
    let mut wordless = bytes.clone();
    wordless[..512].fill(0);
    wordless[124..128].copy_from_slice(&bytes[124..128]);
    assert_eq!(
        of("a.mat", &wordless).unwrap().names,
        of("a.mat", &bytes).unwrap().names
    );
}

#[test]
fn what_is_not_read_of_a_matlab_file_is_said() {
    let told = [
        ("v73.mat", "note", "text"),
        ("v73.mat", "complex", "complex numbers"),
        ("v73.mat", "cells", "cells"),
        ("v73.mat", "none", "nothing"),
        ("v73.mat", "cube", "more than two dimensions"),
        ("v73.mat", "short", "another number of rows"),
        ("v73_packed.mat", "sparse", "a sparse matrix"),
        ("v73_packed.mat", "half", "numbers of another kind"),
        (
            "v73_latest.mat",
            "plain",
            "lacks the attribute MATLAB_class",
        ),
        ("v7.mat", "note", "text"),
        ("v7.mat", "complex", "complex numbers"),
        ("v7.mat", "short", "another number of rows"),
    ];
    for (name, column, holds) in told {
        let columns = table(name);
        let said = columns.cell(&path(name), column).unwrap_err().to_string();
        let both = said.contains(&format!("'{column}' holds")) && said.contains(holds);
        assert!(both, "{name}: {said}");
    }
    let count = |name: &str| table(name).left_out.len();
    // What cells refer to is no variable.
    assert_eq!(FILES.map(count), [6, 3, 3]);
}

#[test]
fn an_array_of_structures_is_told_with_how_to_save_one() {
    for name in ["structures.mat", "structures73.mat"] {
        let error = of("a.mat", &std::fs::read(path(name)).unwrap()).unwrap_err();
        let said = error.to_string();
        assert!(
            said.ends_with("`test` is an array of 2 structures"),
            "{name}: {said}"
        );
        let remedy = "save one of them: s = test(1); save('log.mat', '-struct', 's')";
        assert_eq!(error.remedy().unwrap(), remedy);
    }
}

/// Three gains, a time and an angle of 50 rows, and those of a slower recorder.
fn workspace() -> MatVariables {
    let mut found = MatVariables::default();
    let ramp = |rows: usize| (0..rows).map(|k| k as f64).collect::<Vec<_>>();
    for gain in ["A", "K", "Q"] {
        found.push(gain.into(), 30, 30, ramp(900));
    }
    for (time, angle, rows) in [("slow_t", "slow_q", 20), ("t", "q", 50)] {
        found.push(time.into(), rows, 1, ramp(rows));
        found.push(angle.into(), rows, 1, ramp(rows));
    }
    found
}

#[test]
fn matrices_do_not_hide_what_is_as_long_as_the_time() {
    let names = |time: Option<&str>| workspace().table(time).unwrap().names;
    assert_eq!(names(None), ["t", "q"]);
    // The model's time column decides.
    assert_eq!(names(Some("slow_t")), ["slow_t", "slow_q"]);
    assert_eq!(names(Some("K_2")).len(), 90);
    // What is not read is said with its rows.
    let left_out = workspace().table(None).unwrap().left_out;
    assert!(left_out.contains(&(
        "K".into(),
        "30 rows, another number of rows than the 50 of the log".into()
    )));
    // Without a time the most numbers count, not the most columns.
    let mut few = MatVariables::default();
    few.push("K".into(), 3, 3, vec![1.0; 9]);
    few.push("x".into(), 50, 1, vec![1.0; 50]);
    assert_eq!(few.table(None).unwrap().names, ["x"]);
}

#[test]
fn a_wide_matrix_takes_no_more_memory_than_its_numbers() {
    let mut found = MatVariables::default();
    found.push("wide".into(), 3, 4096, vec![1.0; 3 * 4096]);
    found.push("wider".into(), 3, 4097, vec![1.0; 3 * 4097]);
    let table = found.table(None).unwrap();
    assert_eq!(table.columns.len(), 4096);
    assert!(table.columns.iter().all(|column| column.capacity() < 8));
    assert_eq!(
        table.left_out,
        [("wider".into(), "more than 4096 columns".into())]
    );
}

/// The file with `old`, which is in it, replaced by `new` everywhere.
fn replaced(name: &str, old: &[u8], new: &[u8]) -> Vec<u8> {
    let mut bytes = std::fs::read(path(name)).unwrap();
    let places: Vec<usize> = (0..bytes.len())
        .filter(|at| bytes[*at..].starts_with(old))
        .collect();
    assert!(!places.is_empty());
    for at in places {
        bytes[at..at + new.len()].copy_from_slice(new);
    }
    bytes
}

fn words(values: [u64; 2]) -> Vec<u8> {
    values.map(u64::to_le_bytes).concat()
}

#[test]
fn sizes_that_no_file_of_version_73_bears_are_refused() {
    let said = |bytes: &[u8]| of("a.mat", bytes).unwrap_err().to_string();
    // Chunks that are not there are zeros: 2^41 of them would be 16 TB.
    let huge = said(&replaced(
        "v73_packed.mat",
        &words([2, 60]),
        &words([2, 1 << 40]),
    ));
    assert!(huge.contains("larger than its bytes hold"), "{huge}");
    let huge = said(&replaced(
        "v73_packed.mat",
        &words([2, 60]),
        &words([u64::MAX, 60]),
    ));
    assert!(huge.contains("broken"), "{huge}");
    let huge = said(&replaced("v73.mat", &words([2, 60]), &words([2, 1 << 20])));
    assert!(huge.contains("broken"), "{huge}");
}

#[test]
fn a_group_that_holds_itself_comes_to_an_end() {
    let bytes = std::fs::read(path("v73.mat")).unwrap();
    // Nodes of groups: entries of 40 bytes, each with the address of an object.
    let nodes = (512..bytes.len()).filter(|at| bytes[*at..].starts_with(b"SNOD"));
    let nodes: Vec<(usize, usize)> = nodes
        .map(|at| (at + 8, usize::from(bytes[at + 6])))
        .collect();
    let places = |(from, count): (usize, usize)| (0..count).map(move |at| from + 40 * at + 8);
    let mut said = Vec::new();
    for object in nodes.iter().flat_map(|node| places(*node)) {
        for node in &nodes {
            let mut damaged = bytes.clone();
            for place in places(*node) {
                damaged.copy_within(object..object + 8, place);
            }
            said.extend(of("a.mat", &damaged).err().map(|error| error.to_string()));
        }
    }
    // Where both fields of `data` are `data`, there are 2^16 structures.
    let too_many = |said: &&String| said.contains("more variables than its bytes hold");
    assert_eq!(said.iter().filter(too_many).count(), 1, "{said:?}");
}

#[test]
fn random_damage_is_refused_or_read_but_never_a_panic() {
    FILES.par_iter().for_each(|name| {
        let mut random = ChaCha8Rng::seed_from_u64(73);
        let bytes = std::fs::read(path(name)).unwrap();
        let (mut refused, mut read) = (0, 0);
        for _ in 0..10_000 {
            let mut damaged = bytes.clone();
            for _ in 0..random.random_range(1..=4) {
                // Most of the bytes are numbers; what describes them stands at the begin.
                let most = [2048, 8192, bytes.len()][random.random_range(0..3)];
                let at = random.random_range(512..most);
                let end = (at + [1, 2, 8][random.random_range(0..3)]).min(bytes.len());
                match random.random_range(0..4) {
                    0 => damaged[at] ^= 1 << random.random_range(0..8),
                    1 => damaged[at..end].fill([0, 0xff, 0x7f][random.random_range(0..3)]),
                    2 => damaged[at..end].fill_with(|| random.random()),
                    _ => damaged.copy_within(at..end, random.random_range(512..bytes.len() - 8)),
                }
            }
            if random.random_range(0..16) == 0 {
                damaged.truncate(random.random_range(0..bytes.len()));
            }
            match of("a.mat", &damaged) {
                Ok(table) => {
                    let rows = table.rows();
                    assert!(table.columns.iter().all(|column| column.len() == rows));
                    read += 1;
                }
                Err(error) => {
                    assert!(error.remedy().is_some(), "{error}");
                    refused += 1;
                }
            }
        }
        assert!(refused > 500 && read > 500, "{name}: {refused}, {read}");
    });
}
