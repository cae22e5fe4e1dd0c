//! When torque comes on.

use super::{App, Goal, Onset, State, Torque};
use crate::age::Age;
use crate::board::Board;
use crate::design::{CALM_TICKS, LOW_SUPPLY};
use handstand_shared::message::{ArmLimits, Refusal};

impl App {
    /// Torque on, if everything speaks for it. A greeting serves once.
    #[inline(never)]
    pub(super) fn arm<B: Board>(
        &mut self,
        board: &mut B,
        token: u16,
        limits: ArmLimits,
    ) -> Result<(), Refusal> {
        if self.is_armed() {
            return Err(Refusal::Armed);
        }
        match self.token {
            None => return Err(Refusal::Version),
            Some(right) if right != token || self.is_used => return Err(Refusal::Token),
            Some(_) => {}
        }
        let is_balance = match self.state {
            State::Stream(_) => false,
            State::Balance(_) => true,
            State::Bridge | State::Fault(_) => return Err(Refusal::State),
        };
        if !limits.is_sound() {
            return Err(Refusal::Limits);
        }
        // It would have to be let go and pressed again to stop the robot.
        if self.buttons.is_down() {
            return Err(Refusal::Button);
        }
        // The plan that is being written would be taken while the robot is armed.
        if self.writer.is_busy() {
            return Err(Refusal::Busy);
        }
        self.has_supply()?;
        if self.calm < CALM_TICKS {
            return Err(Refusal::Overrun);
        }
        if is_balance {
            self.prepare_balance(board)?;
        }
        self.is_used = true;
        self.goal = Goal::Hold;
        self.low = (0, self.servos.rounds);
        self.life = Age::from(board.clock());
        self.longest_silence_ms = 0;
        self.off = Age::NEVER;
        self.limits = limits;
        self.onset = match is_balance {
            true => Onset::Balance,
            false => Onset::Done,
        };
        match is_balance {
            // A servo that missed torque off has these limits from now on, too.
            true => self.servos.choose(board, limits),
            false => self.servos.arm(board, limits),
        }
        self.state = match is_balance {
            true => State::Balance(Torque::On),
            false => State::Stream(Torque::On),
        };
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
