//! The number of a start, which no start before it had.

use super::rig::*;
use handstand_cm5_sim::{Bus, HostBoard, SimulatedCm5, VirtualCm5};
use handstand_firmware::boot_counter::count;
use handstand_shared::message::ResetCause;

/// Where its cells lie.
const CELLS: std::ops::Range<usize> = 0x800..0x840;

/// Each start's number is the next one, however often it starts, and a cell is written in turn.
#[test]
fn starts_are_numbered_one_after_the_other() {
    let mut board = HostBoard::new(Bus::new([]));
    // As an erased EEPROM has it: the next start wraps.
    let first = count(&mut board);
    assert_eq!(first, 0);
    for number in 1..16_384u32 + 200 {
        let before = board.eeprom.clone();
        assert_eq!(u32::from(count(&mut board)), number % 16_384);
        let changed: Vec<usize> = (0..before.len())
            .filter(|at| before[*at] != board.eeprom[*at])
            .collect();
        assert_eq!(changed, [CELLS.start + number as usize % 64], "{number}");
    }
}

/// A cell that a power cut tore is written again.
#[test]
fn a_torn_cell_is_written_again() {
    let mut board = HostBoard::new(Bus::new([]));
    let numbers: Vec<u16> = (0..10).map(|_| count(&mut board)).collect();
    assert_eq!(numbers, (0..10).collect::<Vec<u16>>());
    board.eeprom[CELLS.start + 9] = 0x5a;
    assert_eq!(count(&mut board), 9);
    assert_eq!(count(&mut board), 10);
}

/// No token of a start is one of the starts before it.
#[test]
fn tokens_carry_the_start_s_number() {
    let mut eeprom = vec![0xff; 4096];
    let mut tokens = Vec::new();
    for _ in 0..300 {
        let mut cm5 = VirtualCm5::boot(eeprom, ResetCause(ResetCause::POWER));
        cm5.run_ms(30.0);
        tokens.push(greet(&mut cm5).token);
        eeprom = std::mem::take(&mut cm5.board.eeprom);
    }
    let starts = tokens.iter().map(|token| token.to_le_bytes()[1]);
    let wanted = (0..300u16).map(|start| start as u8);
    assert!(starts.eq(wanted), "{tokens:?}");
}
