//! The hidden-effect benchmark: is an effect that a virtual rig hides named, missed, or invented?
//!
//! Truth and library share no equation: [`handstand::challenge`] has its own, and MuJoCo knows
//! nothing of either. The virtual robot has the library's plant; there the question is what the
//! robot's own recordings tell.

mod approximate;
mod case;
mod detection;
mod family;
mod mujoco;
mod outcome;
mod robot;
mod said;
mod score;
mod tally;
mod text;
mod trial;
mod within;

pub use case::{Case, Truth};
pub use detection::{DetectionLimit, Faintest, detection_limit, limits_table};
pub use family::{FAMILIES, Family, OUTSIDE, Plan, kinds};
pub use mujoco::install as install_mujoco;
pub(crate) use mujoco::run as mujoco_script;
pub use outcome::{Answer, Outcome, Value};
pub use robot::ROBOT_KINDS;
pub(crate) use said::said;
pub use tally::{EffectRow, FamilyRow, Share, Tally};
pub use text::{line, misses, tables};
pub use trial::try_case;
pub use within::{Timed, Within, try_within};

use rayon::ThreadPoolBuilder;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Tries all cases, `jobs` at a time, sharing `threads` threads out among them; outcomes in the
/// order of the cases, whatever these numbers are, and the cases that could not be made, with why.
/// The rigs' files stay in folders of `rigs`, if one is given. `heard` hears of every outcome as it
/// comes.
pub fn try_all(
    cases: &[Case],
    rigs: Option<&Path>,
    [jobs, threads]: [usize; 2],
    heard: &(dyn Fn(&Outcome) + Sync),
) -> (Vec<Outcome>, Vec<(Case, String)>) {
    let next = AtomicUsize::new(0);
    let found: Mutex<Vec<(usize, Result<Outcome, String>)>> = Mutex::new(Vec::new());
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
                        Some(pool) => pool.install(|| try_case(case, rigs)),
                        None => try_case(case, rigs),
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
    let (mut outcomes, mut failed) = (Vec::new(), Vec::new());
    for (index, outcome) in found {
        match outcome {
            Ok(outcome) => outcomes.push(outcome),
            Err(why) => failed.push((cases[index].clone(), why)),
        }
    }
    (outcomes, failed)
}
