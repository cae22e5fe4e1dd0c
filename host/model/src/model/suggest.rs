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

/// Unit suffixes of keys, longest first where one ends in another.
const SUFFIXES: &[(&str, &str)] = &[
    ("_nm_s2_rad2", "N m s^2/rad^2"),
    ("_nm_s_rad", "N m s/rad"),
    ("_nm_rad", "N m/rad"),
    ("_n_s2_m2", "N s^2/m^2"),
    ("_n_s_m", "N s/m"),
    ("_n_m", "N/m"),
    ("_s_per_m", "s/m"),
    ("_per_m", "1/m"),
    ("_per_s", "1/s"),
    ("_s_per_rad", "s/rad"),
    ("_per_rad", "1/rad"),
    ("_kg_m2", "kg m^2"),
    ("_rad_s2", "rad/s^2"),
    ("_m_s2", "m/s^2"),
    ("_m_s", "m/s"),
    ("_rad_s", "rad/s"),
    ("_rad", "rad"),
    ("_ohm", "ohm"),
    ("_kg", "kg"),
    ("_nm", "N m"),
    ("_n", "N"),
    ("_m", "m"),
    ("_s", "s"),
    ("_v", "V"),
];

/// A key's stem and the unit its suffix names.
pub fn split_unit(key: &str) -> Option<(&str, &'static str)> {
    SUFFIXES
        .iter()
        .find_map(|(suffix, unit)| key.strip_suffix(suffix).map(|stem| (stem, *unit)))
}
