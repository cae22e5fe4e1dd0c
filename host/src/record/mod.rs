//! Recording servos: samples from a robot into files that survive a crash, and back.
//!
//! Read downward: `sample` -> `cdr` -> `csv`, `mcap` -> [`Recorder`], [`read`]; `source` -> `adapter`, `stream` fetch samples over a
//! link.

mod adapter;
mod cdr;
mod csv;
mod mcap;
mod read;
mod recorder;
mod sample;
mod source;
mod stream;

pub use adapter::Adapter;
pub use read::{Recording, read};
pub use recorder::{Format, Recorder};
pub use sample::{Joint, Sample};
pub use source::{LetGo, Source};
pub use stream::Stream;

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests;
