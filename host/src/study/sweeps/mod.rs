//! The sweeps, one file each.

pub(super) mod dead_zone;
pub(super) mod delay;
pub(super) mod float_fixed;
pub(super) mod gyro_resolution;
pub(super) mod jitter;
pub(super) mod position_resolution;
pub(super) mod sampling_time;
pub(super) mod saturation;
pub(super) mod supply;
pub(super) mod word_length;
