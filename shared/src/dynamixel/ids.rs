//! Lists of servo ids as users write them.

use core::ops::RangeInclusive;

/// How to write a list of ids, for error messages.
pub const ID_LIST_SYNTAX: &str = "write 1-18 or 1-4+9, each 0 to 253";

/// Parse a list of servo ids such as `1-4+9` or `1-4,9`: the ids in order, `None` where a part
/// names none.
pub fn ids(text: &str) -> impl Iterator<Item = Option<u8>> + '_ {
    text.split(['+', ',']).flat_map(|part| {
        let range = range(part);
        let wrong = range.is_none().then_some(None);
        range.into_iter().flatten().map(Some).chain(wrong)
    })
}

fn range(part: &str) -> Option<RangeInclusive<u8>> {
    let (first, last) = part.split_once('-').unwrap_or((part, part));
    let (first, last) = (first.trim().parse().ok()?, last.trim().parse().ok()?);
    (first <= last && last < super::BROADCAST).then_some(first..=last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_and_single_ids_are_read_and_others_refused() {
        assert!(ids("1-3+7, 9").eq([1, 2, 3, 7, 9].map(Some)));
        for wrong in ["", "5-2", "254", "1-", "a", "1++2"] {
            assert!(ids(wrong).any(|id| id.is_none()), "{wrong}");
        }
    }
}
