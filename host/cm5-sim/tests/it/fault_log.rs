//! The fault log, which outlasts restarts and power cuts.

use super::rig::*;
use handstand_cm5_sim::{HostBoard, SimulatedCm5, VirtualCm5};
use handstand_firmware::fault_log::ENTRIES;
use handstand_shared::message::*;

/// Where the firmware keeps it.
const EEPROM: std::ops::Range<usize> = 0x700..0x800;

/// Entry `back`, as the CM-5 tells it.
fn entry(cm5: &mut VirtualCm5, back: u8) -> Option<FaultEntry> {
    cm5.clear();
    // To an adapter a zero tells that this is no servo packet.
    cm5.send_bytes(&[0]);
    cm5.send(&Command::FaultRead { back });
    cm5.run_ms(60.0);
    let mut reports = cm5.reports().into_iter();
    let told = reports.find_map(|(_, report)| match report {
        Report::Fault { back: told, entry } if told == back => Some(entry),
        _ => None,
    });
    told.expect("an answer")
}

/// Arms, and falls silent until torque is off and the entry is written.
fn lose_the_line(cm5: &mut VirtualCm5) {
    arm(cm5);
    cm5.run_ms(600.0);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::LinkLost));
}

/// The same EEPROM in a controller that starts.
fn restarted(mut cm5: VirtualCm5, cause: u8) -> VirtualCm5 {
    let mut board = HostBoard::new(handstand_cm5_sim::Bus::new(1..=18));
    board.eeprom = std::mem::take(&mut cm5.board.eeprom);
    board.reset_cause = ResetCause(cause);
    let mut cm5 = VirtualCm5::start(board);
    cm5.run_ms(250.0);
    cm5
}

#[test]
fn faults_are_kept_with_cause_tick_and_state() {
    let mut cm5 = VirtualCm5::new();
    cm5.run_ms(50.0);
    assert_eq!(entry(&mut cm5, 0), None);
    lose_the_line(&mut cm5);
    let lost = entry(&mut cm5, 0).expect("a fault");
    assert_eq!(lost.cause, Cause::LinkLost);
    assert_eq!(lost.condition, Condition::StreamArmed);
    let last = telemetry(&mut cm5).ticks;
    assert!(
        (last - 70..last - 40).contains(&lost.tick),
        "{lost:?} of {last}"
    );
    assert_eq!(entry(&mut cm5, 1), None);

    let mut cm5 = restarted(cm5, ResetCause::WATCHDOG);
    let restart = entry(&mut cm5, 0).expect("a fault");
    assert_eq!(restart.cause, Cause::Watchdog);
    assert_eq!(restart.condition, Condition::Fault(Cause::Watchdog));
    assert_eq!(restart.tick, 0);
    assert_eq!(restart.start, lost.start.wrapping_add(1));
    assert_eq!(entry(&mut cm5, 1), Some(lost));

    // A start that nothing went wrong before adds nothing.
    let mut cm5 = restarted(cm5, ResetCause::POWER);
    assert_eq!(entry(&mut cm5, 0), Some(restart));
}

#[test]
fn a_fault_while_balancing_says_so_and_once() {
    let mut cm5 = with_wheels();
    balance(&mut cm5);
    cm5.run_ms(600.0);
    let soft = entry(&mut cm5, 0).expect("a fault");
    assert_eq!(soft.cause, Cause::AttitudeLost);
    assert_eq!(soft.condition, Condition::BalanceArmed);
    // Torque off at the end of the let-down is no second fault.
    assert_eq!(entry(&mut cm5, 1), None);

    let token = greet(&mut cm5).token;
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Balance)), Some(Ok(())));
    say(&mut cm5, &UPRIGHT, 300);
    assert_eq!(ask_upright(&mut cm5, &arm_with(token)), Some(Ok(())));
    let fallen = Command::Attitude(Attitude {
        angle: 9000,
        rate: 0,
    });
    say(&mut cm5, &fallen, 300);
    let entry_0 = entry(&mut cm5, 0).expect("a fault");
    assert_eq!(entry_0.cause, Cause::Fallen);
    assert_eq!(entry_0.condition, Condition::BalanceArmed);
    assert_eq!(entry(&mut cm5, 1), Some(soft));
}

#[test]
fn what_the_host_asks_for_is_no_fault() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::LetDown), Some(Ok(())));
    cm5.run_ms(600.0);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::LetDown));
    assert_eq!(entry(&mut cm5, 0), None);
}

#[test]
fn it_is_not_read_while_armed() {
    let mut cm5 = VirtualCm5::new();
    arm(&mut cm5);
    let answer = ask(&mut cm5, &Command::FaultRead { back: 0 });
    assert_eq!(answer, Some(Err(Refusal::Armed)));
}

#[test]
fn the_oldest_make_room_and_sequence_numbers_wrap() {
    let mut cm5 = VirtualCm5::new();
    let mut kept = Vec::new();
    for round in 0..300 {
        cm5 = restarted(cm5, ResetCause::WATCHDOG);
        kept.insert(0, entry(&mut cm5, 0).expect("a fault"));
        kept.truncate(usize::from(ENTRIES));
        if round % 37 == 0 || round == 299 {
            for (back, known) in (0..).zip(&kept) {
                assert_eq!(entry(&mut cm5, back), Some(*known), "{round}: {back}");
            }
            let beyond = kept.len() as u8;
            assert_eq!(entry(&mut cm5, beyond), None, "{round}");
            assert_eq!(entry(&mut cm5, 255), None, "{round}");
        }
    }
}

/// Whatever byte a power cut tears: the entries before stay, and the torn one is none.
#[test]
fn a_torn_entry_is_none() {
    let mut cm5 = VirtualCm5::new();
    lose_the_line(&mut cm5);
    let lost = entry(&mut cm5, 0);
    let before = cm5.board.eeprom.clone();
    let mut cm5 = restarted(cm5, ResetCause::WATCHDOG);
    let after = cm5.board.eeprom.clone();
    let written: Vec<usize> = EEPROM.filter(|at| before[*at] != after[*at]).collect();
    assert!(written.len() > 8, "{written:?}");
    for torn in written {
        let mut eeprom = before.clone();
        eeprom[EEPROM.start..torn].copy_from_slice(&after[EEPROM.start..torn]);
        eeprom[torn] = 0x5a ^ after[torn];
        cm5.board.eeprom = eeprom;
        cm5 = restarted(cm5, ResetCause::POWER);
        assert_eq!(entry(&mut cm5, 0), lost, "torn at {torn:#x}");
    }
}

/// It is told at once, though a byte of it is written in each tick.
#[test]
fn a_fault_is_told_before_it_is_written() {
    let mut cm5 = with_wheels();
    balance(&mut cm5);
    say(&mut cm5, &FALLEN, 20);
    assert_eq!(cm5.app.condition(), Condition::Fault(Cause::Fallen));
    let told = entry(&mut cm5, 0).expect("a fault");
    assert_eq!(told.cause, Cause::Fallen);
    assert!(
        cm5.board.eeprom[EEPROM]
            .iter()
            .filter(|byte| **byte != 0xff)
            .count()
            < 10
    );
    cm5.run_ms(300.0);
    assert_eq!(entry(&mut cm5, 0), Some(told));
}
