//! The control law on the AVR: its answers, and its cycles.

use crate::core::{Core, Event};
use handstand_shared::gains::GainTable;
use std::path::Path;
use std::process::Command;

/// The program `law` with a table of gains.
pub struct Law {
    core: Core,
    mailbox: usize,
    asked: u8,
}

// Offsets in the program's mailbox, which is `repr(C)`; the AVR aligns nothing.
const ANSWERED: usize = 1;
const X: usize = 2;
const U: usize = X + 12;
const BYTES: usize = U + 4;

impl Law {
    /// Loads the program.
    ///
    /// # Errors
    /// It, or `avr-nm`, which finds its mailbox, is not there.
    pub fn load(elf: &Path) -> Result<Law, String> {
        let mut core = Core::load(elf)?;
        // Until its start has cleared the RAM.
        core.run(20_000);
        let symbols = Command::new("avr-nm").arg(elf).output();
        let symbols = symbols.map_err(|error| format!("avr-nm: {error}"))?.stdout;
        let symbols = String::from_utf8_lossy(&symbols).into_owned();
        let address = symbols.lines().find_map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            (words.last() == Some(&"MAILBOX")).then(|| usize::from_str_radix(words[0], 16).ok())?
        });
        let mailbox = address.ok_or("the program has no MAILBOX")? & 0xffff;
        Ok(Law {
            core,
            mailbox,
            asked: 0,
        })
    }

    /// Hands over a table.
    pub fn set(&mut self, table: &GainTable<2, 6>) {
        let mut at = self.mailbox + BYTES;
        table.bytes(|byte| {
            self.core.data()[at] = byte;
            at += 1;
        });
        self.ask(0x80);
    }

    /// The inputs for a state, and the cycles between the marks before and after the law.
    pub fn control(&mut self, x: &[i16; 6]) -> ([i16; 2], u64) {
        for (at, x) in x.iter().enumerate() {
            let at = self.mailbox + X + 2 * at;
            self.core.data()[at..at + 2].copy_from_slice(&x.to_le_bytes());
        }
        let marks = self.ask(0);
        let begin = marks.iter().find(|(_, mark)| *mark == 1);
        let end = marks.iter().find(|(_, mark)| *mark == 2);
        let cycles = match (begin, end) {
            (Some((begin, _)), Some((end, _))) => end - begin,
            _ => panic!("the program made no marks: {marks:?}"),
        };
        let u = self.mailbox + U;
        let data = self.core.data();
        let u = [u, u + 2].map(|at| i16::from_le_bytes([data[at], data[at + 1]]));
        (u, cycles)
    }

    fn ask(&mut self, kind: u8) -> Vec<(u64, u8)> {
        self.asked = (self.asked + 1) & 0x7f;
        let asked = self.asked | kind;
        self.core.data()[self.mailbox] = asked;
        let mut marks = Vec::new();
        let limit = self.core.cycle() + 1_000_000;
        while self.core.data()[self.mailbox + ANSWERED] != asked {
            let now = self.core.cycle();
            assert!(now < limit, "the program does not answer");
            for event in self.core.run(now + 100) {
                if let Event::Mark(cycle, mark) = event {
                    marks.push((cycle, mark));
                }
            }
        }
        marks
    }
}
