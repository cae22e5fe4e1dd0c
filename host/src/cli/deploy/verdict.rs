//! Whether a plan holds the model's robot.

use crate::cli::Console;
use handstand::deploy::PlanBasis;
#[cfg(feature = "virtual-cm5")]
use handstand::deploy::rehearsal::{Rehearsal, Setting};
use handstand::{Model, Result};
use handstand_shared::plan::Plan;

/// A program without simulated servos has none.
#[cfg(not(feature = "virtual-cm5"))]
#[derive(serde::Serialize)]
pub enum Rehearsal {}

/// Seed of the starts.
#[cfg(feature = "virtual-cm5")]
const SEED: u64 = 1;

/// Tries a plan for `model` out.
///
/// # Errors
/// A model that is no robot on these servos.
#[cfg(feature = "virtual-cm5")]
pub fn of(
    model: &Model,
    plan: &Plan,
    basis: &PlanBasis,
    console: &Console,
) -> Result<Option<Rehearsal>> {
    let setting = Setting {
        lag_s: basis.timing.lag_s,
        supply_v: basis.supply_v,
        ..Setting::default()
    };
    let rehearsal = Rehearsal::of(model, plan, &setting, SEED)?;
    if !rehearsal.holds {
        console.say(&rehearsal.words(plan));
    }
    Ok(Some(rehearsal))
}

/// Says that there is no verdict.
///
/// # Errors
/// Never.
#[cfg(not(feature = "virtual-cm5"))]
pub fn of(_: &Model, _: &Plan, _: &PlanBasis, console: &Console) -> Result<Option<Rehearsal>> {
    console.say("no verdict: this program was built without simulated servos");
    Ok(None)
}

/// The verdict in a sentence.
pub fn words(rehearsal: Option<&Rehearsal>, plan: &Plan) -> String {
    #[cfg(feature = "virtual-cm5")]
    if let Some(rehearsal) = rehearsal {
        return rehearsal.words(plan);
    }
    let _ = (rehearsal, plan);
    "no verdict: this program was built without simulated servos".to_string()
}

/// Whether nothing speaks against the plan.
pub fn holds(rehearsal: Option<&Rehearsal>) -> bool {
    #[cfg(feature = "virtual-cm5")]
    if let Some(rehearsal) = rehearsal {
        return rehearsal.holds;
    }
    let _ = rehearsal;
    true
}
