//! Bytes of the two lines: servo packets, frames and messages, and what is stored of them.

use super::text;
use handstand::link::Exchange;
use handstand_shared::dynamixel::{Parser, Request, Status};
use handstand_shared::dynamixel2;
use handstand_shared::frame::{Decoder, MAX_FRAME, encode};
use handstand_shared::gains::GainTable;
use handstand_shared::message::{self, Command, Message, Report};
use handstand_shared::plan::Plan;

/// Whatever the line carries, a packet that is found is whole, and a request in it is written as it
/// was read.
pub(crate) fn dynamixel(bytes: &[u8]) {
    let mut parser = Parser::<256>::default();
    for byte in bytes {
        let Some(packet) = parser.push(*byte) else {
            continue;
        };
        let status = Status::of(packet);
        let mut out = [0; 256];
        if let Some(length) = status.emit(&mut out) {
            assert_eq!(&out[..length], packet.bytes(), "{status:?}");
        }
        if let Ok(request) = Request::parse(packet)
            && let Some(length) = request.emit(packet.id(), &mut out)
        {
            assert_eq!(&out[..length], packet.bytes(), "{request:?}");
        }
    }
}

/// The same of Protocol 2.0. A sender that stuffs otherwise may be read, so what is read is written
/// and read again. Parts of a joint status lie within it.
pub(crate) fn dynamixel2(bytes: &[u8]) {
    let mut receiver = dynamixel2::Receiver::<256>::default();
    for byte in bytes {
        let mut packet = receiver.push(*byte);
        while let Some(found) = packet {
            let (id, instruction) = (found.id(), found.instruction());
            let parameters: Vec<u8> = found.parameters().collect();
            let lengths = [2, 4, 10].into_iter().cycle().take(8);
            for part in dynamixel2::fast_parts(found.bytes(), lengths) {
                assert!(part.data.len() < found.bytes().len());
            }
            let mut out = [0; 512];
            if let Ok(request) = dynamixel2::Request::parse(instruction, &parameters) {
                let length = request.emit(id, &mut out).expect("it fits twice over");
                let again = dynamixel2::Packet::new(&out[..length]).expect("a sound packet");
                assert!(
                    again.parameters().eq(parameters.iter().copied()),
                    "{request:?}"
                );
            }
            if let Some((error, data)) = found.status() {
                let data: Vec<u8> = data.collect();
                let length = dynamixel2::emit_status(&mut out, id, error, &data);
                let length = length.expect("it fits twice over");
                let again = dynamixel2::Packet::new(&out[..length]).expect("a sound packet");
                assert_eq!(again.status().map(|(_, data)| data.collect()), Some(data));
            }
            packet = receiver.next_packet();
        }
    }
}

/// A frame that passes its check is the frame that its body makes.
pub(crate) fn frame(bytes: &[u8]) {
    let mut decoder = Decoder::default();
    let mut from = 0;
    for (at, byte) in bytes.iter().enumerate() {
        if let Some(Ok(body)) = decoder.push(*byte) {
            let mut out = [0; MAX_FRAME];
            let length = encode(body, &mut out).expect("a body that was decoded fits");
            assert_eq!(&out[..length], &bytes[from..=at], "{body:?}");
        }
        if *byte == 0 {
            from = at + 1;
        }
    }
}

fn both_ways<M: Message + PartialEq + std::fmt::Debug>(body: &[u8]) {
    let Ok(read) = message::decode::<M>(body) else {
        return;
    };
    let mut out = [0; MAX_FRAME];
    let Some(length) = message::encode(read.sequence, &read.message, &mut out) else {
        return;
    };
    let mut frame = out;
    let body = handstand_shared::frame::decode(&mut frame[..length - 1]).expect("a sound frame");
    let again = message::decode::<M>(body).expect("what was written is a message");
    assert_eq!(again, read);
}

/// A message that is read is the same when it is written and read again.
pub(crate) fn message(bytes: &[u8]) {
    both_ways::<Command>(bytes);
    both_ways::<Report>(bytes);
}

/// A plan that is read is the same when it is written and read again.
pub(crate) fn plan(bytes: &[u8]) {
    let Some(plan) = Plan::from_bytes(bytes) else {
        return;
    };
    let mut written = Vec::new();
    plan.bytes(|byte| written.push(byte));
    assert_eq!(Plan::from_bytes(&written).as_ref(), Some(&plan));
    assert_eq!(written, bytes);
    let _ = plan.fingerprint();
}

/// The same for a gain table of the size on board.
pub(crate) fn gain_table(bytes: &[u8]) {
    let Some(table) = GainTable::<2, 6>::from_bytes(bytes) else {
        return;
    };
    let mut written = Vec::new();
    table.bytes(|byte| written.push(byte));
    assert_eq!(written, bytes);
    let _ = (table.is_safe(), table.fingerprint());
}

/// A line of a tapped link.
pub(crate) fn exchange(bytes: &[u8]) {
    let Some(text) = text(bytes) else {
        return;
    };
    if let Some(exchange) = Exchange::parse(text) {
        let again = Exchange::parse(&exchange.line()).expect("a line that was written");
        assert_eq!((again.way, again.bytes), (exchange.way, exchange.bytes));
    }
}
