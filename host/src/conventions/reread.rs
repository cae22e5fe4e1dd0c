//! Motions read by one model's columns, as another's would have read them.

use crate::log::Motion;
use crate::model::{Column, LogColumns};

/// The motion as the columns `new` read it, where `old` read it before: units, signs, offsets and
/// shifts in time.
pub(super) fn reread(motion: &Motion, old: &LogColumns, new: &LogColumns) -> Motion {
    let mut motion = motion.clone();
    if old.time != new.time {
        each(&mut motion.time_s, &old.time, &new.time);
    }
    let joints = old.joints.iter().zip(&new.joints);
    for (joint, (old, new)) in joints.enumerate() {
        each(
            &mut motion.position_rad[joint],
            &old.position,
            &new.position,
        );
        let pairs = [
            (
                &mut motion.velocity_rad_s[joint],
                &old.velocity,
                &new.velocity,
            ),
            (&mut motion.input[joint], &old.input, &new.input),
        ];
        for (values, old, new) in pairs {
            if let (Some(values), Some(old), Some(new)) = (values, old, new) {
                each(values, old, new);
            }
        }
    }
    motion.shifted_by(|joint| {
        let (old, new) = (old.joints[joint].shifts_s(), new.joints[joint].shifts_s());
        std::array::from_fn(|i| new[i] - old[i])
    })
}

fn each(values: &mut [f64], old: &Column, new: &Column) {
    if old != new {
        let reread = |value: &mut f64| *value = new.to_si(old.written(*value));
        values.iter_mut().for_each(reread);
    }
}
