//! What buttons do, and which LEDs tell the state.

use super::{App, State, Torque};
use crate::board::Board;
use crate::design::SILENT_US;
use crate::panel::{button, leds};
use crate::servos::Servo;
use handstand_shared::message::Mode;

impl App {
    /// Buttons and LEDs.
    #[inline(never)]
    pub(super) fn panel<B: Board>(&mut self, board: &mut B) {
        let pressed = self.buttons.pressed(board.buttons());
        if pressed != 0 {
            self.press(board, pressed);
        }
        let all_answer = self.servos.all().iter().all(Servo::is_present);
        let lit = leds(
            self.condition(),
            self.ticks,
            self.life.us() <= SILENT_US,
            all_answer,
        );
        board.set_leds(lit);
    }

    /// Any button stops a robot that is armed, and an adapter, whose user may have switched torque
    /// on: it passes nothing on any more. Start chooses balancing while torque is off; the host
    /// arms.
    fn press<B: Board>(&mut self, board: &mut B, pressed: u8) {
        match self.state {
            State::Stream(Torque::On(_) | Torque::Fading(_))
            | State::Balance(Torque::On(_) | Torque::Fading(_)) => self.disarm(board),
            State::Bridge | State::Stream(Torque::Off) if pressed & button::START != 0 => {
                self.enter(board, Mode::Balance);
            }
            State::Bridge => self.enter(board, Mode::Stream),
            State::Stream(Torque::Off) => {}
            State::Balance(Torque::Off) | State::Fault(_) => {}
        }
    }
}
