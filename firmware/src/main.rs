//! The CM-5's program: the board, the logic, and nothing else.
#![cfg_attr(target_arch = "avr", no_std, no_main)]

#[cfg(target_arch = "avr")]
#[avr_device::entry]
fn main() -> ! {
    use handstand_firmware::{app::App, atmega128::Cm5};

    let mut board = Cm5::start();
    let mut app = App::boot(&mut board);
    loop {
        app.run(&mut board);
    }
}

/// There is no text to show: the watchdog restarts the controller.
#[cfg(target_arch = "avr")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}

#[cfg(not(target_arch = "avr"))]
fn main() {
    eprintln!("This program runs on the CM-5: build it with `cargo xtask firmware`.");
    std::process::exit(2);
}
