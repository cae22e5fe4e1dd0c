//! The start of the ELF: how long the watchdog waits, and how often it bites.

use super::balance::{plan, upload};
use super::loss::try_arm;
use super::{SimulatedCm5, VirtualCm5};
use handstand_cm5_sim::{Bus, STARTED_MS};
use handstand_shared::control_table::STATUS_LEVEL;
use handstand_shared::message::{Command, Hello, Report, VERSION};
use handstand_simavr::ElfCm5;
use std::path::Path;

/// What a start showed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Boot {
    /// The longest the watchdog was not fed in the first second, ms.
    pub unfed_ms: f64,
    /// Resets in a second after the one of a hang, that one included.
    pub resets: usize,
    /// Whether it then answers a greeting.
    pub answers: bool,
}

/// EEPROM with so many plans, at most two.
pub fn eeprom_with(plans: usize) -> Vec<u8> {
    let (_, plan) = plan();
    let mut rig = VirtualCm5::new();
    rig.run_ms(STARTED_MS);
    rig.send(&Command::Hello { version: VERSION });
    rig.run_ms(50.0);
    for count in 0..plans {
        let mut plan = plan;
        plan.range += count as u16;
        upload(&mut rig, &plan).expect("it is kept");
    }
    rig.board.eeprom
}

/// Starts it with this EEPROM and watchdog, waits a second, lets it hang, and watches for another.
///
/// # Panics
/// The ELF cannot be loaded.
pub fn boot(elf: &Path, eeprom: &[u8], ids: &[u8], watchdog_us: u32) -> Boot {
    let mut rig = ElfCm5::new(elf).expect("the ELF was found");
    rig.bus = Bus::new(ids.iter().copied());
    rig.core.eeprom().copy_from_slice(eeprom);
    rig.core.set_watchdog_us(watchdog_us);
    rig.core.power_cycle();
    rig.core.longest_unfed_ms();
    rig.run_ms(1000.0);
    let unfed_ms = rig.core.longest_unfed_ms();
    // The instruction that is next is replaced by a jump to itself, until the watchdog bites.
    let at = rig.core.pc() as usize;
    let kept = [rig.core.flash()[at], rig.core.flash()[at + 1]];
    rig.core.flash()[at..at + 2].copy_from_slice(&[0xff, 0xcf]);
    let before = rig.seen.resets.len();
    for _ in 0..1000 {
        rig.run_ms(0.1);
        if rig.seen.resets.len() > before {
            break;
        }
    }
    rig.core.flash()[at..at + 2].copy_from_slice(&kept);
    rig.run_ms(1000.0);
    let resets = rig.seen.resets.len() - before;
    Boot {
        unfed_ms,
        resets,
        answers: greeted(&mut rig).is_some(),
    }
}

fn greeted(rig: &mut ElfCm5) -> Option<Hello> {
    rig.clear();
    rig.send(&Command::Hello { version: VERSION });
    rig.run_ms(50.0);
    rig.reports()
        .into_iter()
        .find_map(|(_, report)| match report {
            Report::Hello(hello) => Some(hello),
            _ => None,
        })
}

/// Armed and streaming, with a byte of noise on the bus every so often: resets in so long, and the
/// longest the watchdog was not fed, ms.
///
/// # Panics
/// The ELF cannot be loaded, or does not arm.
pub fn noise(elf: &Path, every_us: u64, watchdog_us: u32, ms: f64) -> (usize, f64) {
    let mut rig = ElfCm5::new(elf).expect("the ELF was found");
    rig.core.set_watchdog_us(watchdog_us);
    assert_eq!(try_arm(&mut rig), Ok(()), "arming");
    let now_ns = (rig.now_ms() * 1e6) as u64;
    // They do what they are told and answer nothing: noise fills each wait for their answers.
    for servo in rig.bus.servos.iter_mut().filter(|servo| servo.id() > 6) {
        servo.set(STATUS_LEVEL, 0);
    }
    rig.bus.set_noise(now_ns, Some(every_us * 1000));
    rig.core.longest_unfed_ms();
    let until_ms = rig.now_ms() + ms;
    while rig.now_ms() < until_ms {
        rig.send(&Command::KeepAlive);
        rig.run_ms(10.0);
    }
    (rig.seen.resets.len(), rig.core.longest_unfed_ms())
}
