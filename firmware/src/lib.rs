//! The CM-5's firmware: a bridge between the PC line and the servo bus, and a controller of its
//! own.
//!
//! Everything but `atmega128` is logic behind [`board::Board`] and is tested on a PC, on the host
//! board of `handstand-cm5-sim`. Read downward only: `design` -> `age`; `board` -> `bus` ->
//! `servos`; `link`, `filter`, `plan_store`, `boot_counter`, `fault_log`, `panel`, `balance` -> `app`.
#![no_std]
#![cfg_attr(not(target_arch = "avr"), forbid(unsafe_code))]
#![cfg_attr(target_arch = "avr", feature(abi_avr_interrupt, asm_experimental_arch))]

#[cfg(not(target_arch = "avr"))]
extern crate std;

pub mod age;
pub mod app;
pub mod balance;
pub mod board;
pub mod boot_counter;
pub mod bus;
pub mod design;
pub mod fault_log;
pub mod filter;
pub mod link;
pub mod panel;
pub mod plan_store;
pub mod servos;
#[cfg(test)]
mod test_board;

#[cfg(target_arch = "avr")]
pub mod atmega128;
