//! Balancing on board: one tick of estimate, law and command.

use crate::servos::Servos;
use handstand_shared::law::control;
use handstand_shared::message::Attitude;
use handstand_shared::plan::Plan;
use handstand_shared::raw::Signed;
use handstand_shared::velocity::Memory;

/// Ticks a joint's servo may miss before it counts as lost.
const LOST_AFTER: u8 = 3;

/// What balancing remembers from tick to tick.
#[derive(Debug, Clone)]
pub struct Balance {
    /// The plan in use.
    pub plan: Plan,
    memory: [Memory; 2],
    /// The first link's angle, in 1/10 of its step: a rate step lasts 1/10 angle step per tick.
    angle: i32,
    rate: i16,
    missed: u8,
}

/// Why it cannot go on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// Too far from where the gains hold.
    Fallen,
    /// A joint's servo does not answer.
    ServoLost,
}

impl Balance {
    /// At rest at the plan's operating point.
    pub fn new(plan: Plan) -> Self {
        let [angle, ..] = plan.table.x0;
        Balance {
            plan,
            memory: [Memory::default(); 2],
            angle: i32::from(angle) * 10,
            rate: 0,
            missed: 0,
        }
    }

    /// Takes the first link's attitude: the host's, if the plan wants it, or the gyro's rate and its sum.
    pub fn sense(&mut self, host: Attitude, gyro: u16) {
        if self.plan.gyro.from_host {
            self.rate = host.rate;
            self.angle = i32::from(host.angle) * 10;
            return;
        }
        let code = (gyro as i16).wrapping_sub(self.plan.gyro.zero as i16);
        let rate = i32::from(code).wrapping_mul(i32::from(self.plan.gyro.scale)) >> 4;
        self.rate = rate.clamp(i32::from(i16::MIN), i32::from(i16::MAX)) as i16;
        // 1e-3 rad/s for 10 ms are 1e-5 rad: 1/10 of the angle's step.
        let angle = self.angle.saturating_add(i32::from(self.rate));
        self.angle = angle.clamp(-320_000, 320_000);
    }

    /// The states, in the table's order.
    pub fn states(&mut self, servos: &Servos) -> Result<[i16; 6], Stop> {
        let [shoulder, hip] = self.plan.joints;
        let (Some(first), Some(second)) = (servos.with_id(shoulder.id), servos.with_id(hip.id))
        else {
            return Err(Stop::ServoLost);
        };
        self.missed = match first.present && second.present {
            true => 0,
            false => self.missed.saturating_add(1),
        };
        if self.missed >= LOST_AFTER {
            return Err(Stop::ServoLost);
        }
        let [q2, q3] = [shoulder.angle(first.position), hip.angle(second.position)];
        let [memory2, memory3] = &mut self.memory;
        let velocity = self.plan.velocity;
        let (dq2, dq3) = (
            velocity.estimate(memory2, q2),
            velocity.estimate(memory3, q3),
        );
        let angle = (self.angle / 10) as i16;
        let [x0, ..] = self.plan.table.x0;
        if angle.abs_diff(x0) > self.plan.range {
            return Err(Stop::Fallen);
        }
        Ok([angle, q2, q3, self.rate, dq2, dq3])
    }

    /// The servos' commands for these states, each with its id.
    pub fn commands(&self, states: &[i16; 6]) -> impl Iterator<Item = (u8, Signed)> {
        let [u2, u3] = control(&self.plan.table, states);
        let [shoulder, hip] = &self.plan.joints;
        let first = shoulder.commands(shoulder.command(u2));
        first.chain(hip.commands(hip.command(u3)))
    }

    /// Whether all servos it commands answered.
    pub fn has_servos(&self, servos: &Servos) -> bool {
        let there = |id: u8| id >= 254 || servos.with_id(id).is_some_and(|servo| servo.present);
        self.plan
            .joints
            .iter()
            .all(|joint| there(joint.id) && there(joint.mirror))
    }
}
