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

/// Steps of an update: the departures, then one per estimated state.
const STEPS: u8 = 1 + ESTIMATED as u8;

/// State of the observer: estimate, past inputs, innovation and applied inputs, and the next
/// estimate while it is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    all: [i16; WIDTH],
    departure: [i16; WIDTH],
    next: [i16; ESTIMATED],
    /// Steps that are left until the next estimate counts; none if no update is under way.
    left: u8,
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
            left: 0,
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

    /// Raw command at these readings. Finishes a pending update first.
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
        let predicted = match memory.all.first_chunk() {
            Some(state) => control(&self.predict, state),
            None => [0; READINGS],
        };
        let place = memory.all.iter_mut().skip(STATE);
        let read = readings.iter().zip(self.reading_places).zip(predicted);
        for (to, (((reading, places), predicted), is_heard)) in place.zip(read.zip(is_heard)) {
            *to = match is_heard {
                true => finer(*reading, places).saturating_sub(predicted),
                false => 0,
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
        memory.left = STEPS;
    }

    /// A step of the pending update; false if there is none. After the last one the next estimate
    /// is valid.
    #[inline(never)]
    pub fn step_update(&self, memory: &mut Memory) -> bool {
        let left = memory.left;
        if left == 0 {
            return false;
        }
        if left == STEPS {
            memory.departure = departure(&self.update.x0, &memory.all);
        } else {
            let at = ESTIMATED - usize::from(left);
            if let (Some(row), Some(next)) = (self.update.rows.get(at), memory.next.get_mut(at)) {
                *next = input(row, &memory.departure);
            }
        }
        memory.left = left - 1;
        if memory.left == 0 {
            memory.take_next();
        }
        true
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
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    /// Readings are predicted as estimated, but for the rate; the estimate stays but for 256 times
    /// the innovation and the first applied input; inputs are minus the driven joints' angles and
    /// inputs two samples old.
    fn observer() -> Observer {
        let mut observer = Observer::ZERO;
        for (i, row) in observer.predict.rows.iter_mut().enumerate() {
            (row.shift, row.low, row.high) = (8, i16::MIN, i16::MAX);
            if i < JOINTS {
                row.k[i] = -256;
            }
        }
        for (i, row) in observer.update.rows.iter_mut().enumerate() {
            (row.shift, row.low, row.high) = (8, i16::MIN, i16::MAX);
            if i < JOINTS {
                row.k[i] = -256;
                row.k[STATE + i] = -128;
                row.k[SEEN] = -3 * 256;
            }
        }
        for (i, row) in observer.feedback.rows.iter_mut().enumerate() {
            (row.shift, row.low, row.high) = (8, -100, 100);
            row.k[i + 1] = 256;
            row.k[ESTIMATED + INPUTS + i] = 256;
        }
        observer.reading_places = [1, 1, 1, 0];
        observer.balance_places = [0, 2, 3];
        observer
    }

    #[test]
    fn it_starts_at_the_readings_and_remembers_what_was_given() {
        let observer = observer();
        let mut memory = Memory::ZERO;
        observer.start(&mut memory, &[10, 20, 30, 40], [1, 2, 3]);
        assert_eq!(
            memory.all()[..ESTIMATED],
            [20, 40, 60, 0, 0, 0, 1, 8, 24, 0, 0]
        );
        assert_eq!(
            observer.raw_command(&mut memory, &[10, 20, 30, 40]),
            [-40, -60]
        );
        assert_eq!(memory.all()[STATE..SEEN], [0, 0, 0, 40]);
        observer.update(&mut memory, [7, 9]);
        assert_eq!(memory.all()[..JOINTS], [41, 61, 81]);
        assert_eq!(memory.all()[ESTIMATED..STATE], [7, 9, 0, 0, 0, 0]);
        observer.raw_command(&mut memory, &[20, 31, 40, 0]);
        assert_eq!(memory.all()[STATE..SEEN], [-1, 1, -1, 0]);
        observer.update(&mut memory, [1, 2]);
        // Halves of the innovation are rounded down, for there is no bias.
        assert_eq!(memory.all()[..JOINTS], [43, 64, 83]);
        assert_eq!(memory.all()[ESTIMATED..STATE], [1, 2, 7, 9, 0, 0]);
        assert_eq!(observer.raw_command(&mut memory, &[0; 4]), [-71, -92]);
        memory.all[1] = 1000;
        assert_eq!(observer.raw_command(&mut memory, &[0; 4]), [-100, -92]);
        // A reading that is missing is the one predicted.
        let heard = [true, false, true, false];
        observer.raw_command_of(&mut memory, &[30, 99, 50, 77], heard);
        let all = observer.raw_command(&mut memory, &[30, 99, 50, 77]);
        let [first, _, third, _] = *memory.all()[STATE..SEEN].first_chunk::<4>().unwrap();
        let some = observer.raw_command_of(&mut memory, &[30, 99, 50, 77], heard);
        assert_eq!(memory.all()[STATE..SEEN], [first, 0, third, 0]);
        assert_eq!(all, some);
        // Innovations saturate.
        observer.raw_command(&mut memory, &[i16::MIN, i16::MAX, 0, 0]);
        assert_eq!(memory.all()[STATE..STATE + 2], [i16::MIN, i16::MAX - 1000]);
    }

    #[test]
    fn the_next_estimate_counts_from_the_last_step_on() {
        let observer = observer();
        let mut memory = Memory::ZERO;
        observer.start(&mut memory, &[10, 20, 30, 40], [1, 2, 3]);
        assert!(!observer.step_update(&mut memory));
        observer.raw_command(&mut memory, &[11, 22, 33, 44]);
        let (mut whole, mut left_to_next) = (memory, memory);
        observer.update(&mut whole, [7, 9]);
        observer.begin_update(&mut memory, [7, 9]);
        let before = memory;
        for _ in 1..STEPS {
            assert!(observer.step_update(&mut memory));
            assert_eq!(memory.all(), before.all());
        }
        assert!(observer.step_update(&mut memory));
        assert_ne!(memory.all(), before.all());
        assert_eq!(memory, whole);
        assert!(!observer.step_update(&mut memory));
        // What was not done meanwhile is done before the next raw command.
        observer.begin_update(&mut left_to_next, [7, 9]);
        let next = [12, 23, 34, 45];
        assert_eq!(
            observer.raw_command(&mut left_to_next, &next),
            observer.raw_command(&mut whole, &next)
        );
        assert_eq!(left_to_next, whole);
        // A new start forgets an update.
        observer.begin_update(&mut memory, [7, 9]);
        observer.start(&mut memory, &[10, 20, 30, 40], [1, 2, 3]);
        assert!(!observer.step_update(&mut memory));
    }

    #[test]
    fn it_survives_its_bytes() {
        let mut bytes = Vec::new();
        observer().bytes(|byte| bytes.push(byte));
        assert_eq!(bytes.len(), Observer::LENGTH);
        let mut back = Observer::ZERO;
        assert_eq!(back.fill(&mut bytes.iter().copied()), Some(()));
        assert_eq!(back, observer());
        assert!(back.is_safe());
        for length in 0..bytes.len() {
            let mut short = bytes[..length].iter().copied();
            assert_eq!(back.fill(&mut short), None);
        }
    }
}
