//! The work after a search: what the verdict rests on beside the explanation itself.

use crate::fitting::{Halt, Halted};
use std::time::Duration;

/// The work after a search. What does not come to its end in time is left out, and told.
pub(super) struct Judging {
    halt: Halt,
    end: Option<Duration>,
    left_out: Vec<&'static str>,
}

impl Judging {
    /// Of work that must be done by then, if by any time.
    pub fn until(end: Option<Duration>, halt: &Halt) -> Judging {
        halt.ends_at(end, false);
        Judging {
            halt: halt.clone(),
            end,
            left_out: Vec::new(),
        }
    }

    /// What was left out since the last call, in words.
    pub fn take_left_out(&mut self) -> Vec<String> {
        let left_out = std::mem::take(&mut self.left_out);
        left_out.into_iter().map(str::to_string).collect()
    }

    /// A part of it, which may take this share of the time that is left.
    pub fn part<T>(
        &mut self,
        what: &'static str,
        share: f64,
        work: impl FnOnce() -> T,
    ) -> Option<T> {
        if let Some(end) = self.end {
            let now = self.halt.elapsed();
            let own = end.saturating_sub(now).mul_f64(share);
            self.halt.ends_at(Some(now + own), false);
        }
        match self.halt.until(work) {
            Ok(done) => Some(done),
            Err(Halted) => {
                self.left_out.push(what);
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitting::StopSwitch;

    #[test]
    fn what_is_not_done_in_time_is_left_out_and_told() {
        let halt = Halt::by(&StopSwitch::default());
        let mut judging = Judging::until(None, &halt);
        assert_eq!(judging.part("all", 0.1, || 1), Some(1));
        assert!(judging.take_left_out().is_empty());
        // The time of a part is a share of what is left of it.
        let mut judging = Judging::until(Some(halt.elapsed() + Duration::from_secs(3600)), &halt);
        let spent = judging.part("none", 0.0, || halt.begin_run());
        assert_eq!(spent, None);
        assert_eq!(judging.part("some", 0.5, || halt.begin_run()), Some(()));
        assert_eq!(judging.take_left_out(), ["none"]);
        assert!(judging.take_left_out().is_empty());
    }
}
