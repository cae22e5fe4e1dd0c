//! Time stamps as ISO 8601 writes them: `2026-03-01T12:00:00.123456789+01:00`.

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
    let date = match date.contains('-') {
        true => date.into(),
        false => date.replace('/', "-"),
    };
    let mut parts = date.split('-');
    let (year, month, day) = (
        digits(parts.next()?, 4)?,
        digits(parts.next()?, 2)?,
        digits(parts.next()?, 2)?,
    );
    let rest = rest.trim_start();
    let zone = rest.find(['Z', 'z', '+', '-']).unwrap_or(rest.len());
    let (clock, zone) = rest.split_at(zone);
    let mut clock = clock.trim_end().splitn(3, ':');
    let (hour, minute) = (digits(clock.next()?, 2)?, digits(clock.next()?, 2)?);
    let (second, nanosecond) = match clock.next() {
        None => (0, 0),
        Some(text) => match text.split_once(['.', ',']) {
            None => (digits(text, 2)?, 0),
            Some((whole, fraction)) => (digits(whole, 2)?, nanoseconds(fraction)?),
        },
    };
    let fits = parts.next().is_none()
        && (1..=12).contains(&month)
        && (1..=days_in(year, month)).contains(&day)
        && hour < 24
        && minute < 60
        && second <= 60;
    let seconds = (days_since_1970(year, month, day) * 24 + hour) * 3600 + minute * 60 + second;
    let seconds = fits.then_some(seconds - offset_s(zone)?)?;
    seconds.checked_mul(1_000_000_000)?.checked_add(nanosecond)
}

/// `12:00:00.25`, `0:00:01`, `1 days 00:00:00.01`.
fn day_ns(text: &str) -> Option<i64> {
    let (days, clock) = match text
        .split_once(" days ")
        .or_else(|| text.split_once(" day, "))
    {
        Some((days, clock)) => (days.parse::<i32>().ok()?, clock),
        None => (0, text),
    };
    let (hour, rest) = clock.split_once(':')?;
    let (minute, second) = rest.split_once(':')?;
    let (second, fraction) = second.split_once(['.', ',']).unwrap_or((second, "0"));
    let hour = digits(hour, 2).or_else(|| digits(hour, 1))?;
    let (minute, second) = (digits(minute, 2)?, digits(second, 2)?);
    let fits = hour < 24 && minute < 60 && second <= 60;
    let seconds = ((i64::from(days) * 24 + hour) * 60 + minute) * 60 + second;
    fits.then(|| {
        seconds
            .checked_mul(1_000_000_000)?
            .checked_add(nanoseconds(fraction)?)
    })?
}

/// A number of exactly so many digits.
fn digits(text: &str, count: usize) -> Option<i64> {
    let plain = text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit());
    plain.then(|| text.parse().ok()).flatten()
}

fn nanoseconds(fraction: &str) -> Option<i64> {
    let plain = !fraction.is_empty() && fraction.bytes().all(|byte| byte.is_ascii_digit());
    plain
        .then(|| format!("{:0<9.9}", fraction).parse().ok())
        .flatten()
}

/// Seconds east of UTC: `Z`, `+01:00`, `+0100`, `+01`.
fn offset_s(zone: &str) -> Option<i64> {
    let sign = match zone.chars().next() {
        None => return Some(0),
        Some('Z' | 'z') => return (zone.len() == 1).then_some(0),
        Some('-') => -1,
        Some(_) => 1,
    };
    let plain = zone[1..].replacen(':', "", 1);
    let (hours, minutes) = match plain.len() {
        2 => (digits(&plain, 2)?, 0),
        4 => (digits(plain.get(..2)?, 2)?, digits(plain.get(2..)?, 2)?),
        _ => return None,
    };
    Some(sign * (hours * 3600 + minutes * 60))
}

fn days_in(year: i64, month: i64) -> i64 {
    match month {
        2 if (year % 4 == 0 && year % 100 != 0) || year % 400 == 0 => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Days of the Gregorian calendar; years begin in March, so that a leap day ends one.
fn days_since_1970(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = match month {
        ..=2 => (year - 1, month + 9),
        _ => (year, month - 3),
    };
    let leap_days = year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    let in_year = (153 * month + 2) / 5 + day - 1;
    365 * year + leap_days + in_year - 719_468
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
