//! `handstand latency`: where the time between PC and servos goes, and whether it fits the sampling
//! time.
//!
//! Without `--stream` it pings the servos, reads whole rounds, and splits a round trip into the
//! PC's line, the servos' bus (return delay included), and the rest: adapter, USB, drivers. With
//! `--stream` a CM-5 reads the servos itself: it splits the time from asking to answer into line
//! and controller, and takes the controller's tick from its telemetry.
//!
//! The verdict compares the slowest of 99 % of the rounds with `--period-ms`. Exit code 0: it fits,
//! 1: it does not.
//!
//! `--json` prints `round_trip_us`, `line_us`, `bus_us`, `rest_us`, `round_us`, `period_us`,
//! `fits`, `missing`, and of Protocol 2.0 `limit_us`: the time of a round's bytes on the line. Each
//! measured time with `min`, `median`, `p99`, `max`.

use super::robot::RobotArgs;
use super::{Console, ExitStatus, interrupt::Interrupt};
use handstand::link::Protocol;
use handstand::link::record::{Adapter, GroupAdapter, LatencyBudget, Quantiles, RoundTrip, Stream};
use handstand::{Error, Result};
use std::time::Duration;

/// Measure round trips.
#[derive(Debug, clap::Args)]
pub struct LatencyArgs {
    #[command(flatten)]
    robot: RobotArgs,
    /// Rounds to measure
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u64).range(10..=100_000))]
    rounds: u64,
    /// Sampling time that is wanted
    #[arg(long, default_value_t = 10.0)]
    period_ms: f64,
}

/// Measures, judges.
pub fn run(args: &LatencyArgs, console: &Console) -> Result<ExitStatus> {
    if !(0.1..=10_000.0).contains(&args.period_ms) {
        return Err(Error::usage(
            format!("--period-ms {} is no sampling time", args.period_ms),
            "give 0.1 to 10000",
        ));
    }
    let interrupt = Interrupt::listen();
    let bar = console.bar(args.rounds);
    let goes_on = || {
        bar.inc(1);
        !interrupt.has_come()
    };
    let (rounds, period_us) = (args.rounds, args.period_ms * 1e3);
    let mut link = args.robot.port.open()?;
    let ids = args.robot.chosen(&mut link, console)?;
    let ids = &ids[..];
    let budget = if args.robot.stream {
        let mut stream = Stream::new(link, ids)?;
        let trip = RoundTrip::of_stream(&mut stream)?;
        trip.budget(&mut stream, rounds, period_us, goes_on)
    } else {
        let mut servos = args.robot.port.on(link);
        let trip = RoundTrip::of_adapter(&mut servos, ids)?;
        if servos.protocol == Some(Protocol::Two) {
            let mut adapter = GroupAdapter::new(servos, ids, Duration::ZERO, false)?;
            let limit_us = adapter.limit_us();
            let budget = trip.budget(&mut adapter, rounds, period_us, goes_on);
            budget.map(|budget| LatencyBudget {
                limit_us: Some(limit_us),
                ..budget
            })
        } else {
            let mut adapter = Adapter::new(servos, ids, Duration::ZERO)?;
            trip.budget(&mut adapter, rounds, period_us, goes_on)
        }
    };
    drop(bar);
    let answer = budget?;
    console.result(&answer, || text(&answer, ids.len(), args))?;
    Ok(ExitStatus::answer(answer.fits))
}

fn text(answer: &LatencyBudget, servos: usize, args: &LatencyArgs) -> String {
    let times = |times: &Quantiles| {
        format!(
            "{:.0} us median, {:.0} to {:.0}, 99 % below {:.0}",
            times.median, times.min, times.max, times.p99
        )
    };
    let (bus, rest) = if args.robot.stream {
        (
            "the CM-5's tick, servos included",
            "waiting for the tick and behind its reports",
        )
    } else {
        (
            "servos' bus and return delay",
            "the rest (adapter, USB, drivers)",
        )
    };
    let limit = answer.limit_us.map_or(String::new(), |limit_us| {
        format!("; the line's limit is {limit_us:.0} us")
    });
    let verdict = if answer.fits {
        "fits".to_string()
    } else {
        format!("does not fit: {}", remedy(answer, args))
    };
    format!(
        "round trip: {}\n  PC's line {:.0} us, {bus} {:.0} us, {rest} {:.0} us\n\
         round of {} servos: {}{limit}\nmissing answers: {}\nsampling time {:.1} ms: {verdict}",
        times(&answer.round_trip_us),
        answer.line_us,
        answer.bus_us,
        answer.rest_us,
        servos,
        times(&answer.round_us),
        answer.missing,
        args.period_ms,
    )
}

fn remedy(answer: &LatencyBudget, args: &LatencyArgs) -> &'static str {
    let largest = answer.line_us.max(answer.bus_us).max(answer.rest_us);
    if args.robot.stream {
        "fewer servos, or return delay 0: handstand bus setup"
    } else if answer.bus_us == largest {
        "return delay 0: handstand bus setup"
    } else if answer.line_us == largest {
        "the PC's line is the slowest part: --stream, or an adapter on the servos' bus at \
         1000000 baud"
    } else {
        "the adapter is the slowest part: --stream, or an FTDI latency timer of 1 ms"
    }
}
