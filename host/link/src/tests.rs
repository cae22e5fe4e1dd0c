//! Requests over every kind of line.

use super::*;
use crate::protocol::ServoRequest;
use crate::virtual_cm5::{AdapterPort, SimLink};
use handstand_shared::control_table as table;
use handstand_shared::dynamixel::ErrorBits;
use std::sync::{Arc, Mutex};
use std::time::Duration;

fn sim(spec: &str) -> SimLink<AdapterPort> {
    SimLink::adapter(spec).unwrap()
}

#[test]
fn servos_are_pinged_read_and_set() {
    let mut servos = Servos::new(sim("ids=1-3"));
    assert_eq!(servos.ping(2).unwrap(), ErrorBits(0));
    assert_eq!(servos.get(3, table::PRESENT_POSITION).unwrap(), 512);
    servos.set(2, table::RETURN_DELAY, 0).unwrap();
    assert_eq!(servos.get(2, table::RETURN_DELAY).unwrap(), 0);
    servos.sync_write(table::LED, &[(1, 1), (3, 1)]).unwrap();
    assert_eq!(
        [1, 2, 3].map(|id| servos.get(id, table::LED).unwrap()),
        [1, 0, 1]
    );
    assert_eq!(servos.retries, 0);
}

#[test]
fn a_new_id_is_verified_under_its_new_name() {
    let mut servos = Servos::new(sim("ids=1"));
    servos.set(1, table::ID, 9).unwrap();
    assert!(servos.ping(9).is_ok());
    assert!(matches!(servos.ping(1), Err(ServoError::NoResponse { .. })));
}

#[test]
fn whatever_the_status_level_a_value_is_set_or_refused() {
    for level in 1..=2 {
        let mut servos = Servos::new(sim(&format!("ids=1,level={level}")));
        servos.set(1, table::MOVING_SPEED, 100).unwrap();
        assert!(matches!(
            servos.set(1, table::PRESENT_POSITION, 1),
            Err(ServoError::Refused { .. })
        ));
    }
}

#[test]
fn a_disturbed_line_is_asked_again_and_never_believed() {
    let mut servos = Servos::new(sim("ids=1-3,drop=0.05,flip=0.05,wrong_id=0.02,late=0.02"));
    servos.tries = 8;
    for round in 0..1000u16 {
        let id = 1 + (round % 3) as u8;
        servos.set(id, table::MOVING_SPEED, round).unwrap();
    }
    assert!(servos.retries > 50, "{}", servos.retries);
}

#[test]
fn an_echo_is_told_from_an_answer() {
    let mut servos = Servos::new(sim("ids=1,echo"));
    assert!(servos.echoes().unwrap());
    assert_eq!(servos.ping(1).unwrap(), ErrorBits(0));
    assert_eq!(servos.get(1, table::MODEL).unwrap(), 12);
    assert!(matches!(servos.ping(2), Err(ServoError::NoResponse { .. })));
    let mut plain = Servos::new(sim("ids=1"));
    assert!(!plain.echoes().unwrap());
}

/// A line that stalled passes a request and what follows on in one burst, so the answer meets it.
#[test]
fn torque_goes_off_behind_a_request_that_is_still_answered() {
    for count in [1, 2, 8, 20, 50] {
        let mut servos = Servos::new(sim("ids=1-2,delay=0"));
        servos.set(1, table::TORQUE_ENABLE, 1).unwrap();
        let request = ServoRequest::Read { address: 0, count };
        let request = Protocol::One.packet(1, request);
        servos.link().send(&request).unwrap();
        servos.torque_off().unwrap();
        servos.link().pause(Duration::from_millis(10));
        servos.link().clear().unwrap();
        let torque = servos.get(1, table::TORQUE_ENABLE).unwrap();
        assert_eq!(torque, 0, "behind a request for {count} bytes");
    }
}

#[test]
fn a_silent_servo_costs_its_time_and_no_more() {
    let mut servos = Servos::new(sim("ids=1"));
    servos.tries = 1;
    servos.ping(1).unwrap();
    let before = servos.link().now();
    assert!(matches!(servos.ping(7), Err(ServoError::NoResponse { .. })));
    let spent = servos.link().now() - before;
    assert!(
        (Duration::from_millis(1)..Duration::from_millis(2)).contains(&spent),
        "{spent:?}"
    );
}

#[test]
fn what_a_tap_wrote_replays() {
    let written = Arc::new(Mutex::new(Vec::new()));
    let hear = written.clone();
    let tap = Tap::new(sim("ids=1-2,drop=0.2"), move |exchange| {
        hear.lock().unwrap().push(exchange.line())
    });
    let talk = |link: Box<dyn SerialLink>| {
        let mut servos = Servos::new(link);
        let codes: Vec<_> = (1..=2)
            .cycle()
            .take(40)
            .map(|id| servos.get(id, table::PRESENT_SUPPLY).ok())
            .collect();
        (codes, servos.retries)
    };
    let live = talk(Box::new(tap));
    let lines = written.lock().unwrap().clone();
    let exchanges: Vec<_> = lines
        .iter()
        .map(|line| Exchange::parse(line).unwrap())
        .collect();
    assert_eq!(
        talk(Box::new(Replay::new(
            "record",
            1_000_000,
            exchanges.clone()
        ))),
        live
    );
    let mut other = Servos::new(Replay::new("record", 1_000_000, exchanges));
    assert!(matches!(other.ping(2), Err(ServoError::Port(_))));
}

#[test]
fn lost_bytes_and_flipped_bits_of_a_line_are_survived() {
    let mut servos = Servos::new(Faulty::new(sim("ids=1"), 0.01, 0.001, 5));
    servos.tries = 10;
    assert!((0..500).all(|_| servos.get(1, table::PRESENT_POSITION).unwrap() == 512));
    assert!(servos.retries > 10);
}

#[test]
fn an_unknown_port_is_named_with_what_there_is() {
    let error = Serial::open("/dev/tty-that-is-not-there", 57_600)
        .map(|_| ())
        .unwrap_err();
    assert_eq!(error.exit_code(), 4);
    assert!(
        error
            .to_string()
            .starts_with("/dev/tty-that-is-not-there: there is no such port"),
        "{error}"
    );
    assert!(error.remedy().is_some());
}

/// A pseudo terminal opened as a serial port, with the simulated bus behind it.
#[cfg(unix)]
#[test]
fn a_serial_port_carries_the_same_talk() {
    let pty = Pty::open().unwrap();
    let mut servos = Servos::new(Serial::open(pty.name(), 1_000_000).unwrap());
    assert_eq!(pty.baud(), 1_000_000);
    let device = std::thread::spawn(move || {
        let mut bus = sim("ids=1");
        let mut bytes = [0; 64];
        loop {
            let count = pty.receive(&mut bytes, Duration::from_secs(2)).unwrap();
            if count == 0 {
                return;
            }
            bus.send(&bytes[..count]).unwrap();
            let count = bus.receive(&mut bytes, Duration::from_millis(1)).unwrap();
            let mut answer = bytes[..count].to_vec();
            while let Ok(count @ 1..) = bus.receive(&mut bytes, Duration::from_micros(300)) {
                answer.extend_from_slice(&bytes[..count]);
            }
            pty.send(&answer).unwrap();
        }
    });
    assert_eq!(servos.get(1, table::MODEL).unwrap(), 12);
    servos.set(1, table::LED, 1).unwrap();
    assert!(matches!(servos.ping(2), Err(ServoError::NoResponse { .. })));
    device.join().unwrap();
}
