//! The joints' range and speed, and servos that lose their torque.

use super::rig::*;
use handstand_cm5_sim::SimulatedCm5;
use handstand_shared::control_table::{PRESENT_POSITION, TORQUE_ENABLE};
use handstand_shared::message::*;
use handstand_shared::raw::Position;

fn turn(cm5: &mut handstand_cm5_sim::VirtualCm5, id: u8, code: u16) {
    let servo = cm5.bus().servo(id).unwrap();
    servo.shaft.angle_rad = Position(code).to_rad();
    assert_eq!(Position::from_rad(servo.shaft.angle_rad).0, code);
    let _ = PRESENT_POSITION;
}

/// Slowly, as far as this code.
fn creep(cm5: &mut handstand_cm5_sim::VirtualCm5, id: u8, to: u16) {
    let mut code = 512u16;
    while code != to {
        code = if to > code {
            (code + 8).min(to)
        } else {
            code.saturating_sub(8).max(to)
        };
        turn(cm5, id, code);
        say(cm5, &UPRIGHT, 10);
        if !cm5.bus().any_torque() {
            return;
        }
    }
    say(cm5, &UPRIGHT, 30);
}

#[test]
fn a_joint_at_the_end_of_its_range_is_let_go() {
    for id in [1, 11] {
        for (code, stops) in [(692, false), (693, true), (312, false), (311, true)] {
            let mut cm5 = with_wheels();
            balance(&mut cm5);
            creep(&mut cm5, id, code);
            let fault = Condition::Fault(Cause::JointRange);
            let expected = if stops {
                fault
            } else {
                Condition::BalanceArmed
            };
            assert_eq!(cm5.app.condition(), expected, "servo {id} at {code}");
            assert_eq!(cm5.bus().any_torque(), !stops);
        }
    }
}

#[test]
fn a_joint_that_turns_too_fast_is_let_go() {
    for (step, stops) in [(12, false), (13, true)] {
        for id in [1, 11] {
            let mut cm5 = with_wheels();
            balance(&mut cm5);
            for count in 1..=4u16 {
                turn(&mut cm5, id, 512 + count * step);
                say(&mut cm5, &UPRIGHT, 10);
            }
            let fault = Condition::Fault(Cause::JointSpeed);
            let expected = if stops {
                fault
            } else {
                Condition::BalanceArmed
            };
            assert_eq!(
                cm5.app.condition(),
                expected,
                "{step} codes a tick, servo {id}"
            );
        }
    }
}

/// Unheard for a tick it may have turned twice as far.
#[test]
fn a_missed_reading_is_no_speed() {
    let mut cm5 = with_wheels();
    balance(&mut cm5);
    for _ in 0..5 {
        cm5.bus().servo(1).unwrap().faults.dead = true;
        say(&mut cm5, &UPRIGHT, 10);
        let code = cm5.bus().servo(1).unwrap().get(PRESENT_POSITION);
        turn(&mut cm5, 1, code + 20);
        cm5.bus().servo(1).unwrap().faults.dead = false;
        say(&mut cm5, &UPRIGHT, 20);
    }
    assert_eq!(cm5.app.condition(), Condition::BalanceArmed);
}

#[test]
fn a_servo_that_loses_its_torque_is_noticed() {
    for (id, is_balance) in [(7, false), (8, false), (2, true), (11, true)] {
        let mut cm5 = with_wheels();
        let say_it = if is_balance {
            UPRIGHT
        } else {
            Command::KeepAlive
        };
        if is_balance {
            balance(&mut cm5);
        } else {
            arm(&mut cm5);
        }
        say(&mut cm5, &say_it, 400);
        cm5.bus().servo(id).unwrap().set(TORQUE_ENABLE, 0);
        // Each servo says so every 180 ms.
        say(&mut cm5, &say_it, 200);
        let fault = Condition::Fault(Cause::TorqueLost);
        let condition = cm5.app.condition();
        assert!([Condition::Soft, fault].contains(&condition), "servo {id}");
        say(&mut cm5, &say_it, 200);
        assert_eq!(cm5.app.condition(), fault);
        assert!(!cm5.bus().any_torque());
        let tripped = telemetry(&mut cm5).tripped;
        assert_eq!(tripped, Some(TrippedServo { id, error: 0 }));
    }
}

#[test]
fn a_list_of_one_servo_is_watched_too() {
    let mut cm5 = handstand_cm5_sim::VirtualCm5::new();
    greet(&mut cm5);
    let list = ServoList {
        count: 1,
        ..ServoList::default()
    };
    // The mode first: an adapter takes frames after a zero only.
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    assert_eq!(ask(&mut cm5, &Command::ServoList(list)), Some(Ok(())));
    arm(&mut cm5);
    cm5.bus().servo(1).unwrap().set(TORQUE_ENABLE, 0);
    say(&mut cm5, &Command::KeepAlive, 400);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::TorqueLost));
}
