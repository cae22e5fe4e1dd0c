//! The ELF on the simulated ATmega128, with servos and PC, in one time: cycles of the controller.

use crate::core::{CPU_HZ, Core, Event};
use handstand_cm5_sim::{Bus, Pc, SimulatedCm5};
use handstand_shared::dynamixel::timing::BYTE_NS;
use std::collections::VecDeque;
use std::path::Path;

/// 62.5 ns.
fn to_ns(cycle: u64) -> u64 {
    cycle * 1_000_000_000 / CPU_HZ
}

fn to_ms(cycle: u64) -> f64 {
    cycle as f64 / (CPU_HZ as f64 / 1000.0)
}

fn to_cycle(ns: u64) -> u64 {
    (ns * CPU_HZ).div_ceil(1_000_000_000)
}

/// Buttons up, link plugged in. simavr passes on changes only.
fn release(core: &mut Core) {
    for level in [false, true] {
        (4..8).for_each(|pin| core.pin('E', pin, level));
        core.pin('D', 0, level);
        core.pin('D', 7, level);
    }
}

const TRANSMIT: u8 = 1 << 2;
const RECEIVE: u8 = 1 << 3;

/// Observations beside what arrives at the PC.
#[derive(Debug, Clone, Default)]
pub struct Observed {
    /// Cycles in which the controller was reset.
    pub resets: Vec<u64>,
    /// Direction changes before the last stop bit, and bytes sent while not transmitting: always a
    /// fault.
    pub direction_faults: usize,
    /// The most bytes that ever waited unread at the bus's receiver; the hardware holds two.
    pub most_waiting: usize,
    /// Port B's charger pin was driven low.
    pub charged: bool,
}

/// The CM-5's boot loader as far as it matters to a robot: a reset leads into it, it waits for `#`
/// from the PC, and starts the program if none comes. How long it waits is not known; it is to be
/// measured on a CM-5.
#[derive(Debug, Clone, Copy)]
pub struct BootLoader {
    /// How long it waits, cycles.
    window: u64,
    /// When it starts the program, while it waits.
    until: Option<u64>,
    /// `#` came: it waits for commands, and the program does not start.
    pub has_prompt: bool,
}

/// Where it lies; a loop stands for it.
const BOOT_LOADER: usize = 0x1e000;

/// A CM-5 that executes the ELF.
pub struct ElfCm5 {
    /// The controller.
    pub core: Core,
    /// The servos.
    pub bus: Bus,
    /// By how much the servos' clock is ahead of the controller's, ns: it decides when their motor
    /// interrupts come.
    pub bus_ahead_ns: u64,
    /// Observations.
    pub seen: Observed,
    /// Bytes on the bus with the cycles their stop bits end, whoever sent them; kept where there is
    /// a list.
    pub trace: Option<Vec<(u64, u8)>>,
    /// The boot loader, if there is one.
    pub loader: Option<BootLoader>,
    port_e: u8,
    /// When the bus was last turned around.
    turned: u64,
    /// When the bus byte in the transmitter will be out.
    bus_free: u64,
    link_free: u64,
    /// Bytes from the PC, each with the cycle its stop bit ends.
    to_link: VecDeque<(u64, u8)>,
    pc: Pc,
}

impl ElfCm5 {
    /// A controller that just got power, with 18 servos.
    ///
    /// # Errors
    /// The ELF cannot be loaded.
    pub fn new(elf: &Path) -> Result<ElfCm5, String> {
        let mut core = Core::load(elf)?;
        release(&mut core);
        // Erased, not zero.
        core.eeprom().fill(0xff);
        let mut cm5 = ElfCm5 {
            core,
            bus: Bus::new(1..=18),
            bus_ahead_ns: 0,
            seen: Observed::default(),
            trace: None,
            loader: None,
            port_e: 0,
            turned: 0,
            bus_free: 0,
            link_free: 0,
            to_link: VecDeque::new(),
            pc: Pc::default(),
        };
        // At rest, as on the board in process.
        cm5.set_gyro(512);
        Ok(cm5)
    }

    /// Puts a boot loader in front of the program, which waits so long after every reset.
    pub fn set_boot_loader(&mut self, window_ms: f64) {
        self.core.flash()[BOOT_LOADER..BOOT_LOADER + 2].copy_from_slice(&[0xff, 0xcf]);
        self.core.reset_to(BOOT_LOADER as u32);
        self.loader = Some(BootLoader {
            window: (window_ms * CPU_HZ as f64 / 1000.0) as u64,
            until: None,
            has_prompt: false,
        });
    }

    /// The boot loader hears a byte; whether it is the one that runs.
    fn loader_hears(&mut self, byte: u8) -> bool {
        let Some(loader) = self.loader.as_mut().filter(|loader| loader.until.is_some()) else {
            return false;
        };
        loader.has_prompt |= byte == b'#';
        true
    }

    fn run_loader(&mut self) {
        let now = self.core.cycle();
        if let Some(loader) = &mut self.loader
            && !loader.has_prompt
            && loader.until.is_some_and(|until| until <= now)
        {
            loader.until = None;
            self.core.jump(0);
        }
    }

    /// Runs until this cycle.
    pub fn run_until(&mut self, until: u64) {
        while self.core.cycle() < until {
            self.feed();
            self.run_loader();
            let next = self.next_event().min(until).max(self.core.cycle() + 1);
            for event in self.core.run(next) {
                self.notice(event);
            }
            self.seen.most_waiting = self.seen.most_waiting.max(self.core.waiting(0));
        }
    }

    /// When the next byte for the controller ends; at most a short step away, for servos answer
    /// within 18 us.
    fn next_event(&self) -> u64 {
        let bus = self.bus_next();
        let link = self.to_link.front().map(|(end, _)| *end);
        let step = self.core.cycle() + 4000;
        bus.into_iter().chain(link).fold(step, u64::min)
    }

    /// The cycle in which the next byte from the servos ends.
    fn bus_next(&self) -> Option<u64> {
        let end_ns = self.bus.next_ns()?.saturating_sub(self.bus_ahead_ns);
        Some(to_cycle(end_ns))
    }

    fn feed(&mut self) {
        let now = self.core.cycle();
        while let Some(end) = self.bus_next()
            && end <= now
        {
            let Some((_, byte)) = self.bus.take(to_ns(end) + self.bus_ahead_ns) else {
                break;
            };
            self.trace
                .iter_mut()
                .for_each(|trace| trace.push((end, byte)));
            // Only a bus that listens from the start bit on hears.
            let begin = end.saturating_sub(to_cycle(BYTE_NS));
            if self.port_e & (TRANSMIT | RECEIVE) == RECEIVE && self.turned <= begin {
                self.core.uart_in(0, byte);
            }
        }
        while let Some((end, byte)) = self.to_link.front().copied()
            && end <= now
        {
            self.to_link.pop_front();
            if !self.loader_hears(byte) {
                self.core.uart_in(1, byte);
            }
        }
    }

    fn notice(&mut self, event: Event) {
        match event {
            Event::Bus(cycle, byte) => {
                let begin = cycle.max(self.bus_free);
                self.bus_free = begin + self.core.byte_cycles(0);
                let end = self.bus_free;
                self.trace
                    .iter_mut()
                    .for_each(|trace| trace.push((end, byte)));
                if self.port_e & (TRANSMIT | RECEIVE) == TRANSMIT {
                    let end_ns = to_ns(self.bus_free) + self.bus_ahead_ns;
                    self.bus.receive(end_ns, byte);
                } else {
                    self.seen.direction_faults += 1;
                }
            }
            Event::Link(cycle, byte) => {
                let begin = cycle.max(self.link_free);
                self.link_free = begin + self.core.byte_cycles(1);
                self.pc.receive(to_ms(self.link_free), byte);
            }
            Event::PortE(cycle, value) => {
                let turned = (self.port_e ^ value) & TRANSMIT != 0;
                // A few cycles of slack: the flag that says "sent" comes with the stop bit's end.
                if turned && cycle + 8 < self.bus_free {
                    self.seen.direction_faults += 1;
                }
                if self.port_e & (TRANSMIT | RECEIVE) != value & (TRANSMIT | RECEIVE) {
                    self.turned = cycle;
                }
                self.port_e = value;
            }
            Event::PortB(_, value) => self.seen.charged |= value & 1 << 5 == 0,
            Event::PortC(..) => {}
            Event::Mark(..) => {}
            Event::Reset(cycle) => {
                self.seen.resets.push(cycle);
                // simavr forgets the pins' levels.
                release(&mut self.core);
                if let Some(loader) = &mut self.loader {
                    loader.until = Some(cycle + loader.window);
                }
                self.port_e = 0;
                self.bus_free = 0;
                self.link_free = 0;
            }
        }
    }

    /// When the last byte queued by the PC arrives, ms since power-on.
    pub fn arrival_ms(&self) -> f64 {
        let last = self.to_link.back().map(|(end, _)| *end);
        to_ms(last.unwrap_or_else(|| self.core.cycle()))
    }
}

impl SimulatedCm5 for ElfCm5 {
    fn run_ms(&mut self, ms: f64) {
        let until = self.core.cycle() + (ms * CPU_HZ as f64 / 1000.0) as u64;
        self.run_until(until);
    }

    fn now_ms(&self) -> f64 {
        to_ms(self.core.cycle())
    }

    fn send_bytes(&mut self, bytes: &[u8]) {
        const BYTE: u64 = CPU_HZ * 10 / 57_600;
        let last = self.to_link.back().map_or(0, |(end, _)| *end);
        let mut end = self.core.cycle().max(last);
        for byte in bytes {
            end += BYTE;
            self.to_link.push_back((end, *byte));
        }
    }

    fn pc(&self) -> &Pc {
        &self.pc
    }

    fn pc_mut(&mut self) -> &mut Pc {
        &mut self.pc
    }

    fn bus(&mut self) -> &mut Bus {
        &mut self.bus
    }

    fn set_gyro(&mut self, code: u16) {
        // The least voltage of that code.
        self.core.adc(3, (u32::from(code) * 5000).div_ceil(1023));
    }
}
