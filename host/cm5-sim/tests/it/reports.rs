//! What the CM-5 reads, in which order, and what it tells of it.

use super::rig::*;
use handstand_cm5_sim::{Plant, Robot, SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT, RETURN_DELAY};
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::*;
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::Position;

/// One joint that turns on and on, and tells by its angle when it was read: a position code takes
/// 0.1 ms.
#[derive(Debug)]
struct Clock {
    time_s: f64,
}

/// Of the clock, rad/s.
const SPEED_RAD_S: f64 = 50.0;

impl Plant for Clock {
    fn joint_count(&self) -> usize {
        1
    }

    fn step_s(&self) -> f64 {
        1e-3
    }

    fn delay_s(&self, _joint: usize) -> f64 {
        0.0
    }

    fn set_duty(&mut self, _joint: usize, _duty: Option<f64>, _supply_v: f64) {}

    fn advance(&mut self, span_s: f64) {
        self.time_s += span_s;
    }

    fn angle_rad(&self, _joint: usize) -> f64 {
        // It begins again with every tick.
        SPEED_RAD_S * (self.time_s % 0.01)
    }

    fn speed_rad_s(&self, _joint: usize) -> f64 {
        SPEED_RAD_S
    }

    fn shaft(&self, joint: usize) -> (f64, f64) {
        (self.angle_rad(joint), SPEED_RAD_S)
    }
}

/// The last report of a stream.
fn report(cm5: &mut VirtualCm5) -> StreamReport {
    cm5.clear();
    cm5.run_ms(40.0);
    let reports = cm5.reports().into_iter().rev();
    let last = reports.into_iter().find_map(|(_, report)| match report {
        Report::Stream(report) => Some(report),
        _ => None,
    });
    last.expect("a report")
}

fn list(ids: &[u8]) -> ServoList {
    let mut all = [0; SERVOS];
    all[..ids.len()].copy_from_slice(ids);
    ServoList {
        count: ids.len() as u8,
        ids: all,
    }
}

/// When each servo of a list was read, ms after `from_ms` in a period.
fn read_at(cm5: &mut VirtualCm5, from_ms: f64) -> Vec<f64> {
    let report = report(cm5);
    let codes = (0..SERVOS).map(|place| report.position(place).expect("it answers"));
    // Mirrored servos turn the other way.
    let at_ms = codes.map(|code| Position(code).to_rad().abs() / SPEED_RAD_S * 1e3);
    at_ms
        .map(|at| (at.round() - from_ms).rem_euclid(10.0))
        .collect()
}

/// In the list's order without a plan; with one, those that measure what balances come last.
#[test]
fn those_that_balance_are_read_last() {
    let mut cm5 = with_wheels();
    let clock = Clock { time_s: 0.0 };
    cm5.bus()
        .attach(Robot::new(Box::new(clock), [(0, (1..=18).collect())]));
    greet(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    cm5.run_ms(300.0);
    let from_ms = read_at(&mut cm5, 0.0)[0];
    let plain = read_at(&mut cm5, from_ms);
    assert!(plain.is_sorted() && plain[17] >= 3.0, "{plain:?}");

    // The others keep the list's order.
    upload(&mut cm5, &plan());
    cm5.run_ms(100.0);
    let at = read_at(&mut cm5, from_ms);
    let is_other = |place: &usize| ![0, 10].contains(place);
    let others: Vec<f64> = (0..18).filter(is_other).map(|place| at[place]).collect();
    assert!(others.is_sorted() && others[0] < 1.0, "{at:?}");
    assert!(
        at[0] >= others[15] && at[10] >= at[0] && at[0] >= 3.0,
        "{at:?}"
    );

    // Also where a list has them elsewhere.
    let ids: Vec<u8> = [11, 1].into_iter().chain(2..=10).chain(12..=18).collect();
    let order = Command::ServoList(list(&ids));
    assert_eq!(ask(&mut cm5, &order), Some(Ok(())));
    cm5.run_ms(300.0);
    let at = read_at(&mut cm5, from_ms);
    assert!(at[2..].is_sorted() && at[2] < 1.0, "{at:?}");
    assert!(at[1] >= at[17] && at[0] >= at[1] && at[1] >= 3.0, "{at:?}");
}

#[test]
fn a_servo_list_is_read_and_told_in_its_order() {
    let mut cm5 = VirtualCm5::new();
    greet(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    for wrong in [list(&[]), list(&[3, 254]), list(&[3, 5, 3])] {
        let refused = Some(Err(Refusal::ServoList));
        assert_eq!(ask(&mut cm5, &Command::ServoList(wrong)), refused);
    }
    let ids = [11, 3, 5, 1];
    for (id, code) in ids.into_iter().zip([100, 200, 300, 400]) {
        let servo = cm5.bus().servo(id).unwrap();
        servo.free = false;
        servo.shaft.angle_rad = Position(code).to_rad();
    }
    assert_eq!(ask(&mut cm5, &Command::ServoList(list(&ids))), Some(Ok(())));
    cm5.run_ms(100.0);
    let told = report(&mut cm5);
    let codes = [0, 1, 2, 3].map(|place| told.position(place));
    assert_eq!(codes, [100, 200, 300, 400].map(Some));
    assert_eq!(told.missing, [0; 3]);
    cm5.bus().servo(5).unwrap().faults.dead = true;
    cm5.run_ms(30.0);
    assert_eq!(report(&mut cm5).missing, [4, 0, 0]);
    // Armed, none is taken.
    cm5.bus().servo(5).unwrap().faults.dead = false;
    arm(&mut cm5);
    let again = Command::ServoList(list(&[1, 2]));
    assert_eq!(ask(&mut cm5, &again), Some(Err(Refusal::Armed)));
}

#[test]
fn reports_say_who_is_missing() {
    for id in 1..=18 {
        let mut cm5 = VirtualCm5::new();
        greet(&mut cm5);
        ask(&mut cm5, &Command::Mode(Mode::Stream));
        cm5.bus().servo(id).unwrap().faults.dead = true;
        let [m0, m1, m2] = report(&mut cm5).missing;
        assert_eq!(u32::from_le_bytes([m0, m1, m2, 0]), 1 << (id - 1));
    }
}

#[test]
fn statistics_count_answers_and_what_is_missing() {
    let mut cm5 = VirtualCm5::new();
    greet(&mut cm5);
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    // Until all were asked for their modes.
    cm5.run_ms(400.0);
    let before = statistics(&mut cm5);
    cm5.bus().servo(4).unwrap().faults.dead = true;
    cm5.run_ms(100.0);
    cm5.bus().servo(4).unwrap().faults.dead = false;
    cm5.run_ms(40.0);
    let after = statistics(&mut cm5);
    // The first time it is asked once more.
    assert_eq!(after.missed[3] - before.missed[3], 10);
    assert_eq!(after.timeouts - before.timeouts, 11);
    assert_eq!(after.retries - before.retries, 1);
    assert_eq!((after.garbled, after.strangers), (0, 0));
    let ticks = 20;
    assert_eq!(after.answers - before.answers, 18 * ticks - 10);
    let elsewhere = (0..SERVOS).filter(|place| *place != 3);
    assert!(
        elsewhere
            .into_iter()
            .all(|place| after.missed[place] == before.missed[place])
    );
}

#[test]
fn spoilt_answers_and_strangers_are_told_apart() {
    for (flip, wrong_id) in [(1.0, 0.0), (0.0, 1.0)] {
        let mut cm5 = VirtualCm5::new();
        greet(&mut cm5);
        ask(&mut cm5, &Command::Mode(Mode::Stream));
        let faults = &mut cm5.bus().servo(4).unwrap().faults;
        (faults.flip, faults.wrong_id) = (flip, wrong_id);
        cm5.run_ms(200.0);
        let told = statistics(&mut cm5);
        let (garbled, strangers) = (told.garbled > 10, told.strangers > 10);
        assert_eq!(
            (garbled, strangers),
            (flip > 0.0, wrong_id > 0.0),
            "{told:?}"
        );
    }
}

/// Entering a mode asks the servos once more which of them turn without end.
#[test]
fn modes_are_asked_again() {
    let mut cm5 = with_wheels();
    let token = ready_to_balance(&mut cm5, &plan());
    cm5.bus().servo(11).unwrap().set(CCW_LIMIT, 1023);
    say(&mut cm5, &UPRIGHT, 300);
    // Not asked since.
    assert_eq!(ask_upright(&mut cm5, &arm_with(token)), Some(Ok(())));
    for (limit, outcome) in [(1023, Err(Refusal::Wheel)), (0, Ok(()))] {
        cm5.bus().servo(11).unwrap().set(CW_LIMIT, 0);
        cm5.bus().servo(11).unwrap().set(CCW_LIMIT, limit);
        let token = greet(&mut cm5).token;
        assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Balance)), Some(Ok(())));
        say(&mut cm5, &UPRIGHT, 300);
        assert_eq!(ask_upright(&mut cm5, &arm_with(token)), Some(outcome));
    }
}

/// An overloaded servo, and one that is too hot.
#[test]
fn a_servo_that_gives_up_says_why() {
    for bit in [ErrorBits::OVERLOAD, ErrorBits::OVERHEAT] {
        let mut cm5 = VirtualCm5::new();
        arm(&mut cm5);
        say(&mut cm5, &Command::KeepAlive, 100);
        let servo = cm5.bus().servo(7).unwrap();
        match bit {
            ErrorBits::OVERLOAD => servo.overload(),
            _ => servo.temperature = 95.0,
        }
        say(&mut cm5, &Command::KeepAlive, 500);
        let told = telemetry(&mut cm5);
        assert_eq!(told.condition, Condition::Fault(Cause::ServoError));
        let tripped = told.tripped.expect("a servo");
        assert_eq!((tripped.id, tripped.error), (7, bit.0));
    }
}

/// What a tick takes is what its packets take: of every servo a request of 8 bytes, 22 us of
/// nothing, and its position in 8 bytes; of two servos the housekeeping in 14, of which one tells
/// its registers, too, in 26, under torque; and the motor interrupts that stall answers.
#[test]
fn a_tick_takes_no_longer_than_its_packets() {
    let mut cm5 = VirtualCm5::new();
    greet(&mut cm5);
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    cm5.run_ms(400.0);
    let least_us = |cm5: &mut VirtualCm5, registers: u16| {
        let us = 18 * (80 + 22) + 10 * (16 * 8 + 14 + registers);
        let ticks = (0..40).map(|_| {
            cm5.send(&Command::KeepAlive);
            telemetry(cm5).tick_us - us
        });
        ticks.min().expect("ticks")
    };
    let off = least_us(&mut cm5, 14);
    // Until what waits for the line is through: reports leave a twentieth of it.
    cm5.run_ms(1500.0);
    arm(&mut cm5);
    say(&mut cm5, &Command::KeepAlive, 300);
    let on = least_us(&mut cm5, 26);
    // How much of a stall each meets hangs on where they fall. One request more would be 80.
    assert!(
        (360..430).contains(&off) && (300..370).contains(&on),
        "{off} and {on} beside the packets"
    );
}

/// Silent servos are asked until 14 ms have passed; those that were left out are missed like the
/// others, and none is asked twice.
#[test]
fn a_round_of_silent_servos_ends_in_time() {
    let mut cm5 = VirtualCm5::new();
    for servo in &mut cm5.bus().servos {
        servo.faults.dead = true;
    }
    greet(&mut cm5);
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    cm5.run_ms(200.0);
    let before = statistics(&mut cm5);
    cm5.run_ms(500.0);
    let after = statistics(&mut cm5);
    let missed: Vec<u8> = (0..SERVOS)
        .map(|place| after.missed[place] - before.missed[place])
        .collect();
    assert!(missed.iter().all(|times| *times == missed[0]), "{missed:?}");
    assert!(missed[0] > 20, "{missed:?}");
    assert_eq!(after.retries, 0);
    let asked = (after.timeouts - before.timeouts) / u16::from(missed[0]);
    assert!((14..18).contains(&asked), "{asked} a tick");
    let told = telemetry(&mut cm5);
    // From when it was due: up to a period later than it could begin.
    assert!((14_000..26_000).contains(&told.tick_us), "{told:?}");
    assert!(
        cm5.board.longest_unfed_ns < 16_000_000,
        "a tick lasts as long"
    );
    // All that is told of them is that they are missing.
    let report = report(&mut cm5);
    assert_eq!(report.missing, [0xff, 0xff, 3]);
    assert!(report.housekeeping.iter().all(|servo| servo.error == 0xff));
}

/// A servo that falls silent late in a tick is not asked again: what follows needs the time.
#[test]
fn no_servo_is_asked_again_too_late() {
    // With a return delay of 0.1 ms each the round takes more than 7.6 ms of which they are 1.8.
    for (delay, asked_again) in [(0, 1), (120, 0)] {
        let mut cm5 = VirtualCm5::new();
        for servo in &mut cm5.bus().servos {
            servo.set(RETURN_DELAY, delay);
        }
        greet(&mut cm5);
        ask(&mut cm5, &Command::Mode(Mode::Stream));
        cm5.run_ms(600.0);
        let before = statistics(&mut cm5);
        cm5.bus().servo(4).unwrap().faults.dead = true;
        cm5.run_ms(200.0);
        let after = statistics(&mut cm5);
        assert_eq!(after.retries - before.retries, asked_again, "{delay}");
    }
}

/// What is done between ticks makes them late, however short they are themselves.
#[test]
fn ticks_that_begin_late_are_overruns() {
    let mut cm5 = VirtualCm5::new();
    let token = greet(&mut cm5).token;
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    say(&mut cm5, &Command::KeepAlive, 300);
    assert_eq!(telemetry(&mut cm5).overruns, 0);
    cm5.board.byte_ns = 500_000;
    for _ in 0..30 {
        for _ in 0..3 {
            cm5.send(&Command::KeepAlive);
        }
        cm5.run_ms(10.0);
    }
    // What is left is taken at once.
    cm5.board.byte_ns = 0;
    cm5.clear();
    cm5.send(&arm_with(token));
    cm5.run_ms(60.0);
    let refused = cm5
        .reports()
        .into_iter()
        .find_map(|(_, report)| match report {
            Report::Answer(answer) => Some(answer.outcome),
            _ => None,
        });
    assert_eq!(refused, Some(Err(Refusal::Overrun)));
    let told = telemetry(&mut cm5);
    assert!(told.overruns > 5, "{told:?}");
    assert!(told.longest_tick_us > 10_000, "{told:?}");
    // On time again, it arms.
    say(&mut cm5, &Command::KeepAlive, 150);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Ok(())));
}

/// As a line gives that turns round: the answer is found behind it.
#[test]
fn a_stray_byte_before_an_answer_costs_nothing() {
    let mut cm5 = VirtualCm5::new();
    for servo in &mut cm5.bus().servos {
        servo.faults.stray = 1.0;
    }
    greet(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    cm5.run_ms(500.0);
    let counted = statistics(&mut cm5);
    let lost = u32::from(counted.garbled) + u32::from(counted.timeouts);
    // A stray FF is taken for the header's first byte: one in 256.
    assert!(lost * 50 < u32::from(counted.answers), "{counted:?}");
    assert!(counted.answers > 800, "{counted:?}");
}
