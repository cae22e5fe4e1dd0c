//! The units that keys of model files end in.

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

/// The unit that the suffix of a key names: 1 where it has none.
pub(super) const fn unit_of(key: &str) -> &'static str {
    let mut index = 0;
    while index < SUFFIXES.len() {
        let (suffix, unit) = SUFFIXES[index];
        if ends_with(key.as_bytes(), suffix.as_bytes()) {
            return unit;
        }
        index += 1;
    }
    "1"
}

const fn ends_with(text: &[u8], end: &[u8]) -> bool {
    let mut behind = 1;
    while behind <= end.len() {
        if behind > text.len() || text[text.len() - behind] != end[end.len() - behind] {
            return false;
        }
        behind += 1;
    }
    true
}
