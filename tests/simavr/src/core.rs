//! simavr's ATmega128, through the shim.

use std::ffi::{CString, c_char, c_int};
use std::path::Path;

/// Cycles per second.
pub const CPU_HZ: u64 = 16_000_000;

#[repr(C)]
#[derive(Clone, Copy, Default)]
struct RawEvent {
    cycle: u64,
    kind: u32,
    value: u32,
}

#[repr(C)]
struct Raw {
    _private: [u8; 0],
}

unsafe extern "C" {
    fn rig_new(elf: *const c_char) -> *mut Raw;
    fn rig_free(rig: *mut Raw);
    fn rig_run(rig: *mut Raw, until: u64) -> c_int;
    fn rig_events(rig: *mut Raw, out: *mut RawEvent, room: u32) -> u32;
    fn rig_cycle(rig: *mut Raw) -> u64;
    fn rig_data(rig: *mut Raw) -> *mut u8;
    fn rig_flash(rig: *mut Raw) -> *mut u8;
    fn rig_pc(rig: *mut Raw) -> u32;
    fn rig_byte_cycles(rig: *mut Raw, uart: c_int) -> u64;
    fn rig_waiting(rig: *mut Raw, uart: c_int) -> c_int;
    fn rig_lost(rig: *mut Raw, uart: c_int) -> u32;
    fn rig_uart_in(rig: *mut Raw, uart: c_int, byte: u8);
    fn rig_pin(rig: *mut Raw, port: c_char, pin: c_int, level: c_int);
    fn rig_adc(rig: *mut Raw, channel: c_int, millivolts: u32);
    fn rig_eeprom(rig: *mut Raw) -> *mut u8;
    fn rig_watchdog(rig: *mut Raw, us: u32);
    fn rig_longest_unfed(rig: *mut Raw) -> u64;
    fn rig_reset_to(rig: *mut Raw, pc: u32);
    fn rig_jump(rig: *mut Raw, pc: u32);
    fn rig_power_cycle(rig: *mut Raw);
}

/// Something the program did, and in which cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// Handed a byte to USART0.
    Bus(u64, u8),
    /// Handed a byte to USART1.
    Link(u64, u8),
    /// Wrote port A, which the CM-5 leaves free: a mark for measuring.
    Mark(u64, u8),
    /// Wrote port B.
    PortB(u64, u8),
    /// Wrote port C.
    PortC(u64, u8),
    /// Wrote port E.
    PortE(u64, u8),
    /// Was reset.
    Reset(u64),
}

/// One simulated controller.
pub struct Core(*mut Raw);

impl Core {
    /// Loads an ELF.
    ///
    /// # Errors
    /// The file cannot be read as one.
    pub fn load(elf: &Path) -> Result<Core, String> {
        let refused = || format!("simavr cannot load {}", elf.display());
        let name = elf.to_str().and_then(|name| CString::new(name).ok());
        let name = name.ok_or_else(refused)?;
        // SAFETY: a valid string; the result is checked.
        let raw = unsafe { rig_new(name.as_ptr()) };
        if raw.is_null() {
            Err(refused())
        } else {
            Ok(Core(raw))
        }
    }

    /// Runs until the cycle, or until something happened.
    ///
    /// # Panics
    /// The program crashed the core: a wild jump or an unknown instruction.
    pub fn run(&mut self, until: u64) -> Vec<Event> {
        // SAFETY: `self.0` is a live rig, as in all calls below.
        let outcome = unsafe { rig_run(self.0, until) };
        assert!(outcome >= 0, "the AVR crashed at pc {:#x}", self.pc());
        if outcome == 0 {
            return Vec::new();
        }
        let mut raw = [RawEvent::default(); 256];
        let count = unsafe { rig_events(self.0, raw.as_mut_ptr(), raw.len() as u32) };
        raw[..count as usize].iter().filter_map(event).collect()
    }

    /// Now.
    pub fn cycle(&self) -> u64 {
        unsafe { rig_cycle(self.0) }
    }

    /// Byte address of the next instruction.
    pub fn pc(&self) -> u32 {
        unsafe { rig_pc(self.0) }
    }

    /// A byte's stop bit has arrived at a USART.
    pub fn uart_in(&mut self, uart: usize, byte: u8) {
        unsafe { rig_uart_in(self.0, uart as c_int, byte) }
    }

    /// Bytes that arrived at a USART and were not read.
    pub fn waiting(&self, uart: usize) -> usize {
        unsafe { rig_waiting(self.0, uart as c_int) as usize }
    }

    /// Bytes that arrived at a USART while three were waiting, and were lost.
    pub fn lost(&self, uart: usize) -> usize {
        unsafe { rig_lost(self.0, uart as c_int) as usize }
    }

    /// Cycles of a byte on a USART.
    pub fn byte_cycles(&self, uart: usize) -> u64 {
        unsafe { rig_byte_cycles(self.0, uart as c_int) }
    }

    /// Sets an input pin.
    pub fn pin(&mut self, port: char, pin: u8, level: bool) {
        unsafe { rig_pin(self.0, port as c_char, c_int::from(pin), c_int::from(level)) }
    }

    /// Sets an analogue input, mV of 5000.
    pub fn adc(&mut self, channel: u8, millivolts: u32) {
        unsafe { rig_adc(self.0, c_int::from(channel), millivolts) }
    }

    /// Registers, I/O and RAM.
    pub fn data(&mut self) -> &mut [u8] {
        unsafe { std::slice::from_raw_parts_mut(rig_data(self.0), 0x1100) }
    }

    /// Flash.
    pub fn flash(&mut self) -> &mut [u8] {
        unsafe { std::slice::from_raw_parts_mut(rig_flash(self.0), 0x20000) }
    }

    /// EEPROM.
    pub fn eeprom(&mut self) -> &mut [u8] {
        unsafe { std::slice::from_raw_parts_mut(rig_eeprom(self.0), 0x1000) }
    }

    /// Sets the watchdog's period, us of the 32,768 cycles of its oscillator that the firmware
    /// chooses; 28,100 is the data sheet's typical one at 5 V.
    pub fn set_watchdog_us(&mut self, us: u32) {
        unsafe { rig_watchdog(self.0, us) }
    }

    /// The longest the watchdog was not fed since the last call, ms.
    pub fn longest_unfed_ms(&mut self) -> f64 {
        let cycles = unsafe { rig_longest_unfed(self.0) };
        cycles as f64 / (CPU_HZ as f64 * 1e-3)
    }

    /// Sets the byte address where a reset leads.
    pub fn reset_to(&mut self, pc: u32) {
        unsafe { rig_reset_to(self.0, pc) }
    }

    /// Goes on at this byte address.
    pub fn jump(&mut self, pc: u32) {
        unsafe { rig_jump(self.0, pc) }
    }

    /// Power off and on again.
    pub fn power_cycle(&mut self) {
        unsafe { rig_power_cycle(self.0) }
    }
}

impl Drop for Core {
    fn drop(&mut self) {
        unsafe { rig_free(self.0) }
    }
}

fn event(raw: &RawEvent) -> Option<Event> {
    let RawEvent { cycle, kind, value } = *raw;
    let value = value as u8;
    Some(match kind {
        1 => Event::Bus(cycle, value),
        2 => Event::Link(cycle, value),
        3 => Event::PortE(cycle, value),
        4 => Event::PortB(cycle, value),
        5 => Event::Reset(cycle),
        6 => Event::PortC(cycle, value),
        7 => Event::Mark(cycle, value),
        _ => return None,
    })
}
