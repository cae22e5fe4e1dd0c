//! A law on an estimated state, for three links of which two are driven: what a robot needs whose servos tell neither
//! speed nor balance, and act late.
//!
//! A Kalman filter with the gains behind it, on known past inputs,
//!
//! ```text
//! surprise = readings - expect [estimate, past inputs]           four readings
//! wish     = sat(feedback [estimate, past inputs, surprise])     two inputs
//! next     = update [estimate, past inputs, surprise, given]     nine states
//! ```
//!
//! where `given` is the input that really went out, after dead zone, slew and limits. All three are [`GainTable`]s: 16-bit
//! words, 32-bit sums that no states overflow, one rounding and one saturation per row. Multiplied out to two tables on the readings
//! themselves it would be shorter, but then rounded gains that should cancel would not, and the slowest of its modes
//! would grow. Inputs on their way are kept exactly. The estimate is [angles, speeds, angles of balance] of the three joints.

use crate::gains::{GainTable, take};
use crate::law::{control, departure, input};

/// Inputs.
pub const INPUTS: usize = 2;
/// Joints, the first of them passive.
pub const JOINTS: usize = 3;
/// Estimated states: angles, speeds, angles of balance.
pub const ESTIMATED: usize = 3 * JOINTS;
/// Sample periods an input may be on its way.
pub const DELAYS: usize = 3;
/// Past inputs, the newest first.
pub const PAST: usize = DELAYS * INPUTS;
/// Readings: the angles, then the first link's rate.
pub const READINGS: usize = JOINTS + 1;
/// What readings are expected from.
pub const STATE: usize = ESTIMATED + PAST;
/// What the feedback sees.
pub const SEEN: usize = STATE + READINGS;
/// What the update sees.
pub const WIDTH: usize = SEEN + INPUTS;

/// Binary places of a driven joint's reading below a position code.
pub const FINE: u8 = 5;

/// The machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Observer {
    /// From estimate and past inputs to the readings, in the surprise's steps.
    pub expect: GainTable<READINGS, STATE>,
    /// From those and the surprise to the inputs.
    pub feedback: GainTable<INPUTS, SEEN>,
    /// From all that and the given inputs to the next estimate.
    pub update: GainTable<ESTIMATED, WIDTH>,
    /// Binary places of the surprise below the readings' steps; estimated angles have as many.
    pub reading_places: [u8; READINGS],
    /// Binary places of the angles of balance below the readings' steps.
    pub balance_places: [u8; JOINTS],
}

/// Steps of an update: the departures, then one per estimated state.
const STEPS: u8 = 1 + ESTIMATED as u8;

/// What it remembers: estimate, past inputs, and room for surprise and given inputs; and the next estimate, while it is
/// being made.
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

    /// Estimate, past inputs, last surprise and last given inputs, in the tables' steps.
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
        expect: GainTable::ZERO,
        feedback: GainTable::ZERO,
        update: GainTable::ZERO,
        reading_places: [0; READINGS],
        balance_places: [0; JOINTS],
    };

    /// Hands its bytes to `sink`: the tables' canonical ones, then the places.
    pub fn bytes(&self, mut sink: impl FnMut(u8)) {
        self.expect.bytes(&mut sink);
        self.feedback.bytes(&mut sink);
        self.update.bytes(&mut sink);
        let places = self.reading_places.iter().chain(&self.balance_places);
        places.for_each(|byte| sink(*byte));
    }

    /// Overwrites it by the next bytes, as [`GainTable::fill`].
    pub fn fill(&mut self, from: &mut impl Iterator<Item = u8>) -> Option<()> {
        self.expect.fill(from)?;
        self.feedback.fill(from)?;
        self.update.fill(from)?;
        self.reading_places = take(from)?;
        self.balance_places = take(from)?;
        Some(())
    }

    /// Whether no states whatever overflow a sum.
    pub fn is_safe(&self) -> bool {
        self.expect.is_safe() && self.feedback.is_safe() && self.update.is_safe()
    }

    /// At rest at these readings; `balance` are the angles at which the robot is expected to balance, in the readings' steps.
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

    /// The inputs wished for at these readings. Ends an update that is under way.
    #[inline(never)]
    pub fn wish(&self, memory: &mut Memory, readings: &[i16; READINGS]) -> [i16; INPUTS] {
        self.finish(memory);
        let expected = match memory.all.first_chunk() {
            Some(state) => control(&self.expect, state),
            None => [0; READINGS],
        };
        let place = memory.all.iter_mut().skip(STATE);
        let read = readings.iter().zip(self.reading_places).zip(expected);
        for (to, ((reading, places), expected)) in place.zip(read) {
            *to = finer(*reading, places).saturating_sub(expected);
        }
        match memory.all.first_chunk() {
            Some(seen) => control(&self.feedback, seen),
            None => [0; INPUTS],
        }
    }

    /// Goes on by a sample under the inputs that were really given.
    pub fn learn(&self, memory: &mut Memory, given: [i16; INPUTS]) {
        self.tell(memory, given);
        self.finish(memory);
    }

    /// Begins to go on by a sample under the inputs that were really given: [`Observer::go_on`] does the work, in steps, for
    /// whoever has to wait for something else in between.
    pub fn tell(&self, memory: &mut Memory, given: [i16; INPUTS]) {
        let place = memory.all.iter_mut().skip(SEEN);
        place.zip(given).for_each(|(to, from)| *to = from);
        memory.left = STEPS;
    }

    /// A step of the update that is under way; false if there is none. The last one lets the next estimate count.
    #[inline(never)]
    pub fn go_on(&self, memory: &mut Memory) -> bool {
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
        while self.go_on(memory) {}
    }
}

impl Memory {
    /// The next estimate counts, and the given inputs are the newest past ones.
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

    /// Readings are expected as estimated, but for the rate; the estimate stays but for 256 times the surprise and the
    /// first given input; inputs are minus the driven joints' angles and inputs two samples old.
    fn observer() -> Observer {
        let mut observer = Observer::ZERO;
        for (i, row) in observer.expect.rows.iter_mut().enumerate() {
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
        assert_eq!(memory.all()[..ESTIMATED], [20, 40, 60, 0, 0, 0, 1, 8, 24]);
        assert_eq!(observer.wish(&mut memory, &[10, 20, 30, 40]), [-40, -60]);
        assert_eq!(memory.all()[STATE..SEEN], [0, 0, 0, 40]);
        observer.learn(&mut memory, [7, 9]);
        assert_eq!(memory.all()[..JOINTS], [41, 61, 81]);
        assert_eq!(memory.all()[ESTIMATED..STATE], [7, 9, 0, 0, 0, 0]);
        observer.wish(&mut memory, &[20, 31, 40, 0]);
        assert_eq!(memory.all()[STATE..SEEN], [-1, 1, -1, 0]);
        observer.learn(&mut memory, [1, 2]);
        // Halves of the surprise are rounded down, for there is no bias.
        assert_eq!(memory.all()[..JOINTS], [43, 64, 83]);
        assert_eq!(memory.all()[ESTIMATED..STATE], [1, 2, 7, 9, 0, 0]);
        assert_eq!(observer.wish(&mut memory, &[0; 4]), [-71, -92]);
        memory.all[1] = 1000;
        assert_eq!(observer.wish(&mut memory, &[0; 4]), [-100, -92]);
        // Surprises saturate.
        observer.wish(&mut memory, &[i16::MIN, i16::MAX, 0, 0]);
        assert_eq!(memory.all()[STATE..STATE + 2], [i16::MIN, i16::MAX - 1000]);
    }

    #[test]
    fn the_next_estimate_counts_from_the_last_step_on() {
        let observer = observer();
        let mut memory = Memory::ZERO;
        observer.start(&mut memory, &[10, 20, 30, 40], [1, 2, 3]);
        assert!(!observer.go_on(&mut memory));
        observer.wish(&mut memory, &[11, 22, 33, 44]);
        let (mut whole, mut left_to_wish) = (memory, memory);
        observer.learn(&mut whole, [7, 9]);
        observer.tell(&mut memory, [7, 9]);
        let before = memory;
        for _ in 1..STEPS {
            assert!(observer.go_on(&mut memory));
            assert_eq!(memory.all(), before.all());
        }
        assert!(observer.go_on(&mut memory));
        assert_ne!(memory.all(), before.all());
        assert_eq!(memory, whole);
        assert!(!observer.go_on(&mut memory));
        // What nobody did meanwhile is done before the next wish.
        observer.tell(&mut left_to_wish, [7, 9]);
        let next = [12, 23, 34, 45];
        assert_eq!(
            observer.wish(&mut left_to_wish, &next),
            observer.wish(&mut whole, &next)
        );
        assert_eq!(left_to_wish, whole);
        // A new start forgets an update.
        observer.tell(&mut memory, [7, 9]);
        observer.start(&mut memory, &[10, 20, 30, 40], [1, 2, 3]);
        assert!(!observer.go_on(&mut memory));
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
