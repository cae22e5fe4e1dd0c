//! What a low supply does.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::message::*;

/// One servo tells this supply, V.
fn tells(cm5: &mut VirtualCm5, supply_v: f64) {
    cm5.bus().servo(4).unwrap().supply_v = supply_v;
}

#[test]
fn a_supply_that_stays_low_lets_the_robot_down() {
    let mut cm5 = VirtualCm5::new();
    tells(&mut cm5, 8.8);
    arm(&mut cm5);
    say(&mut cm5, &Command::KeepAlive, 1000);
    assert_eq!(
        cm5.app.condition(),
        Condition::StreamArmed,
        "8.8 V is enough"
    );
    tells(&mut cm5, 8.7);
    let (soft_ms, off_ms) = times_to_off(&mut cm5, Some(&Command::KeepAlive));
    // Three rounds of 9 ticks each, the first of them begun already; then it fades for 160 ms.
    assert!(
        soft_ms.is_some_and(|ms| (180.0..380.0).contains(&ms)),
        "{soft_ms:?}"
    );
    assert!(off_ms.is_some_and(|ms| ms < 560.0), "{off_ms:?}");
    let fault = Condition::Fault(Cause::LowSupply);
    assert_eq!(cm5.app.condition(), fault);
}

#[test]
fn dips_of_the_supply_do_not_add_up() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    for _ in 0..6 {
        tells(&mut cm5, 8.0);
        say(&mut cm5, &Command::KeepAlive, 100);
        tells(&mut cm5, 9.6);
        say(&mut cm5, &Command::KeepAlive, 200);
        assert_eq!(cm5.app.condition(), Condition::StreamArmed);
    }
}

#[test]
fn a_low_supply_is_not_armed_with() {
    let mut cm5 = VirtualCm5::new();
    let token = greet(&mut cm5).token;
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    // Before any servo told it.
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Err(Refusal::Supply)));
    tells(&mut cm5, 8.7);
    say(&mut cm5, &Command::KeepAlive, 250);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Err(Refusal::Supply)));
    tells(&mut cm5, 8.8);
    say(&mut cm5, &Command::KeepAlive, 250);
    assert_eq!(ask(&mut cm5, &arm_with(token)), Some(Ok(())));
}

/// An adapter reads nothing: what it knew of the supply before is old. A change between other modes
/// forgets nothing.
#[test]
fn an_adapter_forgets_the_supply() {
    let mut cm5 = VirtualCm5::new();
    let mut arm_after = |mode: Mode| {
        let token = greet(&mut cm5).token;
        for mode in [mode, Mode::Stream] {
            assert_eq!(ask(&mut cm5, &Command::Mode(mode)), Some(Ok(())));
        }
        let outcome = ask(&mut cm5, &arm_with(token));
        ask(&mut cm5, &Command::Disarm);
        cm5.run_ms(20.0);
        greet(&mut cm5);
        assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
        cm5.run_ms(400.0);
        outcome
    };
    arm_after(Mode::Stream);
    // The supply is known; modes are asked again.
    let known = Some(Err(Refusal::ServoMode));
    assert_eq!(arm_after(Mode::Balance), known);
    assert_eq!(arm_after(Mode::Bridge), Some(Err(Refusal::Supply)));
    assert_eq!(arm_after(Mode::Stream), known);
}

/// Whatever the servo list's length, and with it that of a round.
#[test]
fn a_dip_of_a_tenth_of_a_second_stops_no_robot_of_one_servo() {
    for (dip_ms, stops) in [(100, false), (190, false), (260, true)] {
        let mut cm5 = VirtualCm5::new();
        greet(&mut cm5);
        let list = ServoList {
            count: 1,
            ..ServoList::default()
        };
        ask(&mut cm5, &Command::Mode(Mode::Stream));
        assert_eq!(ask(&mut cm5, &Command::ServoList(list)), Some(Ok(())));
        arm(&mut cm5);
        let set = |cm5: &mut VirtualCm5, volts| cm5.bus().servo(1).unwrap().supply_v = volts;
        set(&mut cm5, 8.0);
        say(&mut cm5, &Command::KeepAlive, dip_ms);
        set(&mut cm5, 9.6);
        say(&mut cm5, &Command::KeepAlive, 50);
        let is_soft = cm5.app.condition() == Condition::Soft;
        assert_eq!(is_soft, stops, "{dip_ms} ms: {:?}", cm5.app.condition());
    }
}
