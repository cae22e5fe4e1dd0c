//! The packets of the manual and others, byte for byte.

extern crate std;

use super::*;
use std::vec::Vec;

pub(super) fn bytes(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

/// This request makes these bytes, and is read from them.
#[track_caller]
fn is(id: u8, request: Request, text: &str) {
    let mut out = [0; 128];
    let length = request.emit(id, &mut out).unwrap();
    assert_eq!(out[..length], bytes(text)[..], "{:02x?}", &out[..length]);
    let packet = Packet::new(&out[..length]).unwrap();
    assert_eq!(packet.id(), id);
    let parameters: Vec<u8> = packet.parameters().collect();
    assert_eq!(
        Request::parse(packet.instruction(), &parameters),
        Ok(request)
    );
}

/// This status makes these bytes, and is read from them.
#[track_caller]
fn says(id: u8, error: u8, data: &[u8], text: &str) {
    let mut out = [0; 128];
    let length = emit_status(&mut out, id, ErrorByte(error), data).unwrap();
    assert_eq!(out[..length], bytes(text)[..], "{:02x?}", &out[..length]);
    let packet = Packet::new(&out[..length]).unwrap();
    let (found, read) = packet.status().unwrap();
    assert_eq!((packet.id(), found), (id, ErrorByte(error)));
    assert!(read.eq(data.iter().copied()));
}

#[test]
fn instructions_to_one_servo() {
    is(1, Request::Ping, "FF FF FD 00 01 03 00 01 19 4E");
    is(BROADCAST, Request::Ping, "FF FF FD 00 FE 03 00 01 31 42");
    let read = |address, count| Request::Read { address, count };
    is(1, read(132, 4), "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15");
    is(
        1,
        read(126, 10),
        "FF FF FD 00 01 07 00 02 7E 00 0A 00 36 F9",
    );
    let write = |address, data| Request::Write { address, data };
    is(
        1,
        write(116, &[0, 2, 0, 0]),
        "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89",
    );
    is(1, write(64, &[1]), "FF FF FD 00 01 06 00 03 40 00 01 DB 66");
    is(1, write(98, &[5]), "FF FF FD 00 01 06 00 03 62 00 05 68 E4");
    is(1, write(98, &[0]), "FF FF FD 00 01 06 00 03 62 00 00 76 E4");
    let data = &[0xc8, 0, 0, 0];
    let later = Request::RegWrite { address: 104, data };
    is(1, later, "FF FF FD 00 01 09 00 04 68 00 C8 00 00 00 AE 8E");
    is(1, Request::Action, "FF FF FD 00 01 03 00 05 02 CE");
    is(
        1,
        Request::FactoryReset(1),
        "FF FF FD 00 01 04 00 06 01 A1 E6",
    );
    is(1, Request::Reboot, "FF FF FD 00 01 03 00 08 2F 4E");
    is(
        1,
        Request::Clear,
        "FF FF FD 00 01 08 00 10 01 44 58 4C 22 B1 DC",
    );
    let backup = |store| Request::Backup { store };
    is(
        1,
        backup(true),
        "FF FF FD 00 01 08 00 20 01 43 54 52 4C 16 F5",
    );
    is(
        1,
        backup(false),
        "FF FF FD 00 01 08 00 20 02 43 54 52 4C 9E F5",
    );
    is(
        1,
        write(116, &[0xff, 0xff, 0xfd, 0]),
        "FF FF FD 00 01 0A 00 03 74 00 FF FF FD FD 00 21 E7",
    );
}

#[test]
fn instructions_to_several_servos() {
    let sync = |fast, ids| Request::SyncRead {
        fast,
        address: 132,
        count: 4,
        ids,
    };
    is(
        BROADCAST,
        sync(false, &[1, 2]),
        "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA",
    );
    is(
        BROADCAST,
        sync(true, &[3, 7, 4]),
        "FF FF FD 00 FE 0A 00 8A 84 00 04 00 03 07 04 20 F2",
    );
    let blocks = &[1, 150, 0, 0, 0, 2, 170, 0, 0, 0];
    is(
        BROADCAST,
        Request::SyncWrite {
            address: 116,
            count: 4,
            blocks,
        },
        "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87",
    );
    let blocks = &[1, 0, 2, 0, 3, 0];
    is(
        BROADCAST,
        Request::SyncWrite {
            address: 64,
            count: 1,
            blocks,
        },
        "FF FF FD 00 FE 0D 00 83 40 00 01 00 01 00 02 00 03 00 FE 51",
    );
    let items = &[1, 144, 0, 2, 0, 2, 146, 0, 1, 0];
    is(
        BROADCAST,
        Request::BulkRead { fast: false, items },
        "FF FF FD 00 FE 0D 00 92 01 90 00 02 00 02 92 00 01 00 1A 05",
    );
}

#[test]
fn status_packets() {
    says(
        1,
        0,
        &[0x06, 0x04, 0x26],
        "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D",
    );
    says(
        1,
        0,
        &[0xb0, 0x04, 0x34],
        "FF FF FD 00 01 07 00 55 00 B0 04 34 B2 D4",
    );
    says(
        1,
        0,
        &[0xa6, 0, 0, 0],
        "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0",
    );
    says(
        1,
        0x80,
        &[0xa6, 0, 0, 0],
        "FF FF FD 00 01 08 00 55 80 A6 00 00 00 8F 7C",
    );
    says(1, 0, &[], "FF FF FD 00 01 04 00 55 00 A1 0C");
    says(1, 4, &[], "FF FF FD 00 01 04 00 55 04 BA 8C");
    says(1, 7, &[], "FF FF FD 00 01 04 00 55 07 B0 8C");
    says(
        2,
        0,
        &[0x1f, 0x08, 0, 0],
        "FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE",
    );
    // Current -1, velocity -3, position 2048; then current -5, velocity -3, position 2301.
    says(
        1,
        0,
        &[0xff, 0xff, 0xfd, 0xff, 0xff, 0xff, 0x00, 0x08, 0x00, 0x00],
        "FF FF FD 00 01 0F 00 55 00 FF FF FD FD FF FF FF 00 08 00 00 49 F0",
    );
    says(
        1,
        0,
        &[0xfb, 0xff, 0xfd, 0xff, 0xff, 0xff, 0xfd, 0x08, 0x00, 0x00],
        "FF FF FD 00 01 0F 00 55 00 FB FF FD FF FF FF FD FD 08 00 00 9E 21",
    );
}

#[test]
fn an_alert_is_a_note_and_a_code_a_refusal() {
    let alert = ErrorByte(0x80);
    assert_eq!((alert.has_alert(), alert.code()), (true, None));
    let both = ErrorByte(0x87);
    assert_eq!(
        (both.has_alert(), both.code()),
        (true, Some(ErrorCode::Access))
    );
}

const FAST: &str = "FF FF FD 00 FE 19 00 55 00 03 A6 00 00 00 84 08 00 07 1F 08 00 00 16 CA 00 04 \
                    FF 03 00 00 D1 9E";

#[test]
fn a_joint_status_and_what_is_left_of_one_cut_short() {
    let whole = bytes(FAST);
    assert!(Packet::new(&whole).is_ok());
    let found = |bytes: &[u8]| -> Vec<(u8, u32)> {
        let word = |part: FastPart| u32::from_le_bytes(part.data.try_into().unwrap());
        fast_parts(bytes, [4; 3].into_iter())
            .map(|part| (part.id, word(part)))
            .collect()
    };
    let all = [(3, 166), (7, 2079), (4, 1023)];
    assert_eq!(found(&whole), all);
    for cut in 0..whole.len() {
        let sound = match cut {
            0..16 => 0,
            16..24 => 1,
            24..32 => 2,
            _ => 3,
        };
        assert_eq!(found(&whole[..cut]), all[..sound], "{cut} bytes");
    }
    // A wrong bit in the second part leaves the first.
    let mut wrong = whole.clone();
    wrong[18] ^= 1;
    assert_eq!(found(&wrong), all[..1]);
    let part = |id, data| FastPart {
        id,
        error: ErrorByte(0),
        data,
    };
    let parts = [
        part(3, &[166, 0, 0, 0][..]),
        part(7, &[0x1f, 8, 0, 0]),
        part(4, &[0xff, 3, 0, 0]),
    ];
    let mut out = [0; 64];
    let length = emit_fast_status(&mut out, 24, &parts).unwrap();
    assert_eq!(out[..length], whole[..]);
    // It needs no more room than its own.
    assert_eq!(
        emit_fast_status(&mut out[..length], 24, &parts),
        Some(length)
    );
    assert_eq!(emit_fast_status(&mut out[..length - 1], 24, &parts), None);
    // Another header, id or instruction, its CRC being right, begins no joint status.
    for at in [0, 4, 7] {
        let mut other = bytes(FAST)[..16].to_vec();
        other[at] ^= 1;
        let crc = crc16(0, &other[..14]).to_le_bytes();
        other[14..].copy_from_slice(&crc);
        assert_eq!(found(&other), [], "byte {at}");
    }
}
