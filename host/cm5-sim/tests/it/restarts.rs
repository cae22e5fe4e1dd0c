//! Servos that restart, or miss a packet, under torque: their registers are not what they were
//! written.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{
    GOAL_POSITION, MOVING_SPEED, STATUS_LEVEL, TORQUE_ENABLE, TORQUE_LIMIT,
};
use handstand_shared::message::*;
use handstand_shared::packed::{Positions, SERVOS, Speeds};
use handstand_shared::raw::{MovingSpeed, Position, TorqueLimit};

const LIMITS: ArmLimits = ArmLimits {
    torque: TorqueLimit(200),
    speed: MovingSpeed(50),
};

/// The command to arm within these limits.
fn within_limits(token: u16) -> Command {
    Command::Arm {
        token,
        limits: LIMITS,
    }
}

fn ready(cm5: &mut VirtualCm5) -> u16 {
    let token = greet(cm5).token;
    assert_eq!(ask(cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    say(cm5, &Command::KeepAlive, 300);
    token
}

fn armed_within(limits: ArmLimits) -> VirtualCm5 {
    let mut cm5 = VirtualCm5::new();
    let token = ready(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::Arm { token, limits }), Some(Ok(())));
    cm5
}

fn goals(code: u16) -> Command {
    Command::Goals(Positions::pack([code; SERVOS]))
}

/// At every phase of the rounds in which the registers are read.
#[test]
fn a_servo_that_restarts_under_goals_is_noticed() {
    for limits in [LIMITS, ArmLimits::FULL] {
        for phase in 0..18 {
            let id = 1 + phase;
            let mut cm5 = armed_within(limits);
            say(&mut cm5, &goals(540), 100 + 10 * u32::from(phase));
            cm5.bus().servo(id).unwrap().restart();
            say(&mut cm5, &goals(540), 200);
            let fault = Condition::Fault(Cause::TorqueLost);
            let condition = cm5.app.condition();
            assert!([Condition::Soft, fault].contains(&condition), "{phase}");
            say(&mut cm5, &goals(540), 200);
            assert_eq!(cm5.app.condition(), fault, "{phase}");
            assert!(!cm5.bus().any_torque());
            let tripped = telemetry(&mut cm5).tripped;
            assert_eq!(tripped, Some(TrippedServo { id, error: 0 }));
        }
    }
}

/// One whose registers are what they were: it was its line that was broken.
#[test]
fn a_servo_that_was_silent_is_commanded_from_where_it_stands() {
    let mut cm5 = armed_within(LIMITS);
    say(&mut cm5, &goals(512), 100);
    let servo = cm5.bus().servo(7).unwrap();
    servo.faults.dead = true;
    servo.free = false;
    say(&mut cm5, &goals(700), 150);
    let servo = cm5.bus().servo(7).unwrap();
    servo.faults.dead = false;
    servo.shaft.angle_rad = Position(312).to_rad();
    let mut before = servo.get(GOAL_POSITION);
    let mut farthest = 0;
    for _ in 0..10 {
        say(&mut cm5, &goals(700), 10);
        let goal = cm5.bus().servo(7).unwrap().get(GOAL_POSITION);
        if goal != before {
            // From where it stands, not from where it would be by now.
            farthest = farthest.max(goal);
        }
        before = goal;
    }
    assert_eq!(cm5.app.condition(), Condition::StreamArmed);
    assert!((313..=512).contains(&farthest), "goals up to {farthest}");
}

/// Away for long, and restarted: it gets no goal before it is noticed.
#[test]
fn a_servo_that_restarts_while_it_is_silent_gets_no_goal() {
    let mut cm5 = armed_within(ArmLimits::FULL);
    say(&mut cm5, &goals(600), 100);
    let servo = cm5.bus().servo(7).unwrap();
    servo.faults.dead = true;
    servo.restart();
    say(&mut cm5, &goals(600), 100);
    cm5.bus().servo(7).unwrap().faults.dead = false;
    for _ in 0..40 {
        say(&mut cm5, &goals(600), 10);
        assert!(!cm5.bus().servo(7).unwrap().torque_is_on());
    }
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::TorqueLost));
}

/// Its speed is a command, of which nothing is known: the torque limit tells.
#[test]
fn a_wheel_that_restarts_under_goals_is_noticed() {
    let mut cm5 = with_wheels();
    let token = ready(&mut cm5);
    let arm = within_limits(token);
    assert_eq!(ask(&mut cm5, &arm), Some(Ok(())));
    say(&mut cm5, &goals(540), 100);
    cm5.bus().servo(DRIVEN[0]).unwrap().restart();
    say(&mut cm5, &goals(540), 400);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::TorqueLost));
}

/// Whichever packet of arming a servo misses, none has torque beyond its limits.
#[test]
fn no_servo_is_switched_on_beyond_the_limits_of_arming() {
    for share in [0.3, 0.6, 0.9] {
        let mut armed = 0;
        for seed in 0..20 {
            let mut cm5 = VirtualCm5::new();
            let token = ready(&mut cm5);
            for at in [3, 9, 15] {
                let servo = &mut cm5.bus().servos[at];
                servo.faults = handstand_cm5_sim::Faults::none(seed * 18 + at as u64);
                servo.faults.corrupt_request = share;
            }
            let arm = within_limits(token);
            cm5.send(&arm);
            for _ in 0..60 {
                say(&mut cm5, &Command::KeepAlive, 10);
                for servo in cm5.bus().servos.iter().filter(|servo| servo.torque_is_on()) {
                    let limits = [TORQUE_LIMIT, MOVING_SPEED].map(|register| servo.get(register));
                    let is_within = limits[0] <= 200 && (1..=50).contains(&limits[1]);
                    assert!(is_within, "servo {}: {limits:?}", servo.id());
                    armed += 1;
                }
            }
        }
        assert!(share > 0.5 || armed > 0, "some are armed at {share}");
    }
}

/// It would come on with its factory's limits.
#[test]
fn a_servo_that_takes_no_limits_is_not_armed_with() {
    let mut cm5 = VirtualCm5::new();
    let token = ready(&mut cm5);
    cm5.bus().servo(4).unwrap().faults.ignore_writes = true;
    let refused = ask(&mut cm5, &within_limits(token));
    assert_eq!(refused, Some(Err(Refusal::Registers)));
    assert!(!cm5.bus().any_torque());
    cm5.bus().servo(4).unwrap().faults.ignore_writes = false;
    say(&mut cm5, &Command::KeepAlive, 100);
    assert_eq!(ask(&mut cm5, &within_limits(token)), Some(Ok(())));
}

/// Writes that come too close to the one before are ignored by the servo.
#[test]
fn servos_that_need_a_pause_between_writes_are_armed_within_the_limits() {
    let mut cm5 = VirtualCm5::new();
    for servo in &mut cm5.bus().servos {
        servo.faults.write_ns = 150_000;
    }
    let token = ready(&mut cm5);
    assert_eq!(ask(&mut cm5, &within_limits(token)), Some(Ok(())));
    say(&mut cm5, &goals(560), 200);
    assert_eq!(cm5.app.condition(), Condition::StreamArmed);
    for servo in &cm5.bus().servos {
        let held = [TORQUE_ENABLE, GOAL_POSITION, MOVING_SPEED, TORQUE_LIMIT];
        let held = held.map(|register| servo.get(register));
        assert_eq!(held, [1, 560, 50, 200], "servo {}", servo.id());
    }
}

/// Asked again until it is known: an unknown one would have no speed limit.
#[test]
fn no_lost_answer_lifts_a_speed_limit() {
    for seed in 0..20 {
        let mut cm5 = VirtualCm5::new();
        for (at, servo) in (0u64..).zip(&mut cm5.bus().servos) {
            servo.faults = handstand_cm5_sim::Faults::none(seed * 18 + at);
            servo.faults.drop = 0.02;
        }
        let token = ready(&mut cm5);
        let arm = within_limits(token);
        let armed = ask(&mut cm5, &arm);
        if armed != Some(Ok(())) {
            assert_eq!(armed, Some(Err(Refusal::ServoMode)));
            continue;
        }
        for servo in cm5.bus().servos.iter().filter(|servo| servo.torque_is_on()) {
            assert_eq!(servo.get(MOVING_SPEED), 50, "servo {}", servo.id());
        }
    }
}

#[test]
fn a_servo_whose_mode_is_not_known_is_not_armed_with() {
    let mut cm5 = VirtualCm5::new();
    let token = ready(&mut cm5);
    // All are asked again, one a tick.
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    say(&mut cm5, &Command::KeepAlive, 100);
    let arm = arm_with(token);
    assert_eq!(ask(&mut cm5, &arm), Some(Err(Refusal::ServoMode)));
    // One that is not there need not say it.
    cm5.bus().servo(18).unwrap().set(STATUS_LEVEL, 0);
    say(&mut cm5, &Command::KeepAlive, 100);
    assert_eq!(ask(&mut cm5, &arm), Some(Ok(())));
}

/// Two servos of one id are never heard whole for long: they are left out, and the others armed.
#[test]
fn two_servos_of_one_id_are_left_out() {
    let mut cm5 = VirtualCm5::new();
    *cm5.bus() = handstand_cm5_sim::Bus::new((1..=18).chain([5]));
    let token = ready(&mut cm5);
    assert_eq!(ask(&mut cm5, &within_limits(token)), Some(Ok(())));
    for servo in &cm5.bus().servos {
        assert_eq!(
            servo.torque_is_on(),
            servo.id() != 5,
            "servo {}",
            servo.id()
        );
    }
}

/// Speeds are commands of wheels; to a joint 0 would be no limit.
#[test]
fn speeds_are_no_limits_of_joints() {
    let mut cm5 = with_wheels();
    let token = ready(&mut cm5);
    assert_eq!(ask(&mut cm5, &within_limits(token)), Some(Ok(())));
    for code in [0, 300] {
        say(&mut cm5, &Command::Speeds(Speeds::pack([code; SERVOS])), 50);
        for servo in &cm5.bus().servos {
            let is_wheel = DRIVEN.contains(&servo.id());
            let expected = if is_wheel { code } else { 50 };
            assert_eq!(servo.get(MOVING_SPEED), expected, "servo {}", servo.id());
        }
    }
    // Nor when they stop.
    cm5.run_ms(150.0);
    assert_eq!(cm5.app.condition(), Condition::Soft);
    assert_eq!(cm5.bus().servo(5).unwrap().get(MOVING_SPEED), 50);
}

/// It is let go with the first, and the limits that fall do not wake it.
#[test]
fn a_second_servo_that_gives_up_while_torque_falls_is_not_woken() {
    let mut cm5 = armed_within(ArmLimits::FULL);
    say(&mut cm5, &Command::KeepAlive, 100);
    cm5.bus().servo(7).unwrap().overload();
    while cm5.app.condition() == Condition::StreamArmed {
        say(&mut cm5, &Command::KeepAlive, 10);
    }
    assert_eq!(cm5.app.condition(), Condition::Soft);
    let second = cm5.bus().servo(9).unwrap();
    second.set(handstand_shared::control_table::SHUTDOWN, 0);
    second.overload();
    say(&mut cm5, &Command::KeepAlive, 30);
    for _ in 0..10 {
        assert!(!cm5.bus().servo(9).unwrap().torque_is_on());
        say(&mut cm5, &Command::KeepAlive, 10);
    }
}

#[test]
fn a_servo_that_is_too_hot_is_not_armed_with() {
    let mut cm5 = VirtualCm5::new();
    let token = ready(&mut cm5);
    cm5.bus().servo(4).unwrap().temperature = 90.0;
    say(&mut cm5, &Command::KeepAlive, 50);
    let arm = arm_with(token);
    assert_eq!(ask(&mut cm5, &arm), Some(Err(Refusal::ServoError)));
    assert!(!cm5.bus().any_torque());
    cm5.bus().servo(4).unwrap().temperature = 30.0;
    say(&mut cm5, &Command::KeepAlive, 50);
    assert_eq!(ask(&mut cm5, &arm), Some(Ok(())));
}
