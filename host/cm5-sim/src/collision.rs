//! Replies that overlap: the line is low while any servo pulls it low.

/// A transmitted byte: start of its start bit, ns, and its value.
pub(super) type Sent = (u64, u8);

/// Bytes that a UART receives from overlapping transmissions of `bit_ns` a bit, each with the end
/// of its stop bit, ns.
pub(super) fn received(sent: &[Sent], bit_ns: u64) -> Vec<(u64, u8)> {
    // How finely the listener looks for a start bit, ns.
    let look_ns = (bit_ns / 4).max(1);
    let byte_ns = 10 * bit_ns;
    let Some(mut at_ns) = sent.iter().map(|(begin, _)| *begin).min() else {
        return Vec::new();
    };
    let end_ns = sent.iter().map(|(begin, _)| begin + byte_ns).max();
    let is_low = |at_ns: u64| sent.iter().any(|byte| pulls(byte, at_ns, bit_ns));
    let mut bytes = Vec::new();
    while Some(at_ns) < end_ns {
        if !is_low(at_ns) {
            at_ns += look_ns;
            continue;
        }
        let bit = |place: u64| u8::from(!is_low(at_ns + bit_ns * (place + 1) + bit_ns / 2));
        let byte = (0..8).fold(0, |byte, place| byte | bit(place) << place);
        bytes.push((at_ns + byte_ns, byte));
        // It looks for the next start bit from the middle of the stop bit on.
        at_ns += byte_ns - bit_ns / 2;
        // A line that is still low has no edge to find.
        while Some(at_ns) < end_ns && is_low(at_ns) {
            at_ns += look_ns;
        }
    }
    bytes
}

/// Whether this byte pulls the line low at this moment: its start bit and its zeros.
fn pulls((begin_ns, byte): &Sent, at_ns: u64, bit_ns: u64) -> bool {
    let Some(into_ns) = at_ns.checked_sub(*begin_ns) else {
        return false;
    };
    match into_ns / bit_ns {
        0 => true,
        place @ 1..=8 => byte >> (place - 1) & 1 == 0,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use handstand_shared::dynamixel::timing::{BIT_NS, BYTE_NS};

    const TALK: [u8; 6] = [0xff, 0xff, 1, 2, 0, 0xfc];

    fn sent(begin_ns: u64) -> Vec<Sent> {
        let begins = (0..).map(|place| begin_ns + place * BYTE_NS);
        begins.zip(TALK).collect()
    }

    #[test]
    fn one_reply_arrives_intact_and_two_collide() {
        let alone = received(&sent(5_000), BIT_NS);
        let bytes: Vec<u8> = alone.iter().map(|(_, byte)| *byte).collect();
        assert_eq!((bytes, alone[0].0), (TALK.to_vec(), 15_000));
        // At the very same moment the same words are one.
        assert_eq!(
            received(&[sent(5_000), sent(5_000)].concat(), BIT_NS),
            alone
        );
        for late_ns in [1_000, 3_500, 9_000, 14_000] {
            let both = received(&[sent(5_000), sent(5_000 + late_ns)].concat(), BIT_NS);
            let bytes: Vec<u8> = both.iter().map(|(_, byte)| *byte).collect();
            assert_ne!(bytes, TALK, "{late_ns}");
            assert!(!bytes.is_empty());
        }
    }
}
