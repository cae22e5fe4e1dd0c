//! Answers that come sometimes, late, wrong, or from somebody else: what disturbs them, told by what arrives.

use super::pulse::{PINGS, Pulse};
use super::{Cause, cause};

/// One way in which an exchange fails.
struct Kind {
    count: fn(&Pulse) -> usize,
    /// What is wrong if one servo of several fails so; `{}` is its id.
    of_one: &'static str,
    /// What is wrong if several do.
    of_line: &'static str,
    seen: &'static str,
    remedy: &'static str,
}

const CABLE: &str =
    "look for loose plugs and a low supply; shorten the cables; keep the ground wire connected";

const KINDS: [Kind; 5] = [
    Kind {
        count: |pulse| pulse.silent,
        of_one: "servo {} or its cable is bad: answers are lost",
        of_line: "the line is disturbed: answers are lost",
        seen: "got no answer",
        remedy: CABLE,
    },
    Kind {
        count: |pulse| pulse.garbled,
        of_one: "servo {} or its cable is bad: bits are wrong on the way from it",
        of_line: "the line is disturbed: bits are wrong on the way from the servos",
        seen: "got an answer that is no sound packet",
        remedy: CABLE,
    },
    Kind {
        count: |pulse| pulse.misheard,
        of_one: "servo {} or its cable is bad: bits are wrong on the way to it",
        of_line: "the line is disturbed: bits are wrong on the way to the servos",
        seen: "got the answer that their checksum was wrong",
        remedy: "change the adapter or its plug; look at the ground wire and the supply",
    },
    Kind {
        count: |pulse| pulse.strangers,
        of_one: "servo {} answers with another's id",
        of_line: "servos answer with others' ids",
        seen: "got an answer with another id",
        remedy: "a servo is faulty: take servos off one by one until it stops",
    },
    Kind {
        count: |pulse| pulse.late,
        of_one: "servo {} answers later than its return delay allows",
        of_line: "answers come later than the return delay allows: the adapter holds them back",
        seen: "got their answer too late",
        remedy: "set the adapter's latency timer to 1 ms; a single servo that is late is exchanged",
    },
];

/// The causes of what failed sometimes.
pub(super) fn disturbances(pulses: &[Pulse]) -> impl Iterator<Item = Cause> {
    let there = pulses.iter().filter(|pulse| !is_silent(pulse));
    let there: Vec<&Pulse> = there.filter(|pulse| !is_twice(pulse)).collect();
    KINDS
        .iter()
        .filter_map(move |kind| disturbance(kind, &there))
}

/// Whether its answers look like those of two: garbled, or one behind the other where they miss each other.
pub(super) fn is_twice(pulse: &Pulse) -> bool {
    2 * (pulse.garbled + pulse.doubled) > PINGS
}

fn is_silent(pulse: &Pulse) -> bool {
    pulse.silent == PINGS
}

fn disturbance(kind: &Kind, there: &[&Pulse]) -> Option<Cause> {
    let poor: Vec<&&Pulse> = there
        .iter()
        .filter(|pulse| (kind.count)(pulse) > 0)
        .collect();
    let failed: usize = poor.iter().map(|pulse| (kind.count)(pulse)).sum();
    let what = match poor[..] {
        [] => return None,
        [one] if there.len() > 1 => kind.of_one.replace("{}", &one.id.to_string()),
        _ => kind.of_line.to_string(),
    };
    let asked = PINGS * there.len();
    let ids: Vec<u8> = poor.iter().map(|pulse| pulse.id).collect();
    Some(cause(
        0.4 + 0.5 * failed as f64 / (PINGS * poor.len()) as f64,
        what,
        format!("{failed} of {asked} pings {}: ids {ids:?}", kind.seen),
        kind.remedy,
    ))
}
