//! Recording servos: samples from a robot into files that survive a crash, and back.
//!
//! Read downward: `sample` -> `csv`, `mcap` -> [`RobotRecorder`], [`read`]; `source` ->
//! `adapter`, `stream` fetch samples over a link.

mod adapter;
mod csv;
mod follow;
mod group_adapter;
mod group_sample;
mod latency;
#[cfg(feature = "ros")]
mod mcap;
mod motion;
mod one_sample;
mod open;
mod reach;
mod read;
mod recorder;
mod report_reader;
mod run;
mod sample;
mod servo_watch;
mod silence;
mod source;
mod stream;
mod tally;
mod tick_clock;

pub use adapter::Adapter;
pub use follow::{FollowedMotion, MotionStop, follow};
pub use group_adapter::GroupAdapter;
pub use latency::{LatencyBudget, RoundTrip, no_response};
pub use motion::GoalMotion;
pub use open::{SourceKind, SourceOptions, answering, is_cm5, open_source, open_source_as};
pub use reach::{GoalRange, ServoTravel};
pub use read::{Recording, read};
pub use recorder::{FileFormat, RobotRecorder};
pub use report_reader::ReportReader;
pub use run::record_samples;
pub use sample::{GyroSample, RobotSample, ServoSample};
pub use silence::ServoSilence;
pub use source::{EmergencyOff, SampleSource};
pub use stream::{Stream, emergency_off};
pub use tally::{Quantiles, RecordingTally, Rms};

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod group_tests;
#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod reach_tests;
#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod silence_tests;
#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests;
#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod torque_tests;
