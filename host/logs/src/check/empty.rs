//! Columns without any value in a motion, which the reader refuses.

use super::finding::Findings;
use crate::LogReason;
use crate::error::Place;
use crate::model::LogColumns;
use crate::row::LogRow;

/// Which quantities a motion has a value of.
#[derive(Debug, Default, Clone, Copy)]
struct Known {
    position: bool,
    velocity: bool,
    rate: bool,
    input: bool,
    /// An energised row of the motion came before its first input.
    input_lacks: bool,
}

/// Running account of the present motion of a file.
pub(super) struct EmptyColumns<'a> {
    columns: &'a LogColumns,
    file: String,
    joints: Vec<Known>,
    supply: bool,
}

impl<'a> EmptyColumns<'a> {
    /// Of a file of this name.
    pub fn new(columns: &'a LogColumns, file: String) -> Self {
        EmptyColumns {
            columns,
            file,
            joints: vec![Known::default(); columns.joints.len()],
            supply: false,
        }
    }

    pub fn take(&mut self, row: &LogRow) {
        let finite = |value: Option<f64>| value.is_some_and(f64::is_finite);
        self.supply |= finite(row.supply_v);
        for (joint, known) in self.joints.iter_mut().enumerate() {
            known.position |= row.position_rad[joint].is_finite();
            known.velocity |= finite(row.velocity_rad_s[joint]);
            // A log of a format that has no rates lacks no column.
            known.rate |= row.rate_rad_s[joint].is_none_or(f64::is_finite);
            known.input |= finite(row.input[joint]);
            known.input_lacks |= !known.input && row.torque_on != Some(false);
        }
    }

    /// Begins a motion.
    pub fn begin(&mut self) {
        *self = EmptyColumns::new(self.columns, std::mem::take(&mut self.file));
    }

    /// Ends the motion: refuses what it has no value of.
    pub fn close(&mut self, place: &Place, findings: &mut Findings) {
        let mut refuse = |column: String| {
            let motion = self.file.clone();
            let reason = LogReason::EmptyColumn { column, motion };
            findings.refuse("missing", place.clone(), &reason);
        };
        for (known, columns) in self.joints.iter().zip(&self.columns.joints) {
            let measured = match (&columns.position, &columns.velocity) {
                (Some(position), _) => (!known.position).then_some(position),
                (None, velocity) => velocity.as_ref().filter(|_| !known.velocity),
            };
            let input = columns.input.as_ref().filter(|_| known.input_lacks);
            let rate = columns.rate.as_ref().filter(|_| !known.rate);
            let empty = measured.into_iter().chain(rate).chain(input);
            empty.for_each(|column| refuse(column.name()));
        }
        if let Some(supply) = self.columns.supply.as_ref().filter(|_| !self.supply) {
            refuse(supply.name.clone());
        }
        self.begin();
    }
}
