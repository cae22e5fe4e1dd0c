//! Every timing and limit of the firmware, with its arithmetic, whatever board it runs on. What
//! follows from a board's crystal is the board's: `atmega128/clock.rs`.

/// Period of the tick, us; the host counts with it.
pub use handstand_shared::message::TICK_US;

/// Counts of [`crate::board::Board::clock`] per microsecond, on every board.
pub const CLOCK_PER_US: u16 = 2;

/// Speed of the PC line, baud. 57600 is what the CM-5 and its boot loader use.
pub const LINK_BAUD: u32 = 57_600;

/// Speed of the servo bus, baud: what servos have from the factory.
pub const BUS_BAUD: u32 = 1_000_000;

/// From the last stop bit of a request to the first byte of its answer, us, beside the servo's
/// return delay: 22 us to begin, 10 us for the byte, a motor interrupt of 130 us, and as much again
/// for a slow clock.
pub const FIRST_BYTE_US: u16 = 320;

/// Longest silence inside an answer, us: the servo's motor interrupt stalls it for up to 130 us.
pub const BETWEEN_BYTES_US: u16 = 250;

/// From the first byte of an answer to its last, us: 26 bytes of 10 us, and three motor interrupts
/// of 130 us. Noise that goes on and on ends here.
pub const ANSWER_US: u16 = 800;

/// From a write to the one behind it, us, where both must be obeyed: servos ignore one that comes
/// too close. What they need is not published; bring-up measures it.
pub const BETWEEN_WRITES_US: u16 = 200;

/// Longest time in which the commands of four servos are out, us: 20 bytes of 10 us.
pub const COMMANDS_US: u16 = 200;

/// Ticks in which the limits that arming names are written, in turn, and read back: 18 servos are
/// read in nine and more. Beyond, a servo that could not be read is left out, and one that does not
/// hold them refused.
pub const ARMING_TICKS: u8 = 30;

/// No servo is asked later than this in a tick, us. 18 servos with the factory's return delay take
/// 13.2 ms. The last answer may take 500 + [`FIRST_BYTE_US`] + [`ANSWER_US`] more, commands and the
/// report 1.5 ms: a tick ends within 18 ms.
pub const ROUND_US: u16 = 14_000;

/// No request is repeated later than this in a tick, us: what follows (writing goals, the report)
/// needs about 2 ms.
pub const LAST_RETRY_US: u16 = 7_600;

/// Longest time that a command of the host's takes while torque is on, us: 0.2 ms by the program
/// counter of simavr.
pub const COMMAND_US: u16 = 250;

/// Time without a sign of life from the host after which an armed robot goes soft, us. It is
/// noticed at the next tick, at most [`LONGEST_PERIOD_US`] later.
pub const SILENT_US: u32 = 80_000;

/// Oldest attitude that is balanced with, us: three reports of the host's.
pub const ATTITUDE_US: u32 = 30_000;

/// Time in which the torque limit falls to nothing, us. Torque is off at the tick that follows.
pub const FADE_US: u32 = 160_000;

/// Ticks begin no further apart, us: after one that is longer than its period the next one begins
/// at once.
pub const LONGEST_PERIOD_US: u32 = 2 * TICK_US as u32;

/// For so long torque off is said again in every tick, us: a servo may have missed it in noise.
pub const INSIST_US: u32 = 200_000;

/// Ticks after a start in which nothing from the PC passes to the servos: 200 ms.
pub const START_TICKS: u32 = INSIST_US / TICK_US as u32;

/// Bytes of `FF` that complete, with a wrong checksum, whatever packet the servos were hearing when
/// the controller restarted: the longest has 255 bytes behind its length.
pub const FLUSH_BYTES: u16 = 256;

/// Ticks in a row that must have kept their period before torque comes on: 100 ms.
pub const CALM_TICKS: u8 = 10;

/// Below this supply arming is refused; 8 NiMH cells are empty at about 1.1 V each.
pub const LOW_SUPPLY: handstand_shared::raw::Supply = handstand_shared::raw::Supply(88);

/// So long a supply must be low before an armed robot is let down, us, from the end of the first
/// round of the housekeeping that tells it. A single dip under load is normal, and a round lasts as
/// long as the servo list: 10 to 90 ms.
pub const LOW_SUPPLY_US: u32 = 200_000;

/// The gyro's ADC codes this near an end are no rate: the pad is not connected, or the rate is
/// beyond what it measures.
pub const GYRO_RAIL_CODES: u16 = 8;

/// Furthest from the plan's zero that a gyro's code may be at rest, codes: 0.24 V of 5 V.
pub const GYRO_ZERO_CODES: u16 = 50;

/// Ticks in a row in which the gyro must have been at rest before balancing: 100 ms.
pub const REST_TICKS: u8 = 10;

/// Largest change of the gyro's rate in these ticks, steps of 1e-3 rad/s: who holds the robot moves
/// it no faster. A code more is noise of the ADC's.
pub const REST_RATE: u16 = 350;

/// Furthest from its operating point that the first link may be at arming, 1e-4 rad: 10 degrees, as
/// the joints.
pub const POSE_ANGLE: u16 = 1745;

/// Fastest that the first link may turn at arming, 1e-3 rad/s.
pub const POSE_RATE: u16 = 1000;

/// Largest change of a goal in one tick, codes: 20 x 0.293 degrees x 100 Hz = 586 degrees/s, more
/// than a servo's 354, so it holds nothing back that could be obeyed, and bounds what a wrong goal
/// does.
pub const GOAL_SLEW: u16 = 20;

/// Ticks a button must be down to count: 30 ms.
pub const DEBOUNCE_TICKS: u8 = 3;

const _: () = {
    let soft_us = SILENT_US + LONGEST_PERIOD_US;
    assert!(soft_us <= 100_000);
    // Soft begins with one step down, so the fall takes a period less than it would.
    assert!(soft_us + FADE_US + LONGEST_PERIOD_US <= 300_000);
    assert!(START_TICKS == 20);
};
