//! What arming needs, and what it sets.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{MOVING_SPEED, RETURN_DELAY, TORQUE_LIMIT};
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::raw::{MovingSpeed, Position, TorqueLimit};

#[test]
fn a_token_arms_once() {
    let mut cm5 = VirtualCm5::new();
    let token = arm(&mut cm5);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Err(Refusal::Armed)));
    for mode in [Mode::Stream, Mode::Balance] {
        assert_eq!(ask(&mut cm5, &Command::Mode(mode)), Some(Ok(())));
        say(&mut cm5, &UPRIGHT, 300);
        assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Err(Refusal::Token)));
        assert!(!cm5.bus().any_torque());
    }
    let next = greet(&mut cm5).token;
    assert_ne!(next, token);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    say(&mut cm5, &Command::KeepAlive, 300);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Err(Refusal::Token)));
    assert_eq!(ask(&mut cm5, &arm_with(next)), Some(Ok(())));
}

#[test]
fn after_a_disarm_the_same_frame_arms_nothing() {
    let mut cm5 = VirtualCm5::new();
    let token = arm(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::Disarm), Some(Ok(())));
    say(&mut cm5, &Command::KeepAlive, 300);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Err(Refusal::Version)));
}

/// A joint of two servos would hang on one of them, and no report would say so.
#[test]
fn a_servo_whose_answer_is_lost_as_torque_comes_on_has_it_too() {
    for (silent_ms, has_torque) in [(12.0, true), (60.0, false)] {
        let mut cm5 = VirtualCm5::new();
        let token = greet(&mut cm5).token;
        assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
        say(&mut cm5, &Command::KeepAlive, 300);
        cm5.bus().servo(4).unwrap().faults.drop = 1.0;
        cm5.run_ms(silent_ms);
        cm5.send(&arm_with(token));
        cm5.run_ms(10.0);
        if has_torque {
            cm5.bus().servo(4).unwrap().faults.drop = 0.0;
        }
        say(&mut cm5, &Command::KeepAlive, 180);
        assert_eq!(cm5.app.condition(), Condition::StreamArmed);
        let servo = cm5.bus().servo(4).unwrap();
        assert_eq!(
            servo.torque_is_on(),
            has_torque,
            "silent for {silent_ms} ms"
        );
    }
}

#[test]
fn nothing_is_armed_while_a_plan_is_written() {
    let mut cm5 = with_wheels();
    let token = ready_to_balance(&mut cm5, &plan());
    let before = greet(&mut cm5).plan;
    assert_ne!(greet(&mut cm5).token, token);
    let token = greet(&mut cm5).token;
    say(&mut cm5, &UPRIGHT, 300);
    let other = [7; PLAN_CHUNK];
    let chunk = Command::PlanChunk {
        offset: 0,
        bytes: other,
    };
    cm5.send(&chunk);
    say(&mut cm5, &UPRIGHT, 40);
    assert_eq!(
        ask_upright(&mut cm5, &arm_with(token)),
        Some(Err(Refusal::Busy))
    );
    assert!(!cm5.bus().any_torque());
    say(&mut cm5, &UPRIGHT, 600);
    assert_eq!(ask_upright(&mut cm5, &arm_with(token)), Some(Ok(())));
    // Armed, neither a piece nor the whole is taken.
    for command in [
        chunk,
        Command::PlanStore {
            length: 32,
            check: handstand_shared::crc::crc32(&other),
        },
    ] {
        assert_eq!(
            ask_upright(&mut cm5, &command),
            Some(Err(Refusal::Armed)),
            "{command:?}"
        );
    }
    assert_eq!(greet(&mut cm5).plan, before);
}

#[test]
fn ticks_that_last_too_long_are_not_armed_with() {
    let mut cm5 = VirtualCm5::new();
    for servo in &mut cm5.bus().servos {
        servo.set(RETURN_DELAY, RETURN_DELAY.default);
    }
    let token = greet(&mut cm5).token;
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    say(&mut cm5, &Command::KeepAlive, 800);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Err(Refusal::Overrun)));
    for servo in &mut cm5.bus().servos {
        servo.set(RETURN_DELAY, 0);
    }
    // A new list is asked for its own delays.
    ask(&mut cm5, &Command::ServoList(ServoList::default()));
    say(&mut cm5, &Command::KeepAlive, 800);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Ok(())));
}

#[test]
fn torque_and_speed_are_those_that_arming_names() {
    let mut cm5 = with_wheels();
    let token = greet(&mut cm5).token;
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    say(&mut cm5, &Command::KeepAlive, 300);
    let limits = |torque, speed| Command::Arm {
        token,
        limits: ArmLimits {
            torque: TorqueLimit(torque),
            speed: MovingSpeed(speed),
        },
    };
    for (torque, speed) in [(0, 1), (1024, 1), (1, 0), (1, 1024)] {
        let refused = ask(&mut cm5, &limits(torque, speed));
        assert_eq!(refused, Some(Err(Refusal::Limits)), "{torque} {speed}");
    }
    assert_eq!(ask(&mut cm5, &limits(600, 90)), Some(Ok(())));
    for servo in &cm5.bus().servos {
        assert_eq!(servo.get(TORQUE_LIMIT), 600, "servo {}", servo.id());
        // For one that turns without end it would be its speed.
        let speed = if DRIVEN.contains(&servo.id()) { 0 } else { 90 };
        assert_eq!(servo.get(MOVING_SPEED), speed, "servo {}", servo.id());
    }
    say(
        &mut cm5,
        &Command::Goals(Positions::pack([512; SERVOS])),
        100,
    );
    assert!(
        cm5.bus()
            .servos
            .iter()
            .all(|servo| servo.get(TORQUE_LIMIT) == 600)
    );
    // The limit falls from there, and never rises.
    let mut last = 600;
    while cm5.bus().any_torque() {
        cm5.run_ms(1.0);
        let limit = cm5.bus().servo(5).unwrap().get(TORQUE_LIMIT);
        assert!(limit <= last, "{limit} after {last}");
        last = limit;
    }
    assert_eq!(last, 0);
}

#[test]
fn only_wheels_are_balanced_with() {
    let mut cm5 = with_wheels();
    let servo = cm5.bus().servo(12).unwrap();
    servo.set(handstand_shared::control_table::CCW_LIMIT, 1023);
    let token = ready_to_balance(&mut cm5, &plan());
    let refused = ask_upright(&mut cm5, &arm_with(token));
    assert_eq!(refused, Some(Err(Refusal::Wheel)));
}

#[test]
fn a_piece_of_the_plan_is_read_at_any_offset() {
    let mut cm5 = with_wheels();
    for compiled in [false, true] {
        if compiled {
            cm5.board.compiled = bytes(&plan());
        } else {
            ready_to_balance(&mut cm5, &plan());
        }
        for offset in [0, 96, 999, 1000, 65_504, 65_520, u16::MAX] {
            cm5.clear();
            cm5.send(&Command::PlanRead { offset });
            cm5.run_ms(60.0);
            let mut reports = cm5.reports().into_iter();
            let read = reports.find_map(|(_, report)| match report {
                Report::PlanChunk { offset, bytes, .. } => Some((offset, bytes)),
                _ => None,
            });
            let (of, found) = read.expect("a piece");
            assert_eq!(of, offset);
            let whole = bytes(&plan());
            let expected = (usize::from(offset)..).map(|at| whole.get(at).copied().unwrap_or(0));
            assert!(found.into_iter().eq(expected.take(PLAN_CHUNK)), "{offset}");
        }
        if !compiled {
            cm5 = VirtualCm5::with_plan(bytes(&plan()), vec![0xff; 4096], ResetCause(1));
            cm5.send_bytes(&[0]);
            greet(&mut cm5);
            ask(&mut cm5, &Command::Mode(Mode::Stream));
        }
    }
}

#[test]
fn nothing_is_kept_at_the_first_bytes_of_eeprom() {
    let mut cm5 = with_wheels();
    for _ in 0..3 {
        ready_to_balance(&mut cm5, &plan());
    }
    assert!(cm5.board.eeprom[..16].iter().all(|byte| *byte == 0xff));
    assert!(cm5.board.eeprom[0xcf8..].iter().all(|byte| *byte == 0xff));
}

/// Ten degrees from the pose that the gains are for; a joint's mirror turns the other way.
#[test]
fn a_robot_far_from_its_pose_is_not_balanced() {
    for ids in [[1, 2], [11, 12]] {
        for (away, outcome) in [
            (34, Ok(())),
            (-34, Ok(())),
            (35, Err(Refusal::Pose)),
            (-35, Err(Refusal::Pose)),
        ] {
            let mut cm5 = with_wheels();
            let token = ready_to_balance(&mut cm5, &plan());
            for (id, code) in ids.into_iter().zip([512 + away, 512 - away]) {
                let servo = cm5.bus().servo(id).unwrap();
                servo.shaft.angle_rad = Position(code as u16).to_rad();
            }
            say(&mut cm5, &UPRIGHT, 50);
            let asked = ask_upright(&mut cm5, &arm_with(token));
            assert_eq!(asked, Some(outcome), "servo {} by {away}", ids[0]);
            assert_eq!(cm5.bus().any_torque(), outcome.is_ok());
        }
    }
}

/// While the CM-5 is an adapter it reads no servo: what it read before arms nothing, neither with a
/// supply that has fallen since nor towards where a servo stood.
#[test]
fn what_was_read_before_an_adapter_s_time_arms_nothing() {
    let mut cm5 = with_wheels();
    let token = greet(&mut cm5).token;
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    say(&mut cm5, &Command::KeepAlive, 300);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Bridge)), Some(Ok(())));
    let servo = cm5.bus().servo(5).unwrap();
    servo.shaft.angle_rad = Position(700).to_rad();
    servo.free = false;
    let set_supply = |cm5: &mut VirtualCm5, volts| {
        for servo in &mut cm5.bus().servos {
            servo.supply_v = volts;
        }
    };
    set_supply(&mut cm5, 8.4);
    cm5.run_ms(600.0);
    cm5.send_bytes(&[0]);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    let refused = Some(Err(Refusal::Supply));
    assert_eq!(ask(&mut cm5, &arm_with(token)), refused);
    say(&mut cm5, &Command::KeepAlive, 300);
    assert_eq!(ask(&mut cm5, &arm_with(token)), refused);
    set_supply(&mut cm5, 9.6);
    say(&mut cm5, &Command::KeepAlive, 300);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Ok(())));
    let goal = handstand_shared::control_table::GOAL_POSITION;
    assert_eq!(cm5.bus().servo(5).unwrap().get(goal), 700);
}

/// Of two frames that ask for the same the later one is answered, once; other limits need another
/// greeting.
#[test]
fn arming_that_is_said_again_goes_on() {
    let mut cm5 = VirtualCm5::new();
    let token = greet(&mut cm5).token;
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    say(&mut cm5, &Command::KeepAlive, 300);
    cm5.clear();
    let first = cm5.send(&arm_with(token));
    cm5.run_ms(15.0);
    let again = cm5.send(&arm_with(token));
    let other = cm5.send(&Command::Arm {
        token,
        limits: ArmLimits {
            torque: TorqueLimit(100),
            ..ArmLimits::FULL
        },
    });
    say(&mut cm5, &Command::KeepAlive, 600);
    let reports = cm5.reports().into_iter();
    let answers: Vec<_> = reports
        .filter_map(|(_, report)| match report {
            Report::Answer(answer) if answer.sequence >= first && answer.sequence <= other => {
                Some((answer.sequence, answer.outcome))
            }
            _ => None,
        })
        .collect();
    assert_eq!(answers, [(other, Err(Refusal::Token)), (again, Ok(()))]);
}

/// Milliseconds from the command to its answer, which is a yes.
fn armed_after_ms(cm5: &mut VirtualCm5, command: &Command) -> f64 {
    let began_ms = cm5.now_ms();
    assert_eq!(ask(cm5, command), Some(Ok(())));
    cm5.now_ms() - began_ms
}

/// Servos that need a pause between writes, and torque off that is said again and again for 200
/// ms: the limits are written behind it as soon as later.
#[test]
fn a_robot_let_go_a_moment_ago_is_armed_as_fast() {
    for wait_ms in [0, 100, 300] {
        let mut cm5 = VirtualCm5::new();
        for servo in &mut cm5.bus().servos {
            servo.faults.write_ns = 150_000;
        }
        arm(&mut cm5);
        assert_eq!(ask(&mut cm5, &Command::Disarm), Some(Ok(())));
        let token = greet(&mut cm5).token;
        say(&mut cm5, &Command::KeepAlive, wait_ms);
        let limits = ArmLimits {
            torque: TorqueLimit(200),
            speed: MovingSpeed(50),
        };
        let ms = armed_after_ms(&mut cm5, &Command::Arm { token, limits });
        assert!(ms < 112.0, "{ms} ms, {wait_ms} ms after torque went off");
    }
}

/// Thirty ticks, and the one in which it is told.
#[test]
fn a_servo_that_cannot_be_read_is_waited_for_no_longer_than_said() {
    let mut cm5 = VirtualCm5::new();
    let token = greet(&mut cm5).token;
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    say(&mut cm5, &Command::KeepAlive, 300);
    cm5.bus().servo(7).unwrap().faults.drop = 1.0;
    let ms = armed_after_ms(&mut cm5, &arm_with(token));
    assert!((300.0..310.0).contains(&ms), "{ms} ms");
    assert!(!cm5.bus().servo(7).unwrap().torque_is_on());
}
