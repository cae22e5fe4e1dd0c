//! Balancing on board: one tick of reading, law and command.

use crate::design::{POSE_ANGLE, POSE_RATE};
use crate::servos::{Driven, Servo, Servos};
use handstand_shared::crc::extend32;
use handstand_shared::fixed::saturate;
use handstand_shared::law::control;
use handstand_shared::observer::{self, FINE, READINGS};
use handstand_shared::plan::{AppliedInput, Law, Plan};
use handstand_shared::raw::Signed;
use handstand_shared::velocity;

mod attitude;
mod compensation;

use compensation::{coarse, compensation};

/// Ticks a joint's servo may miss before it counts as lost.
const LOST_AFTER: u8 = 3;

/// A joint further off than 10 degrees, in codes, was not put there on purpose.
const POSE_CODES: u16 = 34;

/// Of a reading there was none before. Zero, as all of [`Balance::NONE`]: another value would take
/// a constant of its whole size from the AVR's RAM.
const NEVER_HEARD: u8 = 0;

/// What balancing remembers from tick to tick.
#[derive(Debug, Clone)]
pub struct Balance {
    plan: Plan,
    /// CRC-32 of the plan; none if there is none that can be used.
    fingerprint: Option<u32>,
    velocities: [velocity::Memory; 2],
    estimate: observer::Memory,
    applied: [AppliedInput; 2],
    /// Angles at which the robot balances beside the operating point: the first link's in its
    /// steps, the joints' as readings.
    compensation: [i16; 3],
    /// The first link's angle, in its steps.
    angle: i16,
    /// Of a gyro, the sum of its rates, in 1/10 of an angle step: a rate step lasts that long per
    /// tick. Not divided for the host's angle: it takes the AVR 40 us.
    rate_sum: i32,
    rate: i16,
    /// The gyro's code at rest, times 2^16: the mean of those before arming.
    zero: i32,
    rest: attitude::Rest,
    /// Which readings are new.
    is_heard: [bool; READINGS],
    missed: u8,
    /// Both joints' readings of the tick before, and how many ticks ago each was heard.
    before: [(i16, u8); 2],
}

/// Why it cannot go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// Too far from where the gains hold.
    Fallen,
    /// A joint is out of its range.
    JointRange,
    /// A joint turns faster than it may.
    JointSpeed,
    /// A joint's servo does not answer, the mirrored one included.
    ServoLost,
}

impl Balance {
    /// Without a plan.
    pub const NONE: Balance = Balance {
        plan: Plan::ZERO,
        fingerprint: None,
        velocities: [velocity::Memory::NONE; 2],
        estimate: observer::Memory::ZERO,
        applied: [AppliedInput::NOTHING; 2],
        compensation: [0; 3],
        angle: 0,
        rate_sum: 0,
        rate: 0,
        zero: 0,
        rest: attitude::Rest::NONE,
        is_heard: [false; READINGS],
        missed: 0,
        before: [(0, NEVER_HEARD); 2],
    };

    /// Takes a plan from its bytes, in place: RAM has no room for two. Whether it can be used.
    pub fn load(&mut self, bytes: impl Iterator<Item = u8>) -> bool {
        let mut crc = u32::MAX;
        let mut bytes = bytes.inspect(|byte| crc = extend32(crc, &[*byte]));
        let is_sound = self.plan.fill(&mut bytes);
        drop(bytes);
        self.fingerprint = is_sound.then_some(!crc);
        self.zero = i32::from(self.plan.gyro.zero) << attitude::ZERO_PLACES;
        is_sound
    }

    /// CRC-32 of the plan; none if there is none that can be used.
    pub fn fingerprint(&self) -> Option<u32> {
        self.fingerprint
    }

    /// Begins at rest at the plan's operating point, where the robot's masses balance.
    #[inline(never)]
    pub fn start(&mut self) {
        self.velocities = [velocity::Memory::NONE; 2];
        self.applied = [AppliedInput::NOTHING; 2];
        self.missed = 0;
        self.before = [(0, NEVER_HEARD); 2];
        self.rate = 0;
        self.compensation = compensation(&self.plan.moments);
        let [angle, ..] = self.point();
        self.angle = angle;
        self.rate_sum = i32::from(angle) * 10;
    }

    /// The first link's angle, both joints' in position codes, the first link's rate.
    pub fn readings(&mut self, servos: &Servos) -> Result<[i16; READINGS], Stop> {
        let [shoulder, hip] = &self.plan.joints;
        let (Some(first), Some(second)) = (servos.with_id(shoulder.id), servos.with_id(hip.id))
        else {
            return Err(Stop::ServoLost);
        };
        self.missed = if self.has_servos(servos) {
            0
        } else {
            self.missed.saturating_add(1)
        };
        if self.missed >= LOST_AFTER {
            return Err(Stop::ServoLost);
        }
        let angle = self.angle;
        let [x0, ..] = self.point();
        if angle.abs_diff(x0) > self.plan.range {
            return Err(Stop::Fallen);
        }
        let mut joints = [0; 2];
        let both = [(shoulder, first), (hip, second)];
        for ((q, before), (joint, servo)) in joints.iter_mut().zip(&mut self.before).zip(both) {
            *q = joint.angle(servo.position);
            if !joint.is_in_range(*q) {
                return Err(Stop::JointRange);
            }
            let (last, ago) = *before;
            if !servo.is_present() {
                if ago != NEVER_HEARD {
                    *before = (last, ago.saturating_add(1));
                }
                continue;
            }
            if ago != NEVER_HEARD && !joint.is_slow(q.wrapping_sub(last), ago) {
                return Err(Stop::JointSpeed);
            }
            *before = (*q, 1);
        }
        let [q2, q3] = joints;
        self.is_heard = [true, first.is_present(), second.is_present(), true];
        Ok([angle, q2, q3, self.rate])
    }

    /// The servos that measure the driven joints; none without a plan.
    pub fn measuring(&self) -> Option<[u8; 2]> {
        let [shoulder, hip] = &self.plan.joints;
        self.fingerprint.map(|_| [shoulder.id, hip.id])
    }

    /// All servos it commands.
    pub fn servos(&self) -> Driven {
        Driven::of(&self.plan.joints)
    }

    /// Whether all servos it commands turn without end: others would take its commands for speeds
    /// on the way to their goals.
    pub fn are_wheels(&self, servos: &Servos) -> bool {
        let driven = self.servos();
        driven.ids().iter().all(|id| servos.is_wheel(*id))
    }

    /// Whether all links are near the operating point, and the first one turns slowly.
    pub fn is_posed(&self, readings: &[i16; READINGS]) -> bool {
        let [angle, q2, q3, rate] = *readings;
        let [x1, x2, x3] = self.point();
        angle.abs_diff(x1) <= POSE_ANGLE
            && rate.unsigned_abs() <= POSE_RATE
            && q2.abs_diff(x2) <= POSE_CODES
            && q3.abs_diff(x3) <= POSE_CODES
    }

    /// Begins to estimate from these readings.
    pub fn begin(&mut self, readings: &[i16; READINGS]) {
        let mut balance = self.compensation;
        let [first, ..] = &mut balance;
        if !self.plan.gyro.from_host {
            // Its place is the gyro's offset, and the angle is that from its equilibrium.
            *first = 0;
        }
        let readings = self.seen(readings);
        if let Law::Observer(observer) = &self.plan.law {
            observer.start(&mut self.estimate, &readings, balance);
        }
    }

    /// Readings as an observer wants them: of a gyro the angle from equilibrium.
    fn seen(&self, readings: &[i16; READINGS]) -> [i16; READINGS] {
        let mut seen = fine(readings);
        if let ([angle, ..], [e1, ..]) = (&mut seen, self.compensation)
            && !self.plan.gyro.from_host
        {
            *angle = angle.saturating_sub(e1);
        }
        seen
    }

    /// The servos' commands at these readings, each with its id.
    #[inline(never)]
    pub fn commands(&mut self, readings: &[i16; READINGS]) -> [Option<(u8, Signed)>; 4] {
        let [u2, u3] = self.raw_command(readings);
        let [shoulder, hip] = &self.plan.joints;
        let [applied2, applied3] = &mut self.applied;
        let (u2, u3) = (shoulder.apply(applied2, u2), hip.apply(applied3, u3));
        let [a, b] = shoulder.commands(shoulder.command(u2));
        let [c, d] = hip.commands(hip.command(u3));
        [a, b, c, d]
    }

    fn raw_command(&mut self, readings: &[i16; READINGS]) -> [i16; 2] {
        match &self.plan.law {
            Law::State { table, velocity } => {
                let [angle, q2, q3, rate] = *readings;
                let [v2, v3] = &mut self.velocities;
                let (dq2, dq3) = (velocity.estimate(v2, q2), velocity.estimate(v3, q3));
                // The operating point moves to where the robot balances.
                let [e1, e2, e3] = coarse(self.compensation);
                let states = [
                    angle.saturating_sub(e1),
                    q2.saturating_sub(e2),
                    q3.saturating_sub(e3),
                    rate,
                    dq2,
                    dq3,
                ];
                control(table, &states)
            }
            Law::Observer(observer) => {
                let seen = self.seen(readings);
                observer.raw_command_of(&mut self.estimate, &seen, self.is_heard)
            }
        }
    }

    /// Tells the estimate what was applied; [`Balance::step_update`] does the rest.
    pub fn begin_update(&mut self) {
        if let Law::Observer(observer) = &self.plan.law {
            let applied = [self.applied[0].input, self.applied[1].input];
            observer.begin_update(&mut self.estimate, applied);
        }
    }

    /// A step towards the next estimate, if one is left: 60 us on the AVR.
    #[inline(never)]
    pub fn step_update(&mut self) {
        if let Law::Observer(observer) = &self.plan.law {
            observer.step_update(&mut self.estimate);
        }
    }

    /// Whether all servos it commands answered.
    pub fn has_servos(&self, servos: &Servos) -> bool {
        let is_there = |id: &u8| servos.with_id(*id).is_some_and(Servo::is_present);
        self.servos().ids().iter().all(is_there)
    }

    /// The operating point with compensation: the first link's angle, and both joints' in codes.
    fn point(&self) -> [i16; 3] {
        let [x1, x2, x3] = match &self.plan.law {
            Law::State { table, .. } => {
                let [x1, x2, x3, ..] = table.x0;
                [x1, x2, x3]
            }
            // An observer's readings are departures from upright.
            Law::Observer(_) => [0; 3],
        };
        let [e1, e2, e3] = coarse(self.compensation);
        [
            x1.saturating_add(e1),
            x2.saturating_add(e2),
            x3.saturating_add(e3),
        ]
    }
}

/// Readings with the places an observer wants.
fn fine(readings: &[i16; READINGS]) -> [i16; READINGS] {
    let [angle, q2, q3, rate] = *readings;
    let fine = |q| saturate(i32::from(q) << FINE, i16::MIN, i16::MAX);
    [angle, fine(q2), fine(q3), rate]
}
