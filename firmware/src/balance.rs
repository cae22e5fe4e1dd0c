//! Balancing on board: one tick of reading, law and command.

use crate::servos::Servos;
use handstand_shared::crc::extend32;
use handstand_shared::fixed::saturate;
use handstand_shared::law::control;
use handstand_shared::message::Attitude;
use handstand_shared::observer::{self, FINE, READINGS};
use handstand_shared::plan::{AppliedInput, Gyro, Joint, Law, Moment, Plan};
use handstand_shared::raw::{Position, Signed};
use handstand_shared::velocity;
use micromath::F32Ext;

/// Ticks a joint's servo may miss before it counts as lost.
const LOST_AFTER: u8 = 3;

/// A joint further off than 10 degrees, in codes, was not put there on purpose.
const POSE_CODES: u16 = 34;

/// Of a reading there was none before. Zero, as all of [`Balance::NONE`]: another value would take a
/// constant of its whole size from the AVR's RAM.
const NEVER_HEARD: u8 = 0;

/// Binary places of the gyro's mean code.
const ZERO_PLACES: u8 = 16;

/// The mean forgets with a time constant of 2^5 ticks, 0.32 s.
const REST_SHIFT: u8 = 5;

/// Binary places of the gyro's code that the rate is computed with: times any scale it stays within
/// 32 bits.
const CODE_PLACES: u8 = 4;

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
    /// The first link's angle, in 1/10 of its step: a rate step lasts 1/10 angle step per tick.
    angle: i32,
    rate: i16,
    /// The gyro's code at rest, times 2^16: the mean of those before arming.
    zero: i32,
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
        rate: 0,
        zero: 0,
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
        self.zero = i32::from(self.plan.gyro.zero) << ZERO_PLACES;
        is_sound
    }

    /// Torque is off: the gyro's code goes into the mean of those at rest.
    pub fn rest(&mut self, gyro: u16) {
        // Both below 2^26.
        let off = (i32::from(gyro as i16) << ZERO_PLACES).wrapping_sub(self.zero);
        self.zero = self.zero.wrapping_add(off >> REST_SHIFT);
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
        self.angle = i32::from(angle) * 10;
    }

    /// Takes the first link's attitude: the host's, if the plan wants it, or the gyro's rate and
    /// its sum.
    pub fn sense(&mut self, host: Attitude, gyro: u16) {
        if self.plan.gyro.from_host {
            self.rate = host.rate;
            self.angle = i32::from(host.angle) * 10;
            return;
        }
        let code = i32::from(gyro as i16) << CODE_PLACES;
        let code = code.wrapping_sub(self.zero >> (ZERO_PLACES - CODE_PLACES));
        let rate = code.wrapping_mul(i32::from(self.plan.gyro.scale)) >> (4 + CODE_PLACES);
        self.rate = rate.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16;
        // 1e-3 rad/s for 10 ms are 1e-5 rad: 1/10 of the angle's step.
        let angle = self.angle.saturating_add(i32::from(self.rate));
        self.angle = angle.clamp(-320_000, 320_000);
    }

    /// The first link's angle, both joints' in position codes, the first link's rate.
    pub fn readings(&mut self, servos: &Servos) -> Result<[i16; READINGS], Stop> {
        let [shoulder, hip] = &self.plan.joints;
        let (Some(first), Some(second)) = (servos.with_id(shoulder.id), servos.with_id(hip.id))
        else {
            return Err(Stop::ServoLost);
        };
        self.missed = match self.has_servos(servos) {
            true => 0,
            false => self.missed.saturating_add(1),
        };
        if self.missed >= LOST_AFTER {
            return Err(Stop::ServoLost);
        }
        let angle = (self.angle / 10) as i16;
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
            if !servo.present {
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
        self.is_heard = [true, first.present, second.present, true];
        Ok([angle, q2, q3, self.rate])
    }

    /// Whether the host must say the first link's attitude.
    pub fn needs_attitude(&self) -> bool {
        self.plan.gyro.from_host
    }

    /// The gyro as the plan has it, its zero as measured since; zero and scale are 0 without a
    /// plan.
    pub fn gyro(&self) -> Gyro {
        match self.fingerprint {
            Some(_) => Gyro {
                zero: ((self.zero + (1 << (ZERO_PLACES - 1))) >> ZERO_PLACES) as u16,
                ..self.plan.gyro
            },
            None => Plan::ZERO.gyro,
        }
    }

    /// The servos that measure the driven joints; none without a plan.
    pub fn measuring(&self) -> Option<[u8; 2]> {
        let [shoulder, hip] = &self.plan.joints;
        self.fingerprint.map(|_| [shoulder.id, hip.id])
    }

    /// Whether all servos it commands turn without end: others would take its commands for speeds
    /// on the way to their goals.
    pub fn are_wheels(&self, servos: &Servos) -> bool {
        let is_wheel = |id: u8| id >= 254 || servos.is_wheel(id);
        let are_wheels = |joint: &Joint| is_wheel(joint.id) && is_wheel(joint.mirror);
        self.plan.joints.iter().all(are_wheels)
    }

    /// Whether the driven joints are near the operating point.
    pub fn is_posed(&self, readings: &[i16; READINGS]) -> bool {
        let both = readings.iter().zip(self.point());
        both.skip(1).all(|(q, x)| q.abs_diff(x) <= POSE_CODES)
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
    pub fn commands(
        &mut self,
        readings: &[i16; READINGS],
    ) -> impl Iterator<Item = (u8, Signed)> + use<> {
        let [u2, u3] = self.raw_command(readings);
        let [shoulder, hip] = &self.plan.joints;
        let [applied2, applied3] = &mut self.applied;
        let (u2, u3) = (shoulder.apply(applied2, u2), hip.apply(applied3, u3));
        let first = shoulder.commands(shoulder.command(u2));
        first.chain(hip.commands(hip.command(u3)))
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
        let there = |id: u8| id >= 254 || servos.with_id(id).is_some_and(|servo| servo.present);
        self.plan
            .joints
            .iter()
            .all(|joint| there(joint.id) && there(joint.mirror))
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

/// Angles with the joints' in whole codes.
fn coarse([e1, e2, e3]: [i16; 3]) -> [i16; 3] {
    let whole = |e: i16| e.saturating_add(1 << (FINE - 1)) >> FINE;
    [e1, whole(e2), whole(e3)]
}

/// The angles at which the links' masses balance, beside upright: every link's resultant centre of
/// mass above its joint.
///
/// The paper, section IV.D: "finding and compensating the system with the angle of the resultant
/// center of gravity". Gravity's torques vanish where the moments p_j e^{i t_j} of all links point
/// up, so at absolute angles t_j = -arg p_j. micromath's arc is off by up to 0.003 rad; an observer
/// finds the rest.
#[inline(never)]
fn compensation(moments: &[Moment; 3]) -> [i16; 3] {
    const STEPS: [f32; 3] = [
        (1.0 / Attitude::ANGLE_LSB_RAD) as f32,
        ((1 << FINE) as f64 / Position::LSB_RAD) as f32,
        ((1 << FINE) as f64 / Position::LSB_RAD) as f32,
    ];
    let mut angles = [0; 3];
    let mut before = 0.0;
    for ((angle, moment), steps) in angles.iter_mut().zip(moments).zip(STEPS) {
        let absolute = match moment.aside {
            // Exactly, not nearly, straight.
            0 => 0.0,
            aside => -F32Ext::atan2(f32::from(aside), f32::from(moment.along)),
        };
        *angle = ((absolute - before) * steps) as i16;
        before = absolute;
    }
    angles
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A millimetre aside at 30: 33 mrad; a straight link between tilted ones turns both its
    /// joints.
    #[test]
    fn resultant_masses_come_to_lie_above_their_joints() {
        let tilted = Moment {
            along: 3000,
            aside: 100,
        };
        let straight = Moment {
            along: 3000,
            aside: 0,
        };
        let found = compensation(&[tilted, straight, tilted]);
        let rad = (100f64 / 3000.0).atan();
        let fine = f64::from(1 << FINE) / Position::LSB_RAD;
        let exact = [-rad * 1e4, rad * fine, -rad * fine];
        for (i, exact) in exact.into_iter().enumerate() {
            let step = if i == 0 { 1e4 } else { fine };
            assert!(
                (f64::from(found[i]) - exact).abs() <= 3e-3 * step + 1.0,
                "{found:?}"
            );
        }
        assert_eq!(compensation(&[Moment::ZERO; 3]), [0; 3]);
        assert_eq!(coarse([7, 48, -48]), [7, 2, -1]);
    }
}
