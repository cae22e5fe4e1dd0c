//! Servos of Protocol 2.0 sampled and moved.

use super::*;
use crate::virtual_cm5::{AdapterPort, SimLink};
use crate::{SerialLink as _, Servos, Tap};
use handstand_shared::control_table::x;
use std::time::Duration;

type Sim = SimLink<AdapterPort>;

fn sim(words: &str) -> Sim {
    SimLink::adapter(words).unwrap()
}

fn adapter(words: &str, ids: &[u8]) -> GroupAdapter<Sim> {
    let period = Duration::from_millis(10);
    GroupAdapter::new(Servos::new(sim(words)), ids, period, true).unwrap()
}

#[test]
fn current_supply_and_temperature_are_in_si() {
    let mut source = adapter("model=XM430-W350,ids=1-2,jam=2,supply=12.3", &[1, 2]);
    source.arm().unwrap();
    let mut goals = vec![0.0, 0.3];
    let mut last = source.sample(Some(&goals)).unwrap().unwrap();
    for _ in 0..50 {
        last = source.sample(Some(&goals)).unwrap().unwrap();
    }
    goals[1] = 0.0;
    assert!(last.has_current && last.torque_on == Some(true));
    // The jammed one pushes with 0.3 of 0.5 rad for full output, 1193 codes of 2.69 mA.
    let current_a = last.joints[1].current_a.unwrap();
    assert!(
        (current_a - 0.6 * 1193.0 * 2.69e-3).abs() < 0.05,
        "{current_a}"
    );
    assert_eq!(last.joints[0].load, None);
    let supply = (0..4).find_map(|_| source.sample(None).unwrap().unwrap().joints[0].supply_v);
    assert!((supply.unwrap() - 12.3).abs() < 1e-9);
}

#[test]
fn a_load_stays_a_load() {
    let mut source = adapter("model=xl430,ids=1", &[1]);
    let sample = source.sample(None).unwrap().unwrap();
    assert_eq!(
        (sample.has_current, sample.joints[0].load),
        (false, Some(0.0))
    );
    assert_eq!(sample.joints[0].current_a, None);
}

#[test]
fn servos_follow_and_are_let_go() {
    for words in [
        "model=XL330-M288,ids=1-3",
        "model=XL330-M288,ids=1-3,drop=0.02,flip=0.01,wrong_id=0.01",
        "model=MX-64,ids=1-3,mode=4",
    ] {
        let mut source = adapter(words, &[1, 2, 3]);
        source.arm().unwrap();
        let mut last = None;
        for step in 0..200 {
            let goals = [0.001 * f64::from(step); 3];
            last = source.sample(Some(&goals)).unwrap();
            assert_eq!(source.danger(), None, "{words}");
        }
        let angles = last.unwrap().joints;
        for joint in angles.iter().filter_map(|joint| joint.position_rad) {
            assert!((joint - 0.199).abs() < 0.05, "{words}: {joint}");
        }
        source.disarm().unwrap();
        let servos = source.servos();
        for id in 1..=3 {
            servos.tries = 10;
            assert_eq!(servos.code(id, &x::TORQUE_ENABLE).unwrap(), 0);
            assert_eq!(servos.code(id, &x::BUS_WATCHDOG).unwrap(), 0);
        }
    }
}

#[test]
fn a_silent_line_trips_the_watchdog_and_is_a_danger() {
    let mut source = adapter("model=XL330-M288,ids=1-3", &[1, 2, 3]);
    source.arm().unwrap();
    source.sample(Some(&[0.1; 3])).unwrap();
    let servos = source.servos();
    assert_eq!(servos.code(1, &x::BUS_WATCHDOG).unwrap(), 10);
    servos.link().pause(Duration::from_millis(300));
    let found = (0..20).find_map(|_| {
        source.sample(Some(&[0.1; 3])).unwrap();
        source.danger()
    });
    assert!(found.unwrap().contains("bus watchdog of servo"));
    // What follows can move them again.
    source.disarm().unwrap();
    source.arm().unwrap();
    assert!((0..20).all(|_| source.sample(None).unwrap().is_some() && source.danger().is_none()));
}

#[test]
fn servos_that_may_not_be_moved_are_refused() {
    for (words, said) in [
        ("model=XL330-M288,ids=1,mode=1", "operating mode 1"),
        ("model=XL330-M288,ids=1,overload=1", "overload"),
        ("model=XL330-M288,ids=1,mode=4,turns=2", "outside the turn"),
    ] {
        let error = adapter(words, &[1]).arm().unwrap_err().to_string();
        assert!(error.contains(said), "{words}: {error}");
    }
    let servos = || Servos::new(sim("model=xl430,ids=1,firmware=37"));
    let period = Duration::from_millis(10);
    let old = GroupAdapter::new(servos(), &[1], period, true);
    assert!(
        old.map(drop)
            .unwrap_err()
            .to_string()
            .contains("no bus watchdog")
    );
    assert!(GroupAdapter::new(servos(), &[1], period, false).is_ok());
    let slow = Servos::new(sim("model=XL330-M288,ids=1"));
    assert!(GroupAdapter::new(slow, &[1], Duration::from_secs(1), true).is_err());
}

#[test]
fn a_first_goal_far_away_is_refused() {
    let mut source = adapter("model=XL330-M288,ids=1", &[1]);
    source.arm().unwrap();
    let error = source.sample(Some(&[1.0])).unwrap_err().to_string();
    assert!(error.contains("its first goal is 1.00 rad"), "{error}");
    source.arm().unwrap();
    source.sample(Some(&[0.3])).unwrap();
    source.sample(Some(&[1.0])).unwrap();
}

#[test]
fn a_hardware_error_is_named_and_stops_the_motion() {
    let mut source = adapter("model=XL330-M288,ids=1-2", &[1, 2]);
    source.arm().unwrap();
    source.sample(Some(&[0.0; 2])).unwrap();
    assert_eq!(source.danger(), None);
    source.servos().link().0.bus().x.servos[1].overload();
    source.sample(Some(&[0.0; 2])).unwrap();
    let danger = source.danger().unwrap();
    assert!(danger.contains("servo 2 reports: overload"), "{danger}");
    assert!(danger.contains("bus reboot 2"), "{danger}");
}

/// A silent servo costs its own time and takes none of the others' answers, once it is known.
#[test]
fn a_dead_servo_costs_no_answers_of_others() {
    let mut source = adapter("model=XL330-M288,ids=1-6", &[1, 2, 3, 4, 5, 6]);
    source.servos().link().0.bus().x.servos[2].faults.dead = true;
    for round in 0..20 {
        let sample = source.sample(None).unwrap().unwrap();
        let there = sample
            .joints
            .iter()
            .map(|joint| joint.position_rad.is_some());
        let there: Vec<bool> = there.collect();
        assert_eq!(
            there,
            [true, true, false, true, true, true],
            "round {round}"
        );
    }
}

/// 18 servos: a round takes what its bytes take on the line, and the servos' turnaround.
#[test]
fn rounds_of_18_servos_against_the_lines_limit() {
    let ids: Vec<u8> = (1..=18).collect();
    for (baud, code, most_us) in [(1_000_000, 3, 3_600.0), (4_000_000, 6, 1_100.0)] {
        let words = format!("model=XL330-M288,delay=0,baud={code}");
        let mut link = sim(&words);
        link.set_baud(baud).unwrap();
        let mut source = GroupAdapter::new(Servos::new(link), &ids, Duration::ZERO, true).unwrap();
        let limit_us = source.limit_us();
        let times = (0..50).map(|_| source.sample(None).unwrap().unwrap().time_s);
        let times: Vec<f64> = times.collect();
        let round_us = (times[49] - times[1]) / 48.0 * 1e6;
        println!("{baud} baud: {round_us:.0} us a round, limit {limit_us:.0} us");
        assert!(
            round_us >= limit_us && round_us < most_us,
            "{round_us} us, limit {limit_us}"
        );
    }
}

#[test]
fn a_recording_has_currents_and_is_read_back() {
    let folder = std::env::temp_dir().join(format!("handstand-current-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for name in ["a.csv", "a.mcap"] {
        let file = folder.join(name);
        let mut source = adapter("model=XL330-M288,ids=1-2", &[1, 2]);
        let mut recorder = RobotRecorder::create(&file, &[1, 2], true).unwrap();
        for _ in 0..5 {
            recorder
                .write(&source.sample(None).unwrap().unwrap())
                .unwrap();
        }
        recorder.finish().unwrap();
        let recording = read(&file).unwrap();
        assert_eq!(recording.samples.len(), 5);
        let last = &recording.samples[4];
        assert!(
            last.has_current && last.joints[1].current_a == Some(0.0),
            "{name}: {last:?}"
        );
        if name.ends_with("csv") {
            let text = std::fs::read_to_string(&file).unwrap();
            assert!(text.starts_with("time_s,q1_rad,") && text.contains(",current2_a"));
        }
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_tapped_adapter_sends_torque_off_last() {
    use std::sync::{Arc, Mutex};
    let sent = Arc::new(Mutex::new(Vec::new()));
    let heard = sent.clone();
    let tap = Tap::new(sim("model=XL330-M288,ids=1"), move |exchange| {
        if exchange.way == crate::Way::Out {
            heard.lock().unwrap().push(exchange.bytes.clone());
        }
    });
    let period = Duration::from_millis(10);
    let mut source = GroupAdapter::new(Servos::new(tap), &[1], period, true).unwrap();
    source.arm().unwrap();
    let baud = source.servos().link().baud() as usize;
    sent.lock().unwrap().clear();
    drop(source);
    let off = [0xff, 0xff, 0xfd, 0, 0xfe, 6, 0, 3, 64, 0, 0];
    let sent = sent.lock().unwrap();
    assert!(sent[0].starts_with(&off), "{sent:02x?}");
    // Behind as much idle as outlasts an answer.
    assert_eq!(sent[1], vec![0xff; baud / 10 / 200]);
    assert!(sent[2].starts_with(&off), "{sent:02x?}");
}
