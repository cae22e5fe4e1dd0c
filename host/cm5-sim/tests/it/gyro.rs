//! A gyro that is not there, or not at rest.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::message::*;

fn ready() -> (VirtualCm5, u16) {
    let mut cm5 = with_wheels();
    let token = ready_to_balance(&mut cm5, &gyro_plan());
    (cm5, token)
}

#[test]
fn a_gyro_that_is_not_there_or_far_off_arms_nothing() {
    for (code, outcome) in [
        (512, Ok(())),
        (462, Ok(())),
        (562, Ok(())),
        (461, Err(Refusal::Gyro)),
        (563, Err(Refusal::Gyro)),
        (0, Err(Refusal::Gyro)),
        (5, Err(Refusal::Gyro)),
        (1023, Err(Refusal::Gyro)),
    ] {
        let (mut cm5, token) = ready();
        cm5.set_gyro(code);
        say(&mut cm5, &Command::KeepAlive, 3000);
        let asked = ask(&mut cm5, &arm_with(token));
        assert_eq!(asked, Some(outcome), "{code}");
        say(&mut cm5, &Command::KeepAlive, 100);
        assert_eq!(cm5.bus().any_torque(), outcome.is_ok(), "{code}");
    }
}

/// A code more or less is the ADC's noise; 10 degrees/s to and fro are somebody's hands.
#[test]
fn a_gyro_that_is_not_at_rest_arms_nothing() {
    for (swing, outcome) in [
        (1, Ok(())),
        (10, Ok(())),
        (11, Err(Refusal::Gyro)),
        (30, Err(Refusal::Gyro)),
    ] {
        let (mut cm5, token) = ready();
        for step in 0..40 {
            let off = if step % 2 == 0 { swing } else { 0 };
            cm5.set_gyro(506 + off * 2);
            say(&mut cm5, &Command::KeepAlive, 10);
        }
        cm5.send(&arm_with(token));
        let mut outcomes = Vec::new();
        for step in 0..20 {
            let off = if step % 2 == 0 { swing } else { 0 };
            cm5.set_gyro(506 + off * 2);
            say(&mut cm5, &Command::KeepAlive, 10);
            outcomes.extend(
                cm5.reports()
                    .into_iter()
                    .filter_map(|(_, report)| match report {
                        Report::Answer(answer) => Some(answer.outcome),
                        _ => None,
                    }),
            );
        }
        assert_eq!(outcomes.last(), Some(&outcome), "{swing}");
    }
}

#[test]
fn a_gyro_at_a_rail_while_balancing_lets_the_robot_down() {
    for code in [0, 7, 1016, 1023] {
        let (mut cm5, token) = ready();
        assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Ok(())));
        say(&mut cm5, &Command::KeepAlive, 100);
        assert_eq!(cm5.app.condition(), Condition::BalanceArmed);
        cm5.set_gyro(code);
        say(&mut cm5, &Command::KeepAlive, 30);
        assert_eq!(cm5.app.condition(), Condition::Soft, "{code}");
        say(&mut cm5, &Command::KeepAlive, 200);
        let fault = Condition::Fault(Cause::AttitudeLost);
        assert_eq!(cm5.app.condition(), fault, "{code}");
    }
}

/// A robot that leans or turns is not at its pose, whoever says so.
#[test]
fn a_first_link_that_leans_or_turns_is_not_balanced() {
    for (angle, rate, outcome) in [
        (1745, 0, Ok(())),
        (-1745, 1000, Ok(())),
        (1746, 0, Err(Refusal::Pose)),
        (0, 1001, Err(Refusal::Pose)),
        (0, i16::MIN, Err(Refusal::Pose)),
    ] {
        let mut cm5 = with_wheels();
        let token = ready_to_balance(&mut cm5, &plan());
        let there = Command::Attitude(Attitude { angle, rate });
        say(&mut cm5, &there, 50);
        cm5.clear();
        let sequence = cm5.send(&arm_with(token));
        say(&mut cm5, &there, 250);
        let answered = cm5
            .reports()
            .into_iter()
            .find_map(|(_, report)| match report {
                Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome),
                _ => None,
            });
        assert_eq!(answered, Some(outcome), "{angle}, {rate}");
    }
}
