//! Numbers and names as XML attributes.

/// A number with all its digits, in the fewest characters.
pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}

/// Numbers with blanks between them.
pub(super) fn numbers(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| number(*value)).collect();
    values.join(" ")
}

/// A text as an attribute's value.
pub(super) fn escaped(text: &str) -> String {
    let escape = |c: char| match c {
        '&' => "&amp;".to_string(),
        '<' => "&lt;".to_string(),
        '>' => "&gt;".to_string(),
        '"' => "&quot;".to_string(),
        c if c.is_control() => " ".to_string(),
        c => c.to_string(),
    };
    text.chars().map(escape).collect()
}

/// A text within a comment, which ends at two hyphens.
pub(super) fn comment(text: &str) -> String {
    escaped(text).replace("--", "- -")
}
