//! How torque goes off, and when it must.

use super::{App, Fading, Onset, State, Token, Torque};
use crate::age::Age;
use crate::board::Board;
use crate::design::{ATTITUDE_US, FADE_US, LOW_SUPPLY, LOW_SUPPLY_US, SILENT_US, TICK_US};
use handstand_shared::message::{Cause, Condition, Mode, Refusal};
use handstand_shared::packed::Speeds;
use handstand_shared::raw::TorqueLimit;

impl App {
    /// Whether an armed robot must be let down.
    pub(super) fn must_stop(&mut self, clock: u16) -> Option<Cause> {
        let armed = self.state.armed_mut()?;
        let is_low = self.servos.supply.is_none_or(|supply| supply < LOW_SUPPLY);
        armed.low = is_low.then(|| armed.low.unwrap_or(Age::from(clock)));
        if let Some(cause) = self.servos.gave_up() {
            Some(cause)
        } else if self.life.us() >= SILENT_US {
            Some(Cause::LinkLost)
        } else if armed.low.is_some_and(|low| low.us() >= LOW_SUPPLY_US) {
            Some(Cause::LowSupply)
        } else {
            None
        }
    }

    /// Whether the law may act on the first link's attitude: the gyro's is always new.
    pub(super) fn has_attitude<B: Board>(&mut self, board: &B) -> bool {
        self.attitude_age.pass(board.clock());
        !self.balance.needs_attitude() || self.attitude_age.us() <= ATTITUDE_US
    }

    /// Holds the positions and begins to fade.
    #[inline(never)]
    pub(super) fn soften<B: Board>(&mut self, board: &mut B, cause: Cause) {
        let Some(armed) = self.state.armed_mut() else {
            return;
        };
        if armed.onset == Onset::Balance {
            // No servo has torque yet: soft would say that it has.
            return self.give_up(board, cause);
        }
        let obeyed = armed.obeyed;
        self.log_fault(cause);
        if self.servos.tripped.is_some() {
            self.servos.release(board);
        }
        // A servo in wheel mode has no position to hold: it stops. While balancing the others have
        // their goals, or no torque yet.
        self.servos.spin(board, &Speeds::default());
        if matches!(self.state, State::Stream(_)) {
            self.servos.hold(board);
        }
        let fading = Fading {
            cause,
            since: Age::from(board.clock()),
            from: self.servos.torque_limit(),
            obeyed,
        };
        if let Some(torque) = self.state.torque_mut() {
            *torque = Torque::Fading(fading);
        }
        self.fade(board);
    }

    /// Lowers every servo's torque limit as time passes; at none, torque goes off.
    #[inline(never)]
    pub(super) fn fade<B: Board>(&mut self, board: &mut B) {
        let Some(Torque::Fading(fading)) = self.state.torque() else {
            return;
        };
        // 1/16 of the time is the least that counts; it stays within 16 bits, 1023 * 16.
        const SIXTEENTH_US: u32 = FADE_US / 16;
        let (cause, faded_us) = (fading.cause, fading.since.us());
        if faded_us >= FADE_US {
            return self.give_up(board, cause);
        }
        // The limit that the period ends with, so that it falls from the first one on.
        let left_us = FADE_US.saturating_sub(faded_us + u32::from(TICK_US));
        let sixteenths = (left_us / SIXTEENTH_US) as u16;
        let limit = fading.from.0 / 16 * sixteenths;
        self.servos.lower_limit(board, TorqueLimit(limit));
    }

    /// Torque off at once.
    pub(super) fn give_up<B: Board>(&mut self, board: &mut B, cause: Cause) {
        let is_soft = matches!(self.condition(), Condition::Soft);
        if !is_soft {
            self.log_fault(cause);
        }
        self.disarm(board);
        self.state = State::Fault(cause);
    }

    /// Torque off, and nothing that was said before arms again.
    pub(super) fn disarm<B: Board>(&mut self, board: &mut B) {
        self.servos.disarm(board);
        self.abandon_arming(board, Refusal::State);
        self.off = Age::from(board.clock());
        self.tokens.set(Token::None);
        if let Some(torque) = self.state.torque_mut() {
            *torque = Torque::Off;
        }
    }

    /// Changes the mode; torque is off on the way.
    #[inline(never)]
    pub(super) fn enter<B: Board>(&mut self, board: &mut B, mode: Mode) {
        self.disarm(board);
        // An adapter's user may have changed them.
        self.servos.ask_again();
        self.balance.forget_rest();
        if matches!(self.state, State::Bridge) {
            self.servos.forget_supply();
        }
        self.state = match mode {
            Mode::Bridge => State::Bridge,
            Mode::Stream => State::Stream(Torque::Off),
            Mode::Balance => State::Balance(Torque::Off),
        };
    }
}
