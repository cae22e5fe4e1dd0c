//! How deep the stack has been: it is painted at the start, and what paint is left was never used.

const PAINT: u8 = 0xc5;
const TOP: u16 = 0x10ff;

unsafe extern "C" {
    /// First byte behind the static data; the linker's.
    static mut _end: u8;
}

fn bottom() -> u16 {
    (&raw const _end) as u16
}

/// Paints everything below what is in use now.
pub fn paint() {
    // Here, and a little below, lives this very function.
    let here = 0u8;
    let end = (&raw const here as u16).saturating_sub(32);
    for address in bottom()..end {
        // SAFETY: between the static data and the stack lies nothing; there is no heap.
        unsafe { (address as *mut u8).write_volatile(PAINT) };
    }
}

/// Bytes the stack has used at its deepest, and bytes there are for it.
pub fn used_and_size() -> (u16, u16) {
    let bottom = bottom();
    // SAFETY: reading RAM.
    let is_paint = |address: u16| unsafe { (address as *const u8).read_volatile() } == PAINT;
    let mut end = bottom;
    // Eight in a turn: one a turn took a tenth of the period, and made the next tick late.
    while end < TOP - 8 && (0..8).all(|at| is_paint(end + at)) {
        end += 8;
    }
    while end <= TOP && is_paint(end) {
        end += 1;
    }
    let size = TOP + 1 - bottom;
    (size - (end - bottom), size)
}
