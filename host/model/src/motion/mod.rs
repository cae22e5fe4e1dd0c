//! One motion: samples recorded without interruption, in SI and in the model's angle convention.

mod excerpts;
mod shift;
mod split;

pub use excerpts::excerpts;
pub use shift::ends_s;
pub use split::{NAME_ONCE, Split, split};

use crate::model::MeasuredSignal;
use std::path::PathBuf;

/// Where a motion came from.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MotionSource {
    /// The file as the user named it.
    pub path: PathBuf,
    /// SHA-256 of the whole file, lower-case hexadecimal.
    pub sha256: String,
    /// First and last line of the file that belong to the motion, counted from 1.
    pub lines: (usize, usize),
}

/// One motion. Every vector is as long as `time_s`; an input holds from its sample to the next.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Motion {
    /// File name, and the segment where a file holds several: `single_id.csv#3`.
    pub name: String,
    /// File, hash and lines.
    pub source: MotionSource,
    /// Strictly increasing, s.
    pub time_s: Vec<f64>,
    /// Per joint: measured angle, rad, in the log's convention (zero and relative/absolute as the
    /// model says); not a number where it was not measured.
    pub position_rad: Vec<Vec<f64>>,
    /// Per joint: measured speed, rad/s, where logged; not a number where it was not measured.
    pub velocity_rad_s: Vec<Option<Vec<f64>>>,
    /// Per joint: what a rate sensor reads that it has beside the one of its angle, rad/s; not a
    /// number where it was not measured. Empty where no joint has one.
    pub rate_rad_s: Vec<Option<Vec<f64>>>,
    /// Per joint: the drive's input, in SI of its kind, never a gap; none for a passive joint.
    pub input: Vec<Option<Vec<f64>>>,
    /// Supply, V, where logged.
    pub supply_v: Option<Vec<f64>>,
    /// Whether the drives were energised, where logged; without it they always are.
    pub torque_on: Option<Vec<bool>>,
    /// Known mass bolted to the last link, kg.
    pub payload_kg: f64,
    /// Whether the rig stood turned by 180 degrees about the vertical.
    pub turned: bool,
}

impl Motion {
    /// Whether both hold the same samples to the last digit, whatever they are called. A zero is
    /// one with either sign, and a gap is a gap.
    pub fn holds_the_same(&self, other: &Motion) -> bool {
        let bits = |row: &[f64]| {
            // -0.0 + 0.0 is 0.0.
            let plain = |value: &f64| {
                if value.is_nan() {
                    f64::NAN
                } else {
                    value + 0.0
                }
            };
            row.iter()
                .map(|value| plain(value).to_bits())
                .collect::<Vec<_>>()
        };
        let same =
            |own: &[f64], theirs: &[f64]| own.len() == theirs.len() && bits(own) == bits(theirs);
        let rows = |own: &[Vec<f64>], theirs: &[Vec<f64>]| {
            own.len() == theirs.len()
                && own
                    .iter()
                    .zip(theirs)
                    .all(|(own, theirs)| same(own, theirs))
        };
        // A joint without is none, whether the list says so or ends before it.
        let known = |all: &[Option<Vec<f64>>]| -> Vec<(usize, Vec<u64>)> {
            let known = all.iter().enumerate();
            known
                .filter_map(|(joint, row)| Some((joint, bits(row.as_deref()?))))
                .collect()
        };
        same(&self.time_s, &other.time_s)
            && rows(&self.position_rad, &other.position_rad)
            && known(&self.velocity_rad_s) == known(&other.velocity_rad_s)
            && known(&self.rate_rad_s) == known(&other.rate_rad_s)
            && known(&self.input) == known(&other.input)
            && self.supply_v.as_deref().map(bits) == other.supply_v.as_deref().map(bits)
            && self.torque_on == other.torque_on
            && self.payload_kg.to_bits() == other.payload_kg.to_bits()
            && self.turned == other.turned
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// What is measured of a joint: its angles, rad, or its rates, rad/s; all gaps where nothing
    /// is.
    pub fn measured(&self, joint: usize, signal: MeasuredSignal) -> &[f64] {
        match (signal, &self.velocity_rad_s[joint]) {
            (MeasuredSignal::Rate, Some(rate)) => rate,
            _ => &self.position_rad[joint],
        }
    }

    /// What the rate sensor reads that a joint has beside the one of its angle, rad/s, if it has.
    pub fn rate(&self, joint: usize) -> Option<&[f64]> {
        self.rate_rad_s.get(joint)?.as_deref()
    }

    /// The same with gaps for those of these joints of whose rate sensor it holds nothing.
    pub fn with_rates(mut self, joints: &[usize]) -> Motion {
        let samples = self.len();
        if !joints.is_empty() {
            self.rate_rad_s.resize(self.position_rad.len(), None);
        }
        for &joint in joints {
            if let Some(rate @ None) = self.rate_rad_s.get_mut(joint) {
                *rate = Some(vec![f64::NAN; samples]);
            }
        }
        self
    }

    /// From the first sample to the last, s.
    pub fn duration_s(&self) -> f64 {
        match (self.time_s.first(), self.time_s.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }
}
