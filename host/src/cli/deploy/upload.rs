//! The plan over the line: piece by piece, and back.

use super::super::port::AnyLink;
use super::super::talk::Talk;
use handstand::link::Session;
use handstand::{Error, Result};
use handstand_shared::crc::crc32;
use handstand_shared::message::{Command, PLAN_CHUNK, Report};

/// Sends a plan; the CM-5 answers when it is in EEPROM.
pub fn upload(session: &mut Session<AnyLink>, bytes: &[u8], talk: &Talk) -> Result<()> {
    let bar = talk.bar();
    bar.set_length(bytes.len() as u64);
    for (place, piece) in bytes.chunks(PLAN_CHUNK).enumerate() {
        let mut chunk = [0; PLAN_CHUNK];
        chunk[..piece.len()].copy_from_slice(piece);
        let offset = (place * PLAN_CHUNK) as u16;
        session.obey(
            &Command::PlanChunk {
                offset,
                bytes: chunk,
            },
            "take gains",
        )?;
        bar.inc(piece.len() as u64);
    }
    bar.finish_and_clear();
    let store = Command::PlanStore {
        length: bytes.len() as u16,
        check: crc32(bytes),
    };
    session.obey(&store, "keep the gains")
}

/// The plan that the CM-5 has.
pub fn read_back(session: &mut Session<AnyLink>) -> Result<Vec<u8>> {
    let mut back = Vec::new();
    loop {
        let wanted = back.len() as u16;
        let (length, bytes) =
            session.fetch(
                &Command::PlanRead { offset: wanted },
                |report| match *report {
                    Report::PlanChunk {
                        offset,
                        length,
                        bytes,
                    } if offset == wanted => Some((usize::from(length), bytes)),
                    _ => None,
                },
            )?;
        let left = length.saturating_sub(back.len());
        back.extend(bytes.iter().take(left));
        if back.len() >= length {
            return Ok(back);
        }
    }
}

/// Whether what came back is what was sent, and the CM-5 takes it for these gains.
pub fn verify(session: &mut Session<AnyLink>, ours: &[u8], fingerprint: u32) -> Result<Vec<u8>> {
    let theirs = read_back(session)?;
    if ours != theirs {
        return Err(Error::device(
            format!(
                "{} bytes were sent, {} others came back",
                ours.len(),
                theirs.len()
            ),
            "try again; if it stays so, the CM-5's EEPROM is worn",
        ));
    }
    session.greet()?;
    match session.hello.plan == fingerprint {
        true => Ok(theirs),
        false => Err(Error::device(
            format!(
                "the CM-5 says its gains are {:08X}, not {fingerprint:08X}",
                session.hello.plan
            ),
            "its firmware does not take this plan: flash the firmware that belongs to this program, docs/flash.md",
        )),
    }
}
