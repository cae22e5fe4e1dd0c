//! When the CM-5's ticks were, from the numbers of its reports and from when these came.
//!
//! The CM-5's crystal sets the ticks. A report comes after its tick by what the servos' answers,
//! the line and the PC's driver take, which is another time in every tick, but never less than a
//! certain one: so the reports that were the least late tell when all of their neighbours were
//! read. Where ticks last longer than their period (many servos with the factory's return delay)
//! there is no such grid, and the arrivals are taken as they are.

use handstand_shared::message::TICK_US;
use std::collections::VecDeque;

/// Reports among which the least late one tells the grid.
const KNOWN: usize = 64;
/// The newest of them. One of these must be as punctual as the others, or ticks last longer than
/// their period, or the controller has left some out.
const NEWEST: usize = 12;
/// Lateness of all the newest above which that is so, s.
const MOST_LATE_S: f64 = 0.5 * PERIOD_S;
/// Ticks without a report after which nothing is known of the grid: ten seconds.
const LONGEST_GAP: u16 = 1000;
const PERIOD_S: f64 = TICK_US as f64 * 1e-6;

/// Estimates each tick's time, s.
#[derive(Debug, Default)]
pub(super) struct TickClock {
    /// The number of the last report's tick, and that number without its turns.
    last: Option<(u16, u64)>,
    /// By how much each report came later than its number says, s, the newest last.
    late_s: VecDeque<f64>,
    told_s: f64,
}

impl TickClock {
    /// When the report of this tick would have come at the least, s, if it came at `arrival_s`;
    /// later than what was told before.
    pub fn time_s(&mut self, tick: u16, arrival_s: f64) -> f64 {
        let number = match self.last {
            Some((last, number)) => match tick.wrapping_sub(last) {
                0 | LONGEST_GAP.. => self.start_over(),
                ticks => number + u64::from(ticks),
            },
            None => self.start_over(),
        };
        self.last = Some((tick, number));
        let grid_s = number as f64 * PERIOD_S;
        self.late_s.push_back(arrival_s - grid_s);
        if self.late_s.len() > KNOWN {
            self.late_s.pop_front();
        }
        let least_s =
            |some: &mut dyn Iterator<Item = &f64>| some.fold(f64::INFINITY, |a, b| a.min(*b));
        let newest_s = least_s(&mut self.late_s.iter().rev().take(NEWEST));
        let older_s = least_s(&mut self.late_s.iter().rev().skip(NEWEST));
        // With few reports nothing is older, and nothing known.
        let is_on_grid = older_s.is_finite() && newest_s - older_s < MOST_LATE_S;
        let time_s = if is_on_grid {
            grid_s + newest_s.min(older_s)
        } else {
            arrival_s
        };
        self.told_s = time_s.max(self.told_s + 0.1 * PERIOD_S);
        self.told_s
    }

    /// Forgets the grid: the controller has restarted, or was not heard for long.
    fn start_over(&mut self) -> u64 {
        self.late_s.clear();
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Times told for reports that come this late after ticks of this period, and the ticks' own.
    fn told(period_s: f64, count: u16, late_s: impl Fn(u16) -> f64) -> Vec<(f64, f64)> {
        let mut clock = TickClock::default();
        let first = u16::MAX - 20;
        (0..count)
            .map(|k| {
                let tick_s = f64::from(k) * period_s;
                let told_s = clock.time_s(first.wrapping_add(k), tick_s + late_s(k));
                (told_s, tick_s)
            })
            .collect()
    }

    /// Scattered by a hash over `0..1`.
    fn scatter(k: u16) -> f64 {
        f64::from(k.wrapping_mul(40_503) >> 4) / 4096.0
    }

    /// How far the times are from the ticks' own but for one delay, s.
    fn scatter_s(told: &[(f64, f64)]) -> f64 {
        let late = told.iter().map(|(told_s, tick_s)| told_s - tick_s);
        let (low, high) = late.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), late| {
            (low.min(late), high.max(late))
        });
        high - low
    }

    #[test]
    fn late_reports_do_not_move_their_ticks() {
        // Answers that are repeated, a busy PC, and a driver that hands over every 16 ms.
        let all: [fn(u16) -> f64; 3] = [
            |k| 0.001 * scatter(k),
            |k| 0.005 * scatter(k),
            |k| 0.016 - (0.010 * f64::from(k)) % 0.016,
        ];
        for late_s in all {
            // A crystal 100 ppm off.
            let told = told(0.010_001, 800, |k| 0.011 + late_s(k));
            let arrivals: Vec<(f64, f64)> = (0..800).map(|k| (late_s(k), 0.0)).collect();
            let scatter = scatter_s(&told[KNOWN..]);
            assert!(scatter < 0.12 * scatter_s(&arrivals), "{scatter}");
        }
    }

    #[test]
    fn ticks_that_keep_no_period_are_told_by_their_arrival() {
        let told = told(0.0132, 400, |k| 0.011 + 0.001 * scatter(k));
        let longest = told.windows(2).map(|pair| pair[1].0 - pair[0].0);
        let longest = longest.skip(2 * NEWEST).fold(0.0, f64::max);
        assert!((longest - 0.0132).abs() < 0.0011, "{longest}");
        assert!(scatter_s(&told[2 * NEWEST..]) < 0.0011);
    }

    #[test]
    fn a_restart_and_a_long_silence_begin_anew() {
        let mut clock = TickClock::default();
        for k in 0..50 {
            clock.time_s(k, f64::from(k) * PERIOD_S);
        }
        assert!((clock.time_s(50, 0.504) - 0.5).abs() < 1e-12);
        assert_eq!(clock.time_s(0, 3.0), 3.0);
        assert_eq!(clock.time_s(1, 3.013), 3.013);
        assert_eq!(clock.time_s(5001, 60.0), 60.0);
    }

    #[test]
    fn time_never_goes_back() {
        let mut clock = TickClock::default();
        let first = clock.time_s(0, 0.5);
        let second = clock.time_s(1, 0.451);
        assert!(second > first);
    }
}
