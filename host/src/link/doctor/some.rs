//! What is wrong where some servos answer.

use super::super::port::Link;
use super::super::retry::Failure;
use super::super::servos::Servos;
use super::disturbance::{disturbances, is_twice};
use super::pulse::{PINGS, Pulse};
use super::{Cause, cause};
use crate::error::Result;
use handstand_shared::control_table::{PRESENT_SUPPLY, RETURN_DELAY, STATUS_LEVEL};
use handstand_shared::dynamixel::ErrorBits;

/// Some answer: what is wrong with the others, or with how they answer.
pub(super) fn some<L: Link>(
    servos: &mut Servos<L>,
    pulses: &[Pulse],
    causes: &mut Vec<Cause>,
) -> Result<()> {
    for pulse in pulses.iter().filter(|pulse| is_twice(pulse)) {
        causes.push(twice(pulse));
    }
    let silent = |pulse: &&Pulse| pulse.answered == 0 && !is_twice(pulse);
    causes.extend(pulses.iter().filter(silent).map(missing));
    causes.extend(disturbances(pulses));
    for pulse in pulses.iter().filter(|pulse| !pulse.errors.is_empty()) {
        let supply = servos.get(pulse.id, PRESENT_SUPPLY).ok();
        causes.push(complaint(pulse, supply));
    }
    for pulse in pulses.iter().filter(|pulse| pulse.answered > 0) {
        settings(servos, pulse.id, causes)?;
    }
    Ok(())
}

fn twice(pulse: &Pulse) -> Cause {
    let id = pulse.id;
    cause(
        0.85,
        format!("two servos have the id {id}"),
        format!(
            "of {PINGS} answers of id {id} {} were garbled, {} came double; those of others are sound",
            pulse.garbled, pulse.doubled
        ),
        format!(
            "disconnect all others, connect one of the two, and give it a free id: handstand bus setup --new-id N; id {id} stays with the other"
        ),
    )
}

fn missing(pulse: &Pulse) -> Cause {
    let id = pulse.id;
    if pulse.strangers > 0 {
        return cause(
            0.8,
            format!("another servo answers for id {id}"),
            format!("{} of {PINGS} answers carried another id", pulse.strangers),
            "an adapter or servo is faulty: take servos off one by one",
        );
    }
    cause(
        0.7,
        format!(
            "servo {id} is not there: unplugged, without power, broken, or of another id or speed"
        ),
        format!("id {id} is silent, others on the same line answer"),
        "is it the last of its chain? check the cable before it; then connect it alone: `handstand bus scan` finds its id, `doctor` its speed",
    )
}

fn complaint(pulse: &Pulse, supply: Option<u16>) -> Cause {
    let (id, errors) = (pulse.id, pulse.errors.join(", "));
    let has = |bits: ErrorBits| bits.names().any(|name| pulse.errors.contains(&name));
    let remedy = if has(ErrorBits::OVERLOAD) {
        "take the load off it; it recovers when its torque limit is written, then torque enable"
    } else if has(ErrorBits::OVERHEAT) {
        "let it cool down"
    } else if has(ErrorBits::VOLTAGE) {
        "charge or exchange the battery; 9 to 12 V is right"
    } else {
        "see the error bits in docs/bus.md"
    };
    let volts = supply.map_or(String::new(), |code| {
        format!(" at {:.1} V", f64::from(code) * 0.1)
    });
    cause(
        0.6,
        format!("servo {id} complains of: {errors}"),
        format!("its status packets say so{volts}"),
        remedy,
    )
}

/// Settings under which a good servo looks silent or slow.
fn settings<L: Link>(servos: &mut Servos<L>, id: u8, causes: &mut Vec<Cause>) -> Result<()> {
    servos.tries = 3;
    let level = servos.get(id, STATUS_LEVEL);
    let delay = servos.get(id, RETURN_DELAY);
    servos.tries = 1;
    match level {
        Err(Failure::Port(error)) => return Err(error),
        Err(Failure::Silent) => causes.push(cause(
            0.75,
            format!("servo {id} has status level 0: it answers PING and nothing else"),
            "PING is answered, READ is not",
            format!("handstand bus write {id} \"status return level\" 1, though it cannot be read back until then"),
        )),
        _ => {}
    }
    if let Ok(code @ 1..) = delay {
        causes.push(cause(
            0.05 + f64::from(code) * 4e-4,
            format!("servo {id} waits {} us before it answers", 2 * code),
            format!("return delay time is {code}"),
            "too slow for 100 Hz with 18 servos: handstand bus setup",
        ));
    }
    Ok(())
}
