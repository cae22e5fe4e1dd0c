//! Everything the firmware needs to balance on board: the law, and how its states and inputs meet
//! the servos.
//!
//! Readings: the first link's angle from upright in [`Attitude::ANGLE_LSB_RAD`], both driven
//! joints' angles in position codes from their centres (an observer's with [`FINE`] more places),
//! the first link's rate in [`Attitude::RATE_LSB_RAD_S`]. A law on plain states has both joints'
//! velocities behind them, as [`Velocity`] estimates them.
//!
//! [`Attitude::ANGLE_LSB_RAD`]: crate::message::Attitude::ANGLE_LSB_RAD
//! [`Attitude::RATE_LSB_RAD_S`]: crate::message::Attitude::RATE_LSB_RAD_S
//! [`FINE`]: crate::observer::FINE

use crate::crc::extend32;
use crate::gains::{GainTable, take};
use crate::observer::Observer;
use crate::velocity::Velocity;

mod joint;
mod parts;

pub use joint::{AppliedInput, Joint};
pub use parts::{Gyro, Moment};

/// Version of the bytes.
pub const VERSION: u8 = 4;

/// Largest departure of the first link, 1e-4 rad: beyond a right angle it hangs.
const MOST_RANGE: u16 = 15_708;

/// The plan for three links and two driven joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// The law.
    pub law: Law,
    /// The driven joints: shoulder, hip.
    pub joints: [Joint; 2],
    /// Where the first link's attitude comes from.
    pub gyro: Gyro,
    /// What the links' centres of mass ask of the angles: the paper's angle compensation.
    pub moments: [Moment; 3],
    /// Largest departure of the first link from the operating point before it counts as fallen, in
    /// its angle's steps.
    pub range: u16,
}

/// The law on board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
// The larger one is what ships; a box there is not.
#[allow(clippy::large_enum_variant)]
pub enum Law {
    /// On an estimated state. Comes first: a plan of zeros is then all zeros, which take no
    /// constant from the AVR's RAM.
    Observer(Observer),
    /// u = sat(u0 - K (x - x0)) of angles and differenced speeds: the paper's regulator.
    State {
        /// The gains.
        table: GainTable<2, 6>,
        /// How joint velocities are estimated.
        velocity: Velocity,
    },
}

const STATE: u8 = 0;
const OBSERVER: u8 = 1;

impl Law {
    fn bytes(&self, sink: &mut impl FnMut(u8)) {
        match self {
            Law::State { table, velocity } => {
                sink(STATE);
                table.bytes(&mut *sink);
                sink(velocity.fraction);
                velocity.share.to_le_bytes().into_iter().for_each(sink);
            }
            Law::Observer(observer) => {
                sink(OBSERVER);
                observer.bytes(sink);
            }
        }
    }

    fn fill(&mut self, from: &mut impl Iterator<Item = u8>) -> Option<()> {
        match (from.next()?, &self) {
            (STATE, Law::State { .. }) | (OBSERVER, Law::Observer(_)) => {}
            (STATE, Law::Observer(_)) => {
                *self = Law::State {
                    table: GainTable::ZERO,
                    velocity: Velocity::DIFFERENCE,
                };
            }
            (OBSERVER, Law::State { .. }) => *self = Law::Observer(Observer::ZERO),
            _ => return None,
        }
        match self {
            Law::State { table, velocity } => {
                table.fill(from)?;
                [velocity.fraction] = take(from)?;
                velocity.share = u16::from_le_bytes(take(from)?);
            }
            Law::Observer(observer) => observer.fill(from)?,
        }
        Some(())
    }

    fn is_sound(&self) -> bool {
        match self {
            Law::State { table, velocity } => {
                table.is_safe() && velocity.fraction <= 7 && (1..=256).contains(&velocity.share)
            }
            Law::Observer(observer) => observer.is_safe(),
        }
    }
}

impl Plan {
    /// Most bytes a plan has: one with an observer.
    pub const MOST: usize =
        2 + Observer::LENGTH + 2 * Joint::LENGTH + Gyro::LENGTH + 3 * Moment::LENGTH + 2;

    /// A plan that balances nothing.
    pub const ZERO: Plan = Plan {
        law: Law::Observer(Observer::ZERO),
        joints: [Joint::ZERO; 2],
        gyro: Gyro::ZERO,
        moments: [Moment::ZERO; 3],
        range: 0,
    };

    /// Its bytes, little-endian: version, kind of law, the law, joints, gyro, moments, range.
    pub fn bytes(&self, mut sink: impl FnMut(u8)) {
        sink(VERSION);
        self.law.bytes(&mut sink);
        self.joints.iter().for_each(|joint| joint.bytes(&mut sink));
        self.gyro.bytes(&mut sink);
        self.moments
            .iter()
            .for_each(|moment| moment.bytes(&mut sink));
        self.range.to_le_bytes().into_iter().for_each(sink);
    }

    /// A plan from its bytes, if they are of this version and safe to use.
    pub fn from_bytes(bytes: &[u8]) -> Option<Plan> {
        let mut plan = Plan::ZERO;
        plan.fill(&mut bytes.iter().copied()).then_some(plan)
    }

    /// Overwrites the plan by all these bytes; whether they are of this version, end with the plan
    /// and are safe to use. If not, the plan is spoilt.
    pub fn fill(&mut self, from: &mut impl Iterator<Item = u8>) -> bool {
        self.filled(from).is_some() && from.next().is_none() && self.is_sound()
    }

    fn filled(&mut self, from: &mut impl Iterator<Item = u8>) -> Option<()> {
        if from.next()? != VERSION {
            return None;
        }
        self.law.fill(from)?;
        for joint in &mut self.joints {
            *joint = Joint::from_bytes(take(from)?);
        }
        self.gyro = Gyro::from_bytes(take(from)?);
        for moment in &mut self.moments {
            *moment = Moment::from_bytes(take(from)?);
        }
        self.range = u16::from_le_bytes(take(from)?);
        Some(())
    }

    /// CRC-32 of its bytes: two plans with one fingerprint are the same.
    pub fn fingerprint(&self) -> u32 {
        let mut crc = u32::MAX;
        self.bytes(|byte| crc = extend32(crc, &[byte]));
        !crc
    }

    fn is_sound(&self) -> bool {
        let [shoulder, hip] = &self.joints;
        self.law.is_sound()
            && self.joints.iter().all(Joint::is_sound)
            && shoulder.is_apart_from(hip)
            && self.gyro.is_sound()
            && self.range <= MOST_RANGE
    }
}

#[cfg(test)]
mod tests;
