//! Everything the firmware needs to balance on board: the gain table, and how its states and inputs meet the servos.
//!
//! States, in the table's order: the first link's angle from upright in [`Attitude::ANGLE_LSB_RAD`]; both driven joints'
//! angles in position codes from their centres; the first link's rate in [`Attitude::RATE_LSB_RAD_S`]; both joints' velocities as
//! [`Velocity`] estimates them. Where the centre of mass is eccentric, the table's operating point is where the robot balances:
//! that is the angle compensation, found once on the host.
//!
//! [`Attitude::ANGLE_LSB_RAD`]: crate::message::Attitude::ANGLE_LSB_RAD
//! [`Attitude::RATE_LSB_RAD_S`]: crate::message::Attitude::RATE_LSB_RAD_S

use crate::gains::GainTable;
use crate::raw::{Position, Signed};
use crate::velocity::Velocity;

/// The plan for two driven joints and six states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plan {
    /// The law.
    pub table: GainTable<2, 6>,
    /// The driven joints: shoulder, hip.
    pub joints: [Joint; 2],
    /// How joint velocities are estimated.
    pub velocity: Velocity,
    /// Where the first link's attitude comes from.
    pub gyro: Gyro,
    /// Largest departure of the first link from the operating point before it counts as fallen, in its angle's steps.
    pub range: u16,
}

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
    /// Largest command, at most 1023: the torque limit.
    pub most: u16,
}

/// The first link's attitude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gyro {
    /// From the host's [`crate::message::Attitude`] instead of the gyro.
    pub from_host: bool,
    /// ADC code at rest.
    pub zero: u16,
    /// Rate steps per ADC code, times 16; negative if it is mounted the other way.
    pub scale: i16,
}

const HEAD: usize = GainTable::<2, 6>::LENGTH;

impl Joint {
    const LENGTH: usize = 11;

    /// Angle in position codes from the centre.
    pub fn angle(&self, position: Position) -> i16 {
        let angle = (position.0 as i16).wrapping_sub(self.centre as i16);
        if self.reversed { -angle } else { angle }
    }

    /// The command for an input of the law: nothing for nothing, else beyond the dead zone.
    pub fn command(&self, input: i16) -> i16 {
        if input == 0 {
            return 0;
        }
        let size = (u32::from(input.unsigned_abs()) * u32::from(self.gain)) >> 16;
        let size = (size as u16).saturating_add(self.dead).min(self.most);
        let clockwise = (input < 0) != self.reversed;
        if clockwise {
            -(size as i16)
        } else {
            size as i16
        }
    }

    /// Both servos' commands, each with its id.
    pub fn commands(&self, command: i16) -> impl Iterator<Item = (u8, Signed)> {
        let pair = [(self.id, command), (self.mirror, -command)];
        let there = pair.into_iter().filter(|(id, _)| *id < 254);
        there.map(|(id, command)| (id, Signed::new(command)))
    }
}

impl Plan {
    /// Number of its bytes.
    pub const LENGTH: usize = HEAD + 2 * Joint::LENGTH + 3 + 5 + 2;

    /// Its bytes: the table's canonical ones, then joints, velocity, gyro and range; little-endian.
    pub fn bytes(&self, mut sink: impl FnMut(u8)) {
        self.table.bytes(&mut sink);
        let mut put = |bytes: &[u8]| bytes.iter().for_each(|byte| sink(*byte));
        for joint in &self.joints {
            put(&[joint.id, joint.mirror, u8::from(joint.reversed)]);
            for word in [joint.centre, joint.dead, joint.gain, joint.most] {
                put(&word.to_le_bytes());
            }
        }
        put(&[self.velocity.fraction]);
        put(&self.velocity.share.to_le_bytes());
        put(&[u8::from(self.gyro.from_host)]);
        put(&self.gyro.zero.to_le_bytes());
        put(&self.gyro.scale.to_le_bytes());
        put(&self.range.to_le_bytes());
    }

    /// A plan from its bytes, if they are of this version and safe to use.
    pub fn from_bytes(bytes: &[u8]) -> Option<Plan> {
        let (table, rest) = bytes.split_at_checked(HEAD)?;
        let table = GainTable::from_bytes(table).filter(GainTable::is_safe)?;
        let (first, rest) = rest.split_first_chunk::<{ Joint::LENGTH }>()?;
        let (second, rest) = rest.split_first_chunk::<{ Joint::LENGTH }>()?;
        let &[fraction, s0, s1, from_host, z0, z1, g0, g1, r0, r1] = rest else {
            return None;
        };
        let plan = Plan {
            table,
            joints: [joint(first), joint(second)],
            velocity: Velocity {
                fraction,
                share: u16::from_le_bytes([s0, s1]),
            },
            gyro: Gyro {
                from_host: from_host != 0,
                zero: u16::from_le_bytes([z0, z1]),
                scale: i16::from_le_bytes([g0, g1]),
            },
            range: u16::from_le_bytes([r0, r1]),
        };
        plan.is_sound().then_some(plan)
    }

    fn is_sound(&self) -> bool {
        let joint =
            |j: &Joint| j.id < 254 && j.centre <= 1023 && j.dead <= j.most && j.most <= 1023;
        self.joints.iter().all(joint)
            && self.velocity.fraction <= 7
            && (1..=256).contains(&self.velocity.share)
    }
}

fn joint(bytes: &[u8; Joint::LENGTH]) -> Joint {
    let &[id, mirror, reversed, c0, c1, d0, d1, g0, g1, m0, m1] = bytes;
    Joint {
        id,
        mirror,
        reversed: reversed != 0,
        centre: u16::from_le_bytes([c0, c1]),
        dead: u16::from_le_bytes([d0, d1]),
        gain: u16::from_le_bytes([g0, g1]),
        most: u16::from_le_bytes([m0, m1]),
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    const JOINT: Joint = Joint {
        id: 1,
        mirror: 2,
        reversed: false,
        centre: 512,
        dead: 80,
        gain: 1 << 15,
        most: 1000,
    };

    fn plan() -> Plan {
        Plan {
            table: GainTable::new(
                [[1, -2, 3, -4, 5, -6]; 2],
                [7; 2],
                [16; 2],
                [[-9, 9]; 2],
                [0; 6],
            ),
            joints: [
                JOINT,
                Joint {
                    id: 11,
                    mirror: 255,
                    reversed: true,
                    ..JOINT
                },
            ],
            velocity: Velocity {
                fraction: 4,
                share: 128,
            },
            gyro: Gyro {
                from_host: true,
                zero: 512,
                scale: -77,
            },
            range: 5000,
        }
    }

    #[test]
    fn a_plan_survives_its_bytes_and_shorter_or_unsound_ones_are_refused() {
        let mut bytes = Vec::new();
        plan().bytes(|byte| bytes.push(byte));
        assert_eq!(bytes.len(), Plan::LENGTH);
        assert_eq!(Plan::from_bytes(&bytes), Some(plan()));
        for length in 0..bytes.len() {
            assert_eq!(Plan::from_bytes(&bytes[..length]), None);
        }
        let mut unsound = plan();
        unsound.joints[0].dead = 1001;
        let mut bytes = Vec::new();
        unsound.bytes(|byte| bytes.push(byte));
        assert_eq!(Plan::from_bytes(&bytes), None);
    }

    #[test]
    fn commands_jump_over_the_dead_zone_and_stop_at_the_limit() {
        assert_eq!(
            [0, 1, 2, 200, -200, 30_000].map(|u| JOINT.command(u)),
            [0, 80, 81, 180, -180, 1000]
        );
        let reversed = plan().joints[1];
        assert_eq!(
            (reversed.command(200), reversed.angle(Position(500))),
            (-180, 12)
        );
        let both: Vec<_> = JOINT.commands(-180).collect();
        assert_eq!(both, [(1, Signed::new(-180)), (2, Signed::new(180))]);
        assert_eq!(reversed.commands(5).count(), 1);
    }
}
