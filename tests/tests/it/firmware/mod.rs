//! The firmware: its logic in process, and the real ELF in simavr where both are there.

mod adapter;
mod arming;
mod balance;
mod damage;
#[cfg(simavr)]
mod elf;
mod faults;
mod panel;
mod safety;
mod stream;

use handstand_measure::bench::*;
use handstand_shared::message::*;

/// What it says against a command; nothing if it obeys.
fn refused(rig: &mut VirtualCm5, command: Command) -> Option<Refusal> {
    rig.clear();
    let sequence = rig.send(&command);
    // Torque comes on when all servos have said their limits.
    for _ in 0..60 {
        rig.run_ms(10.0);
        let answer = rig
            .reports()
            .into_iter()
            .find_map(|(_, report)| match report {
                Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome.err()),
                _ => None,
            });
        if let Some(outcome) = answer {
            return outcome;
        }
    }
    None
}

/// Greets it.
fn greet(rig: &mut VirtualCm5) -> Hello {
    rig.clear();
    rig.send(&Command::Hello { version: VERSION });
    rig.run_ms(20.0);
    let hello = rig
        .reports()
        .into_iter()
        .find_map(|(_, report)| match report {
            Report::Hello(hello) => Some(hello),
            _ => None,
        });
    hello.expect("an answer")
}

/// Torque on, with all the servos have.
fn arm_with(token: u16) -> Command {
    let limits = ArmLimits::FULL;
    Command::Arm { token, limits }
}

/// What the last report of a tick says.
fn condition(bench: &mut impl SimulatedCm5) -> Option<Condition> {
    bench.clear();
    bench.run_ms(30.0);
    let last = bench.reports().into_iter().rev();
    last.filter_map(|(_, report)| match report {
        Report::Stream(report) => Some(report.condition),
        _ => None,
    })
    .next()
}
