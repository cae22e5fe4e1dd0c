//! Commanding: torque, goals and speeds, one packet for all.

use super::mode::ServoMode;
use super::registers::Registers;
use super::{Driven, Servo, Servos};
use crate::board::Board;
use crate::bus;
use crate::design::GOAL_SLEW;
use handstand_shared::control_table::{
    GOAL_POSITION, MOVING_SPEED, Register, TORQUE_ENABLE, TORQUE_LIMIT,
};
use handstand_shared::message::ArmLimits;
use handstand_shared::packed::{Positions, SERVOS, Speeds};
use handstand_shared::raw::{Position, Signed, TorqueLimit};
use heapless::Vec;

/// The servo list from its first place on.
const ALL: Part = Part {
    from: 0,
    places: SERVOS as u8,
};

/// A part of the servo list.
#[derive(Debug, Clone, Copy)]
struct Part {
    from: u8,
    places: u8,
}

/// Which servos of a part are written to, of those that take goals.
#[derive(Debug, Clone, Copy)]
enum Whom {
    All,
    Only(Driven),
    AllBut(Driven),
}

impl Whom {
    fn has(&self, id: u8) -> bool {
        match self {
            Whom::All => true,
            Whom::Only(driven) => driven.ids().contains(&id),
            Whom::AllBut(driven) => !driven.ids().contains(&id),
        }
    }
}

/// Which of the limits is written in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// The torque limit, of all servos.
    Torque,
    /// The moving speed, of those that are commanded.
    Speed,
}

/// What a servo is sent. Apart from its register, whose name the AVR would hold in RAM.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sent {
    Goal,
    TorqueOn,
}

impl Servos {
    /// Those that answered lately are commanded from now on, within these limits, which
    /// [`Servos::write_limit`] writes, and their goal is where they stand. Torque stays as it is.
    pub fn choose(&mut self, limits: ArmLimits) {
        self.tripped = None;
        self.has_torque = false;
        self.limits = limits;
        for servo in self.all_mut() {
            servo.armed = servo.was_heard_lately() && servo.mode != ServoMode::Unknown;
            servo.registers = Registers::Unread;
        }
    }

    /// Writes the torque limit, or the moving speeds: one of them a tick, for servos ignore a write
    /// that comes right behind another.
    pub fn write_limit<B: Board>(&self, board: &mut B, limit: Limit) {
        match limit {
            Limit::Torque => bus::write_all(board, TORQUE_LIMIT, self.limits.torque.0),
            Limit::Speed => {
                let limits = self.limits;
                let is_meant = |servo: &Servo| servo.armed;
                self.write_each(board, MOVING_SPEED, is_meant, |servo| {
                    // None has an unknown mode: it would not be armed.
                    servo.mode.moving_speed(limits).unwrap_or(limits.speed.0)
                });
            }
        }
    }

    /// The torque limit that those that are commanded were written last.
    pub fn torque_limit(&self) -> TorqueLimit {
        self.limits.torque
    }

    /// Whether all that are commanded have said that their limits are those they were written.
    pub fn have_limits(&self) -> bool {
        let mut armed = self.all().iter().filter(|servo| servo.armed);
        armed.all(|servo| servo.registers == Registers::AsWritten)
    }

    /// Those whose registers could not be read are not commanded, as those that do not answer.
    pub fn leave_out_unread(&mut self) {
        for servo in self.all_mut() {
            servo.armed &= [Registers::AsWritten, Registers::Differ].contains(&servo.registers);
        }
    }

    /// Lowers the torque limit of those that are commanded; one that gave up would be woken by it.
    pub fn lower_limit<B: Board>(&mut self, board: &mut B, limit: TorqueLimit) {
        self.limits.torque = limit;
        if self.tripped.is_some() {
            self.release(board);
            let is_meant = |servo: &Servo| servo.armed;
            self.write_each(board, TORQUE_LIMIT, is_meant, |_| limit.0);
        } else {
            bus::write_all(board, TORQUE_LIMIT, limit.0);
        }
    }

    /// Torque on in all that are commanded.
    pub fn switch_on<B: Board>(&mut self, board: &mut B) {
        self.write_to(board, Sent::TorqueOn, ALL, Whom::All);
        self.has_torque = true;
        for servo in self.all_mut() {
            servo.registers = Registers::Unread;
        }
    }

    /// Torque on in those that are commanded of a third of the servo list, from this place on. The
    /// place to go on from; none at the end of the list.
    pub fn switch_on_third<B: Board>(&mut self, board: &mut B, from: u8) -> Option<u8> {
        let (third, next) = self.third(from);
        self.write_to(board, Sent::TorqueOn, third, Whom::All);
        self.has_torque = next.is_none();
        next
    }

    /// Torque on in those of these servos that are commanded.
    pub fn switch_on_these<B: Board>(&self, board: &mut B, driven: Driven) {
        self.write_to(board, Sent::TorqueOn, ALL, Whom::Only(driven));
    }

    /// Has all that are commanded stay where they stand now.
    pub fn hold<B: Board>(&mut self, board: &mut B) {
        self.hold_those(board, ALL, Whom::All);
    }

    /// Has those that are commanded but these stay where they stand now, in a third of the servo
    /// list, from this place on. The place to go on from; none at the end of the list.
    pub fn hold_third<B: Board>(&mut self, board: &mut B, from: u8, but: Driven) -> Option<u8> {
        let (third, next) = self.third(from);
        self.hold_those(board, third, Whom::AllBut(but));
        next
    }

    /// The third of the servo list that begins at this place, and the place behind it, if one is.
    fn third(&self, from: u8) -> (Part, Option<u8>) {
        let places = self.count.div_ceil(3);
        let next = Some(from.saturating_add(places)).filter(|next| *next < self.count);
        (Part { from, places }, next)
    }

    #[inline(never)]
    fn hold_those<B: Board>(&mut self, board: &mut B, part: Part, whom: Whom) {
        let all = self.all_mut().iter_mut().skip(part.from.into());
        for servo in all.take(part.places.into()) {
            servo.goal = servo.position;
        }
        self.write_to(board, Sent::Goal, part, whom);
    }

    /// Writes to each of these servos of a part that takes goals.
    // One function for all, for it is long.
    #[inline(never)]
    fn write_to<B: Board>(&self, board: &mut B, sent: Sent, part: Part, whom: Whom) {
        let is_goal = sent == Sent::Goal;
        let all = self.all().iter().skip(part.from.into());
        let all = all.take(part.places.into());
        let value = |servo: &Servo| if is_goal { servo.goal.0 } else { 1 };
        // Their number goes out first; looking for them takes longer than keeping them.
        let mut meant: Vec<(u8, u16), SERVOS, u8> = Vec::new();
        for servo in all.filter(|servo| servo.takes_goals() && whom.has(servo.id)) {
            // There is room for every servo.
            let _ = meant.push((servo.id, value(servo)));
        }
        let register = if is_goal {
            GOAL_POSITION
        } else {
            TORQUE_ENABLE
        };
        let count = meant.len() as u8;
        bus::write_each(board, register, count, meant.iter().copied());
    }

    /// Torque off everywhere.
    pub fn disarm<B: Board>(&mut self, board: &mut B) {
        bus::torque_off(board);
        for servo in self.all_mut() {
            servo.armed = false;
        }
    }

    /// Torque off where none is commanded, as in servos that gave up: else the limits written to
    /// all would wake them.
    pub fn release<B: Board>(&self, board: &mut B) {
        let released = self.all().iter().filter(|servo| !servo.armed);
        let count = self.count.saturating_sub(self.armed());
        bus::write_each(
            board,
            TORQUE_ENABLE,
            count,
            released.map(|servo| (servo.id, 0)),
        );
    }

    /// Sends goals, each at most [`GOAL_SLEW`] from the last.
    pub fn go_to<B: Board>(&mut self, board: &mut B, goals: &Positions) {
        let all = self.all().iter();
        let count = all.filter(|servo| servo.takes_goals()).count() as u8;
        let all = self.all_mut().iter_mut().enumerate();
        let commanded = all.filter(|(_, servo)| servo.takes_goals());
        let moved = commanded.map(|(place, servo)| {
            let from = servo.goal.0;
            let nearest = from.saturating_sub(GOAL_SLEW);
            let farthest = from.saturating_add(GOAL_SLEW).min(Position::MAX.0);
            let goal = goals.get(place).max(nearest).min(farthest);
            servo.goal = Position(goal);
            (servo.id, goal)
        });
        bus::write_each(board, GOAL_POSITION, count, moved);
    }

    /// Sends commands to the servos in wheel mode, in the servo list's order: to others they would
    /// be speed limits, or none.
    pub fn spin<B: Board>(&self, board: &mut B, speeds: &Speeds) {
        let is_meant = |servo: &Servo| servo.armed && servo.mode == ServoMode::Wheel;
        let all = self.all().iter();
        let count = all.clone().filter(|servo| is_meant(servo)).count() as u8;
        let commanded = all
            .zip(speeds.codes())
            .filter(|(servo, _)| is_meant(servo))
            .map(|(servo, code)| (servo.id, code));
        bus::write_each(board, MOVING_SPEED, count, commanded);
    }

    /// Sends commands to servos in wheel mode, each given with its id.
    pub fn turn<B: Board>(&self, board: &mut B, mut commands: [Option<(u8, Signed)>; 4]) {
        let mut count = 0;
        for slot in &mut commands {
            let is_armed = |id: u8| self.with_id(id).is_some_and(|servo| servo.armed);
            *slot = slot.filter(|(id, _)| is_armed(*id));
            count += u8::from(slot.is_some());
        }
        let commands = commands.iter().flatten();
        let codes = commands.map(|(id, code)| (*id, code.0));
        bus::write_each(board, MOVING_SPEED, count, codes);
    }

    /// How many are commanded.
    fn armed(&self) -> u8 {
        self.all().iter().map(|servo| u8::from(servo.armed)).sum()
    }

    fn write_each<B: Board>(
        &self,
        board: &mut B,
        register: Register,
        is_meant: impl Fn(&Servo) -> bool,
        value: impl Fn(&Servo) -> u16,
    ) {
        let meant = self.all().iter().filter(|servo| is_meant(servo));
        let count = meant.clone().count() as u8;
        bus::write_each(
            board,
            register,
            count,
            meant.map(|servo| (servo.id, value(servo))),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::list;
    use super::*;

    #[test]
    fn what_was_not_read_is_not_commanded() {
        let states = [
            (true, Registers::Unread, false),
            (true, Registers::AsWritten, true),
            (true, Registers::Differ, true),
            (true, Registers::Withheld, false),
            (false, Registers::AsWritten, false),
        ];
        let mut servos = Servos::new(&list(&[1, 2, 3, 4, 5]));
        for (servo, (armed, registers, _)) in servos.all_mut().iter_mut().zip(states) {
            (servo.armed, servo.registers) = (armed, registers);
        }
        servos.leave_out_unread();
        let left: std::vec::Vec<bool> = servos.all().iter().map(|servo| servo.armed).collect();
        assert_eq!(left, states.map(|(_, _, stays)| stays));
    }
}
