//! How long ticks take, and whether they come in time.

use crate::board::{Board, since_us};
use crate::design::{CLOCK_PER_US, TICK_US};

/// The account of ticks, times in us.
#[derive(Debug, Default)]
pub(super) struct TickTimes {
    /// When the next tick is due, in counts of the clock; none before the first.
    due: Option<u16>,
    /// Ticks since one was too long.
    pub calm: u8,
    /// Ticks that ended later than a period after they were due, and those that were skipped.
    pub overruns: u16,
    /// The last tick's, since it was due.
    pub last_us: u16,
    /// The longest since this was told.
    pub longest_us: u16,
    /// The law's longest since this was told.
    pub longest_law_us: u16,
}

impl TickTimes {
    /// When the tick that starts now was due: ticks that begin late are late for the servos,
    /// however short they are. The earliest phase counts; one that was skipped is an overrun.
    pub fn begin(&mut self, started: u16) -> u16 {
        const PERIOD: u16 = TICK_US * CLOCK_PER_US;
        let mut due = self.due.unwrap_or(started);
        // More than half of the clock's range late is early.
        while started.wrapping_sub(due) < 0x8000 && started.wrapping_sub(due) >= PERIOD {
            due = due.wrapping_add(PERIOD);
            self.overrun();
        }
        if started.wrapping_sub(due) >= 0x8000 {
            due = started;
        }
        self.due = Some(due.wrapping_add(PERIOD));
        due
    }

    /// What the tick took since it was due.
    pub fn end(&mut self, board: &impl Board, due: u16) {
        self.last_us = since_us(board, due);
        self.longest_us = self.longest_us.max(self.last_us);
        self.calm = self.calm.saturating_add(1);
        if self.last_us > TICK_US {
            self.overrun();
        }
    }

    fn overrun(&mut self) {
        self.overruns = self.overruns.saturating_add(1);
        self.calm = 0;
    }

    /// They were told.
    pub fn forget_longest(&mut self) {
        self.longest_us = 0;
        self.longest_law_us = 0;
    }
}
