//! How long ago something was, in real time: ticks that are late count as long as they last.

use crate::design::CLOCK_PER_US;

/// Time since a moment, us; stops at the largest value.
///
/// The clock wraps after 32.8 ms, so it must be brought up to date at least so often: once per
/// tick, and the watchdog bounds a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Age {
    us: u32,
    /// The clock when it was last brought up to date.
    at: u16,
}

impl Age {
    /// Of what never was.
    pub const NEVER: Age = Age {
        us: u32::MAX,
        at: 0,
    };

    /// Of what is at this reading of the clock.
    pub fn from(clock: u16) -> Self {
        Age { us: 0, at: clock }
    }

    /// Brings it up to date.
    pub fn pass(&mut self, clock: u16) {
        let passed = clock.wrapping_sub(self.at) / CLOCK_PER_US;
        // Half a microsecond stays for the next time.
        self.at = self.at.wrapping_add(passed * CLOCK_PER_US);
        self.us = self.us.saturating_add(u32::from(passed));
    }

    /// Microseconds when it was last brought up to date.
    pub fn us(&self) -> u32 {
        self.us
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_counts_through_the_clock_s_wraps_and_stops_at_the_end() {
        let mut age = Age::from(65_000);
        for step in 1..=100u32 {
            age.pass((65_000 + step * 40_001) as u16);
        }
        assert_eq!(age.us(), 100 * 40_001 / 2);
        let mut never = Age::NEVER;
        never.pass(40_000);
        assert_eq!(never.us(), u32::MAX);
    }
}
