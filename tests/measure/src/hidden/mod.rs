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
pub(crate) use mujoco::run as mujoco_script;
pub use mujoco::{install as install_mujoco, so101};
pub use outcome::{Answer, Outcome, Value};
pub use robot::ROBOT_KINDS;
pub(crate) use said::said;
pub use tally::{EffectRow, FamilyRow, Share, Tally};
pub use text::{line, misses, tables};
pub use trial::try_case;
pub use within::{Timed, Within, try_within};

use crate::jobs::try_each;
use std::path::Path;

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
    let found = try_each(cases, [jobs, threads], &|case| {
        let outcome = try_case(case, rigs);
        outcome.inspect(heard)
    });
    let (mut outcomes, mut failed) = (Vec::new(), Vec::new());
    for (case, outcome) in cases.iter().zip(found) {
        match outcome {
            Ok(outcome) => outcomes.push(outcome),
            Err(why) => failed.push((case.clone(), why)),
        }
    }
    (outcomes, failed)
}
