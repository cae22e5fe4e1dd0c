//! Commands that take long, one right behind the other: times are those of the clock all the same,
//! which wraps after 32.8 ms.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::control_table::{TORQUE_ENABLE, TORQUE_LIMIT};
use handstand_shared::message::*;

/// A plan that is not what it should be: all of it is read to know.
const WRONG_PLAN: Command = Command::PlanStore {
    length: 1200,
    check: 1,
};

/// Says it as fast as the line takes it, for so long.
fn flood(cm5: &mut VirtualCm5, command: &Command, ms: f64, until: impl Fn(&VirtualCm5) -> bool) {
    let end_ms = cm5.now_ms() + ms;
    while cm5.now_ms() < end_ms && !until(cm5) {
        while cm5.board.last_byte_ns() < cm5.board.now_ns() + 20_000_000 {
            cm5.send(command);
        }
        cm5.run_ms(0.5);
    }
}

/// An attitude is as old as it is when commands behind it took longer than the clock's range.
#[test]
fn no_flood_makes_an_attitude_younger() {
    let (mut begun, mut refused) = (0, 0);
    for count in 0..16 {
        let mut cm5 = with_wheels();
        let token = ready_to_balance(&mut cm5, &plan());
        cm5.board.take_time();
        say(&mut cm5, &UPRIGHT, 200);
        cm5.clear();
        cm5.send(&UPRIGHT);
        let said_ms = cm5.board.last_byte_ns() as f64 * 1e-6;
        for _ in 0..count {
            cm5.send(&WRONG_PLAN);
        }
        let sequence = cm5.send(&arm_with(token));
        // Arming that goes on uses the token up.
        while cm5.app.used_token().is_none() && cm5.now_ms() < said_ms + 500.0 {
            cm5.run_ms(0.1);
        }
        let age_ms = cm5.now_ms() - said_ms;
        if cm5.app.used_token().is_some() {
            begun += 1;
            assert!(age_ms <= 30.5, "{count} plans: arms by one of {age_ms} ms");
            continue;
        }
        let mut reports = cm5.reports().into_iter();
        let answer = reports.find_map(|(_, report)| match report {
            Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome),
            _ => None,
        });
        refused += 1;
        // Ticks that were late are another reason.
        let late = [Some(Err(Refusal::Attitude)), Some(Err(Refusal::Overrun))];
        // The queue of 127 bytes has no room for more than nine frames: the one that arms is lost.
        let is_lost = answer.is_none() && count > 9;
        assert!(
            is_lost || late.contains(&answer),
            "{count} plans: {answer:?}"
        );
    }
    assert!(
        begun >= 2 && refused >= 8,
        "{begun} begun, {refused} refused"
    );
}

/// Whatever is asked meanwhile, and however long it takes: soft in 100 ms, off in 300.
#[test]
fn no_flood_puts_off_the_let_down() {
    for command in [
        Command::Ask(Subject::Telemetry),
        Command::Ask(Subject::Statistics),
        Command::PlanRead { offset: 0 },
        Command::FaultRead { back: 0 },
        WRONG_PLAN,
    ] {
        for phase in 0..10 {
            let mut cm5 = VirtualCm5::new();
            arm(&mut cm5);
            cm5.board.take_time();
            say(&mut cm5, &Command::KeepAlive, 100);
            cm5.run_ms(f64::from(phase));
            cm5.send(&Command::KeepAlive);
            let life_ns = cm5.board.last_byte_ns();
            flood(&mut cm5, &command, 1000.0, |cm5| {
                cm5.app.condition() == Condition::Soft
            });
            let soft_ns = cm5.bus().last_write_ns(TORQUE_LIMIT).expect("it fades");
            flood(&mut cm5, &command, 1000.0, |cm5| !cm5.app.is_armed());
            let off_ns = cm5.bus().last_write_ns(TORQUE_ENABLE).expect("it is off");
            assert!(!cm5.bus().any_torque(), "{command:?}");
            let [soft_ms, off_ms] = [soft_ns, off_ns].map(|ns| (ns - life_ns) as f64 * 1e-6);
            assert!(
                soft_ms <= 100.0 && off_ms <= 300.0,
                "{command:?}, phase {phase}: soft after {soft_ms} ms, off after {off_ms}"
            );
        }
    }
}
