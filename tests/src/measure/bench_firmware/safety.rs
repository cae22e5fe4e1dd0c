//! Link losses, hangs and power cuts.

use super::{Args, Row};
use handstand_tests::bench::{VirtualCm5, Worst, link_loss, power_cuts, worst_of};
use handstand_tests::firmware::Built;
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
    let new = || handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
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
        holds: Some(tried > 0 && failed == 0 && off_ms <= 150.0),
        values: json!({"tried": tried, "failed": failed, "off_ms": off_ms}),
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
