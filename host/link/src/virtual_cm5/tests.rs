//! A model on simulated servos.

use super::*;
use handstand_shared::control_table::{GOAL_POSITION, PRESENT_POSITION};
use handstand_shared::dynamixel::{BROADCAST, Request};

/// The humanoid on the bar, as `virtual --robot` hangs it.
fn robot(more: &str) -> Bus {
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/robot.toml");
    let text = format!("ids=1-18,delay=0,robot={model}{more}");
    set_up(&spec(&text).unwrap()).unwrap()
}

fn goal(bus: &mut Bus, id: u8, code: u16) {
    let data = code.to_le_bytes();
    bus.transact(
        id,
        Request::Write {
            address: GOAL_POSITION.address,
            data: &data,
        },
    );
}

#[test]
fn goals_of_the_servos_move_the_robot_s_joints_and_their_twins() {
    let mut bus = robot("");
    for (id, code) in [(1, 600), (2, 424), (11, 450), (12, 574)] {
        goal(&mut bus, id, code);
    }
    bus.advance(5_000_000_000);
    let mut at = |id: u8| i32::from(bus.servo(id).unwrap().get(PRESENT_POSITION));
    // Compliance and friction leave some; gravity pulls both back towards hanging.
    for (id, code) in [(1, 600), (11, 450)] {
        let away = at(id) - code;
        assert!(away.abs() < 40, "servo {id}: {away}");
        assert!((at(id) - 512).abs() > 30, "servo {id} moved");
        assert!((at(id) + at(id + 1) - 1024).abs() <= 1, "its twin faces it");
    }
    assert_eq!(at(5), 512, "a servo it does not hang on is free");
    bus.transact(
        BROADCAST,
        Request::Write {
            address: 24,
            data: &[0],
        },
    );
    bus.advance(60_000_000_000);
    let rate = bus.robot().unwrap().rate_rad_s();
    assert!(rate.abs() < 0.05, "let go it comes to rest: {rate}");
}

#[test]
fn a_robot_that_stands_falls_without_torque() {
    let mut bus = robot(",start=upright");
    let (tell, states) = std::sync::mpsc::channel();
    bus.robot().unwrap().watch(tell);
    goal(&mut bus, 1, 530);
    goal(&mut bus, 2, 494);
    bus.advance(3_000_000_000);
    let states: Vec<RobotState> = states.try_iter().collect();
    assert_eq!(states.len(), 300);
    let up = |state: &RobotState| (state.angle_rad[0] - std::f64::consts::PI).abs();
    assert!(up(&states[0]) < 0.01);
    let farthest = states.iter().map(up).fold(0.0, f64::max);
    assert!(farthest > 1.0, "{farthest}");
    assert!(states[5].drive[0].is_none() && states[5].drive[1].unwrap().torque_on);
}

/// With the factory's return delay each tick takes longer than its period.
#[test]
fn asking_often_makes_no_time_pass() {
    use crate::SerialLink as _;
    use handstand_shared::message::{Command, Mode};
    use std::time::Duration;
    let bus = set_up(&spec("ids=1-18").unwrap()).unwrap();
    let mut session = crate::Session::open(SimLink(Cm5Port::new(bus))).unwrap();
    session
        .obey(&Command::Mode(Mode::Stream), "stream")
        .unwrap();
    let link = session.link();
    let mut bytes = [0; 512];
    // As a server of a port in real time does it, which pauses for what is left.
    let began = link.now();
    for _ in 0..200 {
        let until = began + Duration::from_millis(100);
        let left = until.saturating_sub(link.now());
        link.pause(left.min(Duration::from_millis(1)));
        link.receive(&mut bytes, Duration::ZERO).unwrap();
    }
    let passed = link.now() - began;
    assert!(passed < Duration::from_millis(120), "{passed:?}");
}

#[test]
fn a_robot_that_fits_no_servos_is_refused() {
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/robot.toml");
    for (text, said) in [
        (
            format!("ids=1-3,robot={model}"),
            "servo 11, which is not there",
        ),
        (format!("robot={model},joints=1+2"), "2 driven joints"),
        ("robot=absent.toml".to_string(), "cannot read"),
    ] {
        let spec = spec(&text).unwrap();
        let error = set_up(&spec).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
}
