//! No file makes the reader panic.

use super::*;

/// Reads and judges, whatever comes of it.
fn survive(log: &tempfile::NamedTempFile) {
    let request = [LogRequest::whole(log.path())];
    let _ = read(&request, &columns());
    let _ = check(&request, &model(position_drive(), columns()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        for ending in [".csv", ".json"] {
            let log = file(&bytes, ending);
            survive(&log);
        }
    }

    #[test]
    fn mutated_logs_are_survived(at in 0usize..200, byte in any::<u8>(), cut in 0usize..200, twice in any::<bool>()) {
        let mut bytes = rows("t_s;q;u", ';').into_bytes();
        let length = bytes.len();
        bytes[at % length] = byte;
        if twice {
            let tail = bytes[cut % length..].to_vec();
            bytes.extend(tail);
        } else {
            bytes.truncate(length - cut % length);
        }
        let log = file(&bytes, ".csv");
        survive(&log);
    }
}
