//! The CM-5's program.
#![cfg_attr(target_arch = "avr", no_std, no_main)]
#[cfg(target_arch = "avr")]
#[avr_device::entry]
fn main() -> ! {
    loop {}
}
#[cfg(target_arch = "avr")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}
#[cfg(not(target_arch = "avr"))]
fn main() {}
