//! Timing of the AX-12 on a bus at 1 Mbaud, from published measurements: when each byte of a reply
//! starts.

/// A bit at 1 Mbaud, ns.
pub const BIT_NS: u64 = 1000;
/// A byte of 8N1 at 1 Mbaud, ns.
pub const BYTE_NS: u64 = 10 * BIT_NS;
/// From the last stop bit of a PING to the first start bit of its reply at return delay 0, ns.
pub const PING_REPLY_NS: u64 = 18_000;
/// The same for every other request, ns.
pub const REPLY_NS: u64 = 22_000;
/// An EEPROM write silences a servo for this long per byte, ns.
pub const EEPROM_NS: u64 = 6_000_000;

/// Period of the servo's motor interrupt, ns.
const INTERRUPT_PERIOD_NS: u64 = 1_000_000;
/// The motor interrupt takes this long, ns; a byte that would start in it starts at its end.
const INTERRUPT_NS: u64 = 130_000;

/// The earliest start of a byte, ns, that is ready at `ready_ns` in the servo with this serial
/// number.
///
/// Each servo's motor interrupt has a phase of its own, scattered by a hash of `serial`: servos
/// started together would otherwise all stall a periodic reader alike.
pub fn byte_start_ns(ready_ns: u64, serial: u64) -> u64 {
    let phase_ns = ((serial * 2_654_435_761) >> 8) % INTERRUPT_PERIOD_NS;
    let into_ns = (ready_ns + INTERRUPT_PERIOD_NS - phase_ns) % INTERRUPT_PERIOD_NS;
    if into_ns < INTERRUPT_NS {
        ready_ns + INTERRUPT_NS - into_ns
    } else {
        ready_ns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Serial numbers 0 and 1 have phases of 0 and 0.368889 ms.
    #[test]
    fn a_byte_waits_for_the_end_of_the_motor_interrupt() {
        for (serial, phase_ns) in [(0, 0), (1, 368_889)] {
            for period_ns in [0, 7_000_000] {
                let begins_ns = period_ns + phase_ns;
                let ends_ns = begins_ns + 130_000;
                for ready_ns in [begins_ns, begins_ns + 1, ends_ns - 1, ends_ns] {
                    assert_eq!(byte_start_ns(ready_ns, serial), ends_ns);
                }
                for ready_ns in [ends_ns + 1, begins_ns + 999_999] {
                    assert_eq!(byte_start_ns(ready_ns, serial), ready_ns);
                }
            }
        }
    }
}
