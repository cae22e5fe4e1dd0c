//! `cargo xtask bench-firmware`: the firmware's promises, measured, one row each.
//!
//! Runs the very ELF in simavr against simulated servos; without simavr or an ELF it measures the same logic in process
//! and says so. simavr lets a byte of 8N1 take 11 bits; the bench sets it to 10, so no time here needs correcting.

use comfy_table::{Table, presets::UTF8_HORIZONTAL_ONLY};
#[cfg(simavr)]
use handstand_shared::message::Telemetry;
use handstand_tests::bench::{
    Balanced, Conditions, FrameTally, PcRig, Sides, Source, StreamRun, Worst, bit_flips, link_loss,
    patterns, power_cuts, random_bytes, resynchronised, side_by_side, stream, worst_of,
};
use handstand_tests::firmware::{Built, find_built};
use rayon::prelude::*;
use serde_json::{Value, json};

/// Measure the firmware: cycles, times, losses and frames.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Only the rows whose name holds this
    #[arg(long)]
    only: Option<String>,
    /// Seconds of streaming
    #[arg(long, default_value_t = 60.0)]
    seconds: f64,
    /// Link losses and hangs
    #[arg(long, default_value_t = 1000)]
    losses: usize,
    /// States on which the two laws are compared
    #[arg(long, default_value_t = 1_000_000)]
    states: usize,
    /// Random bytes fed to the decoder
    #[arg(long, default_value_t = 1_000_000_000)]
    bytes: u64,
    /// Seed of all chance
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Small figures everywhere: a minute instead of many
    #[arg(long)]
    quick: bool,
    /// Print the rows as JSON
    #[arg(long)]
    json: bool,
}

/// A promise, what was measured, and whether it holds.
struct Row {
    name: &'static str,
    measured: String,
    limit: &'static str,
    holds: bool,
    values: Value,
}

/// Whether every promise holds.
pub fn run(args: &Args) -> bool {
    let built = find_built();
    let on = match (&built, handstand_simavr::AVAILABLE) {
        (Some(_), true) => "the ELF in simavr",
        (None, true) => "the logic in process: there is no ELF, `cargo xtask firmware` builds it",
        (_, false) => "the logic in process: simavr is not installed (Debian: libsimavr-dev)",
    };
    eprintln!("Measured on {on}.");
    let mut rows = Vec::new();
    for (name, measure) in ROWS {
        if args
            .only
            .as_ref()
            .is_none_or(|part| name.contains(part.as_str()))
        {
            eprintln!("{name} ...");
            rows.extend(measure(args, built.as_ref()));
        }
    }
    if args.json {
        let rows: Vec<_> = (rows.iter())
            .map(|row| json!({"row": row.name, "measured": row.measured, "limit": row.limit, "holds": row.holds, "values": row.values}))
            .collect();
        println!("{}", json!({"on": on, "rows": rows}));
    } else {
        println!("{}", table(&rows));
    }
    rows.iter().all(|row| row.holds)
}

type Measure = fn(&Args, Option<&Built>) -> Vec<Row>;
const ROWS: &[(&str, Measure)] = &[
    ("stream", streams),
    ("link loss", losses),
    ("hang", hangs),
    ("law", laws),
    ("age of readings", readings),
    ("closed loop", loops),
    ("gyro alone", gyros),
    ("balancing", balancing),
    ("power cut", cuts),
    ("frames", frames),
];

fn table(rows: &[Row]) -> Table {
    let mut table = Table::new();
    table
        .load_preset(UTF8_HORIZONTAL_ONLY)
        .set_header(["", "Measured", "Limit", "Holds"]);
    for row in rows {
        let holds = if row.holds { "yes" } else { "NO" };
        table.add_row([row.name, &row.measured, row.limit, holds]);
    }
    table
}

impl Args {
    fn reduced(&self, full: usize, quick: usize) -> usize {
        if self.quick { full.min(quick) } else { full }
    }
}

fn streams(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let seconds = if args.quick {
        args.seconds.min(3.0)
    } else {
        args.seconds
    };
    #[cfg(simavr)]
    if let Some(built) = built {
        let mut rig = handstand_simavr::Rig::new(&built.elf).expect("the ELF was found");
        let run = stream(&mut rig, seconds);
        let mut rows = stream_rows(&run);
        rows.extend(elf_rows(&run, &rig));
        rows.push(longest_tick(built, args));
        return rows;
    }
    let _ = built;
    stream_rows(&stream(&mut PcRig::new(), seconds))
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
            holds: (at(0.5) - 10.0).abs() < 0.1 && jitter < 2.0,
            values: json!({"min_ms": at(0.0), "median_ms": at(0.5), "max_ms": at(1.0), "reports": run.reports.len()}),
        },
        Row {
            name: "lost reports, missing positions, bad frames",
            measured: format!("{}, {}, {}", run.lost, run.missing, run.bad_frames),
            limit: "0, 0, 0",
            holds: run.lost + run.missing + run.bad_frames == 0,
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
            holds: run.bytes_per_frame <= line,
            values: json!({"bytes": run.bytes_per_frame}),
        },
        Row {
            name: "goals said to report of obeying heard",
            measured: format!("{:.1} / {:.1} / {:.1} ms", trip(0.0), trip(0.5), trip(1.0)),
            limit: "min / median / max",
            holds: true,
            values: json!({"min_ms": trip(0.0), "median_ms": trip(0.5), "max_ms": trip(1.0)}),
        },
    ]
}

#[cfg(simavr)]
fn stack_row(name: &'static str, telemetry: &Telemetry) -> Row {
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
        holds: used <= 0.8 * 4096.0,
        values: json!({"stack_bytes": depth, "stack_size_bytes": telemetry.stack_size, "ram_bytes": used}),
    }
}

#[cfg(simavr)]
fn elf_rows(run: &StreamRun, rig: &handstand_simavr::Rig) -> Vec<Row> {
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
            holds: rig.seen.direction_faults == 0
                && rig.seen.most_waiting <= 2
                && !rig.seen.charged,
            values: json!({"direction_faults": rig.seen.direction_faults, "most_waiting": rig.seen.most_waiting, "charged": rig.seen.charged}),
        },
    ]
}

/// The longest tick, from its start to its end, with all waiting for the bus, whatever the moment at which the servos' motor
/// interrupts come: the controller starts in ten different tenths of their millisecond.
#[cfg(simavr)]
fn longest_tick(built: &Built, args: &Args) -> Row {
    let starts = args.reduced(10, 3) as u64;
    let of_start = |start: u64| {
        let mut rig = handstand_simavr::Rig::new(&built.elf).expect("the ELF was found");
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
        limit: "60 %",
        holds: share <= 0.6 && overruns == 0,
        values: json!({"longest_tick_us": longest, "overruns": overruns, "starts": starts}),
    }
}

/// What the firmware says of itself while it balances, whatever the moment of the servos' interrupts.
#[cfg(simavr)]
fn balancing(args: &Args, built: Option<&Built>) -> Vec<Row> {
    use handstand_tests::bench::balance;
    let Some(built) = built else {
        return Vec::new();
    };
    let starts = args.reduced(10, 3) as u64;
    let (_, plan) = Source::Host.plan();
    let of_start = |start: u64| {
        let mut rig = handstand_simavr::Rig::new(&built.elf).expect("the ELF was found");
        rig.bus_ahead_ns = start * 1_000_000 / starts;
        let run = balance(&mut rig, &plan, &corner(1.0, [1.0, -1.0, 1.0]), 2.0).expect("it arms");
        run.telemetry.expect("it was asked for")
    };
    let runs: Vec<_> = (0..starts).into_par_iter().map(of_start).collect();
    let ticks = runs.iter().map(|run| run.longest_tick_us);
    let (least, longest) = (ticks.clone().min(), ticks.max());
    let (least, longest) = (least.unwrap_or(0), longest.unwrap_or(0));
    let law = runs.iter().map(|run| run.longest_law_us).max().unwrap_or(0);
    let overruns: u16 = runs.iter().map(|run| run.overruns).sum();
    let share = f64::from(longest) / 10_000.0;
    let deepest = runs.iter().max_by_key(|run| run.stack_used);
    let mut rows = vec![Row {
        name: "longest tick while balancing, waiting for the bus included",
        measured: format!(
            "{least} to {longest} us in {starts} starts, {:.1} % of the period, the law {law} us, {overruns} overruns",
            100.0 * share
        ),
        limit: "60 %",
        holds: share <= 0.6 && overruns == 0,
        values: json!({"longest_tick_us": longest, "longest_law_us": law, "overruns": overruns, "starts": starts}),
    }];
    rows.extend(deepest.map(|run| stack_row("deepest stack while balancing, and RAM", run)));
    rows
}

#[cfg(not(simavr))]
fn balancing(_: &Args, _: Option<&Built>) -> Vec<Row> {
    eprintln!("Left out: ticks and stack are the ELF's, and simavr is not installed");
    Vec::new()
}

fn losses(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let count = args.reduced(args.losses, 10);
    #[cfg(simavr)]
    if let Some(built) = built {
        let new = || handstand_simavr::Rig::new(&built.elf).expect("the ELF was found");
        return loss_row(worst_of(count, args.seed, new, link_loss));
    }
    let _ = built;
    loss_row(worst_of(count, args.seed, PcRig::new, link_loss))
}

fn loss_row(worst: Worst) -> Vec<Row> {
    let Worst {
        tried,
        failed,
        soft_ms,
        off_ms,
    } = worst;
    vec![Row {
        name: "link loss: soft, torque off",
        measured: format!("{tried} tried, {failed} failed, worst {soft_ms:.0} and {off_ms:.0} ms"),
        limit: "100 and 300 ms",
        holds: failed == 0 && soft_ms <= 100.0 && off_ms <= 300.0,
        values: json!({"tried": tried, "failed": failed, "soft_ms": soft_ms, "off_ms": off_ms}),
    }]
}

#[cfg(simavr)]
fn hangs(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let Some(built) = built else {
        return Vec::new();
    };
    let new = || handstand_simavr::Rig::new(&built.elf).expect("the ELF was found");
    let count = args.reduced(args.losses, 10);
    let worst = worst_of(count, args.seed, new, handstand_tests::bench::hang);
    let Worst {
        tried,
        failed,
        off_ms,
        ..
    } = worst;
    vec![Row {
        name: "hang: torque off on the wire",
        measured: format!("{tried} tried, {failed} failed, worst {off_ms:.0} ms"),
        limit: "150 ms",
        holds: failed == 0 && off_ms <= 150.0,
        values: json!({"tried": tried, "failed": failed, "off_ms": off_ms}),
    }]
}

#[cfg(not(simavr))]
fn hangs(_: &Args, _: Option<&Built>) -> Vec<Row> {
    eprintln!("Left out: only the ELF can hang, and simavr is not installed");
    Vec::new()
}

#[cfg(simavr)]
fn laws(args: &Args, built: Option<&Built>) -> Vec<Row> {
    use handstand_shared::plan::Law;
    use handstand_tests::bench::{CHOSEN, ObserverRun, SHIFTS, law, observer_law, plan};
    let Some(built) = built else {
        return Vec::new();
    };
    let count = args.reduced(args.states, 5000);
    let run = law(&built.law, count, args.seed);
    let (chosen, all) = (run.over(CHOSEN), run.over(0..SHIFTS));
    let text = |cycles: Option<(u64, u64)>| match cycles {
        Some((least, most)) => format!("{least} to {most}"),
        None => "not all met".to_string(),
    };
    let most = |cycles: Option<(u64, u64)>| cycles.map_or(u64::MAX, |(_, most)| most);
    let mut rows = vec![
        Row {
            name: "law 2 x 6 on the AVR against the host's",
            measured: format!("{} states, {} different", run.states, run.different),
            limit: "0",
            holds: run.different == 0,
            values: json!({"states": run.states, "different": run.different}),
        },
        Row {
            name: "law 2 x 6, cycles",
            measured: format!(
                "{} at shifts of 0, 8 and 16; {} over 0 to 30; {} at two different ones",
                text(chosen),
                text(all),
                text(run.mixed)
            ),
            limit: "500 at every shift",
            holds: most(all).max(most(run.mixed)) <= 500,
            values: json!({"at_0_8_16": chosen, "mixed": run.mixed, "by_shift": run.cycles}),
        },
    ];
    let (_, plan) = plan();
    if let Law::Observer(observer) = &plan.law {
        let ObserverRun {
            states,
            different,
            wish,
            learn,
        } = observer_law(&built.law, observer, count, args.seed);
        rows.push(Row {
            name: "law with observer on the AVR against the host's",
            measured: format!("{states} states, {different} different"),
            limit: "0",
            holds: different == 0,
            values: json!({"states": states, "different": different}),
        });
        rows.push(Row {
            name: "law with observer, cycles",
            measured: format!("{wish} before the commands, {learn} after them"),
            limit: "part of the tick's 60 %",
            holds: true,
            values: json!({"wish": wish, "learn": learn}),
        });
    }
    rows
}

#[cfg(not(simavr))]
fn laws(_: &Args, _: Option<&Built>) -> Vec<Row> {
    eprintln!("Left out: the law's cycles are the AVR's, and simavr is not installed");
    Vec::new()
}

/// In ten different tenths of the servos' motor interrupts.
#[cfg(simavr)]
fn readings(args: &Args, built: Option<&Built>) -> Vec<Row> {
    use handstand::controllers::Timing;
    use handstand_tests::bench::{Ages, REPORT_MS, Spread, ages};
    let Some(built) = built else {
        return Vec::new();
    };
    let starts = args.reduced(10, 2) as u64;
    let of_start = |start: u64| {
        let mut rig = handstand_simavr::Rig::new(&built.elf).expect("the ELF was found");
        rig.bus_ahead_ns = start * 1_000_000 / starts;
        ages(&mut rig, 1.0)
    };
    let runs: Vec<_> = (0..starts).into_par_iter().map(of_start).collect();
    let over = |part: fn(&Ages) -> Spread| {
        let parts: Vec<Spread> = runs.iter().map(part).collect();
        let mean = parts.iter().map(|part| part[1]).sum::<f64>() / parts.len() as f64;
        let least = parts
            .iter()
            .map(|part| part[0])
            .fold(f64::INFINITY, f64::min);
        let most = parts.iter().map(|part| part[2]).fold(0.0, f64::max);
        [least, mean, most]
    };
    let Timing {
        age_s, effect_s, ..
    } = Timing::HOST_ATTITUDE;
    let row = |name, part, designed_s: f64| {
        let [least, middle, most] = over(part);
        let designed_ms = designed_s * 1e3;
        Row {
            name,
            measured: format!(
                "{least:.2} / {middle:.2} / {most:.2} ms, designed for {designed_ms:.1}"
            ),
            limit: "middle within 0.2 ms of the design",
            holds: (middle - designed_ms).abs() <= 0.2,
            values: json!({"least_ms": least, "middle_ms": middle, "most_ms": most, "designed_ms": designed_ms}),
        }
    };
    let [least, middle, most] = over(|ages| ages.report);
    let report = Row {
        name: "from a tick's first request to its report",
        measured: format!("{least:.2} / {middle:.2} / {most:.2} ms, taken for {REPORT_MS}"),
        limit: "middle within 0.2 ms",
        holds: (middle - REPORT_MS).abs() <= 0.2,
        values: json!({"least_ms": least, "middle_ms": middle, "most_ms": most}),
    };
    vec![
        row(
            "age of readings: attitude said by the host",
            |ages| ages.attitude,
            age_s[0],
        ),
        row("age of readings: shoulder", |ages| ages.joints[0], age_s[1]),
        row("age of readings: hip", |ages| ages.joints[1], age_s[2]),
        row(
            "from the law until its torques act",
            |ages| ages.effect,
            effect_s,
        ),
        report,
    ]
}

#[cfg(not(simavr))]
fn readings(_: &Args, _: Option<&Built>) -> Vec<Row> {
    eprintln!("Left out: the ages are the ELF's, and simavr is not installed");
    Vec::new()
}

/// A start with all angles this far off, with these signs.
fn corner(degrees: f64, signs: [f64; 3]) -> Conditions {
    Conditions {
        dead_zone: 0.08,
        eccentric_m: [0.0; 3],
        start_rad: signs.map(|sign| sign * degrees.to_radians()),
    }
}

fn loops(args: &Args, built: Option<&Built>) -> Vec<Row> {
    // The corners of a cube of starts, but for mirror images; the first takes the longest way back.
    let starts = [
        ("1.5, 1.5, 1.5 deg", corner(1.5, [1.0, 1.0, 1.0])),
        ("2, -2, 2 deg", corner(2.0, [1.0, -1.0, 1.0])),
        ("2, 2, -2 deg", corner(2.0, [1.0, 1.0, -1.0])),
        ("2, -2, -2 deg", corner(2.0, [1.0, -1.0, -1.0])),
    ];
    let seconds = if args.quick { 5.0 } else { 60.0 };
    let of_start = |(start, conditions): &(&str, Conditions)| {
        let sides = loop_sides(built, conditions, Source::Host, seconds);
        let mut rows = loop_rows(LOOP_NAMES, start, &sides, seconds);
        let (different, compared) = sides.different;
        rows.push(Row {
            name: "its commands against the fixed host law's on the same readings",
            measured: format!("{compared} ticks, {different} different"),
            limit: "0",
            holds: different == 0 && compared > 0,
            values: json!({"ticks": compared, "different": different}),
        });
        rows
    };
    starts.par_iter().flat_map_iter(of_start).collect()
}

/// With nothing but a gyro of 10 deg/s per code for the first link.
fn gyros(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let starts = [
        ("upright", corner(0.0, [1.0, 1.0, 1.0])),
        ("0.5, 0.5, 0.5 deg", corner(0.5, [1.0, 1.0, 1.0])),
        ("1, 1, 1 deg", corner(1.0, [1.0, 1.0, 1.0])),
    ];
    let seconds = if args.quick { 5.0 } else { 60.0 };
    let of_start = |(start, conditions): &(&str, Conditions)| {
        let sides = loop_sides(built, conditions, Source::Gyro, seconds);
        loop_rows(GYRO_NAMES, start, &sides, seconds)
    };
    starts.par_iter().flat_map_iter(of_start).collect()
}

const LOOP_NAMES: [&str; 3] = [
    "three links, float host law",
    "three links, fixed host law",
    "three links, the firmware's law",
];
const GYRO_NAMES: [&str; 3] = [
    "gyro alone, float host law",
    "gyro alone, fixed host law",
    "gyro alone, the firmware's law",
];

fn loop_sides(
    built: Option<&Built>,
    conditions: &Conditions,
    source: Source,
    seconds: f64,
) -> Sides {
    #[cfg(simavr)]
    if let Some(built) = built {
        let mut rig = handstand_simavr::Rig::new(&built.elf).expect("the ELF was found");
        return side_by_side(&mut rig, conditions, source, seconds);
    }
    let _ = built;
    side_by_side(&mut PcRig::new(), conditions, source, seconds)
}

fn loop_rows(names: [&'static str; 3], start: &str, sides: &Sides, seconds: f64) -> Vec<Row> {
    let row = |name, run: Result<&Balanced, String>| {
        let stood_s = run.as_ref().map_or(0.0, |run| run.stood_s);
        let values = run.as_ref().map_or(json!({}), |run| {
            json!({"start": start, "stood_s": run.stood_s, "rms_rad": run.rms_rad, "rms_nm": run.torque_rms_nm})
        });
        let measured = match run {
            Ok(run) => format!(
                "from {start}: stood {stood_s:.1} of {seconds} s, {:.1} mrad, {:.3} and {:.3} N m rms",
                1e3 * run.rms_rad,
                run.torque_rms_nm[0],
                run.torque_rms_nm[1]
            ),
            Err(refusal) => refusal,
        };
        Row {
            name,
            measured,
            limit: "stands",
            holds: stood_s >= seconds - 1e-6,
            values,
        }
    };
    let [float, fixed, firmware] = names;
    let board = sides.board.as_ref();
    vec![
        row(float, Ok(&sides.float)),
        row(fixed, Ok(&sides.fixed)),
        row(
            firmware,
            board.map_err(|refusal| format!("refused: {refusal:?}")),
        ),
    ]
}

fn cuts(args: &Args, _: Option<&Built>) -> Vec<Row> {
    let torn: Vec<u8> = (0..=255).step_by(if args.quick { 85 } else { 5 }).collect();
    let tally = power_cuts(&torn);
    vec![Row {
        name: "power cut at every EEPROM byte (logic in process)",
        measured: format!(
            "{} cuts: old {}, new {}, neither {}",
            tally.cuts, tally.old, tally.new, tally.neither
        ),
        limit: "neither 0",
        holds: tally.neither == 0,
        values: json!({"cuts": tally.cuts, "old": tally.old, "new": tally.new, "neither": tally.neither}),
    }]
}

fn frames(args: &Args, _: Option<&Built>) -> Vec<Row> {
    let row = |name, tally: FrameTally, count: u64| Row {
        name,
        measured: format!("{} tried, {} accepted", tally.tried, count),
        limit: "0",
        holds: count == 0,
        values: json!({"tried": tally.tried, "accepted": tally.wrong, "critical": tally.critical}),
    };
    let five = patterns(if args.quick { 4 } else { 5 }, args.seed);
    let short = bit_flips(12, args.reduced(100, 10), args.seed);
    let mut rows = vec![
        row(
            "1 to 5 wrong bits of a 12-byte frame (--quick: 4)",
            five,
            five.wrong,
        ),
        row(
            "1 to 3 wrong bits of 12-byte frames, 100 payloads (--quick: 10)",
            short,
            short.wrong,
        ),
    ];
    if !args.quick {
        let long = bit_flips(52, 20, args.seed);
        rows.push(row(
            "1 to 3 wrong bits of reports of 52 bytes, 20 payloads",
            long,
            long.wrong,
        ));
    }
    let bytes = if args.quick {
        args.bytes.min(10_000_000)
    } else {
        args.bytes
    };
    let random = random_bytes(bytes, args.seed);
    rows.push(Row {
        measured: format!(
            "{bytes} bytes: {} arm, torque or gain frames; {} other bodies passed the CRC-16",
            random.critical, random.wrong
        ),
        ..row("random bytes", random, random.critical)
    });
    let lost = resynchronised(args.reduced(100_000, 1000), args.seed);
    rows.push(Row {
        name: "frames lost after garbage",
        measured: format!("at most {lost}"),
        limit: "2",
        holds: lost <= 2,
        values: json!({"lost": lost}),
    });
    rows
}
