//! Causes where some servos respond.

use super::super::discover::id_ranges;
use super::super::port::SerialLink;
use super::super::protocol::Protocol;
use super::super::servo_error::ServoError;
use super::super::servos::Servos;
use super::disturbance::{disturbances, is_twice};
use super::ping_test::{PINGS, PingTest};
use super::{Cause, cause};
use crate::error::Result;
use handstand_shared::control_table::{PRESENT_SUPPLY, RETURN_DELAY, STATUS_LEVEL};
use handstand_shared::dynamixel::ErrorBits;
use std::collections::BTreeMap;

/// Some servos respond: causes for the others, and for replies that are not valid.
pub(super) fn partial_response<L: SerialLink>(
    servos: &mut Servos<L>,
    pings: &[PingTest],
    causes: &mut Vec<Cause>,
) -> Result<()> {
    for test in pings.iter().filter(|test| is_twice(test)) {
        causes.push(twice(test));
    }
    let silent = |test: &&PingTest| test.answered == 0 && !is_twice(test);
    causes.extend(pings.iter().filter(silent).map(missing));
    causes.extend(disturbances(pings));
    for test in pings.iter().filter(|test| !test.error_flags.is_empty()) {
        let supply = servos.get(test.id, PRESENT_SUPPLY).ok();
        causes.push(error_flags(test, supply, servos.protocol));
    }
    let mut delays = BTreeMap::<u16, Vec<u8>>::new();
    for test in pings
        .iter()
        .filter(|test| test.answered > 0 && !is_twice(test))
    {
        if let Some(code @ 1..) = settings(servos, test.id, causes)? {
            delays.entry(code).or_default().push(test.id);
        }
    }
    causes.extend(delays.iter().map(|(code, ids)| slow(*code, ids)));
    Ok(())
}

/// Servos with one return delay are one cause.
fn slow(code: u16, ids: &[u8]) -> Cause {
    let who = match ids {
        [id] => format!("servo {id} waits"),
        several => format!("servos {} wait", id_ranges(several)),
    };
    cause(
        0.05 + f64::from(code) * 4e-4,
        format!("{who} {} us before answering", 2 * code),
        format!("return delay time is {code}"),
        "too slow for 100 Hz with 18 servos: handstand bus setup",
    )
}

fn twice(test: &PingTest) -> Cause {
    let id = test.id;
    let readings = test.readings.as_ref();
    let readings = readings.map_or(String::new(), |test| format!("; {}", test.evidence()));
    cause(
        0.85,
        format!("two servos have the id {id}"),
        format!(
            "of {PINGS} answers of id {id} {} were garbled, {} came double{readings}; those of \
             others are sound",
            test.garbled, test.doubled
        ),
        format!(
            "disconnect all others, connect one of the two, and give it a free id: handstand bus setup --new-id N; id {id} stays with the other"
        ),
    )
}

fn missing(test: &PingTest) -> Cause {
    let id = test.id;
    if test.unexpected_ids > 0 {
        return cause(
            0.8,
            format!("another servo answers for id {id}"),
            format!(
                "{} of {PINGS} answers carried another id",
                test.unexpected_ids
            ),
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

fn error_flags(test: &PingTest, supply: Option<u16>, protocol: Option<Protocol>) -> Cause {
    let (id, errors) = (test.id, test.error_flags.join(", "));
    let has = |bits: ErrorBits| bits.names().any(|name| test.error_flags.contains(&name));
    let reboot = format!("remove the cause, then: handstand bus reboot {id}");
    let remedy = if protocol == Some(Protocol::Two) {
        reboot.as_str()
    } else if has(ErrorBits::OVERLOAD) {
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
        format!("servo {id} reports: {errors}"),
        format!("its status packets say so{volts}"),
        remedy,
    )
}

fn unknown(id: u8, number: u16) -> Cause {
    cause(
        0.3,
        format!("servo {id} is of model {number}, whose control table is not known"),
        "its model number says so; its registers were not read",
        "docs/servos.md lists the models that are known; it is neither recorded nor moved",
    )
}

/// Settings under which a good servo looks silent; its return delay, if it tells it.
fn settings<L: SerialLink>(
    servos: &mut Servos<L>,
    id: u8,
    causes: &mut Vec<Cause>,
) -> Result<Option<u16>> {
    servos.tries = 3;
    if let Err(ServoError::UnknownModel { number, .. }) = servos.known_model(id) {
        causes.push(unknown(id, number));
        servos.tries = 1;
        return Ok(None);
    }
    let level = servos.get(id, STATUS_LEVEL);
    let delay = servos.get(id, RETURN_DELAY);
    servos.tries = 1;
    match level {
        Err(ServoError::Port(error)) => return Err(error),
        Err(ServoError::NoResponse { .. }) => causes.push(cause(
            0.75,
            format!("servo {id} has status level 0: it answers PING and nothing else"),
            "PING is answered, READ is not",
            format!("handstand bus write {id} \"status return level\" 1, though it cannot be read back until then"),
        )),
        _ => {}
    }
    Ok(delay.ok())
}
