//! Buttons and LEDs of the CM-5.

use crate::design::DEBOUNCE_TICKS;
use handstand_shared::message::{Cause, Condition};

/// Bits of [`crate::board::Board::buttons`].
pub mod button {
    /// Up.
    pub const UP: u8 = 1;
    /// Down.
    pub const DOWN: u8 = 2;
    /// Left.
    pub const LEFT: u8 = 4;
    /// Right.
    pub const RIGHT: u8 = 8;
    /// Start.
    pub const START: u8 = 16;
}

/// Bits of [`crate::board::Board::set_leds`], in the order of port C.
pub mod led {
    /// Power.
    pub const POWER: u8 = 1;
    /// TxD: the PC is heard.
    pub const TXD: u8 = 2;
    /// RxD: all servos answer.
    pub const RXD: u8 = 4;
    /// Aux: fault.
    pub const AUX: u8 = 8;
    /// Manage: adapter.
    pub const MANAGE: u8 = 16;
    /// Program: stream.
    pub const PROGRAM: u8 = 32;
    /// Play: balance.
    pub const PLAY: u8 = 64;
}

/// Presses, each reported once when it has been down long enough.
#[derive(Debug, Clone, Default)]
pub struct Buttons {
    down: u8,
    ticks: u8,
}

impl Buttons {
    /// Whether one is down, bouncing or not.
    pub fn is_down(&self) -> bool {
        self.down != 0
    }

    /// Once per tick: the buttons pressed by now that were not before.
    pub fn pressed(&mut self, down: u8) -> u8 {
        if down != self.down {
            self.down = down;
            self.ticks = 0;
        }
        self.ticks = self.ticks.saturating_add(1);
        if self.ticks == DEBOUNCE_TICKS {
            down
        } else {
            0
        }
    }
}

/// The LEDs for a state: lit for what it is, blinking slowly when torque is off, Aux counting out
/// the cause of a fault.
pub fn leds(condition: Condition, ticks: u32, heard: bool, all_answer: bool) -> u8 {
    let slow = ticks & 0x20 == 0;
    let when = |on: bool, led: u8| if on { led } else { 0 };
    let state = match condition {
        Condition::Bridge => led::MANAGE,
        Condition::Stream => when(slow, led::PROGRAM),
        Condition::StreamArmed => led::PROGRAM,
        Condition::Balance => when(slow, led::PLAY),
        Condition::BalanceArmed => led::PLAY,
        Condition::Soft => led::AUX,
        Condition::Fault(cause) => when(blinks(cause, ticks), led::AUX),
    };
    led::POWER | state | when(heard, led::TXD) | when(all_answer, led::RXD)
}

/// As many flashes as the cause's number, of 160 ms each 320 ms, within 5.12 s.
fn blinks(cause: Cause, ticks: u32) -> bool {
    let flashes = match cause {
        Cause::LinkLost => 1,
        Cause::LowSupply => 2,
        Cause::ServoLost => 3,
        Cause::ServoError => 4,
        Cause::Fallen => 5,
        Cause::Watchdog => 6,
        Cause::AttitudeLost => 7,
        Cause::JointRange => 8,
        Cause::JointSpeed => 9,
        Cause::TorqueLost => 10,
        Cause::LetDown => 11,
    };
    let phase = (ticks & 0x1ff) as u16;
    phase & 0x10 == 0 && phase >> 5 < flashes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bouncing_button_counts_once() {
        let mut buttons = Buttons::default();
        let down = [16, 0, 16, 16, 16, 16, 16, 16, 0, 0, 0, 0];
        let presses: u32 = down.iter().map(|d| u32::from(buttons.pressed(*d))).sum();
        assert_eq!(presses, 16);
    }

    #[test]
    fn a_button_is_pressed_when_it_has_been_down_for_three_ticks() {
        let mut buttons = Buttons::default();
        assert!(!buttons.is_down());
        let mut presses = |down: [u8; 5]| down.map(|down| buttons.pressed(down));
        assert_eq!(presses([16; 5]), [0, 0, 16, 0, 0]);
        // Another one along with it is another press; letting go is none.
        assert_eq!(presses([17; 5]), [0, 0, 17, 0, 0]);
        assert_eq!(presses([0; 5]), [0; 5]);
        assert_eq!(presses([2, 2, 0, 2, 2]), [0; 5]);
        assert!(buttons.is_down());
    }

    /// In the first 320 ms of 640 a mode whose torque is off is lit.
    #[test]
    fn each_state_has_its_leds() {
        use Condition::*;
        for (condition, first, then) in [
            (Bridge, led::MANAGE, led::MANAGE),
            (Stream, led::PROGRAM, 0),
            (StreamArmed, led::PROGRAM, led::PROGRAM),
            (Balance, led::PLAY, 0),
            (BalanceArmed, led::PLAY, led::PLAY),
            (Soft, led::AUX, led::AUX),
        ] {
            for ticks in 0..64 {
                let state = if ticks < 32 { first } else { then };
                for (heard, all_answer) in [(true, true), (true, false), (false, true)] {
                    let lines = u8::from(heard) * led::TXD + u8::from(all_answer) * led::RXD;
                    let lit = leds(condition, ticks, heard, all_answer);
                    assert_eq!(lit, led::POWER + state + lines, "{condition:?} {ticks}");
                }
            }
        }
    }

    /// Of the first cause once, in the first 160 ms of 5.12 s.
    #[test]
    fn a_fault_s_flash_lasts_16_ticks() {
        let lit = |ticks| leds(Condition::Fault(Cause::LinkLost), ticks, false, false);
        for ticks in 0..1024 {
            let aux = if ticks % 512 < 16 { led::AUX } else { 0 };
            assert_eq!(lit(ticks), led::POWER + aux, "{ticks}");
        }
    }

    #[test]
    fn a_fault_flashes_as_often_as_its_number() {
        for (cause, number) in [
            (Cause::LinkLost, 1),
            (Cause::Watchdog, 6),
            (Cause::TorqueLost, 10),
            (Cause::LetDown, 11),
        ] {
            let lit = |tick: u32| blinks(cause, tick);
            let rises = (0..512).filter(|tick| lit(tick + 1) && !lit(*tick)).count();
            assert_eq!(rises, number);
        }
    }
}
