//! Recording: samples from a source into a file, as long as is wanted.

use super::recorder::RobotRecorder;
use super::sample::RobotSample;
use super::source::SampleSource;
use super::tally::RecordingTally;
use crate::error::{Error, Result};

/// Samples that may fail to come one after the other: 2 s of a CM-5's.
const MOST_SILENT: usize = 20;

/// Records for `seconds`, or until `goes_on` says no. It is asked before every sample, with the one
/// before, if that came, and the statistics so far. Nothing is written to the servos.
///
/// # Errors
/// The device failed or has fallen silent, or the system refuses to write. What was recorded is in
/// the file.
pub fn record_samples(
    source: &mut dyn SampleSource,
    recorder: &mut RobotRecorder,
    seconds: Option<f64>,
    mut goes_on: impl FnMut(Option<&RobotSample>, &RecordingTally) -> bool,
) -> Result<RecordingTally> {
    let mut tally = RecordingTally::default();
    let (mut sample, mut silent) = (None, 0);
    let within = |tally: &RecordingTally| {
        seconds.is_none_or(|seconds| tally.samples == 0 || tally.seconds() < seconds)
    };
    while goes_on(sample.as_ref(), &tally) && within(&tally) {
        sample = source.sample(None)?;
        let Some(sample) = &sample else {
            silent += 1;
            if silent == MOST_SILENT {
                return Err(Error::device(
                    "the CM-5 has sent nothing for 2 s",
                    "is it on? what was recorded is in the file",
                ));
            }
            continue;
        };
        silent = 0;
        recorder.write(sample)?;
        tally.count(sample);
    }
    Ok(tally)
}
