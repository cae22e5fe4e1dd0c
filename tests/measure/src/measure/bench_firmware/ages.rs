//! How old readings are at the law's moment, and when its torques act.

use super::{Args, Row};
use handstand_measure::firmware::Built;
#[cfg(simavr)]
use rayon::prelude::*;
#[cfg(simavr)]
use serde_json::json;

/// In ten different tenths of the servos' motor interrupts.
#[cfg(simavr)]
pub(super) fn readings(args: &Args, built: Option<&Built>) -> Vec<Row> {
    use handstand::synth::controllers::BoardTiming;
    use handstand_measure::bench::{Ages, REPORT_MS, Spread, ages};
    let Some(built) = built else {
        return Vec::new();
    };
    let starts = args.reduced(10, 2) as u64;
    let of_start = |start: u64| {
        let mut rig = handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
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
    let BoardTiming {
        age_s, effect_s, ..
    } = BoardTiming::HOST_ATTITUDE;
    let row = |name, part, designed_s: f64| {
        let [least, middle, most] = over(part);
        let designed_ms = designed_s * 1e3;
        Row {
            name,
            measured: format!(
                "{least:.2} / {middle:.2} / {most:.2} ms, designed for {designed_ms:.1}"
            ),
            limit: "middle within 0.2 ms of the design",
            holds: Some((middle - designed_ms).abs() <= 0.2),
            values: json!({"least_ms": least, "middle_ms": middle, "most_ms": most, "designed_ms": designed_ms}),
        }
    };
    let [least, middle, most] = over(|ages| ages.report);
    let report = Row {
        name: "from a tick's first request to its report",
        measured: format!("{least:.2} / {middle:.2} / {most:.2} ms, taken for {REPORT_MS}"),
        limit: "middle within 0.2 ms",
        holds: Some((middle - REPORT_MS).abs() <= 0.2),
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
pub(super) fn readings(_: &Args, _: Option<&Built>) -> Vec<Row> {
    eprintln!("Left out: the ages are the ELF's, and simavr is not installed");
    Vec::new()
}
