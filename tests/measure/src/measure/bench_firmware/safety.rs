//! Link losses, hangs and power cuts.

use super::{Args, Row};
use handstand_measure::bench::{VirtualCm5, Worst, link_loss, power_cuts, worst_of};
use handstand_measure::firmware::Built;
use serde_json::json;

pub(super) fn losses(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let count = args.reduced(args.losses, 10);
    #[cfg(simavr)]
    if let Some(built) = built {
        let new = || handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
        return loss_row(worst_of(count, args.seed, new, link_loss));
    }
    let _ = built;
    loss_row(worst_of(count, args.seed, VirtualCm5::new, link_loss))
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
        holds: Some(tried > 0 && failed == 0 && soft_ms <= 100.0 && off_ms <= 300.0),
        values: json!({"tried": tried, "failed": failed, "soft_ms": soft_ms, "off_ms": off_ms}),
    }]
}

#[cfg(simavr)]
pub(super) fn hangs(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let Some(built) = built else {
        return Vec::new();
    };
    let row = |name, window_ms| {
        let new = || {
            let mut rig = handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
            if window_ms > 0.0 {
                rig.set_boot_loader(window_ms);
            }
            rig
        };
        let count = args.reduced(args.losses, 10);
        let worst = worst_of(count, args.seed, new, handstand_measure::bench::hang);
        let Worst {
            tried,
            failed,
            off_ms,
            ..
        } = worst;
        Row {
            name,
            measured: format!("{tried} tried, {failed} failed, worst {off_ms:.0} ms"),
            limit: "150 ms",
            holds: Some(tried > 0 && failed == 0 && off_ms <= 150.0),
            values: json!({"tried": tried, "failed": failed, "off_ms": off_ms, "boot_loader_ms": window_ms}),
        }
    };
    vec![
        row("hang: torque off on the wire", 0.0),
        row(
            "hang: the same through a boot loader of 50 ms (assumed)",
            50.0,
        ),
    ]
}

/// Starts after power-on and after a hang, the watchdog at its data sheet's period and at the
/// shortest one that is assumed.
#[cfg(simavr)]
pub(super) fn starts(_: &Args, built: Option<&Built>) -> Vec<Row> {
    let Some(built) = built else {
        return Vec::new();
    };
    let all: Vec<u8> = (1..=18).collect();
    let mut boots = Vec::new();
    for plans in 0..=2 {
        let eeprom = handstand_measure::bench::eeprom_with(plans);
        for ids in [&all[..], &[]] {
            for watchdog_us in [28_100, 24_000] {
                let boot = handstand_measure::bench::boot(&built.elf, &eeprom, ids, watchdog_us);
                boots.push(boot);
            }
        }
    }
    let unfed_ms = boots.iter().map(|boot| boot.unfed_ms).fold(0.0, f64::max);
    let bad = boots
        .iter()
        .filter(|boot| boot.resets != 1 || !boot.answers);
    let bad = bad.count();
    vec![Row {
        name: "starts with 0 to 2 plans, 18 and no servos, watchdog at 28.1 and 24 ms",
        measured: format!(
            "{} starts and hangs, {bad} with another reset, at most {unfed_ms:.1} ms unfed",
            boots.len()
        ),
        limit: "0",
        holds: Some(bad == 0),
        values: json!({"starts": boots.len(), "bad": bad, "longest_unfed_ms": unfed_ms}),
    }]
}

/// Noise on the servos' bus while armed.
#[cfg(simavr)]
pub(super) fn noises(args: &Args, built: Option<&Built>) -> Vec<Row> {
    let Some(built) = built else {
        return Vec::new();
    };
    let ms = if args.quick { 400.0 } else { 4000.0 };
    let runs = [10, 50, 200, 240, 249, 500]
        .map(|every_us| handstand_measure::bench::noise(&built.elf, every_us, 24_000, ms));
    let resets: usize = runs.iter().map(|run| run.0).sum();
    let unfed_ms = runs.iter().map(|run| run.1).fold(0.0, f64::max);
    vec![Row {
        name: "noise on the bus, a byte every 10 to 500 us, watchdog at 24 ms",
        measured: format!("{resets} resets, at most {unfed_ms:.1} ms unfed"),
        limit: "0",
        holds: Some(resets == 0),
        values: json!({"resets": resets, "longest_unfed_ms": unfed_ms}),
    }]
}

#[cfg(not(simavr))]
pub(super) fn starts(_: &Args, _: Option<&Built>) -> Vec<Row> {
    Vec::new()
}

#[cfg(not(simavr))]
pub(super) fn noises(_: &Args, _: Option<&Built>) -> Vec<Row> {
    Vec::new()
}

/// The state machine under random commands, times and faults: the tests', longer.
pub(super) fn invariants(args: &Args, _: Option<&Built>) -> Vec<Row> {
    /// Of each run; two tests run beside each other.
    const STEPS: usize = 1000;
    let runs = args.reduced(args.steps, 200_000).div_ceil(2 * STEPS);
    let words = [
        "test",
        "--release",
        "--package",
        "handstand-cm5-sim",
        "--test",
        "it",
        "invariants",
    ];
    let mut cargo = handstand_xtask::cargo(&words);
    let begun = std::time::Instant::now();
    let status = cargo.env("PROPTEST_CASES", runs.to_string()).status();
    let holds = status.is_ok_and(|status| status.success());
    let minutes = begun.elapsed().as_secs_f64() / 60.0;
    let steps = 2 * runs * STEPS;
    vec![Row {
        name: "invariants under random commands, times and faults (logic in process)",
        measured: format!(
            "{steps} steps in {minutes:.1} minutes, building included: {}",
            if holds { "all hold" } else { "broken" }
        ),
        limit: "all hold",
        holds: Some(holds),
        values: json!({"steps": steps, "minutes": minutes}),
    }]
}

#[cfg(not(simavr))]
pub(super) fn hangs(_: &Args, _: Option<&Built>) -> Vec<Row> {
    eprintln!("Left out: only the ELF can hang, and simavr is not installed");
    Vec::new()
}

pub(super) fn cuts(args: &Args, _: Option<&Built>) -> Vec<Row> {
    let torn: Vec<u8> = (0..=255).step_by(if args.quick { 85 } else { 5 }).collect();
    let tally = power_cuts(&torn);
    vec![Row {
        name: "power cut at every EEPROM byte (logic in process)",
        measured: format!(
            "{} cuts: old {}, new {}, neither {}",
            tally.cuts, tally.old, tally.new, tally.neither
        ),
        limit: "neither 0",
        holds: Some(tally.neither == 0 && tally.cuts > 0),
        values: json!({"cuts": tally.cuts, "old": tally.old, "new": tally.new, "neither": tally.neither}),
    }]
}
