//! A queue of bytes between one interrupt and the program, without locks.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicU8, Ordering, compiler_fence};

/// Holds `N - 1` bytes; `N` is a power of two, at most 256, so that a byte counts around it.
pub struct Ring<const N: usize> {
    bytes: UnsafeCell<[u8; N]>,
    /// Where the next byte goes; written by the producer only.
    head: AtomicU8,
    /// Where the oldest byte is; written by the consumer only.
    tail: AtomicU8,
    /// Bytes that found no room.
    lost: AtomicU8,
}

// SAFETY: one producer writes `head` and the slots outside tail..head, one consumer writes `tail`; both are single bytes.
unsafe impl<const N: usize> Sync for Ring<N> {}

impl<const N: usize> Ring<N> {
    const MASK: u8 = (N - 1) as u8;

    /// Empty.
    pub const fn new() -> Self {
        const { assert!(N.is_power_of_two() && N <= 256) };
        Ring {
            bytes: UnsafeCell::new([0; N]),
            head: AtomicU8::new(0),
            tail: AtomicU8::new(0),
            lost: AtomicU8::new(0),
        }
    }

    /// Adds a byte, or counts it as lost. For the producer only.
    #[inline(always)]
    pub fn push(&self, byte: u8) {
        let head = self.head.load(Ordering::Relaxed);
        let next = head.wrapping_add(1) & Self::MASK;
        if next == self.tail.load(Ordering::Relaxed) {
            let lost = self.lost.load(Ordering::Relaxed);
            self.lost.store(lost.saturating_add(1), Ordering::Relaxed);
            return;
        }
        // SAFETY: `head` is below N, and the consumer does not read this slot before `head` moves.
        unsafe {
            (self.bytes.get() as *mut u8)
                .add(usize::from(head))
                .write_volatile(byte)
        };
        compiler_fence(Ordering::Release);
        self.head.store(next, Ordering::Relaxed);
    }

    /// Takes the oldest byte. For the consumer only.
    #[inline(always)]
    pub fn pop(&self) -> Option<u8> {
        let tail = self.tail.load(Ordering::Relaxed);
        if tail == self.head.load(Ordering::Relaxed) {
            return None;
        }
        compiler_fence(Ordering::Acquire);
        // SAFETY: `tail` is below N, and the producer does not write this slot before `tail` moves.
        let byte = unsafe {
            (self.bytes.get() as *mut u8)
                .add(usize::from(tail))
                .read_volatile()
        };
        self.tail
            .store(tail.wrapping_add(1) & Self::MASK, Ordering::Relaxed);
        Some(byte)
    }

    /// How many bytes it can take.
    pub fn room(&self) -> usize {
        let (head, tail) = (
            self.head.load(Ordering::Relaxed),
            self.tail.load(Ordering::Relaxed),
        );
        usize::from(tail.wrapping_sub(head).wrapping_sub(1) & Self::MASK)
    }

    /// How many bytes found no room since the last call.
    pub fn take_lost(&self) -> u8 {
        // A byte lost between the two is not counted; it only says "some".
        let lost = self.lost.load(Ordering::Relaxed);
        self.lost.store(0, Ordering::Relaxed);
        lost
    }
}
