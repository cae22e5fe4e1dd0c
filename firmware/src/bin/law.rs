//! The control law alone, for the bench: state in, input out, marks on port A before and after.
#![cfg_attr(target_arch = "avr", no_std, no_main)]

#[cfg(target_arch = "avr")]
mod program {
    #![allow(unsafe_code)]

    use core::hint::black_box;
    use handstand_shared::{gains::GainTable, law::control};

    /// What the bench writes and reads, at the address of its symbol.
    #[repr(C)]
    struct Mailbox {
        /// The bench changes it to hand over a state, or, with its highest bit set, a table.
        asked: u8,
        /// The program copies `asked` when it has answered.
        answered: u8,
        x: [i16; 6],
        u: [i16; 2],
        /// A table in its canonical bytes.
        bytes: [u8; GainTable::<2, 6>::LENGTH],
    }

    #[unsafe(no_mangle)]
    static mut MAILBOX: Mailbox = Mailbox {
        asked: 0,
        answered: 0,
        x: [0; 6],
        u: [0; 2],
        bytes: [0; GainTable::<2, 6>::LENGTH],
    };

    #[avr_device::entry]
    fn main() -> ! {
        let mailbox = &raw mut MAILBOX;
        let mut table = GainTable::<2, 6>::new([[0; 6]; 2], [0; 2], [0; 2], [[0; 2]; 2], [0; 6]);
        // SAFETY: one static, one user; the bench changes it between instructions, hence the volatile accesses.
        unsafe {
            let registers = avr_device::atmega128a::Peripherals::steal();
            let mark = |value| registers.PORTA.porta().write(|w| w.bits(value));
            loop {
                let asked = (&raw const (*mailbox).asked).read_volatile();
                if asked == (&raw const (*mailbox).answered).read_volatile() {
                    continue;
                }
                if asked & 0x80 != 0 {
                    let bytes = (&raw const (*mailbox).bytes).read_volatile();
                    if let Some(new) = GainTable::from_bytes(&bytes) {
                        table = new;
                    }
                } else {
                    let x = (&raw const (*mailbox).x).read_volatile();
                    let (law, state) = (black_box(&table), black_box(&x));
                    mark(1);
                    let u = black_box(control(law, state));
                    mark(2);
                    (&raw mut (*mailbox).u).write_volatile(u);
                }
                (&raw mut (*mailbox).answered).write_volatile(asked);
            }
        }
    }

    #[panic_handler]
    fn panic(_: &core::panic::PanicInfo) -> ! {
        loop {}
    }
}

#[cfg(not(target_arch = "avr"))]
fn main() {
    eprintln!("This program runs in simavr: see `cargo xtask bench-firmware`.");
    std::process::exit(2);
}
