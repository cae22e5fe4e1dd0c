//! Servos that restart, and a gyro that breaks.

use super::{Args, Row};
use handstand_measure::bench::{SimulatedCm5, VirtualCm5, gyro_at_rail, restart};
use handstand_measure::firmware::Built;
use rayon::prelude::*;
use serde_json::json;

/// Phases of the housekeeping's round: ticks after arming.
const PHASES: u8 = 18;
/// Two rounds, in which every servo's registers are read.
const ROUNDS_MS: f64 = 200.0;

pub(super) fn servo_faults(args: &Args, built: Option<&Built>) -> Vec<Row> {
    #[cfg(simavr)]
    if let Some(built) = built {
        let new = || handstand_simavr::ElfCm5::new(&built.elf).expect("the ELF was found");
        return vec![restarts(args, new), rails(new)];
    }
    let _ = built;
    vec![restarts(args, VirtualCm5::new), rails(VirtualCm5::new)]
}

fn restarts<C: SimulatedCm5>(args: &Args, new: impl Fn() -> C + Sync) -> Row {
    let phases = if args.quick { 2 } else { PHASES };
    let of_servo = |id: u8| -> Vec<Option<f64>> {
        let mut bench = new();
        let phases = 0..phases;
        phases.map(|phase| restart(&mut bench, id, phase)).collect()
    };
    let all: Vec<Option<f64>> = (1..=18).into_par_iter().flat_map_iter(of_servo).collect();
    let noticed = all.iter().flatten().filter(|ms| **ms <= ROUNDS_MS).count();
    let longest_ms = all.iter().flatten().copied().fold(0.0, f64::max);
    Row {
        name: "a servo restarts under goals: torque falls",
        measured: format!(
            "{noticed} of {} noticed, the last after {longest_ms:.0} ms",
            all.len()
        ),
        limit: "all, in 200 ms",
        holds: Some(noticed == all.len()),
        values: json!({"tried": all.len(), "noticed": noticed, "longest_ms": longest_ms}),
    }
}

fn rails<C: SimulatedCm5>(new: impl Fn() -> C) -> Row {
    let of_code = |code: u16| gyro_at_rail(&mut new(), code);
    let all = [0, 5, 1018, 1023].map(of_code);
    let longest_ms = all.iter().flatten().copied().fold(0.0, f64::max);
    let noticed = all.iter().flatten().filter(|ms| **ms <= 100.0).count();
    Row {
        name: "the gyro goes to a rail while it balances: torque falls",
        measured: format!(
            "{noticed} of {} noticed, the last after {longest_ms:.0} ms",
            all.len()
        ),
        limit: "all, in 100 ms",
        holds: Some(noticed == all.len()),
        values: json!({"tried": all.len(), "noticed": noticed, "longest_ms": longest_ms}),
    }
}
