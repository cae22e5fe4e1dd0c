//! When torque comes on.
//!
//! Torque limit and speeds travel in packets that no servo answers, and servos ignore a write that
//! comes right behind another: they are written a tick apart, again and again until every servo
//! that will be commanded has been read and holds them. Only then does torque come on.

use super::{App, Armed, Onset, State, Token, Torque};
use crate::age::Age;
use crate::board::Board;
use crate::bus;
use crate::design::{ARMING_TICKS, CALM_TICKS, INSIST_US, LOW_SUPPLY};
use crate::servos::Limit;
use handstand_shared::message::{ArmLimits, Refusal};

/// Arming that has begun.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arming {
    /// Sequence number of the command to answer.
    answer: u8,
    limits: ArmLimits,
    ticks: u8,
}

impl App {
    /// Begins to arm, if everything speaks for it. A greeting serves once.
    #[inline(never)]
    pub(super) fn arm<B: Board>(
        &mut self,
        board: &mut B,
        answer: u8,
        token: u16,
        limits: ArmLimits,
    ) -> Result<(), Refusal> {
        if self.is_armed() {
            return Err(Refusal::Armed);
        }
        // Said again, for its answer takes long.
        if let Some(arming) = &mut self.arming
            && (self.tokens.now(), arming.limits) == (Token::Used(token), limits)
        {
            arming.answer = answer;
            return Ok(());
        }
        match self.tokens.now() {
            Token::None => return Err(Refusal::Version),
            Token::Fresh(right) if right == token => {}
            Token::Fresh(_) | Token::Used(_) => return Err(Refusal::Token),
        }
        if !limits.is_sound() {
            return Err(Refusal::Limits);
        }
        self.may_arm(board)?;
        self.tokens.uses_up();
        self.servos.choose(limits);
        let ticks = 0;
        self.arming = Some(Arming {
            answer,
            limits,
            ticks,
        });
        Ok(())
    }

    /// Writes a limit, in the ticks of arming; what was told to be off stays off by itself.
    #[inline(never)]
    pub(super) fn write_limits<B: Board>(&mut self, board: &mut B) {
        if let Some(arming) = &mut self.arming {
            let limit = if arming.ticks & 1 == 0 {
                Limit::Torque
            } else {
                Limit::Speed
            };
            arming.ticks += 1;
            if self.off.us() < INSIST_US {
                // Torque off was said just before.
                bus::pause(board);
            }
            self.servos.write_limit(board, limit);
        }
    }

    /// Switches torque on once all limits were read back.
    #[inline(never)]
    pub(super) fn finish_arming<B: Board>(&mut self, board: &mut B) {
        let Some(arming) = self.arming else { return };
        if !self.servos.have_limits() {
            if arming.ticks < ARMING_TICKS {
                return;
            }
            self.servos.leave_out_unread();
        }
        let outcome = if !self.servos.have_limits() {
            Err(Refusal::Registers)
        } else if self.servos.gave_up().is_some() {
            Err(Refusal::ServoError)
        } else {
            self.may_arm(board)
        };
        if let Err(refusal) = outcome {
            // What it needs may be there the next time.
            self.tokens.gives_back();
            self.servos.disarm(board);
            return self.abandon_arming(board, refusal);
        }
        self.arming = None;
        self.switch_on(board, arming.answer);
        self.answer(board, arming.answer, Ok(()));
    }

    /// Answers arming that has begun and comes to nothing.
    pub(super) fn abandon_arming<B: Board>(&mut self, board: &mut B, refusal: Refusal) {
        if let Some(arming) = self.arming.take() {
            self.answer(board, arming.answer, Err(refusal));
        }
    }

    fn switch_on<B: Board>(&mut self, board: &mut B, by: u8) {
        self.life = Age::from(board.clock());
        self.longest_silence_us = 0;
        self.off = Age::NEVER;
        let onset = if let State::Balance(_) = self.state {
            // Torque comes on with the law's first command.
            Onset::Balance
        } else {
            self.servos.hold(board);
            Onset::Torque
        };
        if let Some(torque) = self.state.torque_mut() {
            *torque = Torque::On(Armed::by(by, onset));
        }
    }

    /// Whether torque may come on now, as far as can be known without a write.
    #[inline(never)]
    fn may_arm<B: Board>(&mut self, board: &mut B) -> Result<(), Refusal> {
        let is_balance = match self.state {
            State::Stream(_) => false,
            State::Balance(_) => true,
            State::Bridge | State::Fault(_) => return Err(Refusal::State),
        };
        // It would have to be let go and pressed again to stop the robot.
        if self.buttons.is_down() {
            return Err(Refusal::Button);
        }
        // The plan that is being written would be taken while the robot is armed.
        if self.writer.is_busy() {
            return Err(Refusal::Busy);
        }
        self.has_supply()?;
        if self.times.calm < CALM_TICKS {
            return Err(Refusal::Overrun);
        }
        if !self.servos.modes_are_known() {
            return Err(Refusal::ServoMode);
        }
        if is_balance {
            self.prepare_balance(board)?;
        }
        Ok(())
    }

    /// Balances from the next tick on, if the robot stands where its gains hold.
    #[inline(never)]
    fn prepare_balance<B: Board>(&mut self, board: &mut B) -> Result<(), Refusal> {
        self.balance.fingerprint().ok_or(Refusal::NoPlan)?;
        if !self.balance.has_servos(&self.servos) {
            return Err(Refusal::Servo);
        }
        if !self.balance.are_wheels(&self.servos) {
            return Err(Refusal::Wheel);
        }
        if !self.has_attitude(board) {
            return Err(Refusal::Attitude);
        }
        if !self.balance.is_at_rest() {
            return Err(Refusal::Gyro);
        }
        self.balance.start();
        self.balance.sense(self.attitude, board.gyro());
        let readings = self.balance.readings(&self.servos);
        let readings = readings.map_err(|_| Refusal::Pose)?;
        if !self.balance.is_posed(&readings) {
            return Err(Refusal::Pose);
        }
        self.balance.begin(&readings);
        Ok(())
    }

    fn has_supply(&self) -> Result<(), Refusal> {
        match self.servos.supply {
            Some(supply) if supply >= LOW_SUPPLY => Ok(()),
            Some(_) | None => Err(Refusal::Supply),
        }
    }
}
