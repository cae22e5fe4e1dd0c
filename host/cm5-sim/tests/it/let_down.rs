//! What the servos are told while the robot is let down.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{
    GOAL_POSITION, MOVING_SPEED, PRESENT_POSITION, SHUTDOWN, TORQUE_LIMIT,
};
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS, Speeds};
use handstand_shared::raw::TorqueLimit;

/// Says nothing until it fades.
fn fall_silent(cm5: &mut VirtualCm5) {
    for _ in 0..200 {
        cm5.run_ms(1.0);
        if cm5.app.condition() == Condition::Soft {
            return;
        }
    }
    panic!("it is {:?}", cm5.app.condition());
}

fn speeds(cm5: &mut VirtualCm5) -> Vec<u16> {
    let of = |id: u8| cm5.bus().servo(id).unwrap().get(MOVING_SPEED);
    DRIVEN.into_iter().map(of).collect()
}

#[test]
fn wheels_stop_when_balancing_ends() {
    let mut cm5 = with_wheels();
    balance(&mut cm5);
    let leaning = Command::Attitude(Attitude {
        angle: 300,
        rate: 0,
    });
    say(&mut cm5, &leaning, 100);
    assert!(
        speeds(&mut cm5).iter().all(|code| *code != 0),
        "the law acts"
    );
    fall_silent(&mut cm5);
    assert_eq!(speeds(&mut cm5), [0; 4]);
}

#[test]
fn wheels_that_are_given_speeds_stop() {
    let mut cm5 = with_wheels();
    arm(&mut cm5);
    let turning = Command::Speeds(Speeds::pack([200; SERVOS]));
    say(&mut cm5, &turning, 100);
    assert_eq!(speeds(&mut cm5), [200; 4]);
    fall_silent(&mut cm5);
    assert_eq!(speeds(&mut cm5), [0; 4]);
}

#[test]
fn servos_with_goals_stay_where_they_are() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    let there = Command::Goals(Positions::pack([900; SERVOS]));
    say(&mut cm5, &there, 100);
    let goal = cm5.bus().servo(3).unwrap().get(GOAL_POSITION);
    fall_silent(&mut cm5);
    let servo = cm5.bus().servo(3).unwrap();
    let (held, stands) = (servo.get(GOAL_POSITION), servo.get(PRESENT_POSITION));
    assert_ne!(held, goal);
    assert!(
        held.abs_diff(stands) <= 30 && held != 512,
        "{held}, {stands}"
    );
    // Nothing that was said before is told them again.
    cm5.run_ms(50.0);
    assert_eq!(cm5.bus().servo(3).unwrap().get(GOAL_POSITION), held);
}

/// From 15/16 of what it was, by a sixteenth each 10 ms.
#[test]
fn the_torque_limit_falls_in_equal_steps() {
    for (limit, sixteenth) in [(1023, 63), (810, 50)] {
        let mut cm5 = VirtualCm5::new();
        let token = greet(&mut cm5).token;
        assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
        say(&mut cm5, &Command::KeepAlive, 250);
        let limits = ArmLimits {
            torque: TorqueLimit(limit),
            ..ArmLimits::FULL
        };
        assert_eq!(ask(&mut cm5, &Command::Arm { token, limits }), Some(Ok(())));
        fall_silent(&mut cm5);
        let mut seen = Vec::new();
        while cm5.bus().any_torque() && seen.len() < 40 {
            seen.push(cm5.bus().servo(7).unwrap().get(TORQUE_LIMIT));
            cm5.run_ms(10.0);
        }
        // At none it stays for a tick; then torque is off.
        let steps = (0..16).rev().map(|left| left * sixteenth).chain([0]);
        let steps: Vec<u16> = steps.collect();
        assert_eq!(seen, steps, "of {limit}");
    }
}

/// Said again while torque falls it changes nothing; said without torque it is refused.
#[test]
fn let_down_may_be_said_twice() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::LetDown), Some(Ok(())));
    assert_eq!(cm5.app.condition(), Condition::Soft);
    assert_eq!(ask(&mut cm5, &Command::LetDown), Some(Ok(())));
    let (_, off_ms) = times_to_off(&mut cm5, Some(&Command::KeepAlive));
    assert!(off_ms.is_some_and(|ms| ms < 180.0), "{off_ms:?}");
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::LetDown));
    assert_eq!(ask(&mut cm5, &Command::LetDown), Some(Err(Refusal::State)));
}

/// One that gave up without switching its torque off: the limits that are written while the others
/// are let down would wake it.
#[test]
fn a_servo_that_gave_up_is_let_go_at_once() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    say(&mut cm5, &Command::KeepAlive, 100);
    let servo = cm5.bus().servo(7).unwrap();
    servo.set(SHUTDOWN, 0);
    servo.overload();
    for _ in 0..20 {
        say(&mut cm5, &Command::KeepAlive, 10);
        if cm5.app.condition() == Condition::Soft {
            break;
        }
    }
    assert_eq!(cm5.app.condition(), Condition::Soft);
    for id in 1..=18 {
        let is_on = cm5.bus().servo(id).unwrap().torque_is_on();
        assert_eq!(is_on, id != 7, "servo {id}");
    }
}
