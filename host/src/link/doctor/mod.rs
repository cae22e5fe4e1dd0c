//! Diagnose why servos do not respond: tests that tell the causes apart.

mod disturbance;
mod no_response;
mod partial_response;
mod ping_test;

pub use ping_test::PingTest;

use super::port::SerialLink;
use super::servos::Servos;
use crate::error::Result;
use no_response::no_response;
use partial_response::partial_response;
use ping_test::{PINGS, ping_test};
use serde::Serialize;

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
pub struct BusDiagnosis {
    /// Whether the adapter hears itself.
    pub echo: bool,
    /// Each servo asked.
    pub pings: Vec<PingTest>,
    /// The likeliest first.
    pub causes: Vec<Cause>,
}

/// Test the servos `ids`; `step` receives the name of each test before it begins.
///
/// # Errors
/// The port failed.
pub fn examine<L: SerialLink>(
    link: L,
    ids: &[u8],
    mut step: impl FnMut(&str),
) -> Result<BusDiagnosis> {
    let mut servos = Servos::new(link);
    servos.tries = 1;
    step("listening for an echo");
    let echo = servos.echoes()?;
    let mut pings = Vec::new();
    for id in ids {
        step(&format!("servo {id}: {PINGS} pings"));
        pings.push(ping_test(&mut servos, *id)?);
    }
    let mut causes = Vec::new();
    let replied = |test: &PingTest| {
        test.answered + test.late + test.corrupted_requests + test.unexpected_ids > 0
    };
    if !pings.iter().any(replied) {
        no_response(&mut servos, ids, &pings, &mut causes, &mut step)?;
    } else {
        partial_response(&mut servos, &pings, &mut causes)?;
    }
    causes.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    Ok(BusDiagnosis {
        echo,
        pings,
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
