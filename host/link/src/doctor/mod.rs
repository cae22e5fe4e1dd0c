//! Diagnose why servos do not respond: tests that tell the causes apart.

mod disturbance;
mod latency_timer;
mod no_response;
mod partial_response;
mod ping_test;
mod read_test;

pub use ping_test::PingTest;
pub use read_test::{ReadTest, read_test};

use super::port::SerialLink;
use super::protocol::Protocol;
use super::servos::Servos;
use crate::error::Result;
use latency_timer::held_back;
use no_response::no_response;
use partial_response::partial_response;
use ping_test::{PINGS, ping_test};
use serde::Serialize;
use std::time::Duration;

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
    /// The servos' protocol, if one answered.
    pub protocol: Option<Protocol>,
    /// Whether the adapter hears itself.
    pub echo: bool,
    /// Each servo asked.
    pub pings: Vec<PingTest>,
    /// The likeliest first.
    pub causes: Vec<Cause>,
}

/// Test the servos `ids`, in this protocol or in that of the first which answers; `step` receives
/// the name of each test before it begins.
///
/// # Errors
/// The port failed.
pub fn examine<L: SerialLink>(
    link: L,
    ids: &[u8],
    protocol: Option<Protocol>,
    mut step: impl FnMut(&str),
) -> Result<BusDiagnosis> {
    let mut servos = Servos::new(link);
    servos.protocol = protocol;
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
        let times = round_trips(&mut servos, &pings)?;
        causes.extend(held_back(servos.link().name(), times));
    }
    causes.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    Ok(BusDiagnosis {
        protocol: servos.protocol,
        echo,
        pings,
        causes,
    })
}

/// How long some pings of a servo that answers take.
fn round_trips<L: SerialLink>(servos: &mut Servos<L>, pings: &[PingTest]) -> Result<Vec<Duration>> {
    const COUNT: usize = 9;
    let mut times = Vec::new();
    let Some(test) = pings.iter().find(|test| test.answered == PINGS) else {
        return Ok(times);
    };
    for _ in 0..COUNT {
        let begin = servos.link().now();
        match servos.ping(test.id) {
            Ok(_) => times.push(servos.link().now() - begin),
            Err(error) => drop(error.port()?),
        }
    }
    Ok(times)
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
