//! Finding packets in a stream of bytes that may hold anything else.

use super::stuffing::is_stuffed;
use super::{BROADCAST, Packet, PacketError, STATUS};

/// Collects bytes until they are a packet of at most `N` bytes; searches on within what turned out
/// to be none. Bytes that announce a packet, and hold what no sender leaves unstuffed, are given up
/// at once, not when as many bytes came as were announced.
#[derive(Debug, Clone)]
pub struct Receiver<const N: usize> {
    bytes: [u8; N],
    used: usize,
    /// The packet handed out last is still in front.
    handed_out: usize,
}

impl<const N: usize> Default for Receiver<N> {
    fn default() -> Self {
        Receiver {
            bytes: [0; N],
            used: 0,
            handed_out: 0,
        }
    }
}

enum Look {
    /// Nothing speaks against a packet yet.
    More,
    /// No packet begins here.
    None,
    /// One does, this long.
    Packet(usize),
}

impl<const N: usize> Receiver<N> {
    /// Takes the next byte; the packet it completes, if it does.
    pub fn push(&mut self, byte: u8) -> Option<Packet<'_>> {
        let handed_out = core::mem::take(&mut self.handed_out);
        self.drop_front(handed_out);
        if let Some(slot) = self.bytes.get_mut(self.used) {
            *slot = byte;
            self.used += 1;
        }
        self.next_packet()
    }

    /// A packet among the bytes taken so far, behind the one handed out last: there may be several
    /// where a false one swallowed them.
    pub fn next_packet(&mut self) -> Option<Packet<'_>> {
        let handed_out = core::mem::take(&mut self.handed_out);
        self.drop_front(handed_out);
        loop {
            match self.look() {
                Look::More => return None,
                Look::None => self.drop_front(1),
                Look::Packet(length) => {
                    self.handed_out = length;
                    return Packet::new(self.bytes.get(..length)?).ok();
                }
            }
        }
    }

    /// Gives up what was begun, as after a silence: the packets that it had swallowed can be
    /// fetched with [`Receiver::next_packet`].
    pub fn give_up(&mut self) {
        let handed_out = core::mem::take(&mut self.handed_out);
        self.drop_front(handed_out.max(1));
    }

    /// Forgets what was collected.
    pub fn reset(&mut self) {
        self.used = 0;
        self.handed_out = 0;
    }

    /// Whether nothing is left that may begin a packet.
    pub fn is_empty(&self) -> bool {
        self.used <= self.handed_out
    }

    fn look(&self) -> Look {
        let bytes = self.bytes.get(..self.used).unwrap_or(&[]);
        let (id, low, high) = match bytes {
            [] | [0xff] | [0xff, 0xff] | [0xff, 0xff, 0xfd] | [0xff, 0xff, 0xfd, 0x00] => {
                return Look::More;
            }
            [0xff, 0xff, 0xfd, 0x00, 0xfd | 0xff, ..] => return Look::None,
            [0xff, 0xff, 0xfd, 0x00, _] | [0xff, 0xff, 0xfd, 0x00, _, _] => return Look::More,
            [0xff, 0xff, 0xfd, 0x00, id, low, high, ..] => (*id, *low, *high),
            _ => return Look::None,
        };
        let length = usize::from(u16::from_le_bytes([low, high]));
        let whole = length + 7;
        if length < 3 || whole > N {
            return Look::None;
        }
        match bytes.get(..whole).map(Packet::new) {
            Some(Ok(_)) => Look::Packet(whole),
            Some(Err(PacketError::Header | PacketError::Length | PacketError::Crc)) => Look::None,
            None if self.is_false(id) => Look::None,
            None => Look::More,
        }
    }

    /// Whether the packet that has begun holds an unstuffed header. Only the joint status of a fast
    /// read may.
    fn is_false(&self, id: u8) -> bool {
        let body = self.bytes.get(7..self.used).unwrap_or(&[]);
        let is_fast = id == BROADCAST && body.first().is_none_or(|first| *first == STATUS);
        !is_fast && !is_stuffed(body)
    }

    fn drop_front(&mut self, count: usize) {
        let count = count.min(self.used);
        self.bytes.copy_within(count..self.used, 0);
        self.used -= count;
    }
}
