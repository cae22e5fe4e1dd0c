//! Work that is ended by the clock or by who waits for it. It is looked at before every motion that
//! is simulated, so a fit of any length ends within one run of each thread.
//!
//! A fit that is ended half way is of no use: it unwinds to [`Halt::until`], and what was finished
//! before stays with whoever keeps it.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Ends a diagnosis from another thread. Clones end the same one.
#[derive(Clone, Default)]
pub struct StopSwitch(Arc<AtomicU8>);

const ACCEPTED: u8 = 1;
const ABANDONED: u8 = 2;

impl StopSwitch {
    /// What was found is enough: the search ends, and its best so far is judged.
    pub fn accept(&self) {
        self.0.fetch_max(ACCEPTED, Ordering::Relaxed);
    }

    /// Nothing of it is wanted: the work unwinds with [`Abandoned`].
    pub fn abandon(&self) {
        self.0.fetch_max(ABANDONED, Ordering::Relaxed);
    }

    /// Whether what was found is enough.
    pub fn is_accepted(&self) -> bool {
        self.0.load(Ordering::Relaxed) >= ACCEPTED
    }

    /// Whether nothing of it is wanted.
    pub fn is_abandoned(&self) -> bool {
        self.0.load(Ordering::Relaxed) == ABANDONED
    }
}

/// Options are written down beside what they decide; whether the work was ended is none.
impl fmt::Debug for StopSwitch {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("StopSwitch")
    }
}

/// What unwinds work of which nothing is wanted, to be caught by who [abandoned](StopSwitch) it.
#[derive(Debug)]
pub struct Abandoned;

/// Work that was ended before it was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Halted;

/// What ends the fits to data that know it; none by default.
#[derive(Clone, Default)]
pub struct Halt(Option<Arc<HaltState>>);

struct HaltState {
    begun: Instant,
    switch: StopSwitch,
    /// Whether an accepted result ends the work.
    heeds: AtomicBool,
    /// When the work ends, ns after it began; `u64::MAX` for never.
    end_ns: AtomicU64,
    /// Motions simulated.
    runs: AtomicUsize,
    #[cfg(any(test, feature = "testkit"))]
    sees: Option<Box<dyn Fn(usize) + Send + Sync>>,
}

impl fmt::Debug for Halt {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("Halt")
    }
}

impl Halt {
    /// By this switch; nothing ends it but [`StopSwitch::abandon`] until it
    /// [heeds](Halt::ends_at) more. The clock starts.
    pub fn by(switch: &StopSwitch) -> Halt {
        Halt::watching(HaltState::of(switch))
    }

    /// The same, which shows every run it counts.
    #[cfg(any(test, feature = "testkit"))]
    pub fn seen(switch: &StopSwitch, sees: impl Fn(usize) + Send + Sync + 'static) -> Halt {
        Halt::watching(HaltState {
            sees: Some(Box::new(sees)),
            ..HaltState::of(switch)
        })
    }

    fn watching(watch: HaltState) -> Halt {
        Halt(Some(Arc::new(watch)))
    }

    /// From now on the work ends so long after it began, or never, and whether it also ends where
    /// its result is accepted.
    pub fn ends_at(&self, end: Option<Duration>, heeds: bool) {
        if let Some(watch) = &self.0 {
            let end_ns = end.and_then(|end| u64::try_from(end.as_nanos()).ok());
            watch
                .end_ns
                .store(end_ns.unwrap_or(u64::MAX), Ordering::Relaxed);
            watch.heeds.store(heeds, Ordering::Relaxed);
        }
    }

    /// How long the work has taken.
    pub fn elapsed(&self) -> Duration {
        let begun = self.0.as_ref().map(|watch| watch.begun.elapsed());
        begun.unwrap_or_default()
    }

    /// Motions simulated so far.
    pub fn runs(&self) -> usize {
        let runs = self.0.as_ref().map(|w| w.runs.load(Ordering::Relaxed));
        runs.unwrap_or(0)
    }

    /// Whether the work is to end.
    pub fn is_on(&self) -> bool {
        self.0.as_deref().is_some_and(HaltState::is_on)
    }

    /// Counts a run that begins; unwinds where the work is to end.
    pub fn begin_run(&self) {
        let Some(watch) = &self.0 else {
            return;
        };
        let _runs = watch.runs.fetch_add(1, Ordering::Relaxed);
        #[cfg(any(test, feature = "testkit"))]
        if let Some(sees) = &watch.sees {
            sees(_runs + 1);
        }
        if watch.switch.is_abandoned() {
            resume_unwind(Box::new(Abandoned));
        }
        if watch.is_on() {
            resume_unwind(Box::new(Halted));
        }
    }

    /// Does the work unless it is ended, or was before it began. All else that unwinds goes on.
    ///
    /// # Errors
    /// The work was ended. What it changes must be whole at any time.
    pub fn until<T>(&self, work: impl FnOnce() -> T) -> Result<T, Halted> {
        if self.is_on() {
            return Err(Halted);
        }
        catch_unwind(AssertUnwindSafe(work)).map_err(|thrown| match thrown.downcast::<Halted>() {
            Ok(halted) => *halted,
            Err(thrown) => resume_unwind(thrown),
        })
    }
}

impl HaltState {
    fn of(switch: &StopSwitch) -> HaltState {
        HaltState {
            begun: Instant::now(),
            switch: switch.clone(),
            heeds: AtomicBool::new(false),
            end_ns: AtomicU64::new(u64::MAX),
            runs: AtomicUsize::new(0),
            #[cfg(any(test, feature = "testkit"))]
            sees: None,
        }
    }

    fn is_on(&self) -> bool {
        let end_ns = self.end_ns.load(Ordering::Relaxed);
        (self.heeds.load(Ordering::Relaxed) && self.switch.is_accepted())
            || (end_ns != u64::MAX && self.begun.elapsed().as_nanos() >= u128::from(end_ns))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitting::log_tests::{ANGLE, even, pendulum, swing};
    use crate::fitting::{FitOptions, FitProblem, Horizon, fit};

    /// Runs of a fit of friction to two swings; the switch is pressed at one of them.
    fn runs(press_at: usize, press: impl Fn(&StopSwitch) + Send + Sync + 'static) -> usize {
        let motions = [1.0, 0.5].map(|from_rad| {
            let truth = pendulum(ANGLE, 0.006);
            swing(&truth, &[from_rad], even(600, 100.0))
        });
        let believed = pendulum(ANGLE, 0.003);
        let switch = StopSwitch::default();
        let pressed = switch.clone();
        let halt = Halt::seen(&switch, move |run| {
            if run == press_at {
                press(&pressed);
            }
        });
        halt.ends_at(None, true);
        let data = FitProblem::new(&believed, motions.to_vec(), Horizon::Seconds(1.0));
        let data = data.halted_by(&halt);
        let friction = "coulomb@1.torque_nm".parse().unwrap();
        let fitted = || fit(&believed, &[friction], &data, None, FitOptions::default());
        let ended = catch_unwind(AssertUnwindSafe(|| halt.until(fitted).is_err()));
        let was_pressed = press_at < usize::MAX;
        match ended {
            Ok(halted) => assert_eq!(halted, was_pressed),
            Err(thrown) => assert!(thrown.is::<Abandoned>()),
        }
        halt.runs()
    }

    /// One run more on each thread of the pool, and each of those that were to come looks once.
    #[test]
    fn a_stop_ends_a_fit_within_the_runs_that_were_asked_for() {
        let whole = runs(usize::MAX, |_| ());
        assert!(whole > 30, "{whole}");
        // A Jacobian of one value and two start states, over two motions.
        let most = 2 * 3;
        for press_at in [1, 9, 20] {
            let halted = runs(press_at, StopSwitch::accept);
            assert!(halted <= press_at + most, "{press_at}: {halted}");
            let abandoned = runs(press_at, StopSwitch::abandon);
            assert!(abandoned <= press_at + most, "{press_at}: {abandoned}");
        }
    }

    #[test]
    fn what_was_ended_before_it_began_is_not_begun() {
        let halt = Halt::by(&StopSwitch::default());
        assert_eq!(halt.until(|| 1), Ok(1));
        halt.ends_at(Some(Duration::ZERO), false);
        assert_eq!(halt.until(|| unreachable!()), Err::<(), _>(Halted));
    }
}
