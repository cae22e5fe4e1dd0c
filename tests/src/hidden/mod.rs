//! The hidden-effect benchmark: is an effect that a virtual bench hides named, missed, or invented?
//!
//! Truth and library share no equation: [`handstand::challenge`] has its own.

mod tally;
mod text;
mod trial;

pub use tally::{Figure, Row, Tally};
pub use text::{line, misses, tables};
pub use trial::{Case, Outcome, Value, try_case};

use handstand::Result;
use handstand::challenge::KINDS;
use rayon::ThreadPoolBuilder;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Which cases to try.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Effects to hide.
    pub effects: Vec<&'static str>,
    /// Benches per effect.
    pub seeds: u64,
    /// Benches that hide nothing.
    pub nominal: u64,
    /// First seed of each kind.
    pub seed0: u64,
    /// Whether each effect is also sought by a library that lacks it.
    pub leave_out: bool,
}

impl Default for Plan {
    fn default() -> Self {
        Plan {
            effects: KINDS.to_vec(),
            seeds: 5,
            nominal: 50,
            seed0: 1,
            leave_out: true,
        }
    }
}

impl Plan {
    /// Every case: those with an effect, those with none, then those whose effect the library
    /// lacks.
    pub fn cases(&self) -> Vec<Case> {
        let hidden = |left_out| {
            let seeds = move |kind| {
                (self.seed0..self.seed0 + self.seeds).map(move |seed| Case {
                    kind: Some(kind),
                    seed,
                    left_out,
                })
            };
            self.effects.iter().flat_map(move |&kind| seeds(kind))
        };
        let nominal = (self.seed0..self.seed0 + self.nominal).map(|seed| Case {
            kind: None,
            seed,
            left_out: false,
        });
        let mut cases: Vec<Case> = hidden(false).chain(nominal).collect();
        if self.leave_out {
            cases.extend(hidden(true));
        }
        cases
    }
}

/// Tries all cases, `jobs` at a time, sharing `threads` threads out among them; outcomes in the
/// order of the cases, whatever these numbers are. `heard` hears of every outcome as it comes.
///
/// # Errors
/// A file that could not be written or read back.
pub fn try_all(
    cases: &[Case],
    jobs: usize,
    threads: usize,
    heard: &(dyn Fn(&Outcome) + Sync),
) -> Result<Vec<Outcome>> {
    let next = AtomicUsize::new(0);
    let found: Mutex<Vec<(usize, Result<Outcome>)>> = Mutex::new(Vec::new());
    let each = (threads / jobs.max(1)).max(1);
    std::thread::scope(|scope| {
        for _ in 0..jobs.max(1) {
            scope.spawn(|| {
                // A pool of its own: diagnoses that share one steal each other's work, and their
                // times mean nothing.
                let pool = ThreadPoolBuilder::new().num_threads(each).build().ok();
                loop {
                    let index = next.fetch_add(1, Ordering::SeqCst);
                    let Some(case) = cases.get(index) else {
                        break;
                    };
                    let outcome = match &pool {
                        Some(pool) => pool.install(|| try_case(case)),
                        None => try_case(case),
                    };
                    if let Ok(outcome) = &outcome {
                        heard(outcome);
                    }
                    if let Ok(mut found) = found.lock() {
                        found.push((index, outcome));
                    }
                }
            });
        }
    });
    let mut found = found
        .into_inner()
        .unwrap_or_else(|broken| broken.into_inner());
    found.sort_by_key(|(index, _)| *index);
    found.into_iter().map(|(_, outcome)| outcome).collect()
}
