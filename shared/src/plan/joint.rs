//! One driven joint: from its servo's position to the law's reading, from the law's raw command to
//! the servo's command.

use crate::raw::{Position, Signed};

/// One driven joint, moved by one servo or by two facing each other, in wheel mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Joint {
    /// The servo that measures and drives.
    pub id: u8,
    /// The servo that drives along, mirrored; 255 if there is none.
    pub mirror: u8,
    /// Whether the joint's angle falls when the servo turns counter-clockwise.
    pub reversed: bool,
    /// Position code at the joint's zero.
    pub centre: u16,
    /// Command at which the servo begins to move: its dead zone, jumped over.
    pub dead: u16,
    /// Command codes per step of the law's input, times 65536.
    pub gain: u16,
    /// Least input that surely passes, in steps, where a servo obeys whole what it obeys at all:
    /// less is saved up until it is worth giving. 0 for servos whose torque begins at nothing
    /// behind the dead zone.
    pub least: i16,
    /// Largest input, in steps: the torque limit.
    pub most: i16,
    /// Largest change of the input in one tick, in steps.
    pub slew: i16,
    /// Least angle at which the robot may be driven, position codes from the centre.
    pub lowest: i16,
    /// Largest one.
    pub highest: i16,
    /// Largest change of the angle in one tick, position codes.
    pub fastest: u16,
}

/// Ids from here on are no servo's.
const NO_SERVO: u8 = 254;

/// Largest dead zone that leaves room for commands: half of the largest command.
const MOST_DEAD: u16 = 511;

/// What was applied last, and what is still owed, in steps of the input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AppliedInput {
    /// The input applied last.
    pub input: i16,
    owed: i16,
}

impl AppliedInput {
    /// Nothing applied, nothing owed.
    pub const NOTHING: AppliedInput = AppliedInput { input: 0, owed: 0 };
}

impl Joint {
    pub(super) const LENGTH: usize = 21;

    pub(super) const ZERO: Joint = Joint {
        id: 0,
        mirror: 0,
        reversed: false,
        centre: 0,
        dead: 0,
        gain: 0,
        least: 0,
        most: 0,
        slew: 0,
        lowest: 0,
        highest: 0,
        fastest: 0,
    };

    /// Angle in position codes from the centre.
    pub fn angle(&self, position: Position) -> i16 {
        let angle = (position.0 as i16).wrapping_sub(self.centre as i16);
        if self.reversed { -angle } else { angle }
    }

    /// Whether the robot may be driven at this angle, position codes from the centre.
    pub fn is_in_range(&self, angle: i16) -> bool {
        (self.lowest..=self.highest).contains(&angle)
    }

    /// Whether the angle may change so much, position codes, in so many ticks.
    pub fn is_slow(&self, change: i16, ticks: u8) -> bool {
        u32::from(change.unsigned_abs()) <= u32::from(self.fastest) * u32::from(ticks)
    }

    /// The input that is applied for one that is commanded: within the limits of size and change,
    /// and never one that would vanish in the dead zone. What falls short of `least` is owed.
    pub fn apply(&self, applied: &mut AppliedInput, raw_command: i16) -> i16 {
        let owed = raw_command.saturating_add(applied.owed);
        let half = self.least / 2;
        let whole = if owed.unsigned_abs() < half.unsigned_abs() {
            0
        } else {
            self.beyond_least(owed)
        };
        let last = applied.input;
        let (low, high) = (
            last.saturating_sub(self.slew),
            last.saturating_add(self.slew),
        );
        let mut input = whole.max(-self.most).min(self.most).max(low).min(high);
        if input != 0 && input.unsigned_abs() < self.least.unsigned_abs() {
            // The slew's limit lies in the dead zone: nothing, or as little as passes on the side
            // it comes from.
            input = if (low..=high).contains(&0) {
                0
            } else {
                self.beyond_least(last.signum())
            };
        }
        applied.input = input;
        // What a limit holds back is not owed: it would come when it is no longer wanted.
        applied.owed = owed.saturating_sub(input).max(-half).min(half);
        input
    }

    fn beyond_least(&self, input: i16) -> i16 {
        if input < 0 {
            input.min(-self.least)
        } else {
            input.max(self.least)
        }
    }

    /// The command for an input: nothing for nothing, else beyond the dead zone.
    pub fn command(&self, input: i16) -> i16 {
        if input == 0 {
            return 0;
        }
        let size = u32::from(input.unsigned_abs()) * u32::from(self.gain);
        let size = (size.wrapping_add(0x8000) >> 16) as u16;
        let size = size.saturating_add(self.dead).min(1023);
        let clockwise = (input < 0) != self.reversed;
        if clockwise {
            -(size as i16)
        } else {
            size as i16
        }
    }

    /// The servo that measures and drives, and the one that drives along, if one does.
    pub fn servos(&self) -> [Option<u8>; 2] {
        [self.id, self.mirror].map(|id| (id < NO_SERVO).then_some(id))
    }

    /// Both servos' commands, each with its id.
    pub fn commands(&self, command: i16) -> [Option<(u8, Signed)>; 2] {
        let [own, mirrored] = self.servos();
        let of = |id: Option<u8>, command| id.map(|id| (id, Signed::new(command)));
        [of(own, command), of(mirrored, -command)]
    }

    /// Whether the servo has a code for this angle that is not the last of its range: in wheel mode
    /// it says that one, or any, beyond.
    fn is_measured(&self, angle: i16) -> bool {
        let angle = i32::from(if self.reversed {
            angle.wrapping_neg()
        } else {
            angle
        });
        (1..=1022).contains(&(i32::from(self.centre) + angle))
    }

    /// Whether no servo drives both joints: it would be given two commands.
    pub(super) fn is_apart_from(&self, other: &Joint) -> bool {
        let own = self.servos().into_iter().flatten();
        own.into_iter()
            .all(|id| !other.servos().contains(&Some(id)))
    }

    pub(super) fn is_sound(&self) -> bool {
        self.id < NO_SERVO
            && self.centre <= 1023
            && self.mirror != self.id
            // Else every command would be the largest.
            && self.dead <= MOST_DEAD
            && (0..=self.most).contains(&self.least)
            // Else it could never leave nothing.
            && self.slew >= self.least.max(1)
            && self.is_in_range(0)
            && self.is_measured(self.lowest)
            && self.is_measured(self.highest)
            && (1..=1023).contains(&self.fastest)
    }

    pub(super) fn bytes(&self, sink: &mut impl FnMut(u8)) {
        [self.id, self.mirror, u8::from(self.reversed)]
            .into_iter()
            .for_each(&mut *sink);
        let codes = [self.centre, self.dead, self.gain].map(u16::to_le_bytes);
        let steps = [self.least, self.most, self.slew].map(i16::to_le_bytes);
        let range = [self.lowest, self.highest].map(i16::to_le_bytes);
        let words = codes.into_iter().chain(steps).chain(range);
        words
            .chain([self.fastest.to_le_bytes()])
            .flatten()
            .for_each(sink);
    }

    pub(super) fn from_bytes(bytes: [u8; Joint::LENGTH]) -> Self {
        let [
            id,
            mirror,
            reversed,
            c0,
            c1,
            d0,
            d1,
            g0,
            g1,
            l0,
            l1,
            m0,
            m1,
            s0,
            s1,
            a0,
            a1,
            b0,
            b1,
            f0,
            f1,
        ] = bytes;
        Joint {
            id,
            mirror,
            reversed: reversed != 0,
            centre: u16::from_le_bytes([c0, c1]),
            dead: u16::from_le_bytes([d0, d1]),
            gain: u16::from_le_bytes([g0, g1]),
            least: i16::from_le_bytes([l0, l1]),
            most: i16::from_le_bytes([m0, m1]),
            slew: i16::from_le_bytes([s0, s1]),
            lowest: i16::from_le_bytes([a0, a1]),
            highest: i16::from_le_bytes([b0, b1]),
            fastest: u16::from_le_bytes([f0, f1]),
        }
    }
}
