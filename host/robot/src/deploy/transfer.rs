//! Transfer a plan to the CM-5 in chunks, and read it back.

use crate::error::{Error, Result};
use crate::link::{SerialLink, Session};
use handstand_shared::crc::crc32;
use handstand_shared::message::{Command, PLAN_CHUNK, Report};

/// Upload a plan's bytes; returns when the CM-5 has them in EEPROM. `progress` gets the number of
/// bytes sent so far.
///
/// # Errors
/// The CM-5 does not answer or refuses.
pub fn upload<L: SerialLink>(
    session: &mut Session<L>,
    bytes: &[u8],
    mut progress: impl FnMut(u64),
) -> Result<()> {
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
        progress(u64::from(offset) + piece.len() as u64);
    }
    let store = Command::PlanStore {
        length: bytes.len() as u16,
        check: crc32(bytes),
    };
    Ok(session.obey(&store, "keep the gains")?)
}

/// Read the plan that the CM-5 has; no bytes if it has none.
///
/// # Errors
/// The CM-5 does not answer.
pub fn read_back<L: SerialLink>(session: &mut Session<L>) -> Result<Vec<u8>> {
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

/// Read the plan back; its bytes must be `ours`, and the CM-5's fingerprint this one.
///
/// # Errors
/// The CM-5 does not answer, or has another plan.
pub fn verify<L: SerialLink>(
    session: &mut Session<L>,
    ours: &[u8],
    fingerprint: u32,
) -> Result<Vec<u8>> {
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
    if session.hello.plan == fingerprint {
        Ok(theirs)
    } else {
        Err(Error::device(
            format!(
                "the CM-5 says its gains are {:08X}, not {fingerprint:08X}",
                session.hello.plan
            ),
            "its firmware does not take this plan: flash the firmware that belongs to this \
         program, docs/flash.md",
        ))
    }
}
