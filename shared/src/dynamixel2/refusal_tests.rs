//! Error codes, and what is no packet or no request.

extern crate std;

use super::tests::bytes;
use super::*;

#[test]
fn each_code_has_its_meaning_and_name() {
    let codes = [
        (1, ErrorCode::Result, "result fail"),
        (2, ErrorCode::Instruction, "instruction"),
        (3, ErrorCode::Crc, "CRC"),
        (4, ErrorCode::DataRange, "data range"),
        (5, ErrorCode::DataLength, "data length"),
        (6, ErrorCode::DataLimit, "data limit"),
        (7, ErrorCode::Access, "access"),
        (8, ErrorCode::Other(8), "unknown error"),
        (127, ErrorCode::Other(127), "unknown error"),
    ];
    for (code, meaning, name) in codes {
        assert_eq!(ErrorByte(code).code(), Some(meaning));
        assert_eq!(ErrorByte(0x80 | code).code(), Some(meaning));
        assert_eq!(meaning.name(), name);
        assert!(!ErrorByte(code).has_alert());
    }
    assert_eq!(ErrorByte(0).code(), None);
}

#[test]
fn parameters_that_do_not_fit_are_no_request() {
    let refused: [(u8, &[u8]); 13] = [
        (0x01, &[0]),
        (0x02, &[132, 0, 4]),
        (0x03, &[116, 0]),
        (0x04, &[116, 0]),
        (0x05, &[0]),
        (0x06, &[0x03]),
        (0x08, &[0]),
        (0x10, &[0x01, 0x44, 0x58, 0x4c, 0x23]),
        (0x20, &[0x01, 0x43, 0x54, 0x52, 0x4d]),
        (0x82, &[132, 0, 4]),
        // No bytes for each servo, and a block that is cut short.
        (0x83, &[116, 0, 0, 0]),
        (0x83, &[116, 0, 2, 0, 1, 7]),
        (0x92, &[1, 144, 0, 2]),
    ];
    for (instruction, parameters) in refused {
        let found = Request::parse(instruction, parameters);
        assert_eq!(found, Err(RequestError::Parameters), "{instruction:02x}");
    }
    for instruction in [0x00, 0x07, 0x55, 0x84] {
        let found = Request::parse(instruction, &[]);
        assert_eq!(found, Err(RequestError::Instruction(instruction)));
    }
    let status = "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0";
    assert_eq!(status_length(4), bytes(status).len());
}

/// Id 253 and 255 are no servo's; a length below 3 leaves no room for an instruction.
#[test]
fn headers_that_no_packet_has_are_refused() {
    let sound = |body: &str| {
        let mut packet = bytes(body);
        let crc = crc16(0, &packet);
        packet.extend(crc.to_le_bytes());
        packet
    };
    for id in ["FD", "FF"] {
        let packet = sound(&std::format!("FF FF FD 00 {id} 03 00 01"));
        assert_eq!(Packet::new(&packet), Err(PacketError::Header));
        let mut receiver = Receiver::<64>::default();
        assert!(packet.iter().all(|byte| receiver.push(*byte).is_none()));
        assert!(receiver.is_empty());
    }
    let packet = sound("FF FF FD 00 01 02 00");
    assert_eq!(Packet::new(&packet), Err(PacketError::Length));
    assert!(Packet::new(&sound("FF FF FD 00 01 03 00 01")).is_ok());
    // A status has an error byte.
    let bare = sound("FF FF FD 00 01 03 00 55");
    assert_eq!(Packet::new(&bare).map(|it| it.status().is_none()), Ok(true));
    let ping = bytes("FF FF FD 00 01 03 00 01 19 4E");
    assert!(Packet::new(&ping).unwrap().status().is_none());
}

/// A packet of exactly the receiver's size is received; one that is a byte longer is not waited
/// for.
#[test]
fn a_receiver_takes_what_it_has_room_for() {
    let mut out = [0; 16];
    let length = emit_status(&mut out, 1, ErrorByte(0), &[1, 2, 3, 4, 5]).unwrap();
    assert_eq!(length, out.len());
    let pushed = |bytes: &[u8], found: &mut dyn FnMut(u8) -> bool| {
        bytes.iter().filter(|byte| found(**byte)).count()
    };
    let mut fits = Receiver::<16>::default();
    assert_eq!(pushed(&out, &mut |byte| fits.push(byte).is_some()), 1);
    assert!(fits.is_empty());
    let mut small = Receiver::<15>::default();
    assert_eq!(pushed(&out, &mut |byte| small.push(byte).is_some()), 0);
    assert!(small.is_empty());
    // Half a packet is kept until it is forgotten.
    let mut half = Receiver::<16>::default();
    assert_eq!(pushed(&out[..8], &mut |byte| half.push(byte).is_some()), 0);
    assert!(!half.is_empty());
    half.reset();
    assert!(half.is_empty());
    assert_eq!(pushed(&out, &mut |byte| half.push(byte).is_some()), 1);
    // What was handed out is not handed out twice, and is given up with what follows it.
    assert!(half.next_packet().is_none());
}
