//! A queue of bytes between one interrupt and the program, without locks.

use core::cell::UnsafeCell;
use core::ptr::copy_nonoverlapping;
use core::sync::atomic::{Ordering, compiler_fence};

/// A byte that an interrupt and the program share; where both change it, never at the same time.
/// The AVR reads and
/// writes a byte in one instruction; `AtomicU8` would switch interrupts off and on around it, which
/// costs more than the access.
pub struct SharedByte(UnsafeCell<u8>);

// SAFETY: single bytes, accessed in one instruction each, on one core.
unsafe impl Sync for SharedByte {}

impl SharedByte {
    /// With this value.
    pub const fn new(value: u8) -> Self {
        SharedByte(UnsafeCell::new(value))
    }

    /// Its value now.
    #[inline(always)]
    pub fn get(&self) -> u8 {
        // SAFETY: the cell is always valid.
        unsafe { self.0.get().read_volatile() }
    }

    /// Changes it.
    #[inline(always)]
    pub fn set(&self, value: u8) {
        // SAFETY: the cell is always valid.
        unsafe { self.0.get().write_volatile(value) }
    }
}

/// Holds `N - 1` bytes; `N` is a power of two, at most 256, so that a byte counts around it.
pub struct Ring<const N: usize> {
    bytes: UnsafeCell<[u8; N]>,
    /// Where the next byte goes; written by the producer only.
    head: SharedByte,
    /// Where the oldest byte is; written by the consumer only.
    tail: SharedByte,
    /// Bytes that found no room.
    lost: SharedByte,
}

// SAFETY: one producer writes `head` and the slots outside tail..head, one consumer writes `tail`;
// both are single bytes.
unsafe impl<const N: usize> Sync for Ring<N> {}

impl<const N: usize> Ring<N> {
    const MASK: u8 = (N - 1) as u8;

    /// Empty.
    pub const fn new() -> Self {
        const { assert!(N.is_power_of_two() && N <= 256) };
        Ring {
            bytes: UnsafeCell::new([0; N]),
            head: SharedByte::new(0),
            tail: SharedByte::new(0),
            lost: SharedByte::new(0),
        }
    }

    /// Adds a byte, or counts it as lost. For the producer only.
    #[inline(always)]
    pub fn push(&self, byte: u8) {
        let head = self.head.get();
        let next = head.wrapping_add(1) & Self::MASK;
        if next == self.tail.get() {
            let lost = self.lost.get();
            self.lost.set(lost.saturating_add(1));
            return;
        }
        // SAFETY: `head` is below N, and the consumer does not read this slot before `head` moves.
        unsafe {
            (self.bytes.get() as *mut u8)
                .add(usize::from(head))
                .write_volatile(byte)
        };
        compiler_fence(Ordering::Release);
        self.head.set(next);
    }

    /// Adds as many bytes as find room; how many. For the producer only. Quicker than one by one: no
    /// other moves `head`.
    #[inline(always)]
    pub fn push_all(&self, bytes: &[u8]) -> usize {
        let count = bytes.len().min(self.room());
        let head = self.head.get();
        let to_end = N - usize::from(head);
        let slots = self.bytes.get() as *mut u8;
        // Up to the ring's end, then on from its beginning: place by place it takes twice as long.
        let (first, rest) = bytes.split_at(count.min(to_end));
        // SAFETY: `head` is below N, these are at most N - `head` and then fewer than `head`, and
        // there is room for these: the consumer does not read their slots before `head` moves.
        unsafe {
            copy_nonoverlapping(first.as_ptr(), slots.add(usize::from(head)), first.len());
            copy_nonoverlapping(rest.as_ptr(), slots, count - first.len());
        }
        let head = head.wrapping_add(count as u8) & Self::MASK;
        compiler_fence(Ordering::Release);
        self.head.set(head);
        count
    }

    /// Takes the oldest byte. For the consumer only.
    #[inline(always)]
    pub fn pop(&self) -> Option<u8> {
        if self.is_empty() {
            return None;
        }
        let tail = self.tail.get();
        compiler_fence(Ordering::Acquire);
        // SAFETY: `tail` is below N, and the producer does not write this slot before `tail` moves.
        let byte = unsafe {
            (self.bytes.get() as *mut u8)
                .add(usize::from(tail))
                .read_volatile()
        };
        self.tail.set(tail.wrapping_add(1) & Self::MASK);
        Some(byte)
    }

    /// Whether it holds nothing.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.tail.get() == self.head.get()
    }

    /// How many bytes it can take.
    #[inline(always)]
    pub fn room(&self) -> usize {
        let (head, tail) = (self.head.get(), self.tail.get());
        usize::from(tail.wrapping_sub(head).wrapping_sub(1) & Self::MASK)
    }

    /// How many bytes found no room since the last call.
    pub fn take_lost(&self) -> u8 {
        // A byte lost between the two is not counted; it only says "some".
        let lost = self.lost.get();
        self.lost.set(0);
        lost
    }
}
