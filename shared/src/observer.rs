//! Observer-based state feedback for three links of which two are driven: the law for servos that
//! measure neither speed nor attitude, and act late.
//!
//! A Kalman filter with LQR gains behind it, on known past inputs:
//!
//! ```text
//! innovation  = readings - predict [estimate, past inputs]           four readings
//! raw command = sat(feedback [estimate, past inputs, innovation])    two inputs
//! next        = update [estimate, past inputs, innovation, applied]  eleven states
//! ```
//!
//! `applied` is the input that went out after dead zone, slew and limits. All three are
//! [`GainTable`]s: 16-bit words, 32-bit sums that no states overflow, one rounding and one
//! saturation per row. Multiplied out to two tables on the readings themselves it would be shorter,
//! but rounded gains that should cancel would not, and the slowest mode would grow. Delayed inputs
//! are kept exactly. The estimate is [angles, speeds, equilibrium angles] of the three joints and
//! the torques of the two drives, which follow their inputs late. Where nothing measures the first
//! link's angle, only its departure from its equilibrium can be estimated: its angle is that, and
//! the gyro's offset takes the place of its equilibrium angle.

use crate::gains::{GainTable, take};
use crate::law::{control, departure, input};

/// Inputs.
pub const INPUTS: usize = 2;
/// Joints, the first of them passive.
pub const JOINTS: usize = 3;
/// Estimated states: angles, speeds, equilibrium angles, torques.
pub const ESTIMATED: usize = 3 * JOINTS + INPUTS;
/// Sample periods an input may be on its way.
pub const DELAYS: usize = 3;
/// Past inputs, the newest first.
pub const PAST: usize = DELAYS * INPUTS;
/// Readings: the angles, then the first link's rate.
pub const READINGS: usize = JOINTS + 1;
/// Width of what readings are predicted from.
pub const STATE: usize = ESTIMATED + PAST;
/// Width of what the feedback acts on.
pub const SEEN: usize = STATE + READINGS;
/// Width of what the update acts on.
pub const WIDTH: usize = SEEN + INPUTS;

/// Binary places of a driven joint's reading below a position code.
pub const FINE: u8 = 5;

/// Fixed-point observer and feedback.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observer {
    /// From estimate and past inputs to the readings, in the innovation's steps.
    pub predict: GainTable<READINGS, STATE>,
    /// From those and the innovation to the inputs.
    pub feedback: GainTable<INPUTS, SEEN>,
    /// From all that and the applied inputs to the next estimate.
    pub update: GainTable<ESTIMATED, WIDTH>,
    /// Binary places of the innovation below the readings' steps; estimated angles have as many.
    pub reading_places: [u8; READINGS],
    /// Binary places of the equilibrium angles below the readings' steps.
    pub balance_places: [u8; JOINTS],
}

/// Work that is done in steps, while servos are awaited: what the next readings should be, then,
/// once inputs were applied, the next estimate, and from it the readings behind it.
///
/// Of a prediction: the departures, then a row per reading.
const PREDICT: u8 = 0;
const PREDICT_ROW: u8 = PREDICT + 1;
/// The readings are predicted; nothing is left.
const PREDICTED: u8 = PREDICT_ROW + READINGS as u8;
/// Of an update: the departures, then a row per estimated state.
const UPDATE: u8 = PREDICTED + 1;
/// The last row of an update; a prediction follows.
const LAST: u8 = UPDATE + ESTIMATED as u8;

/// State of the observer: estimate, past inputs, innovation and applied inputs, and the next
/// estimate while it is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    all: [i16; WIDTH],
    departure: [i16; WIDTH],
    next: [i16; ESTIMATED],
    predicted: [i16; READINGS],
    /// The step that is next.
    step: u8,
}

impl Memory {
    /// Of nothing.
    pub const ZERO: Memory = Memory::of([0; WIDTH]);

    /// Of all this.
    pub const fn of(all: [i16; WIDTH]) -> Self {
        Memory {
            all,
            departure: [0; WIDTH],
            next: [0; ESTIMATED],
            predicted: [0; READINGS],
            step: PREDICT,
        }
    }

    /// Estimate, past inputs, last innovation and last applied inputs, in the tables' steps.
    pub fn all(&self) -> &[i16; WIDTH] {
        &self.all
    }
}

impl Observer {
    /// Number of its bytes.
    pub const LENGTH: usize = GainTable::<READINGS, STATE>::LENGTH
        + GainTable::<INPUTS, SEEN>::LENGTH
        + GainTable::<ESTIMATED, WIDTH>::LENGTH
        + READINGS
        + JOINTS;

    /// One of zeros.
    pub const ZERO: Observer = Observer {
        predict: GainTable::ZERO,
        feedback: GainTable::ZERO,
        update: GainTable::ZERO,
        reading_places: [0; READINGS],
        balance_places: [0; JOINTS],
    };

    /// Hands its bytes to `sink`: the tables' canonical ones, then the places.
    pub fn bytes(&self, mut sink: impl FnMut(u8)) {
        self.predict.bytes(&mut sink);
        self.feedback.bytes(&mut sink);
        self.update.bytes(&mut sink);
        let places = self.reading_places.iter().chain(&self.balance_places);
        places.for_each(|byte| sink(*byte));
    }

    /// Overwrites it by the next bytes, as [`GainTable::fill`].
    pub fn fill(&mut self, from: &mut impl Iterator<Item = u8>) -> Option<()> {
        self.predict.fill(from)?;
        self.feedback.fill(from)?;
        self.update.fill(from)?;
        self.reading_places = take(from)?;
        self.balance_places = take(from)?;
        Some(())
    }

    /// Whether no states whatever overflow a sum.
    pub fn is_safe(&self) -> bool {
        self.predict.is_safe() && self.feedback.is_safe() && self.update.is_safe()
    }

    /// At rest at these readings; `balance` are the angles at which the robot is expected to
    /// balance, in the readings' steps.
    pub fn start(&self, memory: &mut Memory, readings: &[i16; READINGS], balance: [i16; JOINTS]) {
        *memory = Memory::ZERO;
        let (angles, rest) = memory.all.split_at_mut(JOINTS);
        let finer_readings = readings.iter().zip(self.reading_places);
        for (to, (from, places)) in angles.iter_mut().zip(finer_readings) {
            *to = finer(*from, places);
        }
        let balances = rest.iter_mut().skip(JOINTS);
        for ((to, from), places) in balances.zip(balance).zip(self.balance_places) {
            *to = finer(from, places);
        }
    }

    /// Raw command at these readings. Finishes what is pending first.
    pub fn raw_command(&self, memory: &mut Memory, readings: &[i16; READINGS]) -> [i16; INPUTS] {
        self.raw_command_of(memory, readings, [true; READINGS])
    }

    /// The same where some readings are missing: those are as they were predicted.
    #[inline(never)]
    pub fn raw_command_of(
        &self,
        memory: &mut Memory,
        readings: &[i16; READINGS],
        is_heard: [bool; READINGS],
    ) -> [i16; INPUTS] {
        self.finish(memory);
        let predicted = memory.predicted;
        let place = memory.all.iter_mut().skip(STATE);
        let read = readings.iter().zip(self.reading_places).zip(predicted);
        for (to, (((reading, places), predicted), is_heard)) in place.zip(read.zip(is_heard)) {
            *to = if is_heard {
                finer(*reading, places).saturating_sub(predicted)
            } else {
                0
            };
        }
        match memory.all.first_chunk() {
            Some(seen) => control(&self.feedback, seen),
            None => [0; INPUTS],
        }
    }

    /// Update the estimate by a sample under the applied inputs.
    pub fn update(&self, memory: &mut Memory, applied: [i16; INPUTS]) {
        self.begin_update(memory, applied);
        self.finish(memory);
    }

    /// Begin an update under the applied inputs: [`Observer::step_update`] does the work in steps,
    /// between which the caller may wait for something else.
    pub fn begin_update(&self, memory: &mut Memory, applied: [i16; INPUTS]) {
        let place = memory.all.iter_mut().skip(SEEN);
        place.zip(applied).for_each(|(to, from)| *to = from);
        memory.step = UPDATE;
    }

    /// A step of what is pending; false if nothing is.
    #[inline(never)]
    pub fn step_update(&self, memory: &mut Memory) -> bool {
        let step = memory.step;
        match step {
            PREDICTED => return false,
            PREDICT => {
                if let (Some(state), Some(out)) = (
                    memory.all.first_chunk(),
                    memory.departure.first_chunk_mut::<STATE>(),
                ) {
                    *out = departure(&self.predict.x0, state);
                }
            }
            UPDATE => memory.departure = departure(&self.update.x0, &memory.all),
            PREDICT_ROW..PREDICTED => self.predict_row(memory, step),
            _ => self.update_row(memory, step),
        }
        memory.step = step + 1;
        if step == LAST {
            memory.take_next();
            memory.step = PREDICT;
        }
        true
    }

    fn predict_row(&self, memory: &mut Memory, step: u8) {
        let at = usize::from(step - PREDICT_ROW);
        if let (Some(row), Some(out), Some(state)) = (
            self.predict.rows.get(at),
            memory.predicted.get_mut(at),
            memory.departure.first_chunk::<STATE>(),
        ) {
            *out = input(row, state);
        }
    }

    fn update_row(&self, memory: &mut Memory, step: u8) {
        let at = usize::from(step - UPDATE - 1);
        if let (Some(row), Some(out)) = (self.update.rows.get(at), memory.next.get_mut(at)) {
            *out = input(row, &memory.departure);
        }
    }

    fn finish(&self, memory: &mut Memory) {
        while self.step_update(memory) {}
    }
}

impl Memory {
    /// The next estimate counts, and the applied inputs are the newest past ones.
    fn take_next(&mut self) {
        let all = &mut self.all;
        all.copy_within(ESTIMATED..ESTIMATED + PAST - INPUTS, ESTIMATED + INPUTS);
        all.copy_within(SEEN..SEEN + INPUTS, ESTIMATED);
        all.iter_mut()
            .zip(self.next)
            .for_each(|(to, from)| *to = from);
    }
}

/// `value` in steps 2^-`places` as large, saturating.
fn finer(value: i16, places: u8) -> i16 {
    crate::fixed::saturate(i32::from(value) << (places & 15), i16::MIN, i16::MAX)
}

#[cfg(test)]
mod tests;
