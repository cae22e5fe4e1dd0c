//! Files: logs, recordings, studies and their journals, servo settings, the program for the boot
//! loader.

use super::{text, with_file};
use handstand::link::Settings;
use handstand::link::boot_loader::Image;
use handstand::link::record;
use handstand::log::init::Draft;
use handstand::log::lerobot::Calibration;
use handstand::log::{LogRequest, RawLog, read, unfolded};
use handstand::model::{LogColumns, Model};
use handstand::study::{Study, merge};
use handstand::synth::StateFeedbackPlan;
use std::path::Path;
use std::sync::LazyLock;

/// Columns of every kind that a log can have.
const COLUMNS: &str = include_str!("log_columns.toml");

fn log(name: &str, bytes: &[u8]) {
    static DECLARED: LazyLock<LogColumns> = LazyLock::new(|| {
        let model = Model::parse(COLUMNS, Path::new("log_columns.toml"));
        model.expect("the model of this target is sound").log
    });
    with_file(name, bytes, |path| {
        let Ok(motions) = read(&[LogRequest::whole(path)], &DECLARED) else {
            return;
        };
        for motion in motions {
            let ascending = motion.time_s.windows(2).all(|pair| pair[0] < pair[1]);
            assert!(ascending, "time does not increase: {:?}", motion.time_s);
            for position in &motion.position_rad {
                assert_eq!(position.len(), motion.len());
            }
        }
    });
}

pub(crate) fn log_csv(bytes: &[u8]) {
    log("log.csv", bytes);
}

pub(crate) fn log_json(bytes: &[u8]) {
    log("log.json", bytes);
}

/// A log before a model says what its columns mean.
fn raw(name: &str, bytes: &[u8]) {
    with_file(name, bytes, |path| {
        if let Ok(log) = RawLog::read(path) {
            assert_eq!(log.names.len(), log.columns.len());
            let rows = log.columns.first().map_or(0, Vec::len);
            assert!(log.columns.iter().all(|column| column.len() == rows));
            let _ = Draft::of(&log, name, None).map(|draft| draft.toml());
        }
    });
}

/// What a data set of LeRobot says of itself, and a calibration: both are JSON.
pub(crate) fn lerobot(bytes: &[u8]) {
    with_file("calibration.json", bytes, |path| {
        let _ = Calibration::read(path);
        let folder = path.with_file_name("dataset");
        let meta = folder.join("meta");
        let put = std::fs::create_dir_all(&meta)
            .and_then(|()| std::fs::write(meta.join("info.json"), bytes));
        put.expect("a folder of one's own can be written to");
        let _ = unfolded(&[LogRequest::whole(&folder)]);
        let _ = RawLog::read(&folder);
    });
}

pub(crate) fn log_mcap(bytes: &[u8]) {
    raw("log.mcap", bytes);
}

pub(crate) fn log_mat(bytes: &[u8]) {
    raw("log.mat", bytes);
}

/// Version 7.3 is HDF5.
pub(crate) fn log_mat73(bytes: &[u8]) {
    raw("log.mat", bytes);
}

pub(crate) fn log_parquet(bytes: &[u8]) {
    raw("log.parquet", bytes);
}

pub(crate) fn log_rosbag(bytes: &[u8]) {
    raw("log.db3", bytes);
}

pub(crate) fn draft(bytes: &[u8]) {
    raw("log.csv", bytes);
}

fn recording(name: &str, bytes: &[u8]) {
    with_file(name, bytes, |path| {
        let Ok(recording) = record::read(path) else {
            return;
        };
        for sample in &recording.samples {
            assert_eq!(sample.joints.len(), recording.ids.len());
        }
    });
}

pub(crate) fn recording_csv(bytes: &[u8]) {
    recording("recording.csv", bytes);
}

pub(crate) fn recording_mcap(bytes: &[u8]) {
    recording("recording.mcap", bytes);
}

/// The plan of a robot of three links, two of them driven.
pub(crate) fn gains(bytes: &[u8]) {
    static ROBOT: LazyLock<Model> = LazyLock::new(|| {
        let text = include_str!("../../../../host/models/handstand.toml");
        Model::parse(text, Path::new("handstand.toml")).expect("the model of this target is sound")
    });
    let Ok(plan) = StateFeedbackPlan::parse(bytes, Path::new("gains.json"), &ROBOT) else {
        return;
    };
    assert_eq!((plan.pose_rad.len(), plan.u0.len()), (3, 2));
    for row in &plan.k {
        assert!(
            row.len() >= 6 && row.len().is_multiple_of(2),
            "{} gains",
            row.len()
        );
    }
}

/// A study file without a model beside it: `robot` can only name what is not there.
pub(crate) fn study(bytes: &[u8]) {
    with_file("study.toml", bytes, |path| {
        let _ = Study::load(path);
    });
}

pub(crate) fn journal(bytes: &[u8]) {
    with_file("shard-1-of-1.journal", bytes, |path| {
        let _ = merge(&[path.to_path_buf()]);
    });
}

pub(crate) fn settings(bytes: &[u8]) {
    if let Some(text) = text(bytes) {
        let _ = Settings::parse(text, Path::new("settings.toml"));
    }
}

/// The sealed answer of a challenge.
pub(crate) fn seal(bytes: &[u8]) {
    if let Some(text) = text(bytes) {
        let _ = handstand::challenge::unseal::<handstand::challenge::ChallengeAnswer>(text);
    }
}

/// What is accepted is flashed byte for byte.
pub(crate) fn image(bytes: &[u8]) {
    with_file("image.bin", bytes, |path| {
        if let Ok(image) = Image::load(path) {
            assert_eq!(image.bytes(), bytes);
            let _ = image.checksum();
        }
    });
}
