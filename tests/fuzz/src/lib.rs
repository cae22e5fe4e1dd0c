//! Fuzz targets: one function per parser, which takes arbitrary bytes and must return.
//!
//! A target fails by panicking: the parser itself, or an assertion about what it returned (what is
//! written and read again must be the same). `cargo xtask fuzz` mutates the files of `corpus/` for
//! minutes, guided by coverage; the tests replay them. A new target is a function and a line in
//! [`TARGETS`], and a folder of its name under `corpus/`.

mod targets;

use std::path::PathBuf;

/// A parser under test.
#[derive(Debug, Clone, Copy)]
pub struct Target {
    /// Name, and that of its folder in the corpus.
    pub name: &'static str,
    /// Feeds it the bytes of one case; panics where the parser is wrong.
    pub run: fn(&[u8]),
}

/// Every target.
pub const TARGETS: &[Target] = &[
    target("arguments", targets::arguments::run),
    target("draft", targets::files::draft),
    target("dynamixel", targets::wire::dynamixel),
    target("dynamixel2", targets::wire::dynamixel2),
    target("exchange", targets::wire::exchange),
    target("frame", targets::wire::frame),
    target("gain_table", targets::wire::gain_table),
    target("gains", targets::files::gains),
    target("image", targets::files::image),
    target("import", targets::model::import),
    target("journal", targets::files::journal),
    target("lerobot", targets::files::lerobot),
    target("log_csv", targets::files::log_csv),
    target("log_json", targets::files::log_json),
    target("log_mat", targets::files::log_mat),
    target("log_mat73", targets::files::log_mat73),
    target("log_mcap", targets::files::log_mcap),
    target("log_parquet", targets::files::log_parquet),
    target("log_rosbag", targets::files::log_rosbag),
    target("mesh", targets::model::mesh),
    target("message", targets::wire::message),
    target("model", targets::model::parse),
    target("model_edit", targets::model::edit),
    target("plan", targets::wire::plan),
    target("recording_csv", targets::files::recording_csv),
    target("recording_mcap", targets::files::recording_mcap),
    target("seal", targets::files::seal),
    target("settings", targets::files::settings),
    target("study", targets::files::study),
];

const fn target(name: &'static str, run: fn(&[u8])) -> Target {
    Target { name, run }
}

/// The target of this name.
pub fn named(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}

/// The folder of saved cases of a target.
pub fn corpus(target: &Target) -> PathBuf {
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/corpus");
    PathBuf::from(own).join(target.name)
}
