//! The bench of the firmware: the same scenarios on the logic in process and on the real ELF in simavr.

#[cfg(simavr)]
mod ages;
mod balance;
mod frames;
#[cfg(simavr)]
mod law;
mod laws;
mod loss;
mod pc;
mod power;
mod robot;
mod run;
#[cfg(unix)]
mod serve;
mod stream;

#[cfg(simavr)]
pub use ages::{Ages, Spread, ages};
pub use balance::{Balanced, Conditions, Source, Tick, arm_balance, balance, plan};
pub use frames::{FrameTally, bit_flips, patterns, random_bytes, resynchronised};
#[cfg(simavr)]
pub use law::{CHOSEN, Cycles, LawRun, ObserverRun, SHIFTS, law, observer_law};
pub use laws::{Fixed, Float, HostLaw, Sides, balance_by_host, different, side_by_side};
#[cfg(simavr)]
pub use loss::hang;
pub use loss::{Loss, Worst, arm, link_loss, worst_of};
pub use pc::PcRig;
pub use power::{PowerCuts, power_cuts};
pub use run::REPORT_MS;
#[cfg(unix)]
pub use serve::serve;
pub use stream::{StreamRun, stream};

use handstand::bus_sim::Bus;
use handstand_shared::message::{Command, Report};

/// A CM-5 with servos and a PC, however it is simulated.
pub trait Bench {
    /// Runs on for this long, ms.
    fn run_ms(&mut self, ms: f64);
    /// Milliseconds since power-on.
    fn now_ms(&self) -> f64;
    /// Queues a command for the line; its sequence number.
    fn say(&mut self, command: &Command) -> u8;
    /// Queues raw bytes for the line.
    fn type_bytes(&mut self, bytes: &[u8]);
    /// What arrived at the PC so far, and when, ms.
    fn reports(&self) -> Vec<(f64, Report)>;
    /// Raw bytes that arrived at the PC.
    fn raw(&self) -> &[u8];
    /// Frames that arrived damaged.
    fn bad_frames(&self) -> usize;
    /// Bytes sent to the PC.
    fn link_bytes(&self) -> u64;
    /// Forgets what arrived.
    fn forget(&mut self);
    /// The servos.
    fn bus(&mut self) -> &mut Bus;
    /// Turns the gyro's voltage so that the ADC reads this code.
    fn turn_gyro(&mut self, code: u16);
}

/// The real ELF.
#[cfg(simavr)]
impl Bench for handstand_simavr::Rig {
    fn run_ms(&mut self, ms: f64) {
        handstand_simavr::Rig::run_ms(self, ms);
    }

    fn now_ms(&self) -> f64 {
        handstand_simavr::Rig::now_ms(self)
    }

    fn say(&mut self, command: &Command) -> u8 {
        handstand_simavr::Rig::say(self, command);
        self.last_sequence()
    }

    fn type_bytes(&mut self, bytes: &[u8]) {
        handstand_simavr::Rig::type_bytes(self, bytes);
    }

    fn reports(&self) -> Vec<(f64, Report)> {
        let to_ms = |cycle: u64| cycle as f64 / 16_000.0;
        self.seen
            .reports
            .iter()
            .map(|(cycle, report)| (to_ms(*cycle), *report))
            .collect()
    }

    fn raw(&self) -> &[u8] {
        &self.seen.raw
    }

    fn bad_frames(&self) -> usize {
        self.seen.bad_frames
    }

    fn link_bytes(&self) -> u64 {
        self.seen.link_bytes
    }

    fn forget(&mut self) {
        self.seen.reports.clear();
        self.seen.raw.clear();
    }

    fn bus(&mut self) -> &mut Bus {
        &mut self.bus
    }

    fn turn_gyro(&mut self, code: u16) {
        // The least voltage of that code.
        self.core.adc(3, (u32::from(code) * 5000).div_ceil(1023));
    }
}
