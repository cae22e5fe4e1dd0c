//! The CM-5 in simavr: the very ELF that is flashed, against simulated servos and a simulated PC.
//!
//! simavr is under the GPL-3, so nothing that is shipped links this crate. Where Debian's
//! `libsimavr-dev` is not installed the crate is empty, and [`AVAILABLE`] says so.
#![allow(unsafe_code)]

/// Whether simavr was there when this was built.
pub const AVAILABLE: bool = cfg!(simavr);

#[cfg(simavr)]
mod core;
#[cfg(simavr)]
mod elf_cm5;
#[cfg(simavr)]
mod law;

#[cfg(simavr)]
pub use core::{Core, Event};
#[cfg(simavr)]
pub use elf_cm5::{BootLoader, ElfCm5, Observed};
#[cfg(simavr)]
pub use law::{Law, ObserverTick};
