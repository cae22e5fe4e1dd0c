//! What a cell of a text log says: a number, or that there is none.

/// Words for a value that is not there, in lower case: of R, SQL, Python, Excel, Julia, C.
const MISSING: &str = "nan na n/a #n/a #na null none nil missing nat -nan(ind) nan(ind) 1.#qnan 1.#ind <na> \
    undefined #div/0! #value! #num!";

/// Signs that stand where a value is missing.
const DASHES: [&str; 4] = ["-", "--", "---", "\u{2013}"];

/// Whether a field says that there is no value: empty, `nan`, `NA`, `NULL`, `None`, ..
pub(super) fn is_missing(text: &str) -> bool {
    let is_number = text.as_bytes().iter().take(2).any(u8::is_ascii_digit);
    let plain = text.strip_prefix(['-', '+']).unwrap_or(text);
    text.is_empty()
        || DASHES.contains(&text)
        // Microsoft's C writes a number that is none as 1.#QNAN.
        || ((!is_number || text.contains('#'))
            && MISSING
                .split(' ')
                .any(|word| plain.eq_ignore_ascii_case(word) || text.eq_ignore_ascii_case(word)))
}

/// The number in a field; a comma counts as the decimal point where it cannot separate fields, `D`
/// as the exponent that Fortran writes.
pub(super) fn number(field: &str, separator: u8) -> Option<f64> {
    if let Ok(value) = field.parse() {
        return Some(value);
    }
    if separator != b',' && field.matches(',').count() == 1 && !field.contains('.') {
        return plain(&field.replace(',', "."));
    }
    plain(field)
}

/// The number that a field of commas between fields holds with a decimal comma: `"0,5"`.
pub(super) fn decimal_comma(field: &str) -> Option<f64> {
    let begins =
        field.starts_with(['-', '+', ',']) || field.starts_with(|c: char| c.is_ascii_digit());
    if begins && field.matches(',').count() == 1 && !field.contains('.') {
        plain(&field.replace(',', "."))
    } else {
        None
    }
}

fn plain(field: &str) -> Option<f64> {
    if let Ok(value) = field.parse() {
        return Some(value);
    }
    let (mantissa, exponent) = field.split_once(['d', 'D'])?;
    let is_number = |text: &str| {
        let first = text.bytes().find(|byte| !b"+-.".contains(byte));
        first.is_some_and(|byte| byte.is_ascii_digit())
    };
    let fits = is_number(mantissa) && is_number(exponent);
    fits.then(|| format!("{mantissa}e{exponent}").parse().ok())
        .flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_programs_write_them() {
        let numbers = [
            ("1.5", b',', 1.5),
            ("1,5", b';', 1.5),
            ("1.5D-03", b',', 1.5e-3),
            ("-0.25d+02", b'\t', -25.0),
            ("1,5D1", b';', 15.0),
        ];
        for (text, separator, value) in numbers {
            assert_eq!(number(text, separator), Some(value), "{text}");
        }
        for text in ["1,5", "D3", "1D", "deg", "1.5D3.5", "aD1", "0x1D3", ""] {
            assert_eq!(number(text, b','), None, "{text}");
        }
        assert_eq!(decimal_comma("-0,5"), Some(-0.5));
        assert_eq!(["1,2,3", "a,b", "1.0,2", "5"].map(decimal_comma), [None; 4]);
    }

    #[test]
    fn words_for_nothing_are_gaps() {
        for text in [
            "", "nan", "NaN", "NA", "N/A", "n/a", "NULL", "null", "None", "-nan", "#N/A", "<NA>",
            "-", "--", "1.#QNAN", "-1.#IND",
        ] {
            assert!(is_missing(text), "{text}");
        }
        for text in ["0", "-1", "x", "no", "inf", "-x", "nano", "1nan", "1.#"] {
            assert!(!is_missing(text), "{text}");
        }
    }
}
