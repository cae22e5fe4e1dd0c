//! Damaged frames and random bytes.

use super::{Args, Row};
use handstand_measure::bench::{FrameTally, bit_flips, patterns, random_bytes, resynchronised};
use handstand_measure::firmware::Built;
use serde_json::json;

pub(super) fn frames(args: &Args, _: Option<&Built>) -> Vec<Row> {
    let row = |name, tally: FrameTally, count: u64| Row {
        name,
        measured: format!("{} tried, {} accepted", tally.tried, count),
        limit: "0",
        holds: Some(count == 0),
        values: json!({"tried": tally.tried, "accepted": tally.wrong, "critical": tally.critical}),
    };
    let five = patterns(if args.quick { 4 } else { 5 }, args.seed);
    let short = bit_flips(12, args.reduced(100, 10), args.seed);
    let mut rows = vec![
        row(
            "1 to 5 wrong bits of a 12-byte frame (--quick: 4)",
            five,
            five.wrong,
        ),
        row(
            "1 to 3 wrong bits of 12-byte frames, 100 payloads (--quick: 10)",
            short,
            short.wrong,
        ),
    ];
    if !args.quick {
        let long = bit_flips(52, 20, args.seed);
        rows.push(row(
            "1 to 3 wrong bits of reports of 52 bytes, 20 payloads",
            long,
            long.wrong,
        ));
    }
    let bytes = if args.quick {
        args.bytes.min(10_000_000)
    } else {
        args.bytes
    };
    let random = random_bytes(bytes, args.seed);
    rows.push(Row {
        measured: format!(
            "{bytes} bytes: {} arm, torque or gain frames; {} other bodies passed the CRC-16",
            random.critical, random.wrong
        ),
        ..row("random bytes", random, random.critical)
    });
    let lost = resynchronised(args.reduced(100_000, 1000), args.seed);
    rows.push(Row {
        name: "frames lost after garbage",
        measured: format!("at most {lost}"),
        limit: "2",
        holds: Some(lost <= 2),
        values: json!({"lost": lost}),
    });
    rows
}
