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

/// A look for the deepest byte ever used, a few bytes at a time: the whole at once takes 0.4 ms,
/// which the next tick would begin late.
pub struct Look {
    /// First byte not looked at yet.
    next: u16,
    /// First byte that was in use when the last look ended.
    deepest: u16,
}

impl Look {
    /// Paints everything below what is in use now.
    pub fn paint() -> Self {
        // Here, and a little below, lives this very function.
        let here = 0u8;
        let end = (&raw const here as u16).saturating_sub(32);
        for address in bottom()..end {
            // SAFETY: between the static data and the stack lies nothing; there is no heap.
            unsafe { (address as *mut u8).write_volatile(PAINT) };
        }
        Look {
            next: bottom(),
            deepest: end,
        }
    }

    /// Looks at eight bytes more. Paint that is gone never comes back: a look ends at what is not
    /// paint, or where the last one ended, and the next begins at the bottom.
    pub fn go_on(&mut self) {
        // SAFETY: reading RAM.
        let is_paint = |address: u16| unsafe { (address as *const u8).read_volatile() } == PAINT;
        let end = self.deepest.min(self.next + 8);
        let met = (self.next..end).find(|at| !is_paint(*at));
        self.deepest = met.unwrap_or(self.deepest);
        self.next = if met.is_some() || end == self.deepest {
            bottom()
        } else {
            end
        };
    }

    /// Bytes the stack has used at its deepest, and bytes there are for it.
    pub fn used_and_size(&self) -> (u16, u16) {
        (TOP + 1 - self.deepest, TOP + 1 - bottom())
    }
}
