//! Latency budget of a robot: round trip of a request, split into its parts, and time of a whole
//! round.

use super::tally::{Quantiles, RecordingTally};
use super::{SampleSource, Stream};
use crate::error::{Error, Result};
use crate::{Protocol, SerialLink, Servos};
use handstand_shared::control_table::RETURN_DELAY;
use handstand_shared::dynamixel::timing::{BYTE_NS, PING_REPLY_NS};
use handstand_shared::frame::wire_length;
use handstand_shared::message::{Command, Report, Subject, Telemetry};
use serde::Serialize;
use std::time::Duration;

/// A stream comes at the CM-5's own pace; this much jitter is the line's, us.
const STREAM_JITTER_US: f64 = 500.0;

/// Latency budget, and whether a round fits the sampling time.
#[derive(Debug, Clone, Serialize)]
pub struct LatencyBudget {
    /// One request and its answer.
    pub round_trip_us: Quantiles,
    /// Of its median: bytes on the PC's line.
    pub line_us: f64,
    /// Of its median: bytes on the servos' bus and their return delay; of a stream the CM-5's tick,
    /// bus included.
    pub bus_us: f64,
    /// The rest of the median: adapter, USB, drivers.
    pub rest_us: f64,
    /// From sample to sample, as fast as possible; of a stream as the CM-5 sends them.
    pub round_us: Quantiles,
    /// Time of a round's bytes on the line, where all servos are read at once (Protocol 2.0).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limit_us: Option<f64>,
    /// Sampling time that is wanted.
    pub period_us: f64,
    /// Whether 99 % of the rounds fit it.
    pub fits: bool,
    /// Answers that did not come.
    pub missing: u64,
}

/// Round trip of one request and its parts.
#[derive(Debug, Clone, Copy)]
pub struct RoundTrip {
    times_us: Quantiles,
    line_us: f64,
    bus_us: f64,
    jitter_us: f64,
}

impl RoundTrip {
    /// Ping servos behind an adapter, at least 50 times. A ping and its reply are 6 bytes each (10
    /// and 14 in Protocol 2.0), on the line and, where the line is not the bus itself, on the bus
    /// again.
    ///
    /// # Errors
    /// No servo answers, or the port fails.
    pub fn of_adapter<L: SerialLink>(servos: &mut Servos<L>, ids: &[u8]) -> Result<RoundTrip> {
        let mut delay_us = 0.0;
        let mut times_us = Vec::new();
        for id in ids.iter().cycle().take(ids.len().max(50)) {
            let begin = servos.link().now();
            if servos.ping(*id).is_ok() {
                times_us.push(micros(servos.link().now() - begin));
                if let Ok(code) = servos.get(*id, RETURN_DELAY) {
                    delay_us = f64::from(2 * code);
                }
            }
        }
        let bytes = match servos.protocol {
            Some(Protocol::Two) => 24,
            _ => 12,
        };
        let is_bus = servos.link().baud() >= 900_000;
        let bytes_us = if is_bus {
            0.0
        } else {
            f64::from(bytes) * 1e-3 * BYTE_NS as f64
        };
        Ok(RoundTrip {
            times_us: Quantiles::of(times_us).ok_or_else(no_response)?,
            line_us: micros(servos.link().line_time(bytes as usize)),
            bus_us: delay_us + 1e-3 * PING_REPLY_NS as f64 + bytes_us,
            jitter_us: 0.0,
        })
    }

    /// Ask the CM-5 for its telemetry 50 times. The request's body has 4 bytes, the report's about
    /// 24.
    ///
    /// # Errors
    /// The CM-5 does not answer.
    pub fn of_stream<L: SerialLink>(stream: &mut Stream<L>) -> Result<RoundTrip> {
        let (mut times_us, mut ticks_us) = (Vec::new(), Vec::new());
        let session = stream.session();
        for _ in 0..50 {
            let begin = session.link().now();
            let telemetry: Telemetry =
                session.fetch(&Command::Ask(Subject::Telemetry), |report| match report {
                    Report::Telemetry(telemetry) => Some(*telemetry),
                    _ => None,
                })?;
            times_us.push(micros(session.link().now() - begin));
            ticks_us.push(f64::from(telemetry.tick_us));
        }
        let bytes = wire_length(4) + 1 + wire_length(24);
        Ok(RoundTrip {
            times_us: Quantiles::of(times_us).ok_or_else(no_response)?,
            line_us: micros(session.link().line_time(bytes)),
            bus_us: Quantiles::of(ticks_us).map_or(0.0, |ticks| ticks.median),
            jitter_us: STREAM_JITTER_US,
        })
    }

    /// The budget with `rounds` samples of `source`, as long as `goes_on`, for a sampling time of
    /// `period_us`.
    ///
    /// # Errors
    /// The device fails, or a sample does not come.
    pub fn budget(
        self,
        source: &mut dyn SampleSource,
        rounds: u64,
        period_us: f64,
        mut goes_on: impl FnMut() -> bool,
    ) -> Result<LatencyBudget> {
        let mut tally = RecordingTally::default();
        let (mut before_s, mut times_us) = (None, Vec::new());
        while tally.samples < rounds && goes_on() {
            let sample = source.sample(None)?.ok_or_else(no_response)?;
            tally.count(&sample);
            let arrival_s = source.arrival_s(&sample);
            let before_s = before_s.replace(arrival_s);
            times_us.extend(before_s.map(|before_s: f64| (arrival_s - before_s) * 1e6));
        }
        let round_us = Quantiles::of(times_us).ok_or_else(no_response)?;
        Ok(LatencyBudget {
            rest_us: (self.times_us.median - self.line_us - self.bus_us).max(0.0),
            fits: round_us.p99 <= period_us + self.jitter_us,
            round_trip_us: self.times_us,
            line_us: self.line_us,
            bus_us: self.bus_us,
            round_us,
            limit_us: None,
            period_us,
            missing: tally.missing,
        })
    }
}

/// The error where no servo answers.
pub fn no_response() -> Error {
    Error::device("no servo answers", "`handstand bus doctor` finds the cause")
}

fn micros(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6
}
