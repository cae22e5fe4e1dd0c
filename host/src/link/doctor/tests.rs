//! Each fault that the simulated bus has, and the cause that is named for it.

use super::*;
use crate::link::virtual_cm5::SimLink;

fn diagnose(words: &str, ids: &[u8]) -> BusDiagnosis {
    examine(SimLink::adapter(words).unwrap(), ids, None, |_| ()).unwrap()
}

/// The likeliest cause named for each fault that can be put into the bus.
#[test]
fn every_fault_is_named_first() {
    for (words, said) in [
        ("ids=1-4,delay=0,dead=3", "servo 3 is not there"),
        ("ids=1-4,delay=0,baud=34", "servos answer at 57600 baud"),
        ("ids=21-24,delay=0", "the ids are others"),
        (
            "ids=1-4,delay=0,drop=0.2",
            "the line is disturbed: answers are lost",
        ),
        (
            "ids=1-4,delay=0,flip=0.2",
            "bits are wrong on the way from the servos",
        ),
        (
            "ids=1-4,delay=0,corrupt_request=0.2",
            "bits are wrong on the way to the servos",
        ),
        (
            "ids=1-4,delay=0,late=0.2",
            "answers come later than the return delay allows",
        ),
        (
            "ids=1-4,delay=0,wrong_id=0.2",
            "servos answer with others' ids",
        ),
        ("ids=1-4+3,delay=0", "two servos have the id 3"),
        ("ids=1-4,delay=0,overload=2", "servo 2 reports: overload"),
        ("ids=1-4,delay=0,hot=2", "servo 2 reports: overheat"),
        ("ids=1-4,delay=0,supply=5", "reports: voltage"),
        ("ids=1-4,delay=0,level=0", "has status level 0"),
        ("ids=1-4,delay=250", "servos 1-4 wait 500 us"),
        (
            "model=XL330-M288,ids=1-4,delay=0,dead=3",
            "servo 3 is not there",
        ),
        (
            "model=XL330-M288,ids=1-4,delay=0,baud=6",
            "servos answer at 4000000 baud",
        ),
        (
            "model=XL330-M288,ids=1-4,delay=0,flip=0.2",
            "bits are wrong on the way from the servos",
        ),
        (
            "model=XL330-M288,ids=1-4,delay=0,overload=2",
            "servo 2 reports: overload",
        ),
        ("model=XL330-M288,ids=1-4", "servos 1-4 wait 500 us"),
        ("ids=1-4,dead=1-4", "the servos have no power"),
        (
            "ids=1-4,dead=1-4,echo",
            "the adapter never lets the line go",
        ),
    ] {
        let diagnosis = diagnose(words, &[1, 2, 3, 4]);
        let first = &diagnosis
            .causes
            .first()
            .unwrap_or_else(|| panic!("{words}: no cause"))
            .cause;
        assert!(first.contains(said), "{words}: {:?}", diagnosis.causes);
    }
}

#[test]
fn a_shutdown_is_mended_by_a_reboot_and_a_wrong_protocol_named() {
    let diagnosis = diagnose("model=XL330-M288,ids=1-4,delay=0,hot=2", &[1, 2, 3, 4]);
    assert!(diagnosis.causes[0].remedy.contains("bus reboot 2"));
    assert_eq!(diagnosis.protocol, Some(Protocol::Two));
    let link = SimLink::adapter("model=XL330-M288,ids=1-4,delay=0").unwrap();
    let wrong = examine(link, &[1, 2], Some(Protocol::One), |_| ()).unwrap();
    let first = &wrong.causes[0].cause;
    assert!(first.contains("Protocol 2.0"), "{first}");
}

#[test]
fn a_bus_that_is_well_has_no_cause() {
    let diagnosis = diagnose("ids=1-4,delay=0", &[1, 2, 3, 4]);
    assert!(diagnosis.causes.is_empty(), "{:?}", diagnosis.causes);
    assert!(diagnosis.pings.iter().all(|test| test.answered == PINGS));
}
