//! Time stamps as ISO 8601 writes them: `2026-03-01T12:00:00.123456789+01:00`.

use chrono::{FixedOffset, NaiveDateTime, NaiveTime, TimeDelta};

/// Nanoseconds since 1970-01-01T00:00:00Z, or since midnight of a time of day without a date; none
/// of a text that is no such stamp.
///
/// Between date and time of day stands `T` or a blank; the date's parts may be parted by `/`. The
/// fraction has up to nine digits, further ones are cut off. Without an offset the stamp counts as
/// UTC. A leap second is the first one of the next minute. A time of day has seconds; it may follow
/// `N days`, as pandas writes durations.
pub(super) fn iso_ns(text: &str) -> Option<i64> {
    let text = text.trim();
    // Most cells are numbers.
    if !text.contains(':') {
        return None;
    }
    if let Some(ns) = day_ns(text) {
        return Some(ns);
    }
    let (date, rest) = text.split_once(['T', 't', ' '])?;
    let rest = rest.trim_start();
    let zone = rest.find(['Z', 'z', '+', '-']).unwrap_or(rest.len());
    let (clock, zone) = rest.split_at(zone);
    let clock = clock.trim_end();
    let clock = if has_shape(clock, "00:00") {
        format!("{clock}:00")
    } else {
        plain_clock(clock)?
    };
    let date = date.replace('/', "-");
    if !has_shape(&date, "0000-00-00") {
        return None;
    }
    let stamp = NaiveDateTime::parse_from_str(&format!("{date}T{clock}"), "%FT%T%.f").ok()?;
    let offset = match zone {
        "" | "Z" | "z" => 0,
        zone => offset_s(zone)?,
    };
    let utc = stamp.checked_sub_offset(FixedOffset::east_opt(offset)?)?;
    utc.and_utc().timestamp_nanos_opt()
}

/// `12:00:00.25`, `0:00:01`, `1 days 00:00:00.01`.
fn day_ns(text: &str) -> Option<i64> {
    let days = text
        .split_once(" days ")
        .or_else(|| text.split_once(" day, "));
    let (days, clock) = match days {
        Some((days, clock)) => (days.parse::<i32>().ok()?, clock),
        None => (0, text),
    };
    let clock = match clock.find(':') {
        Some(1) => format!("0{clock}"),
        _ => clock.to_string(),
    };
    let clock = NaiveTime::parse_from_str(&plain_clock(&clock)?, "%T%.f").ok()?;
    let of_day = clock - NaiveTime::MIN;
    (TimeDelta::days(days.into()) + of_day).num_nanoseconds()
}

/// A time of day with seconds, its fraction of at most nine digits behind a point.
fn plain_clock(clock: &str) -> Option<String> {
    let (whole, fraction) = clock.split_once(['.', ',']).unwrap_or((clock, "0"));
    let digits = !fraction.is_empty() && fraction.bytes().all(|byte| byte.is_ascii_digit());
    let fits = digits && has_shape(whole, "00:00:00");
    fits.then(|| format!("{whole}.{fraction:.9}"))
}

/// Seconds east of UTC: `+01:00`, `+0100`, `+01`.
fn offset_s(zone: &str) -> Option<i32> {
    let hours = if zone.len() == 3 { ":00" } else { "" };
    let zone = format!("{zone}{hours}");
    let fits = has_shape(&zone[1..], "00:00") || has_shape(&zone[1..], "0000");
    let offset = zone.parse::<FixedOffset>().ok().filter(|_| fits)?;
    Some(offset.local_minus_utc())
}

/// Whether a text is as long as a shape, with digits where that has zeros.
fn has_shape(text: &str, shape: &str) -> bool {
    let alike = |(own, wanted): (u8, u8)| match wanted {
        b'0' => own.is_ascii_digit(),
        sign => own == sign,
    };
    text.len() == shape.len() && text.bytes().zip(shape.bytes()).all(alike)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_are_read_to_the_nanosecond() {
        // As `date -u -d ... +%s` counts.
        let cases = [
            ("1970-01-01T00:00:00Z", 0),
            ("2026-03-01T12:00:00.123456789Z", 1_772_366_400_123_456_789),
            ("2024-02-29 23:59:59,5", 1_709_251_199_500_000_000),
            ("2026-03-01T13:00:00+01:00", 1_772_366_400_000_000_000),
            ("2026-03-01T06:30:00-0530", 1_772_366_400_000_000_000),
            ("1969-12-31T23:59:59Z", -1_000_000_000),
            ("2026-03-01T12:00", 1_772_366_400_000_000_000),
            ("2026/03/01 12:00:00.5", 1_772_366_400_500_000_000),
            ("12:00:00.25", 43_200_250_000_000),
            ("0:00:01", 1_000_000_000),
            ("2 days 00:00:00.010000", 172_800_010_000_000),
        ];
        for (text, ns) in cases {
            assert_eq!(iso_ns(text), Some(ns), "{text}");
        }
    }

    #[test]
    fn other_texts_are_none() {
        let texts = [
            "",
            "12",
            "2026-03-01",
            "2025-02-29T00:00:00",
            "2026-13-01T00:00:00",
            "2026-01-01T24:00:00",
            "2026-01-01T00:00:00.",
            "2026-01-01T00:00:00+1",
            "2026-01-01T00:00:00Zx",
            "26-01-01T00:00:00",
            "2026-01-01T00:00:00é",
            "9999-99-99T99:99:99",
            "12:00",
            "25:00:00",
            "12:60:00",
            "1:2:3",
            "999999999999 days 00:00:00",
            "03/01/2026 12:00:00",
            "2026-01-01-02T00:00:00",
        ];
        for text in texts {
            assert_eq!(iso_ns(text), None, "{text}");
        }
    }
}
