//! Which format a log has, by its file's ending.

use std::path::Path;

/// A format of logs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LogFormat {
    /// Text with columns, from a file or the standard input.
    Csv,
    /// A BAM bench's JSON.
    Bam,
    /// MCAP: ROS 2 joint states, or what `handstand record` wrote.
    Mcap,
    /// MATLAB's, version 5.
    Mat,
    /// Apache Parquet.
    Parquet,
    /// A rosbag2 in SQLite.
    Rosbag,
}

impl LogFormat {
    /// Endings of every format but CSV, which any other ending is.
    const ENDINGS: [(&'static str, LogFormat); 5] = [
        ("json", LogFormat::Bam),
        ("mcap", LogFormat::Mcap),
        ("mat", LogFormat::Mat),
        ("parquet", LogFormat::Parquet),
        ("db3", LogFormat::Rosbag),
    ];
    /// Endings of text in a folder of logs.
    const TEXT: [&'static str; 3] = ["csv", "tsv", "txt"];

    /// Endings of files that logs are in, text first.
    pub fn endings() -> impl Iterator<Item = &'static str> {
        let others = Self::ENDINGS.iter().map(|(ending, _)| *ending);
        Self::TEXT.into_iter().chain(others)
    }

    /// The format of a file of this name.
    pub fn of(path: &Path) -> LogFormat {
        Self::by_ending(path).unwrap_or(LogFormat::Csv)
    }

    /// Whether a file in a folder of logs is one.
    pub fn is_log(path: &Path) -> bool {
        let ending = path.extension().and_then(|ending| ending.to_str());
        let is_text = |ending: &str| {
            Self::TEXT
                .iter()
                .any(|text| ending.eq_ignore_ascii_case(text))
        };
        Self::by_ending(path).is_some() || ending.is_some_and(is_text)
    }

    /// The ending that names it; text has others, too.
    pub(super) fn ending(self) -> &'static str {
        let mut known = Self::ENDINGS.iter();
        known
            .find(|(_, format)| *format == self)
            .map_or(Self::TEXT[0], |(ending, _)| ending)
    }

    fn by_ending(path: &Path) -> Option<LogFormat> {
        let ending = path.extension()?.to_str()?;
        let mut known = Self::ENDINGS.iter();
        known
            .find(|(own, _)| ending.eq_ignore_ascii_case(own))
            .map(|(_, format)| *format)
    }
}
