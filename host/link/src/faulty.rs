//! A line on which things go wrong by chance.

use super::port::{SerialLink, left_to_inner};
use crate::error::Result;
use rand::{Rng as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;
use std::time::Duration;

/// Wraps a line and disturbs what comes from the device.
pub struct Faulty<L> {
    inner: L,
    drop: f64,
    flip: f64,
    dice: ChaCha8Rng,
}

impl<L: SerialLink> Faulty<L> {
    /// Loses a share `drop` of the bytes and inverts a share `flip` of the bits, by chance from
    /// `seed`.
    pub fn new(inner: L, drop: f64, flip: f64, seed: u64) -> Self {
        Faulty {
            inner,
            drop,
            flip,
            dice: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    fn happens(&mut self, share: f64) -> bool {
        share > 0.0 && self.dice.random::<f64>() < share
    }

    fn flipped(&mut self, byte: u8) -> u8 {
        (0..8).fold(byte, |byte, bit| {
            if self.happens(self.flip) {
                byte ^ 1 << bit
            } else {
                byte
            }
        })
    }
}

impl<L: SerialLink> SerialLink for Faulty<L> {
    left_to_inner!();

    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        self.inner.send(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        let deadline = self.inner.now() + wait;
        loop {
            let left = deadline.saturating_sub(self.inner.now());
            let came = self.inner.receive(bytes, left)?;
            let mut kept = 0;
            for at in 0..came {
                if !self.happens(self.drop) {
                    bytes[kept] = self.flipped(bytes[at]);
                    kept += 1;
                }
            }
            if kept > 0 || came == 0 || self.inner.now() >= deadline {
                return Ok(kept);
            }
        }
    }
}
