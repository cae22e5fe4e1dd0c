//! Why a servo gives no status packet: tests that tell the causes apart.

mod disturbance;
mod nobody;
mod pulse;
mod some;

pub use pulse::Pulse;

use super::port::Link;
use super::servos::Servos;
use crate::error::Result;
use nobody::nobody;
use pulse::{PINGS, pulse};
use serde::Serialize;
use some::some;

/// A cause, how well the tests support it (0 to 1), and what to do.
#[derive(Debug, Clone, Serialize)]
pub struct Cause {
    /// What is wrong.
    pub cause: String,
    /// What was seen that says so.
    pub evidence: String,
    /// How to mend it.
    pub remedy: String,
    /// How strongly the evidence speaks for it, 0 to 1.
    pub weight: f64,
}

/// What was found; no cause means that all is well.
#[derive(Debug, Clone, Serialize)]
pub struct Diagnosis {
    /// Whether the adapter hears itself.
    pub echo: bool,
    /// Each servo asked.
    pub pulses: Vec<Pulse>,
    /// The likeliest first.
    pub causes: Vec<Cause>,
}

/// Examines the servos `ids`; `step` is told what is done next.
///
/// # Errors
/// The port failed.
pub fn examine<L: Link>(link: L, ids: &[u8], mut step: impl FnMut(&str)) -> Result<Diagnosis> {
    let mut servos = Servos::new(link);
    servos.tries = 1;
    step("listening for an echo");
    let echo = servos.echoes().map_err(|failure| failure.of(0))?;
    let mut pulses = Vec::new();
    for id in ids {
        step(&format!("servo {id}: {PINGS} pings"));
        pulses.push(pulse(&mut servos, *id)?);
    }
    let mut causes = Vec::new();
    let spoke = |pulse: &Pulse| pulse.answered + pulse.late + pulse.misheard + pulse.strangers > 0;
    if !pulses.iter().any(spoke) {
        nobody(&mut servos, ids, &pulses, &mut causes, &mut step)?;
    } else {
        some(&mut servos, &pulses, &mut causes)?;
    }
    causes.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    Ok(Diagnosis {
        echo,
        pulses,
        causes,
    })
}

fn cause(
    weight: f64,
    cause: impl Into<String>,
    evidence: impl Into<String>,
    remedy: impl Into<String>,
) -> Cause {
    Cause {
        cause: cause.into(),
        evidence: evidence.into(),
        remedy: remedy.into(),
        weight,
    }
}

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests;
