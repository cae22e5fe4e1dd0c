mod controllers;

use super::*;
use crate::sim::closed_loop::Velocity;
use crate::synth::Weight;
use std::path::{Path, PathBuf};

const UNCERTAIN: &str = r#"
[runs]
count = 700
length_s = 0.3

[[uncertain]]
what = "mass"
size = 0.1

[[uncertain]]
what = "supply"
distribution = "normal"
size = 0.05
"#;

fn study(text: &str) -> crate::error::Result<Study> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("study.toml");
    std::fs::write(&file, text).unwrap();
    Study::load(&file)
}

/// Writes a shard's journal as the command does.
fn shard(study: &Study, shard: Shard, file: &Path) {
    let designed = study.case.designed().unwrap();
    let mut journal = Journal::open(file, &Header::of(study)).unwrap();
    for chunk in (0..Header::of(study).chunks()).filter(|&chunk| shard.holds(chunk)) {
        let rows = chunk_rows(study, &designed, chunk).unwrap();
        journal.add(chunk, &rows).unwrap();
    }
}

#[test]
fn a_file_says_what_is_studied() {
    let study = study(
        r#"
[design]
q = 1
delay_periods = 1
word_bits = 16
period_s = 0.02
[conditions]
base = "measured"
velocity = "direct"
dead_zone = 0.07
[runs]
count = 10
seed = 7
[[uncertain]]
what = "com"
link = 2
size = 5e-4
"#,
    )
    .unwrap();
    let case = &study.case;
    assert_eq!(case.control.q, Weight::Scalar(1.0));
    assert_eq!(case.control.word_bits, 16);
    assert_eq!((case.clock.period_s, case.drives.dead_zone), (0.02, 0.07));
    assert_eq!(case.sensor.velocity, Velocity::Direct);
    assert!(case.sensor.gyro.is_some() && case.drives.saturates);
    assert_eq!((study.judging.runs, study.judging.seed), (10, 7));
    assert_eq!(study.uncertain[0].column(), "com:2");
}

#[test]
fn what_a_file_cannot_say_is_refused_with_its_line() {
    for (text, place, said) in [
        ("[runs]\ncuont = 3\n", ":2:1", "unknown key `cuont`"),
        ("[runs]\ncount = 2.5\n", ":2:9", "not whole"),
        ("[design]\nr = 0\n", ":2:5", "impossible"),
        ("[design]\nq = [[1, 0], [0]]\n", ":2:5", "no square matrix"),
        ("[design]\nq = [1, \"a\"]\n", ":2:5", "`q` is an array"),
        (
            "[[uncertain]]\nwhat = \"mas\"\nsize = 1\n",
            ":2:8",
            "nothing called `mas`",
        ),
        (
            "[[uncertain]]\nwhat = \"supply\"\nlink = 1\nsize = 1\n",
            ":3:8",
            "whole robot",
        ),
        (
            "[[uncertain]]\nwhat = \"mass\"\nsize = 1\n\
             [[uncertain]]\nwhat = \"mass\"\nlink = 2\nsize = 1\n",
            ":5:8",
            "drawn twice",
        ),
    ] {
        let error = study(text).unwrap_err().to_string();
        assert!(error.contains(place) && error.contains(said), "{error}");
    }
}

#[test]
fn fingerprints_tell_studies_apart_and_nothing_else() {
    let one = study(UNCERTAIN).unwrap();
    assert_eq!(one.fingerprint(), study(UNCERTAIN).unwrap().fingerprint());
    for (from, to) in [
        ("0.1", "0.11"),
        ("0.3", "0.4"),
        ("700", "701"),
        ("normal", "uniform"),
    ] {
        let other = study(&UNCERTAIN.replace(from, to)).unwrap();
        assert_ne!(one.fingerprint(), other.fingerprint(), "{from} -> {to}");
    }
}

#[test]
fn shards_in_any_number_are_the_whole() {
    let study = study(UNCERTAIN).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    shard(&study, Shard::WHOLE, &path("whole.journal"));
    let whole = merge(&[path("whole.journal")]).unwrap().unwrap().csv();
    assert_eq!(whole.lines().count(), 701);
    let two: Vec<PathBuf> = (1..=2)
        .map(|index| {
            let path = path(&format!("{index}.journal"));
            shard(&study, Shard { index, of: 2 }, &path);
            path
        })
        .collect();
    assert_eq!(merge(&two).unwrap().unwrap().csv(), whole);
    // Twice the same is no harm.
    assert_eq!(
        merge(&[folder.path().to_path_buf()])
            .unwrap()
            .unwrap()
            .csv(),
        whole
    );
    let missing = merge(&two[1..]).unwrap().unwrap_err();
    assert_eq!(
        (missing.chunks, missing.runs),
        (vec![0, 2], vec![(0, 255), (512, 699)])
    );
}

#[test]
fn a_torn_end_is_cut_off_and_done_again() {
    let study = study(UNCERTAIN).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shard.journal");
    shard(&study, Shard::WHOLE, &path);
    let bytes = std::fs::read(&path).unwrap();
    let whole = merge(std::slice::from_ref(&path)).unwrap().unwrap().csv();
    for cut in [1, 77, bytes.len() / 2, bytes.len() - 200, bytes.len() - 1] {
        std::fs::write(&path, &bytes[..cut]).unwrap();
        let before = match merge(std::slice::from_ref(&path)) {
            Ok(Err(missing)) => missing.chunks.len(),
            // Not even the first line is whole.
            _ => 3,
        };
        assert!(before > 0);
        let journal = Journal::open(&path, &Header::of(&study)).unwrap();
        assert_eq!(journal.done.len(), 3 - before);
        drop(journal);
        shard_rest(&study, &path);
        assert_eq!(
            merge(std::slice::from_ref(&path)).unwrap().unwrap().csv(),
            whole,
            "{cut}"
        );
    }
}

fn shard_rest(study: &Study, file: &Path) {
    let designed = study.case.designed().unwrap();
    let mut journal = Journal::open(file, &Header::of(study)).unwrap();
    for chunk in 0..Header::of(study).chunks() {
        if !journal.done.contains(&chunk) {
            journal
                .add(chunk, &chunk_rows(study, &designed, chunk).unwrap())
                .unwrap();
        }
    }
}

#[test]
fn what_does_not_belong_together_is_not_merged() {
    let one = study(UNCERTAIN).unwrap();
    let other = study(&UNCERTAIN.replace("0.05", "0.06")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    shard(&one, Shard::WHOLE, &path("a.journal"));
    shard(&other, Shard::WHOLE, &path("b.journal"));
    let files = [path("a.journal"), path("b.journal")];
    let error = merge(&files).unwrap_err();
    assert!(
        error.to_string().contains("this is another study than"),
        "{error}"
    );
    let error = Journal::open(&files[0], &Header::of(&other)).unwrap_err();
    assert_eq!(error.exit_code(), 3);

    // One digit changed, its sum made to fit.
    let mut journal = Journal::open(&path("c.journal"), &Header::of(&one)).unwrap();
    let rows = chunk_rows(&one, &one.case.designed().unwrap(), 1).unwrap();
    journal.add(1, &rows.replacen("0.0", "0.1", 1)).unwrap();
    let error = merge(&[path("a.journal"), path("c.journal")]).unwrap_err();
    assert!(error.to_string().contains("chunk 1 differs"), "{error}");
    let held = Journal::open(&path("c.journal"), &Header::of(&one)).unwrap_err();
    assert!(
        held.to_string().contains("another program is writing it"),
        "{held}"
    );
    std::fs::write(path("d.journal"), "no journal\n").unwrap();
    assert_eq!(merge(&[path("d.journal")]).unwrap_err().exit_code(), 3);
    // A damaged header may ask for more runs than there is memory to list the missing ones in.
    let endless = Header {
        runs: usize::MAX,
        chunk: 1,
        ..Header::of(&one)
    };
    let line = serde_json::to_string(&endless).unwrap() + "\n";
    std::fs::write(path("e.journal"), line).unwrap();
    assert_eq!(merge(&[path("e.journal")]).unwrap_err().exit_code(), 3);
}

#[test]
fn spectral_radius_tells_who_stands_in_the_small() {
    let study = study("[runs]\nstart_rad = 1e-5\n").unwrap();
    let mut seen = [0, 0];
    for corner in 0..8 {
        let mut case = study.case.clone();
        for (link, changed) in case.robot.links.iter_mut().enumerate() {
            changed.mass_kg *= if corner >> link & 1 == 1 { 1.1 } else { 0.9 };
        }
        let designed = case.designed().unwrap();
        case.limits.fall_rad = 0.01;
        let closed = case.closed_loop().unwrap();
        let radius = case.spectral_radius(&designed, &closed).unwrap();
        if (radius - 1.0).abs() < 0.002 {
            continue; // too slow to be seen in time
        }
        let judging = Judging {
            runs: 8,
            seconds: 60.0,
            ..study.judging
        };
        let figures = judge(&case, &[], &judging, &|| ()).unwrap();
        assert_eq!(
            figures.fallen_share == 0.0,
            radius < 1.0,
            "{corner} {radius} {figures:?}"
        );
        seen[usize::from(radius < 1.0)] += 1;
    }
    assert!(seen[0] > 0 && seen[1] > 0, "{seen:?}");
}

#[test]
fn every_sweep_runs_and_says_what_it_is() {
    let study = Study::paper().unwrap();
    let judging = Judging {
        runs: 2,
        seconds: 0.05,
        ..study.judging
    };
    for one in sweeps() {
        let (quantity, levels) = one;
        let ends = [levels.values[0], levels.values[levels.values.len() - 1]];
        let ran = sweep(one, &ends, &study.case, &judging, || ()).unwrap();
        assert!(ran.levels.iter().all(|l| l.figures.is_some()), "{ran:?}");
        assert_ne!(
            ran.levels[0].figures, ran.levels[1].figures,
            "{} changes nothing",
            quantity.id
        );
        let beyond = sweep(one, &[-1.0], &study.case, &judging, || ());
        assert_eq!(beyond.unwrap_err().exit_code(), 2, "{}", quantity.id);
        assert!(std::ptr::eq(
            super::quantity(quantity.id).unwrap(),
            quantity
        ));
    }
}
