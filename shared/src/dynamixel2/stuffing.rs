//! Byte stuffing: an `FD` behind every `FF FF FD`, so that no header occurs inside a packet.

/// Follows bytes and notices the end of each `FF FF FD`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RunFinder {
    matched: u8,
}

impl RunFinder {
    /// Takes the next byte; whether it ends an `FF FF FD`.
    pub fn push(&mut self, byte: u8) -> bool {
        self.matched = match (self.matched, byte) {
            // A third FF begins nothing new: the last two are still the prefix. A matcher that
            // falls back to the start here misses FF FF FF FD.
            (2, 0xfd) => 3,
            (1 | 2, 0xff) => 2,
            (_, 0xff) => 1,
            _ => 0,
        };
        self.matched == 3
    }
}

/// Bytes without the inserted ones.
#[derive(Debug, Clone)]
pub struct Unstuffed<'a> {
    bytes: core::slice::Iter<'a, u8>,
    run: RunFinder,
    skips: bool,
}

impl<'a> Unstuffed<'a> {
    pub(super) fn new(stuffed: &'a [u8]) -> Self {
        Unstuffed {
            bytes: stuffed.iter(),
            run: RunFinder::default(),
            skips: false,
        }
    }
}

impl Iterator for Unstuffed<'_> {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        let mut byte = *self.bytes.next()?;
        if core::mem::take(&mut self.skips) && byte == 0xfd {
            // The inserted byte; it is no part of a further run.
            self.run = RunFinder::default();
            byte = *self.bytes.next()?;
        }
        self.skips = self.run.push(byte);
        Some(byte)
    }
}

/// Whether these bytes, from the instruction on, are as a sender that stuffs leaves them: `FD`
/// behind every `FF FF FD`. A run at the very end may still get it.
pub(super) fn is_stuffed(body: &[u8]) -> bool {
    let mut run = RunFinder::default();
    let mut bytes = body.iter();
    while let Some(byte) = bytes.next() {
        if run.push(*byte) {
            match bytes.next() {
                Some(0xfd) => run = RunFinder::default(),
                Some(_) => return false,
                None => return true,
            }
        }
    }
    true
}
