//! Suggests the nearest known name, or the unit that a key lacks.

/// Which of the known names was meant, and which there are.
pub fn suggest(name: &str, known: &[impl AsRef<str>]) -> String {
    let known: Vec<&str> = known.iter().map(AsRef::as_ref).collect();
    let all = known.join(", ");
    match nearest(name, known) {
        Some(near) => format!("did you mean `{near}`? known here: {all}"),
        None => format!("known here: {all}"),
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
pub(crate) fn split_unit(key: &str) -> Option<(&str, &'static str)> {
    SUFFIXES
        .iter()
        .find_map(|(suffix, unit)| key.strip_suffix(suffix).map(|stem| (stem, *unit)))
}
