//! Answers that come sometimes, late, wrong, or from somebody else: what disturbs them, told by
//! what arrives.

use super::ping_test::{PINGS, PingTest};
use super::read_test::ReadTest;
use super::{Cause, cause};

/// One way in which an exchange fails.
struct Disturbance {
    count: fn(&PingTest) -> usize,
    /// What is wrong if one servo of several fails so; `{}` is its id.
    of_one: &'static str,
    /// What is wrong if several do.
    of_line: &'static str,
    seen: &'static str,
    remedy: &'static str,
}

const CABLE: &str =
    "look for loose plugs and a low supply; shorten the cables; keep the ground wire connected";

const KINDS: [Disturbance; 5] = [
    Disturbance {
        count: |test| test.silent,
        of_one: "servo {} or its cable is bad: answers are lost",
        of_line: "the line is disturbed: answers are lost",
        seen: "got no answer",
        remedy: CABLE,
    },
    Disturbance {
        count: |test| test.garbled,
        of_one: "servo {} or its cable is bad: bits are wrong on the way from it",
        of_line: "the line is disturbed: bits are wrong on the way from the servos",
        seen: "got an answer that is no sound packet",
        remedy: CABLE,
    },
    Disturbance {
        count: |test| test.corrupted_requests,
        of_one: "servo {} or its cable is bad: bits are wrong on the way to it",
        of_line: "the line is disturbed: bits are wrong on the way to the servos",
        seen: "got the answer that their checksum was wrong",
        remedy: "change the adapter or its plug; look at the ground wire and the supply",
    },
    Disturbance {
        count: |test| test.unexpected_ids,
        of_one: "servo {} answers with another's id",
        of_line: "servos answer with others' ids",
        seen: "got an answer with another id",
        remedy: "a servo is faulty: take servos off one by one until it stops",
    },
    Disturbance {
        count: |test| test.late,
        of_one: "servo {} answers later than its return delay allows",
        of_line: "answers come later than the return delay allows: the adapter holds them back",
        seen: "got their answer too late",
        remedy: "set the adapter's latency timer to 1 ms; a single servo that is late is exchanged",
    },
];

/// The causes of what failed sometimes.
pub(super) fn disturbances(pings: &[PingTest]) -> impl Iterator<Item = Cause> {
    let there = pings.iter().filter(|test| !is_silent(test));
    let there: Vec<&PingTest> = there.filter(|test| !is_twice(test)).collect();
    KINDS
        .iter()
        .filter_map(move |kind| disturbance(kind, &there))
}

/// Whether its answers look like those of two: garbled, or one behind the other where they miss
/// each other; or its readings do, where two answer a ping alike.
pub(super) fn is_twice(test: &PingTest) -> bool {
    let readings = test.readings.as_ref();
    2 * (test.garbled + test.doubled) > PINGS || readings.is_some_and(ReadTest::is_twice)
}

fn is_silent(test: &PingTest) -> bool {
    test.silent == PINGS
}

fn disturbance(kind: &Disturbance, there: &[&PingTest]) -> Option<Cause> {
    let poor: Vec<&&PingTest> = there.iter().filter(|test| (kind.count)(test) > 0).collect();
    let failed: usize = poor.iter().map(|test| (kind.count)(test)).sum();
    let what = match poor[..] {
        [] => return None,
        [one] if there.len() > 1 => kind.of_one.replace("{}", &one.id.to_string()),
        _ => kind.of_line.to_string(),
    };
    let asked = PINGS * there.len();
    let ids: Vec<u8> = poor.iter().map(|test| test.id).collect();
    Some(cause(
        0.4 + 0.5 * failed as f64 / (PINGS * poor.len()) as f64,
        what,
        format!("{failed} of {asked} pings {}: ids {ids:?}", kind.seen),
        kind.remedy,
    ))
}
