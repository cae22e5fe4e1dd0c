//! Telling our frames from servo packets while the CM-5 is a plain adapter.
//!
//! A servo packet begins with `FF`, a frame of ours with the zero that ends the one before. Between
//! packets a zero begins a frame, which ends at the next zero and goes to no servo; inside a packet
//! every byte goes to the servos. `FF FF FD 00` begins a packet of Protocol 2.0: as one of
//! Protocol 1.0 it would have the length 0, which none has.

use crate::design::TICK_US;

/// Where a byte from the PC belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// To the servos, as it is.
    Bus,
    /// Into the decoder of frames.
    Frame,
}

/// What the bytes so far began.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Inside {
    #[default]
    Nothing,
    /// One `FF`.
    Header,
    /// `FF FF`.
    Id,
    /// `FF FF ID`.
    Length,
    /// `FF FF FD`: id 253, or Protocol 2.0.
    LengthOfFd,
    /// `FF FF FD 00`.
    Id2,
    /// `FF FF FD 00 ID`.
    LengthLow,
    /// The same with the low byte of its length.
    LengthHigh(u8),
    /// So many bytes of a packet are still to come.
    Packet(u16),
    Frame,
}

/// No longer packet of Protocol 2.0 is sent: a length above it is noise, which must not hide the
/// frames that follow.
const LONGEST_2: u16 = 1024;

/// Ticks of silence after which a packet or frame that was begun is given up: 50 ms, more than a
/// USB adapter pauses.
const GIVEN_UP: u8 = (50_000 / TICK_US as u32) as u8;

/// Sorts the bytes from the PC.
#[derive(Debug, Clone, Default)]
pub struct Filter {
    inside: Inside,
    silent: u8,
}

impl Filter {
    /// Where this byte belongs.
    pub fn push(&mut self, byte: u8) -> Way {
        self.silent = 0;
        let (inside, way) = match (self.inside, byte) {
            (Inside::Nothing, 0) => (Inside::Frame, Way::Frame),
            (Inside::Nothing, 0xff) => (Inside::Header, Way::Bus),
            (Inside::Nothing, _) => (Inside::Nothing, Way::Bus),
            (Inside::Header, 0xff) => (Inside::Id, Way::Bus),
            (Inside::Header, _) => (Inside::Nothing, Way::Bus),
            (Inside::Id, 0xff) => (Inside::Id, Way::Bus),
            (Inside::Id, 0xfd) => (Inside::LengthOfFd, Way::Bus),
            (Inside::Id, _) => (Inside::Length, Way::Bus),
            (Inside::LengthOfFd, 0) => (Inside::Id2, Way::Bus),
            (Inside::Length | Inside::LengthOfFd, length) => {
                (Inside::Packet(u16::from(length)), Way::Bus)
            }
            (Inside::Id2, _) => (Inside::LengthLow, Way::Bus),
            (Inside::LengthLow, low) => (Inside::LengthHigh(low), Way::Bus),
            (Inside::LengthHigh(low), high) => {
                let inside = match u16::from_le_bytes([low, high]) {
                    0 | LONGEST_2.. => Inside::Nothing,
                    length => Inside::Packet(length),
                };
                (inside, Way::Bus)
            }
            (Inside::Packet(0 | 1), _) => (Inside::Nothing, Way::Bus),
            (Inside::Packet(left), _) => (Inside::Packet(left - 1), Way::Bus),
            // Zeros before a frame are idle line; the one after its first byte ends it.
            (Inside::Frame, _) => (Inside::Frame, Way::Frame),
        };
        self.inside = inside;
        way
    }

    /// The frame has ended.
    pub fn end_frame(&mut self) {
        self.inside = Inside::Nothing;
    }

    /// Once per tick: gives up what was begun and not continued. True when it does.
    pub fn tick(&mut self) -> bool {
        self.silent = self.silent.saturating_add(1);
        let stale = self.inside != Inside::Nothing && self.silent > GIVEN_UP;
        if stale {
            self.inside = Inside::Nothing;
        }
        stale
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packet_with_zeros_goes_to_the_servos_whole() {
        let mut filter = Filter::default();
        let packet = [0xff, 0xff, 0, 4, 2, 0, 1, 0xf8];
        for byte in packet.iter().chain(&packet) {
            assert_eq!(filter.push(*byte), Way::Bus);
        }
        assert_eq!(filter.push(0), Way::Frame);
        assert_eq!(filter.push(0xff), Way::Frame);
    }

    #[test]
    fn a_packet_of_protocol_2_goes_to_the_servos_whole() {
        let mut filter = Filter::default();
        let ping = [0xff, 0xff, 0xfd, 0, 1, 3, 0, 1, 0x19, 0x4e];
        let write = [
            0xff, 0xff, 0xfd, 0, 1, 9, 0, 3, 0x74, 0, 0, 2, 0, 0, 0xca, 0x89,
        ];
        let sync = [0xff, 0xff, 0xfd, 0, 0xfe, 0x2c, 1];
        let all = ping.iter().chain(&write).chain(&sync).chain(&[0; 300]);
        for byte in all.chain(&ping) {
            assert_eq!(filter.push(*byte), Way::Bus);
        }
        assert_eq!(filter.push(0), Way::Frame);
        filter.end_frame();
        // Protocol 1.0 to id 253 is passed as before, and a length that none has hides no frame.
        for byte in [0xff, 0xff, 0xfd, 2, 1, 0xff] {
            assert_eq!(filter.push(byte), Way::Bus);
        }
        assert_eq!(filter.push(0), Way::Frame);
        filter.end_frame();
        for byte in [0xff, 0xff, 0xfd, 0, 1, 0, 0x80] {
            assert_eq!(filter.push(byte), Way::Bus);
        }
        assert_eq!(filter.push(0), Way::Frame);
    }

    #[test]
    fn a_packet_cut_short_is_given_up_in_time() {
        let mut filter = Filter::default();
        for byte in [0xff, 0xff, 1, 200] {
            filter.push(byte);
        }
        // 50 ms, and once.
        assert_eq!(
            [(); 8].map(|()| filter.tick()),
            [false, false, false, false, false, true, false, false]
        );
        assert_eq!(filter.push(0), Way::Frame);
        // Every byte begins the wait again.
        let mut filter = Filter::default();
        for byte in [0xff, 0xff, 1, 200, 7, 7] {
            filter.push(byte);
            assert_eq!([(); 5].map(|()| filter.tick()), [false; 5]);
        }
        assert!(filter.tick());
    }

    /// With no more than one `FF`, a wrong length or the last of its bytes a packet is over.
    #[test]
    fn what_follows_a_packet_is_told_by_its_first_byte() {
        for packet in [
            &[0xff, 7][..],
            &[0xff, 0xff, 1, 2, 9, 9],
            &[0xff, 0xff, 0xff, 1, 1, 9],
            &[0xff, 0xff, 1, 0, 9],
            &[0xff, 0xff, 0xfd, 0, 1, 0, 4],
            &[0xff, 0xff, 0xfd, 0, 1, 2, 0, 9, 9],
        ] {
            let mut filter = Filter::default();
            for byte in packet {
                assert_eq!(filter.push(*byte), Way::Bus, "{packet:x?}");
            }
            assert_eq!(filter.push(0), Way::Frame, "{packet:x?}");
            // One byte less, and the zero belongs to it.
            let mut filter = Filter::default();
            let (_, begun) = packet.split_last().unwrap();
            begun.iter().for_each(|byte| {
                filter.push(*byte);
            });
            assert_eq!(filter.push(0), Way::Bus, "{packet:x?}");
        }
        // The longest of Protocol 2.0 has 1023 bytes behind its length.
        let mut filter = Filter::default();
        for byte in [0xff, 0xff, 0xfd, 0, 1, 0xff, 3].iter().chain(&[0; 1023]) {
            assert_eq!(filter.push(*byte), Way::Bus);
        }
        assert_eq!(filter.push(0), Way::Frame);
    }
}
