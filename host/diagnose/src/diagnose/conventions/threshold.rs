//! What a correction must do to be believed: lower the error by so much, in most windows.

use super::continuous::is_far;
use super::correction::{Correction, LogColumn};
use super::search::is_long;
use super::travel::{doubts_travel, stands_still};
use super::trial::{CorrectionTrial, Trial};
use crate::model::{Model, Unit};

/// What a correction must do to be believed.
pub(super) struct CorrectionThreshold {
    /// Error after over error before, at most.
    ratio: f64,
    /// Share of the windows that become better, at least.
    better: f64,
}

/// Share that a correction may leave where it raises the error in rad.
const MOST_WHERE_LARGER: f64 = 0.15;

impl CorrectionThreshold {
    pub(super) fn allows(&self, trial: &Trial) -> bool {
        // In another unit every error in rad may be larger, but then little of the motion is left.
        let most = if trial.after_rad > trial.before_rad {
            MOST_WHERE_LARGER
        } else {
            1.0
        };
        trial.ratio() < self.ratio && trial.better >= self.better && trial.after < most
    }
}

/// What it must do: alternatives without a free number less than zeros and shifts, which
/// effects of the rig (a tilt, a delay) look like.
pub(super) fn least(bench: &CorrectionTrial, correction: &Correction) -> CorrectionThreshold {
    let strict = CorrectionThreshold {
        ratio: 0.6,
        better: 0.75,
    };
    let never = CorrectionThreshold {
        ratio: 0.0,
        better: 1.0,
    };
    match correction {
        Correction::Offset(_, added) => {
            if is_far(&bench.model, correction, *added) {
                strict
            } else {
                never
            }
        }
        // A drive that acts late, whatever delays it, is an effect of the library.
        Correction::Shift(LogColumn::Input(_), shift_s) if *shift_s > 0.0 => never,
        Correction::Shift(_, shift_s) => {
            if shift_s.abs() > 0.008 {
                strict
            } else {
                never
            }
        }
        Correction::Unit(_) if stands_still(bench, correction) => never,
        Correction::Unit(columns) if scales_little(&bench.model, columns) => {
            if is_long(&bench.model) { never } else { strict }
        }
        // Many turns of an arm are reason enough to doubt a unit.
        Correction::Unit(columns) if doubts_travel(&bench.motions, columns) => {
            CorrectionThreshold {
                ratio: 0.97,
                better: 0.5,
            }
        }
        _ => CorrectionThreshold {
            ratio: 0.8,
            better: 0.7,
        },
    }
}

/// Whether the new units are nearly the given ones, of 4000 counts a turn and of 4096: a scale of a
/// few per cent is what wrong friction looks like, too, where it is not fitted.
fn scales_little(model: &Model, columns: &[(LogColumn, Unit)]) -> bool {
    columns.iter().all(|(quantity, unit)| {
        let given = quantity.column(model).map(|column| column.unit.si);
        given.is_some_and(|given| (unit.si / given - 1.0).abs() < LITTLE_SCALE)
    })
}

const LITTLE_SCALE: f64 = 0.1;
