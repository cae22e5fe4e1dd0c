//! Small errors, noise, and whatever else a line may carry.

extern crate std;

use super::tests::bytes;
use super::*;
use proptest::prelude::*;
use std::vec::Vec;

/// A header inside a joint status is data: it is not stuffed.
#[test]
fn a_joint_status_with_a_header_inside_is_received() {
    let data = [0xff, 0xff, 0xfd, 0x00];
    let parts = [FastPart {
        id: 1,
        error: ErrorByte(0),
        data: &data,
    }];
    let mut out = [0; 64];
    let length = emit_fast_status(&mut out, 8, &parts).unwrap();
    let mut receiver = Receiver::<64>::default();
    let found = out[..length]
        .iter()
        .filter(|byte| receiver.push(**byte).is_some())
        .count();
    assert_eq!(found, 1);
    let read = fast_parts(&out[..length], [4].into_iter()).next().unwrap();
    assert_eq!(read.data, data);
}

/// All errors of one to three bits in packets of ten to fifteen bytes.
#[test]
fn every_error_of_one_to_three_bits_is_refused() {
    for text in [
        "FF FF FD 00 01 03 00 01 19 4E",
        "FF FF FD 00 01 04 00 55 00 A1 0C",
        "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0",
    ] {
        let good = bytes(text);
        let bits = good.len() * 8;
        let mut bad = good.clone();
        let flip = |bytes: &mut [u8], bit: usize| bytes[bit / 8] ^= 1 << (bit % 8);
        for a in 0..bits {
            flip(&mut bad, a);
            assert!(Packet::new(&bad).is_err(), "{bad:02x?}");
            for b in a + 1..bits {
                flip(&mut bad, b);
                assert!(Packet::new(&bad).is_err(), "{bad:02x?}");
                for c in b + 1..bits {
                    flip(&mut bad, c);
                    assert!(Packet::new(&bad).is_err(), "{bad:02x?}");
                    flip(&mut bad, c);
                }
                flip(&mut bad, b);
            }
            flip(&mut bad, a);
        }
        assert_eq!(bad, good);
    }
}

#[test]
fn a_false_header_does_not_swallow_what_follows() {
    // It announces 200 bytes; the true packet inside is found as soon as it is whole.
    let mut stream = bytes("FF FF FD 00 01 C8 00 55 00 12");
    let ping = bytes("FF FF FD 00 01 03 00 01 19 4E");
    stream.extend_from_slice(&ping);
    let mut receiver = Receiver::<MAX_PACKET>::default();
    let found = stream
        .iter()
        .filter(|byte| receiver.push(**byte).is_some())
        .count();
    assert_eq!((found, receiver.is_empty()), (1, true));
    // One that looks like a joint status does, until it is given up.
    let mut stream = bytes("FF FF FD 00 FE C8 00 55 00 12");
    stream.extend_from_slice(&ping);
    assert!(stream.iter().all(|byte| receiver.push(*byte).is_none()));
    receiver.give_up();
    assert_eq!(receiver.next_packet().map(|packet| packet.id()), Some(1));
}

#[test]
fn what_does_not_fit_is_not_written() {
    assert_eq!(Request::Ping.emit(1, &mut [0; 9]), None);
    let data = [0xff; 20];
    let write = Request::Write {
        address: 0,
        data: &data,
    };
    assert_eq!(write.emit(1, &mut [0; 30]), None);
    assert_eq!(emit_status(&mut [0; 30], 1, ErrorByte(0), &data), None);
}

/// Bytes in which runs of stuffing are frequent.
fn dense(most: usize) -> impl Strategy<Value = Vec<u8>> {
    let byte = prop_oneof![3 => Just(0xffu8), 2 => Just(0xfd), 1 => Just(0), 1 => any::<u8>()];
    proptest::collection::vec(byte, 0..most)
}

proptest! {
    #[test]
    fn data_survives_stuffing_and_holds_no_header(id in 0..=MAX_ID, error: u8, data in dense(60)) {
        let mut out = [0; 128];
        let length = emit_status(&mut out, id, ErrorByte(error), &data).unwrap();
        let packet = Packet::new(&out[..length]).unwrap();
        let (found, read) = packet.status().unwrap();
        prop_assert_eq!(found, ErrorByte(error));
        prop_assert!(read.eq(data.iter().copied()));
        let is_header = |four: &&[u8]| *four == HEADER;
        prop_assert_eq!(out[..length - 2].windows(4).filter(is_header).count(), 1);
    }

    #[test]
    fn requests_survive(id in 0..=MAX_ID, address: u16, count in 1u16..8, data in dense(48)) {
        let whole = &data[..data.len() / (usize::from(count) + 1) * (usize::from(count) + 1)];
        let fives = &data[..data.len() / 5 * 5];
        for request in [
            Request::Read { address, count },
            Request::SyncRead { fast: data.len() % 2 == 0, address, count, ids: &data },
            Request::SyncWrite { address, count, blocks: whole },
            Request::BulkRead { fast: data.len() % 2 == 1, items: fives },
            Request::BulkWrite { items: &data },
        ] {
            let mut out = [0; 128];
            let length = request.emit(id, &mut out).unwrap();
            let packet = Packet::new(&out[..length]).unwrap();
            let parameters: Vec<u8> = packet.parameters().collect();
            prop_assert_eq!(Request::parse(packet.instruction(), &parameters), Ok(request));
        }
    }

    #[test]
    fn packets_are_found_behind_noise(noise in dense(80), id in 0..=MAX_ID, data in dense(12)) {
        let mut receiver = Receiver::<64>::default();
        for byte in noise {
            receiver.push(byte);
        }
        let mut out = [0; 64];
        let length = emit_status(&mut out, id, ErrorByte(0), &data).unwrap();
        let mut found = 0;
        for byte in out[..length].iter().cycle().take(8 * length) {
            let mut packet = receiver.push(*byte).map(|packet| packet.bytes() == &out[..length]);
            while let Some(is_same) = packet {
                found += usize::from(is_same);
                packet = receiver.next_packet().map(|packet| packet.bytes() == &out[..length]);
            }
        }
        // What the noise began swallows at most the receiver's 64 bytes.
        prop_assert!(found * length >= 8 * length - 64 - length, "{found} of {length} bytes");
    }

    #[test]
    fn any_bytes_are_taken_without_a_panic(stream in dense(400)) {
        let mut receiver = Receiver::<64>::default();
        for byte in stream {
            let Some(packet) = receiver.push(byte) else {
                continue;
            };
            let parameters: Vec<u8> = packet.parameters().collect();
            let _ = (Request::parse(packet.instruction(), &parameters), packet.status());
            let _ = fast_parts(packet.bytes(), [1, 2, 3].into_iter()).count();
        }
    }
}
