use super::*;
use ::mcap::records::MessageHeader;
use ::mcap::{WriteOptions, Writer};

/// A file of three messages by the crate that writes recordings, and where chunks are not
/// wanted none.
fn file(chunks: bool) -> Vec<u8> {
    let mut bytes = Vec::new();
    let options = WriteOptions::new().compression(None).use_chunks(chunks);
    let mut writer = Writer::with_options(std::io::Cursor::new(&mut bytes), options).unwrap();
    let schema = writer.add_schema("numbers", "text", b"n").unwrap();
    let channel = writer
        .add_channel(schema, "/numbers", "json", &Default::default())
        .unwrap();
    for sequence in 1..=3 {
        let header = MessageHeader {
            channel_id: channel,
            sequence,
            log_time: 10 * u64::from(sequence),
            publish_time: 0,
        };
        writer.write_to_known_channel(&header, b"[1]").unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    bytes
}

fn read(bytes: &[u8]) -> (Vec<(u32, u64)>, McapEnd) {
    let mut seen = Vec::new();
    let end = messages::<()>(bytes, |message| {
        let said = (
            message.topic,
            message.schema,
            message.encoding,
            message.data,
        );
        assert_eq!(said, ("/numbers", "numbers", "json", &b"[1]"[..]));
        seen.push((message.sequence, message.log_time_ns));
        Ok(())
    });
    (seen, end.unwrap())
}

#[test]
fn every_message_is_read_with_its_channel() {
    for chunks in [true, false] {
        let expected = vec![(1, 10), (2, 20), (3, 30)];
        assert_eq!(read(&file(chunks)), (expected, McapEnd::Complete));
    }
}

#[test]
fn a_damaged_chunk_and_a_cut_file_are_told_apart() {
    let whole = file(true);
    let at = whole.windows(3).position(|three| three == b"[1]").unwrap();
    let mut damaged = whole.clone();
    damaged[at] ^= 1;
    let broken = McapEnd::Broken("its checksum does not match".into());
    assert_eq!(read(&damaged), (vec![], broken));
    assert_eq!(read(&whole[..at]).1, McapEnd::Torn);
    assert_eq!(read(&file(false)[..whole.len() / 2]).1, McapEnd::Torn);
    assert_eq!(read(MAGIC), (vec![], McapEnd::Torn));
}

#[test]
fn lengths_that_no_file_bears_reserve_nothing() {
    let framed = |kind: u8, body: &[u8]| {
        let length = (body.len() as u64).to_le_bytes();
        [MAGIC, &[kind], &length, body].concat()
    };
    // A channel whose topic is 4 GB long; an attachment too short for its checksum.
    let channel = [&[0; 4][..], &u32::MAX.to_le_bytes()].concat();
    assert_eq!(read(&framed(CHANNEL, &channel)).1, McapEnd::Torn);
    let attachment = [framed(9, b"12"), MAGIC.to_vec()].concat();
    assert_eq!(read(&attachment).1, McapEnd::Complete);
    let endless = [MAGIC, &[MESSAGE], &u64::MAX.to_le_bytes()].concat();
    assert_eq!(read(&endless).1, McapEnd::Torn);
}
