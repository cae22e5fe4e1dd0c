//! `handstand bus ...`: servos, one by one.
//!
//! ```console
//! $ handstand bus scan --port /dev/ttyUSB0
//! $ handstand bus read 3 --port sim
//! $ handstand bus write 3 "moving speed" 100 --port sim
//! $ handstand bus setup --port /dev/ttyUSB0
//! $ handstand bus doctor --port /dev/ttyUSB0
//! $ handstand bus log --port /dev/ttyUSB0
//! ```
//!
//! Over a CM-5 with its firmware as an adapter (57600 baud), any adapter on the servos' bus
//! (`--baud 1000000`), or simulated servos (`--port sim`). Registers are named as in the servo's
//! manual; codes are the register's own. Servos of Protocol 2.0 (X series, MX with that firmware)
//! are recognised by their answers; `--port sim:model=XL330-M288` simulates them.

mod backup;
mod bring_up;
mod changes;
mod doctor;
mod log;
mod monitor;
mod reboot;
mod registers;
mod scan;
mod setup;

use super::{Console, ExitStatus};
use handstand::Result;
pub use scan::garbled_words;

/// What to do with servos.
#[derive(Debug, clap::Subcommand)]
pub enum BusCommand {
    /// Scan the bus for servos
    Scan(scan::ScanArgs),
    /// Read registers of a servo
    Read(registers::ReadArgs),
    /// Write a register of a servo, and read it back
    Write(registers::WriteArgs),
    /// Configure servos for 100 Hz (return delay 0, status level 1), or set one servo's id
    Setup(setup::SetupArgs),
    /// Monitor position, load, supply and temperature
    Monitor(monitor::MonitorArgs),
    /// Restart servos of Protocol 2.0, as after a hardware error
    Reboot(reboot::RebootArgs),
    /// Back up the servos' settings to a file
    Backup(backup::BackupArgs),
    /// Restore saved settings to the servos
    Restore(backup::RestoreArgs),
    /// Diagnose why a servo returns no status packet
    Doctor(doctor::BusDoctorArgs),
    /// Read the CM-5's fault log
    Log(log::FaultLogArgs),
}

/// Does it.
pub fn run(command: &BusCommand, console: &Console) -> Result<ExitStatus> {
    match command {
        BusCommand::Scan(args) => scan::run(args, console),
        BusCommand::Read(args) => registers::read(args, console),
        BusCommand::Write(args) => registers::write(args, console),
        BusCommand::Setup(args) => setup::run(args, console),
        BusCommand::Monitor(args) => monitor::run(args, console),
        BusCommand::Reboot(args) => reboot::run(args, console),
        BusCommand::Backup(args) => backup::backup(args, console),
        BusCommand::Restore(args) => backup::restore(args, console),
        BusCommand::Doctor(args) => doctor::run(args, console),
        BusCommand::Log(args) => log::run(args, console),
    }
}
