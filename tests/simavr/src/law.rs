//! The laws on the AVR: their answers, and their cycles.

use crate::core::{Core, Event};
use handstand_shared::gains::GainTable;
use handstand_shared::observer::{INPUTS, Memory, Observer, READINGS, WIDTH};
use std::path::Path;
use std::process::Command;

/// The program `law` with a table of gains and an observer.
pub struct Law {
    core: Core,
    mailbox: usize,
    asked: u8,
}

/// A tick of the observer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObserverTick {
    /// The inputs commanded.
    pub raw_command: [i16; INPUTS],
    /// What it remembers afterwards.
    pub memory: Memory,
    /// Cycles until the raw command, marks included.
    pub command_cycles: u64,
    /// Cycles of the update after it, marks included.
    pub update_cycles: u64,
}

// Offsets in the program's mailbox, which is `repr(C)`; the AVR aligns nothing.
const ANSWERED: usize = 1;
const KIND: usize = 2;
const X: usize = 3;
const U: usize = X + 12;
const MEMORY: usize = U + 4;
const MAIL_READINGS: usize = MEMORY + 2 * WIDTH;
const APPLIED: usize = MAIL_READINGS + 2 * READINGS;
const BYTES: usize = APPLIED + 2 * INPUTS;

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
        let mut bytes = Vec::new();
        table.bytes(|byte| bytes.push(byte));
        self.put(BYTES, &bytes);
        self.ask(1);
    }

    /// Hands over an observer.
    pub fn set_observer(&mut self, observer: &Observer) {
        let mut bytes = Vec::new();
        observer.bytes(|byte| bytes.push(byte));
        self.put(BYTES, &bytes);
        self.ask(3);
    }

    /// The inputs for a state, and the cycles between the marks before and after the law.
    pub fn control(&mut self, x: &[i16; 6]) -> ([i16; 2], u64) {
        self.put_words(X, x);
        let marks = self.ask(0);
        (self.words(U), between(&marks, 1, 2))
    }

    /// A tick of the observer.
    pub fn tick(
        &mut self,
        memory: &Memory,
        readings: &[i16; READINGS],
        applied: &[i16; INPUTS],
    ) -> ObserverTick {
        self.put_words(MEMORY, memory.all());
        self.put_words(MAIL_READINGS, readings);
        self.put_words(APPLIED, applied);
        let marks = self.ask(2);
        ObserverTick {
            raw_command: self.words(U),
            memory: Memory::of(self.words(MEMORY)),
            command_cycles: between(&marks, 1, 2),
            update_cycles: between(&marks, 2, 3),
        }
    }

    fn put(&mut self, at: usize, bytes: &[u8]) {
        let at = self.mailbox + at;
        self.core.data()[at..at + bytes.len()].copy_from_slice(bytes);
    }

    fn put_words(&mut self, at: usize, words: &[i16]) {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.put(at, &bytes);
    }

    fn words<const N: usize>(&mut self, at: usize) -> [i16; N] {
        let at = self.mailbox + at;
        let data = self.core.data();
        std::array::from_fn(|i| i16::from_le_bytes([data[at + 2 * i], data[at + 2 * i + 1]]))
    }

    fn ask(&mut self, kind: u8) -> Vec<(u64, u8)> {
        self.put(KIND, &[kind]);
        self.asked = self.asked.wrapping_add(1);
        let asked = self.asked;
        self.put(0, &[asked]);
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

/// Cycles from one mark to another.
fn between(marks: &[(u64, u8)], from: u8, to: u8) -> u64 {
    let at = |wanted| marks.iter().find(|(_, mark)| *mark == wanted);
    match (at(from), at(to)) {
        (Some((begin, _)), Some((end, _))) => end - begin,
        _ => panic!("the program made no marks {from} and {to}: {marks:?}"),
    }
}
