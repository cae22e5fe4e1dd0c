//! A fault as the CM-5 keeps it without power.

use super::report::{Cause, Condition};
use serde::{Deserialize, Serialize};

/// An entry of the fault log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct FaultEntry {
    /// Number of the controller's start in which it happened, modulo 256.
    pub start: u8,
    /// Tick in which it happened, counted from that start, 10 ms each; 0 for a restart by the
    /// watchdog, which loses the count.
    #[serde(with = "postcard::fixint::le")]
    pub tick: u32,
    /// Why torque had to go off.
    pub cause: Cause,
    /// What the firmware was doing; the fault itself where a restart lost that.
    pub condition: Condition,
}

impl FaultEntry {
    /// Bytes of an entry in EEPROM: start, tick, cause, condition with its own cause.
    pub const LENGTH: usize = 8;

    /// As EEPROM holds it, filled up with zeros.
    pub fn bytes(&self) -> [u8; FaultEntry::LENGTH] {
        let mut bytes = [0; FaultEntry::LENGTH];
        // The longest entry has as many.
        let _ = postcard::to_slice(self, &mut bytes);
        bytes
    }

    /// The entry of these bytes; none if they are none.
    pub fn from_bytes(bytes: &[u8; FaultEntry::LENGTH]) -> Option<Self> {
        postcard::from_bytes(bytes).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_entry_fits() {
        for cause in [Cause::LinkLost, Cause::LetDown] {
            let entry = FaultEntry {
                start: 255,
                tick: 0xfedc_ba98,
                cause,
                condition: Condition::Fault(cause),
            };
            assert_eq!(FaultEntry::from_bytes(&entry.bytes()), Some(entry));
        }
        assert_eq!(FaultEntry::from_bytes(&[0xff; FaultEntry::LENGTH]), None);
    }
}
