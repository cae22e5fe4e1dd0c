//! Motions read by one model's columns, as another's would have read them.

use crate::model::{Column, ColumnMean, LogColumns};
use crate::motion::Motion;

/// The motion as the columns `new` read it, where `old` read it before: units, signs, offsets and
/// shifts in time. Where several columns make one quantity, all must have changed alike.
pub(super) fn reread(motion: &Motion, old: &LogColumns, new: &LogColumns) -> Motion {
    let mut motion = motion.clone();
    each(
        &mut motion.time_s,
        std::slice::from_ref(&old.time),
        std::slice::from_ref(&new.time),
    );
    let joints = old.joints.iter().zip(&new.joints);
    for (joint, (old, new)) in joints.enumerate() {
        let positions = Some(&mut motion.position_rad[joint]);
        let rates = motion.rate_rad_s.get_mut(joint);
        let triples = [
            (positions, &old.position, &new.position),
            (
                motion.velocity_rad_s[joint].as_mut(),
                &old.velocity,
                &new.velocity,
            ),
            (rates.and_then(Option::as_mut), &old.rate, &new.rate),
            (motion.input[joint].as_mut(), &old.input, &new.input),
        ];
        for (values, old, new) in triples {
            if let (Some(values), Some(old), Some(new)) = (values, old, new) {
                each(values, old.columns(), new.columns());
            }
        }
    }
    motion.shifted_by(|joint| {
        let (old, new) = (old.joints[joint].shifts_s(), new.joints[joint].shifts_s());
        std::array::from_fn(|i| new[i] - old[i])
    })
}

fn each(values: &mut [f64], old: &[Column], new: &[Column]) {
    if old == new {
        return;
    }
    let offset = |columns: &[Column]| {
        columns.iter().map(|column| column.offset).sum::<f64>() / columns.len().max(1) as f64
    };
    let (was, is) = (offset(old), offset(new));
    let sign = if old[0].reversed == new[0].reversed {
        1.0
    } else {
        -1.0
    };
    let factor = sign * new[0].unit.si / old[0].unit.si;
    for value in values {
        *value = factor * (*value - was) + is;
    }
}

/// The number written for an SI value of a quantity, where one column makes it.
pub(super) fn written(si: f64, mean: &ColumnMean) -> f64 {
    let column = &mean.columns()[0];
    let sign = if column.reversed { -1.0 } else { 1.0 };
    sign * (si - column.offset) / column.unit.si
}
