//! The laws alone, for the bench: state in, input out, marks on port A before and after.
#![cfg_attr(target_arch = "avr", no_std, no_main)]
#![cfg_attr(target_arch = "avr", feature(asm_experimental_arch))]

#[cfg(target_arch = "avr")]
mod program {
    #![allow(unsafe_code)]

    use avr_device::atmega128a::{PORTA, Peripherals};
    use core::arch::asm;
    use core::hint::black_box;
    use handstand_shared::gains::GainTable;
    use handstand_shared::law::control;
    use handstand_shared::observer::{INPUTS, Memory, Observer, READINGS, WIDTH};

    /// What the bench writes and reads, at the address of its symbol.
    #[repr(C)]
    struct Mailbox {
        /// The bench changes it to ask.
        asked: u8,
        /// The program copies `asked` when it has answered.
        answered: u8,
        /// What is asked: 0 the law of 2 x 6 at `x`, 1 to take its table, 2 a tick of the observer,
        /// 3 to take it.
        kind: u8,
        x: [i16; 6],
        u: [i16; 2],
        /// The observer's memory, before and after.
        memory: [i16; WIDTH],
        readings: [i16; READINGS],
        applied: [i16; INPUTS],
        /// A table or an observer in its bytes.
        bytes: [u8; Observer::LENGTH],
    }

    #[unsafe(no_mangle)]
    static mut MAILBOX: Mailbox = Mailbox {
        asked: 0,
        answered: 0,
        kind: 0,
        x: [0; 6],
        u: [0; 2],
        memory: [0; WIDTH],
        readings: [0; READINGS],
        applied: [0; INPUTS],
        bytes: [0; Observer::LENGTH],
    };

    fn mark(port: &PORTA, value: u8) {
        // SAFETY: any value may be written.
        port.porta().write(|w| unsafe { w.bits(value) });
    }

    /// The law between its marks, in a frame of its own: in that of `main`, which holds both laws,
    /// every spilt register would cost ten cycles more.
    #[inline(never)]
    fn timed(port: &PORTA, law: &GainTable<2, 6>, state: &[i16; 6]) -> [i16; 2] {
        mark(port, 1);
        let [first, second] = control(law, state);
        // SAFETY: does nothing; both inputs are in registers before the mark, where a caller finds
        // them.
        unsafe {
            asm!("/* {0} {1} */", in(reg_pair) first, in(reg_pair) second, options(nomem, nostack))
        };
        mark(port, 2);
        [first, second]
    }

    #[avr_device::entry]
    fn main() -> ! {
        let mailbox = &raw mut MAILBOX;
        // SAFETY: nobody else has the port.
        let port = unsafe { Peripherals::steal() }.PORTA;
        let mut table = GainTable::<2, 6>::ZERO;
        let mut observer = Observer::ZERO;
        // SAFETY: one static, one user; the bench changes it between instructions, hence the
        // volatile accesses.
        unsafe {
            let bytes = (&raw const (*mailbox).bytes).cast::<u8>();
            let byte = |at| bytes.add(at).read_volatile();
            loop {
                let asked = (&raw const (*mailbox).asked).read_volatile();
                if asked == (&raw const (*mailbox).answered).read_volatile() {
                    continue;
                }
                match (&raw const (*mailbox).kind).read_volatile() {
                    0 => {
                        let x = (&raw const (*mailbox).x).read_volatile();
                        let u = timed(&port, black_box(&table), black_box(&x));
                        (&raw mut (*mailbox).u).write_volatile(u);
                    }
                    1 => {
                        table.fill(&mut (0..GainTable::<2, 6>::LENGTH).map(byte));
                    }
                    2 => {
                        let all = (&raw const (*mailbox).memory).read_volatile();
                        let readings = (&raw const (*mailbox).readings).read_volatile();
                        let applied = (&raw const (*mailbox).applied).read_volatile();
                        let mut memory = Memory::of(all);
                        let law = black_box(&observer);
                        // Done while servos are awaited.
                        while law.step_update(&mut memory) {}
                        mark(&port, 1);
                        let u = black_box(law.raw_command(&mut memory, &readings));
                        mark(&port, 2);
                        law.update(&mut memory, applied);
                        mark(&port, 3);
                        (&raw mut (*mailbox).u).write_volatile(u);
                        (&raw mut (*mailbox).memory).write_volatile(*memory.all());
                    }
                    _ => {
                        observer.fill(&mut (0..Observer::LENGTH).map(byte));
                    }
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
