//! Servos of Protocol 2.0 over every kind of line.

use super::virtual_cm5::{AdapterPort, SimLink};
use super::*;
use handstand_shared::control_table::{self as table, x};
use std::sync::{Arc, Mutex};

fn sim(words: &str) -> SimLink<AdapterPort> {
    SimLink::adapter(words).unwrap()
}

fn state(ids: &[u8]) -> Vec<GroupItem> {
    let item = |id: &u8| GroupItem {
        id: *id,
        address: 126,
        count: 10,
    };
    ids.iter().map(item).collect()
}

#[test]
fn the_protocol_is_that_of_the_servos() {
    for (words, protocol) in [
        ("ids=1-3", Protocol::One),
        ("model=XL330-M288,ids=1-3", Protocol::Two),
        ("model=XL330-M288,ids=1-3,echo", Protocol::Two),
    ] {
        let mut servos = Servos::new(sim(words));
        assert_eq!(servos.detect(2).unwrap(), protocol, "{words}");
        assert_eq!(servos.protocol, Some(protocol));
    }
    // Through a CM-5, which passes both.
    let bus = virtual_cm5::spec("model=xl430,ids=1-3").unwrap().bus();
    let mut servos = Servos::new(SimLink(virtual_cm5::Cm5Port::new(bus)));
    assert_eq!(servos.detect(2).unwrap(), Protocol::Two);
    assert_eq!(servos.model(2).unwrap().number, 1060);
}

#[test]
fn registers_of_one_name_are_one_in_both_protocols() {
    let mut servos = Servos::new(sim("model=XM430-W350,ids=1-3"));
    assert_eq!(servos.get(2, table::MODEL).unwrap(), 1020);
    assert_eq!(servos.get(2, table::RETURN_DELAY).unwrap(), 250);
    servos.set(2, table::RETURN_DELAY, 0).unwrap();
    assert_eq!(servos.get(2, table::RETURN_DELAY).unwrap(), 0);
    servos.sync_write(table::LED, &[(1, 1), (3, 1)]).unwrap();
    let leds = [1, 2, 3].map(|id| servos.get(id, table::LED).unwrap());
    assert_eq!((leds, servos.retries), ([1, 0, 1], 0));
    let none = servos.get(1, table::CW_LIMIT).unwrap_err();
    assert!(matches!(none, ServoError::NoRegister { .. }));
    servos.set(1, table::ID, 9).unwrap();
    assert!(servos.ping(9).is_ok() && servos.ping(1).is_err());
}

#[test]
fn eeprom_says_torque_off_first() {
    let mut servos = Servos::new(sim("model=XL330-M288,ids=1"));
    servos.set(1, table::TORQUE_ENABLE, 1).unwrap();
    let refused = servos.set_code(1, &x::OPERATING_MODE, 4).unwrap_err();
    assert!(matches!(refused, ServoError::Locked { id: 1, .. }));
    let error = crate::error::Error::from(refused);
    assert!(error.remedy().unwrap().starts_with("torque off first"));
    servos.set(1, table::TORQUE_ENABLE, 0).unwrap();
    servos.set_code(1, &x::OPERATING_MODE, 4).unwrap();
    let beyond = servos.set_code(1, &x::GOAL_POSITION, 1_048_575);
    assert!(beyond.is_ok());
}

#[test]
fn an_alert_comes_with_good_data_and_is_named() {
    let mut servos = Servos::new(sim("model=XL330-M288,ids=1,overload=1"));
    assert!(matches!(
        servos.read(1, 132, 4),
        Err(ServoError::OtherProtocol { .. })
    ));
    let reading = servos.read(1, 132, 4).unwrap();
    assert!(reading.error.has_alert() && reading.data.len() == 4);
    assert_eq!(servos.hardware_errors(1).unwrap(), ["overload"]);
    servos.reboot(1).unwrap();
    assert_eq!(servos.hardware_errors(1).unwrap(), [""; 0]);
}

#[test]
fn a_disturbed_line_is_asked_again_and_never_believed() {
    let words = "model=XL330-M288,ids=1-3,drop=0.05,flip=0.05,wrong_id=0.02,late=0.02";
    let mut servos = Servos::new(sim(words));
    servos.tries = 8;
    for round in 0..1000i32 {
        let id = 1 + (round % 3) as u8;
        servos.set_code(id, &x::PROFILE_VELOCITY, round).unwrap();
    }
    assert!(servos.retries > 50, "{}", servos.retries);
    let mut servos = Servos::new(Faulty::new(sim("model=xl430,ids=1"), 0.01, 0.001, 5));
    servos.protocol = Some(Protocol::Two);
    servos.tries = 10;
    assert!((0..500).all(|_| servos.code(1, &x::PRESENT_POSITION).unwrap() == 2048));
    assert!(servos.retries > 10);
}

#[test]
fn a_missing_servo_is_named_and_the_others_are_kept() {
    for firmware in [45, 52] {
        for dead in 1..=6 {
            let words = format!("model=XL330-M288,ids=1-6,dead={dead},firmware={firmware}");
            let mut servos = Servos::new(sim(&words));
            servos.protocol = Some(Protocol::Two);
            for id in (1..=6).filter(|id| *id != dead) {
                servos.identify(id).unwrap();
            }
            let answers = servos.read_group(&state(&[1, 2, 3, 4, 5, 6])).unwrap();
            for (id, answer) in (1..).zip(&answers) {
                match answer {
                    Ok(reading) => assert_eq!(reading.data.len(), 10),
                    Err(ServoError::NoResponse { id: missing }) => assert_eq!(*missing, id),
                    Err(other) => panic!("{other}"),
                }
                assert_eq!(answer.is_err(), id == dead, "{words}: servo {id}");
            }
        }
    }
}

/// Instructions that went out.
fn instructions(words: &str, items: &[GroupItem]) -> Vec<u8> {
    let sent = Arc::new(Mutex::new(Vec::new()));
    let heard = sent.clone();
    let tap = Tap::new(sim(words), move |exchange: &Exchange| {
        if exchange.way == Way::Out && exchange.bytes.len() > 8 {
            heard.lock().unwrap().push(exchange.bytes[7]);
        }
    });
    let mut servos = Servos::new(tap);
    servos.protocol = Some(Protocol::Two);
    for item in items {
        servos.identify(item.id).unwrap();
    }
    let answers = servos.read_group(items).unwrap();
    assert!(answers.iter().all(Result::is_ok), "{words}");
    drop(servos);
    let mut sent = sent.lock().unwrap().clone();
    sent.retain(|code| *code != 0x01);
    sent
}

#[test]
fn reads_are_as_fast_as_the_firmware_allows() {
    let all = state(&[1, 2, 3]);
    let mut mixed = all.clone();
    mixed[1].address = 144;
    mixed[1].count = 3;
    for (words, items, expected) in [
        ("model=XL330-M288,ids=1-3,firmware=46", &all, 0x8a),
        ("model=XL330-M288,ids=1-3,firmware=45", &all, 0x82),
        ("model=MX-28,ids=1-3,firmware=52", &all, 0x82),
        ("model=XL330-M288,ids=1-3,firmware=45", &mixed, 0x92),
        ("model=XL330-M288,ids=1-3,firmware=46", &mixed, 0x9a),
    ] {
        assert_eq!(instructions(words, items), [expected], "{words}");
    }
}

#[test]
fn a_broadcast_ping_finds_all() {
    let mut servos = Servos::new(sim("model=xl430,ids=1-3+7+252"));
    assert_eq!(servos.ping_all().unwrap(), (vec![1, 2, 3, 7, 252], 0));
}
