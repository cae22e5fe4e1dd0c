//! Plans in EEPROM: what is not whole is not balanced with.

use super::rig::*;
use handstand_cm5_sim::{Bus, HostBoard, SimulatedCm5, VirtualCm5};
use handstand_firmware::plan_store::{MAX_TABLE, Stored, Writer};
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

/// A slot as `docs/firmware.md` has it: sequence, length, CRC-32 of table, length and sequence.
fn slot(sequence: u16, table: &[u8]) -> Vec<u8> {
    let length = (table.len() as u16).to_le_bytes();
    let sequence = sequence.to_le_bytes();
    let check = crc32(&[table, &length, &sequence].concat()).to_le_bytes();
    [&sequence, &length, &check[..], table].concat()
}

/// A board whose EEPROM holds these slots.
fn holding(slots: [Option<&[u8]>; 2]) -> HostBoard {
    let mut board = HostBoard::new(Bus::new([]));
    for (start, slot) in SLOTS.into_iter().zip(slots) {
        let bytes = slot.unwrap_or(&[]);
        board.eeprom[start..start + bytes.len()].copy_from_slice(bytes);
    }
    board
}

/// The table that counts.
fn newest(board: &mut HostBoard) -> Option<Vec<u8>> {
    let stored = Stored::newest(board)?;
    Some((0..).map_while(|at| stored.byte(board, at)).collect())
}

#[test]
fn the_newer_of_two_slots_counts() {
    let (first, second) = ([1, 2, 3], [4, 5]);
    // Numbers wrap: the newer one is less than half the circle ahead.
    for (a, b, is_second) in [
        (1, 2, true),
        (2, 1, false),
        (7, 7, true),
        (0xffff, 0, true),
        (0, 0xffff, false),
        (0, 0x7fff, true),
        (0, 0x8000, false),
        (0x8001, 1, false),
        (0x8002, 1, true),
    ] {
        let slots = [slot(a, &first), slot(b, &second)];
        let mut board = holding([Some(&slots[0]), Some(&slots[1])]);
        let wanted = if is_second { &second[..] } else { &first };
        assert_eq!(newest(&mut board).as_deref(), Some(wanted), "{a} {b}");
    }
    let one = slot(5, &first);
    assert_eq!(
        newest(&mut holding([Some(&one), None])).as_deref(),
        Some(&first[..])
    );
    assert_eq!(
        newest(&mut holding([None, Some(&one)])).as_deref(),
        Some(&first[..])
    );
    assert_eq!(newest(&mut holding([None, None])), None);
}

#[test]
fn a_slot_holds_1_to_1200_bytes() {
    let longest = vec![3; usize::from(MAX_TABLE)];
    let mut board = holding([Some(&slot(1, &longest)), None]);
    assert_eq!(newest(&mut board), Some(longest.clone()));
    for wrong in [vec![], [&longest[..], &[3]].concat()] {
        assert_eq!(newest(&mut holding([Some(&slot(1, &wrong)), None])), None);
    }
    // Beyond its end there are zeros.
    let stored = Stored::newest(&mut board).expect("a table");
    let mut bytes = [9; 4];
    stored.read(&mut board, MAX_TABLE - 2, &mut bytes);
    assert_eq!(bytes, [3, 3, 0, 0]);
    stored.read(&mut board, u16::MAX, &mut bytes);
    assert_eq!(bytes, [0; 4]);
}

/// Writes until it is done, a byte every tick; whether another table counts then.
fn written(writer: &mut Writer, board: &mut HostBoard) -> bool {
    assert!(writer.is_busy());
    for _ in 0..200 {
        if let Some((answer, is_new)) = writer.tick(board) {
            assert_eq!(answer, 42);
            assert!(!writer.is_busy());
            return is_new;
        }
        pass(board);
    }
    panic!("it is never written");
}

/// Ten milliseconds, in which a byte is written.
fn pass(board: &mut HostBoard) {
    use handstand_firmware::board::Board as _;
    for _ in 0..10 {
        board.bus_receive(1000);
    }
}

/// Tables go in turn into both slots, each at its place; the one that counts is never touched.
#[test]
fn a_table_goes_into_the_slot_that_does_not_count() {
    let mut board = HostBoard::new(Bus::new([]));
    let mut writer = Writer::new(&mut board);
    let mut counts: Option<Vec<u8>> = None;
    for (at, content) in [5u8, 6, 7].into_iter().enumerate() {
        let table = [content; PLAN_CHUNK];
        assert!(writer.chunk(0, &table, 42));
        // One at a time.
        assert!(!writer.chunk(0, &table, 42));
        assert!(!writer.store(&mut board, PLAN_CHUNK as u16, crc32(&table), 42));
        assert!(!written(&mut writer, &mut board));
        assert_eq!(newest(&mut board), counts, "not before its header");
        assert!(writer.store(&mut board, PLAN_CHUNK as u16, crc32(&table), 42));
        assert!(written(&mut writer, &mut board));
        counts = Some(table.to_vec());
        assert_eq!(newest(&mut board), counts);
        let start = SLOTS[at % 2];
        let whole = slot(at as u16 + 1, &table);
        assert_eq!(board.eeprom[start..start + whole.len()], whole[..]);
        assert_eq!(Stored::newest(&mut board), writer.newest());
    }
    // Nothing but the slots was written.
    let outside = (0..board.eeprom.len()).filter(|at| {
        SLOTS
            .iter()
            .all(|slot| !(*slot..slot + HEADER + PLAN_CHUNK).contains(at))
    });
    assert!(outside.into_iter().all(|at| board.eeprom[at] == 0xff));
}

#[test]
fn no_piece_lies_outside_a_slot() {
    let mut board = HostBoard::new(Bus::new([]));
    let mut writer = Writer::new(&mut board);
    let piece = [8; PLAN_CHUNK];
    assert!(!writer.chunk(MAX_TABLE, &piece, 42));
    assert!(!writer.chunk(u16::MAX, &piece, 42));
    assert!(writer.chunk(MAX_TABLE - 5, &piece, 42));
    written(&mut writer, &mut board);
    let end = SLOTS[0] + HEADER + usize::from(MAX_TABLE);
    assert_eq!(board.eeprom[end - 5..end + 1], [8, 8, 8, 8, 8, 0xff]);
    assert_eq!(board.eeprom[end - 6], 0xff);
    for length in [0, MAX_TABLE + 1] {
        assert!(!writer.store(&mut board, length, 0, 42));
    }
}

/// The application says which plan it has, and while it is written.
#[test]
fn the_plan_that_counts_is_told() {
    let mut cm5 = VirtualCm5::new();
    greet(&mut cm5);
    ask(&mut cm5, &Command::Mode(Mode::Stream));
    assert_eq!(cm5.app.plan_fingerprint(), None);
    assert!(!cm5.app.is_writing());
    let bytes = [1; PLAN_CHUNK];
    cm5.send(&Command::PlanChunk { offset: 0, bytes });
    cm5.run_ms(30.0);
    assert!(cm5.app.is_writing());
    cm5.run_ms(1000.0);
    assert!(!cm5.app.is_writing());
    upload(&mut cm5, &plan());
    let fingerprint = plan().fingerprint();
    assert_eq!(cm5.app.plan_fingerprint(), Some(fingerprint));
    assert_eq!(greet(&mut cm5).plan, fingerprint);
}

/// As after an update of the firmware: the plan in EEPROM is of an older version.
#[test]
fn the_plan_that_is_read_is_the_one_whose_fingerprint_is_said() {
    let compiled = bytes(&plan());
    let mut cm5 = VirtualCm5::with_plan(compiled.clone(), vec![0xff; 4096], ResetCause(1));
    cm5.run_ms(250.0);
    cm5.send_bytes(&[0]);
    greet(&mut cm5);
    assert_eq!(ask(&mut cm5, &Command::Mode(Mode::Stream)), Some(Ok(())));
    let mut old = [0; PLAN_CHUNK];
    old[0] = 3;
    let (length, check) = (PLAN_CHUNK as u16, handstand_shared::crc::crc32(&old));
    let (offset, bytes) = (0, old);
    let written = ask(&mut cm5, &Command::PlanChunk { offset, bytes });
    assert_eq!(written, Some(Ok(())));
    let stored = ask(&mut cm5, &Command::PlanStore { length, check });
    assert_eq!(stored, Some(Ok(())));
    cm5.run_ms(100.0);
    assert_eq!(greet(&mut cm5).plan, plan().fingerprint());
    cm5.clear();
    cm5.send(&Command::PlanRead { offset: 0 });
    cm5.run_ms(60.0);
    let read = cm5
        .reports()
        .into_iter()
        .find_map(|(_, report)| match report {
            Report::PlanChunk { length, bytes, .. } => Some((length, bytes)),
            _ => None,
        });
    let (length, bytes) = read.expect("a piece");
    assert_eq!(usize::from(length), compiled.len());
    assert_eq!(bytes[..], compiled[..PLAN_CHUNK]);
}
