//! The plan that was compiled in, in flash: the AVR's constants would take RAM.

use core::arch::asm;

const BYTES: &[u8] = &include!(concat!(env!("OUT_DIR"), "/plan.rs"));

#[unsafe(link_section = ".progmem.data.plan")]
static PLAN: [u8; BYTES.len()] = {
    let mut plan = [0; BYTES.len()];
    let mut at = 0;
    while at < plan.len() {
        plan[at] = BYTES[at];
        at += 1;
    }
    plan
};

/// A byte of it; none behind its end.
pub fn plan(at: u16) -> Option<u8> {
    if usize::from(at) >= PLAN.len() {
        return None;
    }
    let address = (&raw const PLAN).cast::<u8>().wrapping_add(usize::from(at));
    let byte;
    // SAFETY: reads flash within PLAN, which the linker keeps in the first 64 KiB.
    unsafe {
        asm!("lpm {byte}, Z", byte = out(reg) byte, in("Z") address, options(pure, nomem, nostack, preserves_flags));
    }
    Some(byte)
}
