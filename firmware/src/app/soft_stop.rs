//! How torque goes off, and when it must.

use super::{App, Goal, State, Torque};
use crate::board::Board;
use crate::bus;
use crate::design::{FADE_TICKS, LOW_ROUNDS, LOW_SUPPLY, SILENT_TICKS};
use handstand_shared::control_table::TORQUE_LIMIT;
use handstand_shared::message::{Cause, Mode};
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::TorqueLimit;

impl App {
    /// Whether an armed robot must be let down.
    pub(super) fn must_stop(&mut self) -> Option<Cause> {
        let (low, round) = self.low;
        if self.servos.rounds != round {
            let is_low = self.servos.supply.is_none_or(|supply| supply < LOW_SUPPLY);
            self.low = (
                if is_low { low.saturating_add(1) } else { 0 },
                self.servos.rounds,
            );
        }
        if self.servos.tripped.is_some() {
            Some(Cause::ServoError)
        } else if self.silent > SILENT_TICKS {
            Some(Cause::LinkLost)
        } else if self.low.0 >= LOW_ROUNDS {
            Some(Cause::LowSupply)
        } else {
            None
        }
    }

    /// Holds the positions and begins to fade.
    #[inline(never)]
    pub(super) fn soften<B: Board>(
        &mut self,
        board: &mut B,
        cause: Cause,
        within: fn(Torque) -> State,
    ) {
        if self.servos.tripped.is_some() {
            self.servos.release(board);
        }
        // A servo in wheel mode has no position to hold: it stops.
        let balanced = matches!(self.state, State::Balance(_));
        if balanced || matches!(self.goal, Goal::Speeds(_)) {
            self.servos.spin(board, [0; SERVOS].into_iter());
        } else {
            self.servos.hold(board);
        }
        self.fade(board, FADE_TICKS, cause, within);
    }

    /// Lowers every servo's torque limit in equal steps; at none, torque goes off.
    #[inline(never)]
    pub(super) fn fade<B: Board>(
        &mut self,
        board: &mut B,
        left: u8,
        cause: Cause,
        within: fn(Torque) -> State,
    ) {
        const STEP: u16 = TorqueLimit::FULL.0 / FADE_TICKS as u16;
        match left.checked_sub(1) {
            Some(left) => {
                bus::write_all(board, TORQUE_LIMIT, STEP * u16::from(left));
                self.state = within(Torque::Fading { left, cause });
            }
            None => self.give_up(board, cause),
        }
    }

    /// Torque off at once.
    pub(super) fn give_up<B: Board>(&mut self, board: &mut B, cause: Cause) {
        self.disarm(board);
        self.state = State::Fault(cause);
    }

    /// Torque off, and nothing that was said before arms again.
    pub(super) fn disarm<B: Board>(&mut self, board: &mut B) {
        self.servos.disarm(board);
        self.token = None;
        self.goal = Goal::Hold;
    }

    /// Changes the mode; torque is off on the way.
    #[inline(never)]
    pub(super) fn enter<B: Board>(&mut self, board: &mut B, mode: Mode) {
        self.disarm(board);
        self.state = match mode {
            Mode::Bridge => State::Bridge,
            Mode::Stream => State::Stream(Torque::Off),
            Mode::Balance => State::Balance(Torque::Off),
        };
    }
}
