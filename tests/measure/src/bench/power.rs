//! Power cuts while a gain table is written.

use super::{SimulatedCm5, VirtualCm5};
use handstand_firmware::plan_store::Stored;
use handstand_shared::crc::crc32;
use handstand_shared::message::{Answer, Command, PLAN_CHUNK, Report, ResetCause};

/// What was tried, and what came of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PowerCuts {
    /// Cuts: every byte, several contents of the torn byte.
    pub cuts: usize,
    /// The old table was there afterwards.
    pub old: usize,
    /// The new one was.
    pub new: usize,
    /// Anything else: must be none.
    pub neither: usize,
}

/// Writes one table over another and cuts the power at every byte, with every one of `torn` as what
/// the byte becomes.
pub fn power_cuts(torn: &[u8]) -> PowerCuts {
    let old: Vec<u8> = (0..57).map(|at| at * 3 + 1).collect();
    let new: Vec<u8> = (0..57).map(|at| 200 - at).collect();
    let mut first = VirtualCm5::new();
    assert!(upload(&mut first, &old), "the first table is stored");
    // Both slots full: the next upload overwrites a sound table.
    let mut second = VirtualCm5::boot(first.board.eeprom, ResetCause(0));
    assert!(upload(&mut second, &old), "so is the second");
    let before = second.board.eeprom;
    let mut tally = PowerCuts::default();
    for torn in torn {
        for bytes in 0.. {
            let mut rig = VirtualCm5::boot(before.clone(), ResetCause(0));
            rig.board.cut = Some((bytes, *torn));
            if upload(&mut rig, &new) {
                break;
            }
            let mut rig = VirtualCm5::boot(rig.board.eeprom, ResetCause(ResetCause::POWER));
            tally.cuts += 1;
            match kept(&mut rig) {
                Some(table) if table == old => tally.old += 1,
                Some(table) if table == new => tally.new += 1,
                _ => tally.neither += 1,
            }
        }
    }
    tally
}

fn kept(rig: &mut VirtualCm5) -> Option<Vec<u8>> {
    let stored = Stored::newest(&mut rig.board)?;
    let mut table = vec![0; usize::from(stored.length)];
    stored.read(&mut rig.board, 0, &mut table);
    Some(table)
}

/// Uploads a table through the line; whether it was stored.
fn upload(rig: &mut VirtualCm5, table: &[u8]) -> bool {
    let mut offset = 0;
    for piece in table.chunks(PLAN_CHUNK) {
        let mut bytes = [0; PLAN_CHUNK];
        bytes[..piece.len()].copy_from_slice(piece);
        if !done(rig, &Command::PlanChunk { offset, bytes }) {
            return false;
        }
        offset += PLAN_CHUNK as u16;
    }
    let (length, check) = (table.len() as u16, crc32(table));
    done(rig, &Command::PlanStore { length, check })
}

fn done(rig: &mut VirtualCm5, command: &Command) -> bool {
    rig.clear();
    rig.send_bytes(&[0]);
    let sequence = rig.send(command);
    for _ in 0..60 {
        rig.run_ms(10.0);
        let is_answer = |report: &Report| matches!(report, Report::Answer(Answer { sequence: of, outcome: Ok(()) }) if *of == sequence);
        if rig.reports().iter().any(|(_, report)| is_answer(report)) {
            return true;
        }
    }
    false
}
