//! What others wrote, cut to a length that people read.

use std::borrow::Cow;

/// Most characters of a name or a value.
const WORD: usize = 40;
/// Most characters of a message; of a longer one the begin and the end stay.
const MESSAGE: usize = 2000;
const BEGIN: usize = 1500;
const END: usize = 200;

/// A name or a value, up to 40 characters of it.
pub fn shortened(text: &str) -> Cow<'_, str> {
    match text.char_indices().nth(WORD) {
        Some((end, _)) => format!("{}...", &text[..end]).into(),
        None => text.into(),
    }
}

/// A message, its begin and its end where it is longer than 2000 characters: what it repeats of a
/// file may be of any length.
pub fn readable(message: impl ToString) -> String {
    let message = message.to_string();
    if message.len() <= MESSAGE || message.chars().count() <= MESSAGE {
        return message;
    }
    let begin: String = message.chars().take(BEGIN).collect();
    let end = message.char_indices().rev().nth(END - 1);
    let end = end.map_or("", |(at, _)| &message[at..]);
    format!("{begin} [..] {end}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_cut_between_characters() {
        assert_eq!(shortened("angle_deg"), "angle_deg");
        assert_eq!(shortened(&"ä".repeat(41)), format!("{}...", "ä".repeat(40)));
        let said = readable(format!("ä{}ö: mend it", "é".repeat(50_000)));
        assert!(said.starts_with('ä') && said.ends_with("ö: mend it"));
        assert_eq!(said.chars().count(), BEGIN + END + 6);
        assert_eq!(readable("short"), "short");
    }
}
