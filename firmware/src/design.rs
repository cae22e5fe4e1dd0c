//! Every timing and limit of the firmware, with its arithmetic.

/// Crystal of the CM-5, Hz.
pub const CPU_HZ: u32 = 16_000_000;

/// Period of the tick, us: 100 Hz, as the paper samples.
pub const TICK_US: u16 = 10_000;

/// Counts of [`crate::board::Board::clock`] per microsecond: the timer runs at CPU_HZ / 8.
pub const CLOCK_PER_US: u16 = 2;

/// Speed of the PC line, baud. 57600 is what the CM-5 and its boot loader use.
pub const LINK_BAUD: u32 = 57_600;

/// Baud register of the PC line at double speed: 16 MHz / 8 / 57600 - 1 = 33.7, so 34, 0.8 % slow.
pub const LINK_UBRR: u16 = ((CPU_HZ / 8 + LINK_BAUD / 2) / LINK_BAUD - 1) as u16;

/// Baud register of the servo bus at double speed: 16 MHz / 8 / 1 M - 1 = 1, exact.
pub const BUS_UBRR: u16 = 1;

/// From the last stop bit of a request to the first byte of its answer, us, beside the servo's
/// return delay: 22 us to begin, 10 us for the byte, a motor interrupt of 130 us, and as much again
/// for a slow clock.
pub const FIRST_BYTE_US: u16 = 320;

/// Longest silence inside an answer, us: the servo's motor interrupt stalls it for up to 130 us.
pub const BETWEEN_BYTES_US: u16 = 250;

/// No request is repeated later than this in a tick, us: what follows (writing goals, the report)
/// needs about 2 ms.
pub const LAST_RETRY_US: u16 = 7_000;

/// Ticks without a sound frame after which an armed robot goes soft: 8 x 10 ms, at most 90 ms after
/// the last frame.
pub const SILENT_TICKS: u8 = 8;

/// Ticks in which the torque limit falls to nothing: 16 x 10 ms, so torque is off at most 260 ms
/// after the last frame.
pub const FADE_TICKS: u8 = 16;

/// Below this supply arming is refused; 8 NiMH cells are empty at about 1.1 V each.
pub const LOW_SUPPLY: handstand_shared::raw::Supply = handstand_shared::raw::Supply(88);

/// Rounds of the housekeeping with a low supply before an armed robot is let down: 3 x 90 ms. A
/// single dip under load is normal.
pub const LOW_ROUNDS: u8 = 3;

/// Largest change of a goal in one tick, codes: 20 x 0.293 degrees x 100 Hz = 586 degrees/s, more
/// than a servo's 354, so it holds nothing back that could be obeyed, and bounds what a wrong goal
/// does.
pub const GOAL_SLEW: u16 = 20;

/// Ticks a button must be down to count: 30 ms.
pub const DEBOUNCE_TICKS: u8 = 3;

const _: () = {
    let line_baud = CPU_HZ / 8 / (LINK_UBRR as u32 + 1);
    assert!(line_baud.abs_diff(LINK_BAUD) * 100 < 2 * LINK_BAUD);
    let soft_ms = (SILENT_TICKS as u32 + 1) * TICK_US as u32 / 1000;
    assert!(soft_ms <= 100 && soft_ms + (FADE_TICKS as u32 + 1) * TICK_US as u32 / 1000 <= 300);
};
