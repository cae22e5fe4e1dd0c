//! How long ticks take, and whether they come in time.

use crate::board::{Board, since_us};
use crate::design::{CLOCK_PER_US, COMMAND_US, TICK_US};

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

    /// Whether the next tick is due before a command that begins now would end.
    pub fn is_near(&self, now: u16) -> bool {
        const NEAR: u16 = COMMAND_US * CLOCK_PER_US;
        self.due.is_some_and(|due| due.wrapping_sub(now) < NEAR)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_board::TestBoard;

    const PERIOD: u16 = TICK_US * CLOCK_PER_US;

    #[test]
    fn a_tick_that_was_skipped_is_an_overrun_and_an_early_one_is_none() {
        for (late, overruns) in [
            (0, 0),
            (PERIOD - 1, 0),
            (PERIOD, 1),
            (0x8000, 0),
            (0xfff0, 0),
        ] {
            let mut times = TickTimes::default();
            times.begin(100);
            times.begin((100 + PERIOD).wrapping_add(late));
            assert_eq!(times.overruns, overruns, "{late}");
        }
    }

    #[test]
    fn a_tick_longer_than_its_period_is_an_overrun() {
        for (us, overruns) in [
            (TICK_US - 1, 0),
            (TICK_US, 0),
            (TICK_US + 1, 1),
            (TICK_US + 900, 1),
        ] {
            let mut times = TickTimes::default();
            let board = TestBoard::default();
            // Its clock goes on by one when it is read.
            board.pass_us(us - 1);
            times.end(&board, 0);
            assert_eq!((times.last_us, times.longest_us), (us, us));
            assert_eq!(
                (times.overruns, times.calm == 0),
                (overruns, overruns == 1),
                "{us}"
            );
        }
    }

    #[test]
    fn a_tick_is_near_from_a_commands_time_before_it_until_it_is_due() {
        const NEAR: u16 = COMMAND_US * CLOCK_PER_US;
        let mut times = TickTimes::default();
        assert!(!times.is_near(100), "none is due before the first");
        times.begin(100);
        let due = 100 + PERIOD;
        for (before, is_near) in [(PERIOD, false), (NEAR, false), (NEAR - 1, true), (0, true)] {
            assert_eq!(times.is_near(due - before), is_near, "{before}");
        }
        assert!(!times.is_near(due + 1));
    }

    #[test]
    fn the_longest_are_told_once() {
        let mut times = TickTimes {
            longest_us: 5,
            longest_law_us: 3,
            ..TickTimes::default()
        };
        times.forget_longest();
        assert_eq!((times.longest_us, times.longest_law_us), (0, 0));
    }
}
