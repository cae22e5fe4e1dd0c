//! Plans in EEPROM: what is not whole is not balanced with.

use super::rig::*;
use handstand_cm5_sim::{SimulatedCm5, VirtualCm5};
use handstand_shared::crc::crc32;
use handstand_shared::message::*;

/// Where the slots begin, and their headers' bytes before the plan's.
const SLOTS: [usize; 2] = [0x010, 0x840];
const HEADER: usize = 8;

#[test]
fn a_plan_that_arrived_wrong_is_not_kept() {
    let mut cm5 = VirtualCm5::new();
    greet(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    let table = bytes(&plan());
    for (offset, piece) in (0..).step_by(PLAN_CHUNK).zip(table.chunks(PLAN_CHUNK)) {
        let mut bytes = [0; PLAN_CHUNK];
        bytes[..piece.len()].copy_from_slice(piece);
        let chunk = Command::PlanChunk { offset, bytes };
        assert_eq!(ask(&mut cm5, &chunk), Some(Ok(())));
    }
    let (length, check) = (table.len() as u16, crc32(&table));
    for (length, check) in [(length, check ^ 1), (length - 1, check), (length, !check)] {
        let store = Command::PlanStore { length, check };
        assert_eq!(ask(&mut cm5, &store), Some(Err(Refusal::BadPlan)));
        cm5.run_ms(500.0);
        assert_eq!(greet(&mut cm5).plan, 0);
    }
    let store = Command::PlanStore { length, check };
    assert_eq!(ask(&mut cm5, &store), Some(Ok(())));
    assert_ne!(greet(&mut cm5).plan, 0);
}

#[test]
fn a_plan_that_was_spoilt_is_not_loaded() {
    let mut cm5 = VirtualCm5::new();
    greet(&mut cm5);
    upload(&mut cm5, &plan());
    let eeprom = cm5.board.eeprom.clone();
    let fingerprint = greet(&mut cm5).plan;
    let plan_of = |eeprom: Vec<u8>| {
        let mut cm5 = VirtualCm5::boot(eeprom, ResetCause(ResetCause::POWER));
        cm5.run_ms(250.0);
        greet(&mut cm5).plan
    };
    assert_eq!(plan_of(eeprom.clone()), fingerprint);
    let length = bytes(&plan()).len();
    for at in (0..HEADER + length).step_by(3) {
        let mut spoilt = eeprom.clone();
        for slot in SLOTS {
            spoilt[slot + at] ^= 1;
        }
        assert_eq!(plan_of(spoilt), 0, "byte {at}");
    }
}
