//! The first link's attitude: as old as it may be, and the gyro in the reports.

use super::rig::*;
use handstand_cm5_sim::SimulatedCm5;
use handstand_shared::control_table::MOVING_SPEED;
use handstand_shared::message::*;
use handstand_shared::plan::{Gyro, Plan};
use handstand_shared::raw::Signed;

#[test]
fn nothing_balances_without_a_new_attitude() {
    let mut cm5 = with_wheels();
    let token = ready_to_balance(&mut cm5, &plan());
    // 40 ms later the last one is too old; the link is alive.
    say(&mut cm5, &Command::KeepAlive, 40);
    assert_eq!(
        ask(&mut cm5, &arm_with(token)),
        Some(Err(Refusal::Attitude))
    );
    assert_eq!(ask_upright(&mut cm5, &arm_with(token)), Some(Ok(())));
}

#[test]
fn nothing_balances_without_any_attitude() {
    let mut cm5 = with_wheels();
    let token = greet(&mut cm5).token;
    upload(&mut cm5, &plan());
    ask(&mut cm5, &Command::Mode(Mode::Balance));
    say(&mut cm5, &Command::KeepAlive, 300);
    assert_eq!(
        ask(&mut cm5, &arm_with(token)),
        Some(Err(Refusal::Attitude))
    );
}

#[test]
fn an_attitude_that_stays_away_lets_the_robot_down() {
    let mut cm5 = with_wheels();
    balance(&mut cm5);
    say(&mut cm5, &UPRIGHT, 200);
    assert_eq!(cm5.app.condition(), Condition::BalanceArmed);
    let (soft_ms, off_ms) = times_to_off(&mut cm5, Some(&Command::KeepAlive));
    let (soft_ms, off_ms) = (soft_ms.expect("soft"), off_ms.expect("off"));
    // The last one was sent 10 ms ago.
    assert!((20.0..=40.0).contains(&soft_ms), "{soft_ms}");
    assert!(off_ms <= 240.0, "{off_ms}");
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::AttitudeLost));
}

#[test]
fn one_attitude_in_three_is_enough() {
    let mut cm5 = with_wheels();
    balance(&mut cm5);
    for _ in 0..40 {
        cm5.send(&UPRIGHT);
        cm5.run_ms(20.0);
    }
    assert_eq!(cm5.app.condition(), Condition::BalanceArmed);
}

#[test]
fn with_a_gyro_no_attitude_is_needed() {
    let mut cm5 = with_wheels();
    let own = plan();
    let plan = Plan {
        gyro: Gyro {
            from_host: false,
            ..own.gyro
        },
        ..own
    };
    cm5.set_gyro(510);
    let token = ready_to_balance(&mut cm5, &plan);
    say(&mut cm5, &Command::KeepAlive, 100);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Ok(())));
    say(&mut cm5, &Command::KeepAlive, 200);
    assert_eq!(cm5.app.condition(), Condition::BalanceArmed);
    // 1 rad/s for long enough: it has fallen.
    cm5.set_gyro(568);
    say(&mut cm5, &Command::KeepAlive, 900);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::Fallen));
}

#[test]
fn reports_hold_the_gyro_and_telemetry_its_zero_and_scale() {
    let mut cm5 = with_wheels();
    greet(&mut cm5);
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    let before = telemetry(&mut cm5);
    assert_eq!((before.gyro_zero, before.gyro_scale), (0, 0), "no plan");
    for code in [0, 300, 1023] {
        cm5.set_gyro(code);
        cm5.run_ms(40.0);
        let reports = cm5.reports();
        let told = reports.iter().rev().find_map(|(_, report)| match report {
            Report::Stream(report) => Some(report.gyro),
            _ => None,
        });
        assert_eq!(told, Some(code));
    }
    upload(&mut cm5, &plan());
    let after = telemetry(&mut cm5);
    assert_eq!((after.gyro_zero, after.gyro_scale), (510, 279));
}

/// Turning the same way, the gyro and the host's attitude command the same way.
#[test]
fn the_gyro_s_sign_is_that_of_the_attitude() {
    let turning = |from_host: bool, sign: i16| {
        let mut cm5 = with_wheels();
        let own = plan();
        let gyro = Gyro {
            from_host,
            ..own.gyro
        };
        cm5.set_gyro(510);
        let token = ready_to_balance(&mut cm5, &Plan { gyro, ..own });
        assert_eq!(ask_upright(&mut cm5, &arm_with(token)), Some(Ok(())));
        let attitude = Attitude {
            angle: 200 * sign,
            rate: 200 * sign,
        };
        // 12 codes of 279/16 mrad/s each.
        cm5.set_gyro((510 + 12 * sign) as u16);
        say(&mut cm5, &Command::Attitude(attitude), 100);
        let commands = [1, 11].map(|id| cm5.bus().servo(id).unwrap().get(MOVING_SPEED));
        commands.map(|code| i32::from(Signed(code).get()).signum())
    };
    for sign in [1, -1] {
        let host = turning(true, sign);
        assert!(host.iter().all(|way| *way != 0), "{host:?}");
        assert_eq!(turning(false, sign), host);
    }
}

/// The zero that is told is the one measured while torque is off, and only then.
#[test]
fn the_gyro_s_zero_is_measured_while_torque_is_off() {
    let mut cm5 = with_wheels();
    let own = plan();
    let gyro = Gyro {
        from_host: false,
        ..own.gyro
    };
    cm5.set_gyro(530);
    let token = ready_to_balance(&mut cm5, &Plan { gyro, ..own });
    say(&mut cm5, &Command::KeepAlive, 3000);
    let told = telemetry(&mut cm5);
    assert_eq!((told.gyro_zero, told.gyro_scale), (530, 279));
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Ok(())));
    cm5.set_gyro(531);
    say(&mut cm5, &Command::KeepAlive, 200);
    assert_eq!(telemetry(&mut cm5).gyro_zero, 530);
    assert_eq!(cm5.app.condition(), Condition::BalanceArmed);
}
