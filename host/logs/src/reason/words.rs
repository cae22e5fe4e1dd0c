//! Words of reasons: lists, numbers and what a file holds, in a readable length.

use super::LogReason::{self, DecimalCommas, WrongField};
use super::{FLAG, STAMP};
use crate::cell::decimal_comma;
use crate::error::Reason as _;
use crate::output::shortened;
use std::borrow::Cow;

/// What to do about a column all of whose cells are wrong as this one is.
pub(super) fn of_column(cell: &LogReason) -> Cow<'_, str> {
    let WrongField {
        found, expected, ..
    } = cell
    else {
        return cell.remedy();
    };
    if decimal_comma(found).is_some() {
        return DecimalCommas.remedy();
    }
    let is_number = found.replacen(',', ".", 1).parse::<f64>().is_ok();
    Cow::Borrowed(match *expected {
        _ if found.is_empty() => "record this column, or name another one in the model's [log]",
        STAMP if is_number => {
            "write the unit of these numbers for this column in the model's [log]: \
             unit = \"s\", \"ms\", \"us\" or \"ns\""
        }
        STAMP => {
            "save the times as such stamps, or as numbers with their unit in the model's [log]"
        }
        FLAG => "save this column as 0 and 1, or take it out of the model's [log]",
        _ => {
            "name a column of numbers in the model's [log], or save this one as numbers with a \
             decimal point"
        }
    })
}

/// "lines 5, 9, .."
pub(super) fn of_lines(lines: &[usize], more: usize) -> String {
    let named: Vec<String> = lines.iter().map(usize::to_string).collect();
    let rest = if more > lines.len() { ", .." } else { "" };
    let word = if more == 1 { "line" } else { "lines" };
    format!("{word} {}{rest}", named.join(", "))
}

pub(super) fn meant(nearest: &Option<String>) -> String {
    match nearest {
        Some(nearest) => format!("; did you mean '{}'?", shortened(nearest)),
        None => ".".to_string(),
    }
}

pub(super) fn and_no(column: &Option<String>) -> String {
    column.as_ref().map_or(String::new(), |column| {
        format!(", and no column '{}'", shortened(column))
    })
}

/// Up to 40 names.
pub(super) fn listed(names: &[String]) -> String {
    let shown: Vec<Cow<str>> = names
        .iter()
        .take(40)
        .map(|name| match name.as_str() {
            "" => "(unnamed)".into(),
            name => shortened(name),
        })
        .collect();
    let more = if names.len() > 40 { ", ..." } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// A number of any size in few characters.
pub(super) fn scientific(value: f64) -> String {
    format!("{value:.3e}")
}

/// A time with all its digits, unless it is too large to be one.
pub(super) fn short(time_s: f64) -> String {
    if time_s.abs() < 1e15 {
        time_s.to_string()
    } else {
        format!("{time_s:e}")
    }
}

/// What a field holds, up to 40 characters.
pub(super) fn quoted(text: &str) -> String {
    match text {
        "" => "nothing".to_string(),
        text => format!("'{}'", shortened(text)),
    }
}
