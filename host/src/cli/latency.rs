//! `handstand latency`: where the time between PC and servos goes, and whether it fits the sampling time.
//!
//! Without `--stream` it pings the servos, reads whole rounds, and splits a round trip into the PC's line, the servos' bus
//! (return delay included), and the rest: adapter, USB, drivers. With `--stream` a CM-5 reads the servos itself: it
//! splits the time from asking to answer into line and controller, and takes the controller's tick from its telemetry.
//!
//! The verdict compares the slowest of 99 % of the rounds with `--period-ms`. Exit code 0: it fits, 1: it does not.
//!
//! `--json` prints `round_trip_us`, `line_us`, `bus_us`, `rest_us`, `round_us`, `period_us`, `fits`, `missing`; each
//! measured time with `min`, `median`, `p99`, `max`.

use super::port::no_response;
use super::robot::Robot;
use super::talk::Talk;
use super::{Outcome, interrupt::Interrupt};
use handstand::link::Link as _;
use handstand::record::{Adapter, Sample, Source, Stream};
use handstand::{Error, Result};
use handstand_shared::control_table::RETURN_DELAY;
use handstand_shared::frame::wire_length;
use handstand_shared::message::{Command, Report, Subject, Telemetry};
use serde::Serialize;
use std::time::Duration;

/// Measure round trips.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    robot: Robot,
    /// Rounds to measure
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u64).range(10..=100_000))]
    rounds: u64,
    /// Sampling time that is wanted
    #[arg(long, default_value_t = 10.0)]
    period_ms: f64,
}

/// Times in microseconds, of many.
#[derive(Debug, Clone, Serialize)]
struct Times {
    min: f64,
    median: f64,
    p99: f64,
    max: f64,
}

impl Times {
    fn of(mut times: Vec<f64>) -> Option<Times> {
        times.sort_by(f64::total_cmp);
        let at = |share: f64| {
            times
                .get(((times.len() as f64 - 1.0) * share).ceil() as usize)
                .copied()
        };
        Some(Times {
            min: at(0.0)?,
            median: at(0.5)?,
            p99: at(0.99)?,
            max: at(1.0)?,
        })
    }
}

/// The answer.
#[derive(Debug, Serialize)]
struct Answer {
    /// One request and its answer.
    round_trip_us: Times,
    /// Of its median: bytes on the PC's line.
    line_us: f64,
    /// Of its median: bytes on the servos' bus, and their return delay; with --stream the CM-5's tick, bus included.
    bus_us: f64,
    /// What is left of the median.
    rest_us: f64,
    /// From sample to sample, as fast as it goes; with --stream as the CM-5 sends them.
    round_us: Times,
    period_us: f64,
    fits: bool,
    /// Answers that did not come.
    missing: u64,
}

/// What was measured, either way.
struct Measured {
    round_trip_us: Times,
    line_us: f64,
    bus_us: f64,
    round_us: Times,
    missing: u64,
}

/// A byte on the servos' bus at 1 Mbaud, us.
const BUS_BYTE_US: f64 = 10.0;

/// Measures, judges.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    if !(0.1..=10_000.0).contains(&args.period_ms) {
        return Err(Error::usage(
            format!("--period-ms {} is no sampling time", args.period_ms),
            "give 0.1 to 10000",
        ));
    }
    let measured = match args.robot.stream {
        true => by_stream(args, talk)?,
        false => by_adapter(args, talk)?,
    };
    let answer = judge(measured, args);
    if talk.json {
        talk.data(&answer)?;
    } else {
        talk.print(&text(&answer, args))?;
    }
    Ok(if answer.fits {
        Outcome::Done
    } else {
        Outcome::Refused
    })
}

fn by_adapter(args: &Args, talk: &Talk) -> Result<Measured> {
    let mut servos = args.robot.port.servos()?;
    let ids = &args.robot.ids.0;
    let mut delay_us = 0.0;
    let mut trips = Vec::new();
    for id in ids.iter().cycle().take(ids.len().max(50)) {
        let begin = servos.link().now();
        if servos.ping(*id).is_ok() {
            trips.push(micros(servos.link().now() - begin));
            if let Ok(code) = servos.get(*id, RETURN_DELAY) {
                delay_us = f64::from(2 * code);
            }
        }
    }
    let round_trip_us = Times::of(trips).ok_or_else(no_response)?;
    // PING and its answer: 6 bytes each, on the line and again on the bus behind it.
    let is_direct = servos.link().baud() >= 900_000;
    let line_us = micros(servos.link().line_time(12));
    let bus_us = delay_us + 18.0 + if is_direct { 0.0 } else { 12.0 * BUS_BYTE_US };
    let adapter = Adapter::new(servos, ids, Duration::ZERO);
    let (round_us, missing) = rounds(adapter, args, talk)?;
    Ok(Measured {
        round_trip_us,
        line_us,
        bus_us,
        round_us,
        missing,
    })
}

fn by_stream(args: &Args, talk: &Talk) -> Result<Measured> {
    let mut stream = Stream::new(args.robot.port.open()?, &args.robot.ids.0)?;
    let mut trips = Vec::new();
    let mut ticks = Vec::new();
    for _ in 0..50 {
        let session = stream.session();
        let begin = session.link().now();
        let telemetry: Telemetry =
            session.fetch(&Command::Ask(Subject::Telemetry), |report| match report {
                Report::Telemetry(telemetry) => Some(*telemetry),
                _ => None,
            })?;
        trips.push(micros(session.link().now() - begin));
        ticks.push(f64::from(telemetry.tick_us));
    }
    let round_trip_us = Times::of(trips).ok_or_else(no_response)?;
    let bus_us = Times::of(ticks).map_or(0.0, |ticks| ticks.median);
    // The question of 4 bytes' body and its answer of about 24.
    let line_us = micros(
        stream
            .session()
            .link()
            .line_time(wire_length(4) + 1 + wire_length(24)),
    );
    let (round_us, missing) = rounds(stream, args, talk)?;
    Ok(Measured {
        round_trip_us,
        line_us,
        bus_us,
        round_us,
        missing,
    })
}

fn judge(measured: Measured, args: &Args) -> Answer {
    let Measured {
        round_trip_us,
        line_us,
        bus_us,
        round_us,
        missing,
    } = measured;
    let period_us = args.period_ms * 1e3;
    // A stream comes at the CM-5's own pace; half a millisecond of jitter is the line's.
    let limit_us = if args.robot.stream {
        period_us + 500.0
    } else {
        period_us
    };
    Answer {
        rest_us: (round_trip_us.median - line_us - bus_us).max(0.0),
        fits: round_us.p99 <= limit_us,
        round_trip_us,
        line_us,
        bus_us,
        round_us,
        period_us,
        missing,
    }
}

/// Times from sample to sample, and how many answers were missing.
fn rounds(mut source: impl Source, args: &Args, talk: &Talk) -> Result<(Times, u64)> {
    let interrupt = Interrupt::listen();
    let bar = talk.bar();
    bar.set_length(args.rounds);
    let mut samples: Vec<Sample> = Vec::new();
    while (samples.len() as u64) < args.rounds && !interrupt.has_come() {
        match source.sample(None)? {
            Some(sample) => samples.push(sample),
            None => return Err(no_response()),
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    let times = samples
        .windows(2)
        .map(|pair| (pair[1].time_s - pair[0].time_s) * 1e6)
        .collect();
    let silent = |sample: &Sample| {
        sample
            .joints
            .iter()
            .filter(|joint| joint.position_rad.is_none())
            .count() as u64
    };
    Ok((
        Times::of(times).ok_or_else(no_response)?,
        samples.iter().map(silent).sum(),
    ))
}

fn micros(time: Duration) -> f64 {
    time.as_secs_f64() * 1e6
}

fn text(answer: &Answer, args: &Args) -> String {
    let times = |times: &Times| {
        format!(
            "{:.0} us median, {:.0} to {:.0}, 99 % below {:.0}",
            times.median, times.min, times.max, times.p99
        )
    };
    let (bus, rest) = match args.robot.stream {
        true => (
            "the CM-5's tick, servos included",
            "waiting for the tick and behind its reports",
        ),
        false => (
            "servos' bus and return delay",
            "the rest (adapter, USB, drivers)",
        ),
    };
    let verdict = match answer.fits {
        true => "fits".to_string(),
        false => format!("does not fit: {}", remedy(answer, args)),
    };
    format!(
        "round trip: {}\n  PC's line {:.0} us, {bus} {:.0} us, {rest} {:.0} us\nround of {} servos: {}\nmissing answers: {}\nsampling time {:.1} ms: {verdict}",
        times(&answer.round_trip_us),
        answer.line_us,
        answer.bus_us,
        answer.rest_us,
        args.robot.ids.0.len(),
        times(&answer.round_us),
        answer.missing,
        args.period_ms,
    )
}

fn remedy(answer: &Answer, args: &Args) -> &'static str {
    let largest = answer.line_us.max(answer.bus_us).max(answer.rest_us);
    if args.robot.stream {
        "fewer servos, or return delay 0: handstand bus setup"
    } else if answer.bus_us == largest {
        "return delay 0: handstand bus setup"
    } else if answer.line_us == largest {
        "the PC's line is the slowest part: --stream, or an adapter on the servos' bus at 1000000 baud"
    } else {
        "the adapter is the slowest part: --stream, or an FTDI latency timer of 1 ms"
    }
}
