//! What host and firmware agree on: the servo's registers and packets, and the frames and messages
//! of the PC line.
//!
//! Read downward only: `raw` -> `control_table`; `dynamixel` -> `dynamixel2`; `crc` -> `frame`,
//! `image`; `packed` -> `message`; `fixed` -> `gains` -> `law` -> `observer`; `velocity`; all of
//! these -> `plan`.
#![no_std]
#![cfg_attr(not(target_arch = "avr"), forbid(unsafe_code))]
#![cfg_attr(target_arch = "avr", deny(unsafe_code))]
#![cfg_attr(target_arch = "avr", feature(asm_experimental_arch))]

pub mod control_table;
pub mod crc;
pub mod dynamixel;
pub mod dynamixel2;
pub mod fixed;
pub mod frame;
pub mod gains;
pub mod image;
pub mod law;
pub mod message;
pub mod observer;
pub mod packed;
pub mod plan;
pub mod raw;
pub mod velocity;
