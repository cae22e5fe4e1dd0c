//! Motions that servos cannot get to, refused before torque; and servos whose codes are not the
//! AX-12's.

use super::*;
use crate::error::{Error, Result};
use crate::virtual_cm5::{AdapterPort, Cm5Port, SimLink, set_up, spec};
use crate::{ServoError, Servos};
use handstand_shared::control_table::one::OneModel;
use handstand_shared::control_table::{
    CCW_LIMIT, CW_LIMIT, GOAL_POSITION, Item, MODEL, MOVING_SPEED, TORQUE_ENABLE, x,
};
use std::time::Duration;

const PERIOD: Duration = Duration::from_millis(10);

/// A sine of so many rad of servo 1, around this angle.
fn motion(amplitude_rad: f64, centre_rad: f64) -> GoalMotion {
    let times = (0..200).map(|k| f64::from(k) * 0.01);
    let goals = times
        .clone()
        .map(|t| vec![centre_rad + amplitude_rad * (3.0 * t).sin()]);
    GoalMotion {
        time_s: times.clone().collect(),
        goals_rad: goals.collect(),
        measured_rad: times.clone().map(|_| vec![None]).collect(),
        torque_on: times.map(|_| true).collect(),
    }
}

fn followed(motion: &GoalMotion, source: &mut dyn SampleSource) -> Result<FollowedMotion> {
    follow(motion, source, None, &|| true, &|_| ())
}

fn one(number: u16, limits: (u16, u16)) -> SimLink<AdapterPort> {
    let mut bus = set_up(&spec("ids=1,delay=0").unwrap()).unwrap();
    for (register, code) in [(MODEL, number), (CW_LIMIT, limits.0), (CCW_LIMIT, limits.1)] {
        bus.servos[0].set(register, code);
    }
    SimLink(AdapterPort::new(bus))
}

fn adapter(number: u16, limits: (u16, u16)) -> Result<Adapter<SimLink<AdapterPort>>> {
    Adapter::new(Servos::new(one(number, limits)), &[1], PERIOD)
}

fn refused(outcome: Result<FollowedMotion>, said: &[&str]) {
    let error = outcome.unwrap_err();
    let text = format!("{error} | {}", error.remedy().unwrap_or_default());
    assert_eq!(error.exit_code(), 4, "{text}");
    said.iter()
        .for_each(|said| assert!(text.contains(said), "{said}: {text}"));
}

#[test]
fn an_ax_in_wheel_mode_is_not_moved_by_goals() {
    let mut source = adapter(12, (0, 0)).unwrap();
    let said = [
        "servo 1 is in wheel mode",
        "bus write 1 ccw-angle-limit 1023",
    ];
    refused(followed(&motion(0.3, 0.0), &mut source), &said);
    assert!(!source.servos().link().0.bus().any_torque());
}

#[test]
fn goals_beyond_an_ax_s_angle_limits_are_refused_with_servo_goal_and_limit() {
    for (limits, amplitude, said) in [
        ((0, 560), 0.3, "ccw angle limit is code 560"),
        ((480, 1023), 0.3, "cw angle limit is code 480"),
        ((0, 1023), 3.0, "cw angle limit is code 0"),
    ] {
        let mut source = adapter(12, limits).unwrap();
        let motion = motion(amplitude, 0.0);
        refused(
            followed(&motion, &mut source),
            &["servo 1 cannot get to its goal of", said],
        );
        assert!(!source.servos().link().0.bus().any_torque(), "{limits:?}");
    }
    let mut source = adapter(12, (300, 700)).unwrap();
    let well = followed(&motion(0.3, 0.0), &mut source).unwrap();
    assert!(well.travels[0].not_followed().is_none());
}

#[test]
fn a_cm5_s_servos_are_asked_for_mode_and_limits_too() {
    for (limits, said) in [
        ((0, 0), "wheel mode"),
        ((0, 560), "ccw angle limit is code 560"),
    ] {
        let mut bus = set_up(&spec("ids=1,delay=0").unwrap()).unwrap();
        bus.servos[0].set(CW_LIMIT, limits.0);
        bus.servos[0].set(CCW_LIMIT, limits.1);
        let link = SimLink(Cm5Port::new(bus));
        let mut source = open_source(link, &[1], true, PERIOD).unwrap();
        refused(followed(&motion(0.3, 0.0), &mut *source), &[said]);
    }
    let mut bus = set_up(&spec("ids=1,delay=0").unwrap()).unwrap();
    bus.servos[0].set(MODEL, 29);
    let error = open_source(SimLink(Cm5Port::new(bus)), &[1], true, PERIOD)
        .err()
        .unwrap();
    assert!(
        error.to_string().contains("servo 1 is of model 29 (MX-28)"),
        "{error}"
    );
}

fn x_servo(settings: &[(Item, i32)]) -> GroupAdapter<SimLink<AdapterPort>> {
    let mut servos = Servos::new(SimLink::adapter("model=XL330-M288,ids=1,delay=0").unwrap());
    for (item, code) in settings {
        servos.set_code(1, item, *code).unwrap();
    }
    GroupAdapter::new(servos, &[1], PERIOD, true).unwrap()
}

#[test]
fn goals_beyond_an_x_s_position_limits_are_refused() {
    let mut source = x_servo(&[(x::MAX_POSITION, 2100)]);
    let said = [
        "servo 1 cannot get to its goal",
        "max position limit is code 2100",
    ];
    refused(followed(&motion(0.3, 0.0), &mut source), &said);
    // Extended position mode has no limits.
    let mut source = x_servo(&[(x::MAX_POSITION, 2100), (x::OPERATING_MODE, 4)]);
    let well = followed(&motion(0.3, 0.0), &mut source).unwrap();
    assert!(well.travels[0].not_followed().is_none());
}

/// With an offset the first turn's codes begin at it.
#[test]
fn a_homing_offset_shifts_the_turn_in_which_a_servo_may_stand() {
    let centre = -1500.0 * handstand_shared::control_table::POSITION_LSB_RAD;
    for mode in [4, 5] {
        let settings = [(x::OPERATING_MODE, mode), (x::HOMING_OFFSET, -1500)];
        let mut source = x_servo(&settings);
        let well = followed(&motion(0.2, centre), &mut source).unwrap();
        assert!(well.tracking.value().unwrap() < 0.1, "{mode}");
        let far = [(x::OPERATING_MODE, mode), (x::HOMING_OFFSET, 5000)];
        x_servo(&far).arm().unwrap();
    }
    let turned = SimLink::adapter("model=XL330-M288,ids=1,delay=0,mode=4,turns=1").unwrap();
    let mut servos = Servos::new(turned);
    servos.set_code(1, &x::HOMING_OFFSET, -1500).unwrap();
    let mut source = GroupAdapter::new(servos, &[1], PERIOD, true).unwrap();
    let error = source.arm().unwrap_err().to_string();
    assert!(
        error.contains("outside the turn from -1500 to 2595"),
        "{error}"
    );
}

#[test]
fn an_mx_of_protocol_1_is_read_and_moved_in_its_own_codes() {
    // The simulated shaft is an AX-12's: it stands at code 512.
    let mut source = adapter(29, (0, 4095)).unwrap();
    let quarter = -1536.0 * 2.0 * std::f64::consts::PI / 4096.0;
    let sample = source.sample(None).unwrap().unwrap();
    assert!((sample.joints[0].position_rad.unwrap() - quarter).abs() < 1e-9);
    source.arm().unwrap();
    let goal = |source: &mut Adapter<SimLink<AdapterPort>>| {
        source.servos().link().0.bus().servos[0].get(GOAL_POSITION)
    };
    assert_eq!(goal(&mut source), 512);
    source.sample(Some(&[quarter + 0.0154])).unwrap();
    assert_eq!(goal(&mut source), 522);
}

#[test]
fn models_that_are_not_known_are_neither_read_nor_moved() {
    let error = adapter(1_000, (0, 1023)).err().unwrap();
    assert!(
        error.to_string().contains("servo 1 is of model 1000"),
        "{error}"
    );
    assert!(matches!(error, Error::Device(_)) && error.remedy().is_some());
    let mut servos = Servos::new(one(1_000, (0, 1023)));
    servos.ping(1).unwrap();
    let unknown = |outcome: crate::ServoResult<()>| {
        matches!(outcome, Err(ServoError::UnknownModel { number: 1_000, .. }))
    };
    assert!(unknown(servos.get(1, MOVING_SPEED).map(|_| ())));
    assert!(unknown(servos.set(1, TORQUE_ENABLE, 1)));
    assert!(unknown(servos.items(1).map(|_| ())));
    assert!(unknown(servos.one_servo(1).map(|_| ())));
    assert_eq!(servos.identify(1).unwrap().number, 1_000);
    assert!(OneModel::of(1_000).is_none());
}
