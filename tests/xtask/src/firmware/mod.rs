//! Building the CM-5's program, and what the built image is like.

mod budget;
mod build;
mod image;
mod stack;
mod toolchain;

pub use budget::Budget;
pub use build::{Built, build, find_built};
pub use image::{FLASH_LIMIT, Image, RAM_SIZE};
pub use toolchain::Toolchain;
