//! Causes where no servo responds.

use super::super::port::SerialLink;
use super::super::servos::Servos;
use super::super::session::Session;
use super::super::session_error::condition_words;
use super::ping_test::PingTest;
use super::{Cause, cause};
use crate::error::Result;
use handstand_shared::message::Condition;

/// Speeds servos are found at, likeliest first.
const BAUDS: [u32; 9] = [
    1_000_000, 57_600, 115_200, 500_000, 200_000, 9_600, 2_000_000, 3_000_000, 4_000_000,
];

/// No servo responds: another speed, a controller that is no adapter now, no power, or the line is
/// not connected.
pub(super) fn no_response<L: SerialLink>(
    servos: &mut Servos<L>,
    ids: &[u8],
    pings: &[PingTest],
    causes: &mut Vec<Cause>,
    step: &mut impl FnMut(&str),
) -> Result<()> {
    if let Some(found) = firmware(servos, step)? {
        causes.push(found);
        return Ok(());
    }
    if let Some(found) = other_protocol(servos, ids, step) {
        causes.push(found);
        return Ok(());
    }
    let own = servos.link().baud();
    for baud in BAUDS.into_iter().filter(|baud| *baud != own) {
        step(&format!("the same at {baud} baud"));
        servos.link().set_baud(baud)?;
        let here: Vec<u8> = ids
            .iter()
            .copied()
            .filter(|id| servos.ping(*id).is_ok())
            .collect();
        if !here.is_empty() {
            causes.push(cause(
                1.0,
                format!("the speed is wrong: servos answer at {baud} baud"),
                format!("silent at {own} baud, ids {here:?} answer at {baud}"),
                format!("use --baud {baud}"),
            ));
            servos.link().set_baud(own)?;
            return Ok(());
        }
    }
    servos.link().set_baud(own)?;
    step("all other ids");
    let others: Vec<u8> = (0..=253)
        .filter(|id| !ids.contains(id) && servos.ping(*id).is_ok())
        .collect();
    if !others.is_empty() {
        causes.push(cause(
            1.0,
            "the ids are others",
            format!("ids {others:?} answer, none of those asked"),
            format!(
                "use these ids, or give new ones: handstand bus setup --new-id {}",
                ids.first().unwrap_or(&1)
            ),
        ));
        return Ok(());
    }
    let garbled: usize = pings.iter().map(|test| test.garbled).sum();
    if garbled > 0 {
        causes.push(cause(
            0.8,
            "bytes come back, but no sound packet: the speed is wrong, or two servos have one id",
            format!("{garbled} answers were garbled, none was sound, at any of {BAUDS:?} baud"),
            "connect a single servo and try again; then one after the other",
        ));
        return Ok(());
    }
    causes.extend(silence(servos.echoes().unwrap_or(false)));
    Ok(())
}

/// Whether servos that were asked in one protocol answer in the other.
fn other_protocol<L: SerialLink>(
    servos: &mut Servos<L>,
    ids: &[u8],
    step: &mut impl FnMut(&str),
) -> Option<Cause> {
    let asked = servos.protocol.take()?;
    step("the other protocol");
    let there = ids.iter().any(|id| servos.ping(*id).is_ok());
    match servos.protocol {
        Some(found) if there && found != asked => Some(cause(
            1.0,
            format!("the protocol is wrong: servos answer in Protocol {found}"),
            format!("silent in Protocol {asked}"),
            "leave --protocol out",
        )),
        _ => {
            servos.protocol = None;
            None
        }
    }
}

/// Whether a CM-5 with our firmware is there, but in a mode in which it is no adapter.
fn firmware<L: SerialLink>(
    servos: &mut Servos<L>,
    step: &mut impl FnMut(&str),
) -> Result<Option<Cause>> {
    step("greeting a CM-5");
    let Ok(session) = Session::open(servos.link()) else {
        return Ok(None);
    };
    let condition = session.hello.condition;
    Ok(Some(match condition {
        Condition::Bridge => cause(
            0.9,
            "the CM-5 is well, the servos behind it are silent: they have no power, or the bus cable is out",
            "the firmware answers as an adapter, no servo does",
            "switch the battery on; look at the servo cables, from the CM-5 outwards; are the servos' LEDs lit at power-on?",
        ),
        other => cause(
            1.0,
            "the CM-5 is no adapter now",
            format!("its firmware says: {}", condition_words(other)),
            "press its MODE button (a reset), or end the program that uses it",
        ),
    }))
}

/// Not a byte from anywhere: the tests cannot see further, so the causes are ranked by how common
/// they are.
fn silence(echo: bool) -> Vec<Cause> {
    let evidence = "no byte came at any speed from any id, and no CM-5 answers";
    let mut causes = vec![
        cause(
            0.5,
            "the servos have no power",
            evidence,
            "switch the supply on: 9 to 12 V; each servo's LED flashes once",
        ),
        cause(
            0.3,
            "the data line is not connected, or a connector is turned",
            evidence,
            "check plug and cable; the middle pin is power, one outer pin is ground",
        ),
        cause(
            0.2,
            "the CM-5 runs another program than Handstand's firmware",
            evidence,
            "flash it: docs/flash.md",
        ),
    ];
    if echo {
        causes.insert(0, cause(
            0.6,
            "the adapter never lets the line go, or nothing else is on it",
            "the adapter hears itself, and nothing else",
            "check its direction control (half duplex), and that the servos' data wire reaches it",
        ));
    } else {
        causes.push(cause(
            0.1,
            "this is another device's port",
            evidence,
            "unplug the adapter and see which port disappears",
        ));
    }
    causes
}
