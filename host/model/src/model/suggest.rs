//! Suggests the nearest known name, or the unit that a key lacks.

use crate::effects::{NameMatch, look_up};

/// Which of the known names was meant, and which there are. Where effects are named, what people
/// call them counts: `stribeck` for `stiction`.
pub fn suggest(name: &str, known: &[impl AsRef<str>]) -> String {
    let known: Vec<&str> = known.iter().map(AsRef::as_ref).collect();
    let called: Vec<String> = effects_called(name)
        .into_iter()
        .filter(|id| known.contains(id))
        .map(|id| format!("`{id}`"))
        .collect();
    let all = known.join(", ");
    match (called.as_slice(), nearest(name, known)) {
        ([one], _) => format!("write {one}; known here: {all}"),
        ([first @ .., last], _) => {
            let first = first.join(", ");
            format!("write {first} or {last}; known here: {all}")
        }
        ([], Some(near)) => format!("did you mean `{near}`? known here: {all}"),
        ([], None) => format!("known here: {all}"),
    }
}

/// The known name that is most like this one, if any is.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let slips = |known: &str| strsim::damerau_levenshtein(name, known);
    known
        .into_iter()
        .map(|known| (strsim::jaro_winkler(name, known), known))
        .filter(|(likeness, known)| *likeness > 0.8 || slips(known) <= known.len() / 3)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, known)| known)
}

/// Ids of the effects of this name, which may be an alias.
fn effects_called(name: &str) -> Vec<&'static str> {
    match look_up(name) {
        NameMatch::One(effect) => vec![effect.info().id],
        NameMatch::Several(effects) => effects.iter().map(|effect| effect.info().id).collect(),
        NameMatch::Similar(_) => Vec::new(),
    }
}
