//! What arming needs.

use super::{arm_with, greet, refused};
use handstand_measure::bench::*;
use handstand_shared::message::*;

#[test]
fn arming_needs_a_greeting_a_token_a_state_and_a_supply() {
    let mut rig = VirtualCm5::new();
    rig.send_bytes(&[0]);
    assert_eq!(refused(&mut rig, arm_with(1)), Some(Refusal::Version));
    let token = greet(&mut rig).token;
    rig.send_bytes(&[0]);
    assert_eq!(refused(&mut rig, arm_with(token ^ 1)), Some(Refusal::Token));
    assert_eq!(refused(&mut rig, Command::Mode(Mode::Stream)), None);
    assert_eq!(refused(&mut rig, arm_with(token)), Some(Refusal::Supply));
    rig.bus().servo(4).unwrap().supply_v = 8.0;
    rig.run_ms(300.0);
    assert_eq!(refused(&mut rig, arm_with(token)), Some(Refusal::Supply));
    rig.bus().servo(4).unwrap().supply_v = 9.5;
    rig.run_ms(300.0);
    assert_eq!(refused(&mut rig, arm_with(token)), None);
    assert!(rig.bus().any_torque());
}

#[test]
fn after_the_watchdog_nothing_arms_without_a_greeting() {
    let mut rig = VirtualCm5::boot(vec![0xff; 4096], ResetCause(ResetCause::WATCHDOG));
    rig.run_ms(50.0);
    let hello = greet(&mut rig);
    assert_eq!(hello.condition, Condition::Fault(Cause::Watchdog));
    assert_eq!(
        refused(&mut rig, arm_with(hello.token)),
        Some(Refusal::State)
    );
    arm(&mut rig);
}

#[test]
fn no_start_and_no_greeting_repeats_a_token() {
    let mut eeprom = vec![0xff; 4096];
    let mut tokens = std::collections::BTreeSet::new();
    for start in 0..200 {
        // Now and then the power fails while the cell of this start is written.
        if start % 20 == 7 {
            eeprom[0x800 + start % 64] = 0x5a;
        }
        let mut rig = VirtualCm5::boot(eeprom, ResetCause(ResetCause::POWER));
        rig.run_ms(20.0);
        for _ in 0..3 {
            rig.send_bytes(&[0]);
            let token = greet(&mut rig).token;
            assert!(tokens.insert(token), "{token:#06x} again, start {start}");
        }
        eeprom = rig.board.eeprom;
    }
    let untouched = |range: std::ops::Range<usize>| eeprom[range].iter().all(|byte| *byte == 0xff);
    assert!(untouched(0..0x800) && untouched(0x840..4096));
}
