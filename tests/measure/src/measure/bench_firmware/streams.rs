//! Streaming: cycles, ticks and stack.

use super::{Args, Row};
use handstand_measure::bench::{StreamRun, VirtualCm5, stream};
use handstand_measure::firmware::Built;
#[cfg(simavr)]
use handstand_shared::message::Telemetry;
#[cfg(simavr)]
use rayon::prelude::*;
use serde_json::json;

pub(super) fn streams(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let seconds = if args.quick {
        args.seconds.min(3.0)
    } else {
        args.seconds
    };
    #[cfg(simavr)]
    if let Some(built) = built {
        let mut rig = handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
        let run = stream(&mut rig, seconds);
        let mut rows = stream_rows(&run);
        rows.extend(elf_rows(&run, &rig));
        rows.push(longest_tick(built, args));
        return rows;
    }
    let _ = built;
    stream_rows(&stream(&mut VirtualCm5::new(), seconds))
}

fn stream_rows(run: &StreamRun) -> Vec<Row> {
    let at = |share| StreamRun::quantile(&run.cycles_ms, share);
    let trip = |share| StreamRun::quantile(&run.round_trip_ms, share);
    let jitter = (at(1.0) - 10.0).max(10.0 - at(0.0));
    let line = 57.6;
    vec![
        Row {
            name: "cycle, 18 servos at 57600 baud",
            measured: format!(
                "{:.3} / {:.3} / {:.3} ms over {} reports, jitter {jitter:.3} ms",
                at(0.0),
                at(0.5),
                at(1.0),
                run.reports.len()
            ),
            limit: "10 ms, min / median / max",
            holds: Some((at(0.5) - 10.0).abs() < 0.1 && jitter < 2.0),
            values: json!({"min_ms": at(0.0), "median_ms": at(0.5), "max_ms": at(1.0), "reports": run.reports.len()}),
        },
        Row {
            name: "lost reports, missing positions, bad frames",
            measured: format!("{}, {}, {}", run.lost, run.missing, run.bad_frames),
            limit: "0, 0, 0",
            holds: Some(run.lost + run.missing + run.bad_frames == 0),
            values: json!({"lost": run.lost, "missing": run.missing, "bad": run.bad_frames}),
        },
        Row {
            name: "bytes per report",
            measured: format!(
                "{:.1}, {:.0} % of the line",
                run.bytes_per_frame,
                100.0 * run.bytes_per_frame / line
            ),
            limit: "57.6 per 10 ms",
            holds: Some(run.bytes_per_frame <= line),
            values: json!({"bytes": run.bytes_per_frame}),
        },
        Row {
            name: "goals said to report of obeying heard, min / median / max",
            measured: format!("{:.1} / {:.1} / {:.1} ms", trip(0.0), trip(0.5), trip(1.0)),
            limit: "-",
            holds: None,
            values: json!({"min_ms": trip(0.0), "median_ms": trip(0.5), "max_ms": trip(1.0)}),
        },
    ]
}

#[cfg(simavr)]
fn elf_rows(run: &StreamRun, rig: &handstand_simavr::ElfCm5) -> Vec<Row> {
    let Some(telemetry) = run.telemetry else {
        return Vec::new();
    };
    vec![
        stack_row("deepest stack, and RAM with static data", &telemetry),
        Row {
            name: "bus turned early, receiver's bytes waiting, charger on",
            measured: format!(
                "{}, {}, {}",
                rig.seen.direction_faults, rig.seen.most_waiting, rig.seen.charged
            ),
            limit: "0, 2, false",
            holds: Some(
                rig.seen.direction_faults == 0 && rig.seen.most_waiting <= 2 && !rig.seen.charged,
            ),
            values: json!({"direction_faults": rig.seen.direction_faults, "most_waiting": rig.seen.most_waiting, "charged": rig.seen.charged}),
        },
    ]
}

/// The longest tick, from its start to its end, with all waiting for the bus, whatever the moment
/// at which the servos' motor interrupts come: the controller starts in ten different tenths of
/// their millisecond.
#[cfg(simavr)]
fn longest_tick(built: &Built, args: &Args) -> Row {
    let starts = args.reduced(10, 3) as u64;
    let of_start = |start: u64| {
        let mut rig = handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
        rig.bus_ahead_ns = start * 1_000_000 / starts;
        let telemetry = stream(&mut rig, 1.0).telemetry.expect("it was asked for");
        (telemetry.longest_tick_us, telemetry.overruns)
    };
    let runs: Vec<(u16, u16)> = (0..starts).into_par_iter().map(of_start).collect();
    let longest = runs.iter().map(|run| run.0).max().unwrap_or(0);
    let least = runs.iter().map(|run| run.0).min().unwrap_or(0);
    let overruns: u16 = runs.iter().map(|run| run.1).sum();
    let share = f64::from(longest) / 10_000.0;
    Row {
        name: "longest tick, waiting for the bus included",
        measured: format!(
            "{least} to {longest} us in {starts} starts, {:.1} % of the period, {overruns} overruns",
            100.0 * share
        ),
        limit: super::LONGEST_TICK,
        holds: Some(longest <= handstand_measure::bench::LONGEST_TICK_US && overruns == 0),
        values: json!({"longest_tick_us": longest, "overruns": overruns, "starts": starts}),
    }
}

#[cfg(simavr)]
pub(super) fn stack_row(name: &'static str, telemetry: &Telemetry) -> Row {
    let depth = f64::from(telemetry.stack_used);
    // Of all RAM: what the static data takes is not the stack's.
    let used = 4096.0 - f64::from(telemetry.stack_size) + depth;
    Row {
        name,
        measured: format!(
            "{depth} of {} bytes; {used} of 4096, {:.0} %",
            telemetry.stack_size,
            100.0 * used / 4096.0
        ),
        limit: "80 % of 4096",
        holds: Some(used <= 0.8 * 4096.0),
        values: json!({"stack_bytes": depth, "stack_size_bytes": telemetry.stack_size, "ram_bytes": used}),
    }
}
