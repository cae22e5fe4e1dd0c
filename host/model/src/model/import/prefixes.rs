//! Prefixes of vendors' elements that a robot's file uses and never declares, as old files do:
//! readers of URDF pass over them.

use super::xml::parsed;
use roxmltree::Error;
use std::borrow::Cow;
use std::ops::Range;

/// Most prefixes that are declared in a file's stead.
const MOST: usize = 32;

/// The text with each prefix that it does not declare declared in its first element, as a namespace
/// of that name. Lines stay; columns of the first element's line move.
pub(in crate::model) fn declared(text: &str) -> Cow<'_, str> {
    let mut text = Cow::Borrowed(text);
    for _ in 0..MOST {
        let Err(Error::UnknownNamespace(prefix, _)) = parsed(&text) else {
            break;
        };
        let Some(at) = behind_first_tag(&text) else {
            break;
        };
        text.to_mut()
            .insert_str(at, &format!(" xmlns:{prefix}=\"{prefix}\""));
    }
    text
}

/// Where [`declared`] has added to a text, bytes of what it made of it.
pub(in crate::model) fn added(text: &str, declared: &str) -> Range<usize> {
    let at = behind_first_tag(text).unwrap_or(0);
    at..at + declared.len() - text.len()
}

/// Where the name of the first element ends.
fn behind_first_tag(text: &str) -> Option<usize> {
    let is_name = |letter: char| letter.is_alphabetic() || letter == '_';
    let begins = text.match_indices('<').find_map(|(at, _)| {
        let first = text[at + 1..].chars().next()?;
        is_name(first).then_some(at + 1)
    })?;
    let ends =
        text[begins..].find(|letter: char| letter.is_whitespace() || "/>".contains(letter))?;
    Some(begins + ends)
}
