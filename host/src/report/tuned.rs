//! What a search of weights found, in words.

use crate::study::{Tried, Tuned};

/// The chosen weights as options, and how they compare with the request's own.
pub fn tuned_text(tuned: &Tuned) -> String {
    let figures = |one: &Tried| {
        let reach = if one.region_open {
            "at least"
        } else {
            "within"
        };
        format!(
            "stabilised {reach} {:.2} deg, disk margin {:.3}",
            one.region_rad.to_degrees(),
            one.disk_margin
        )
    };
    let chosen = &tuned.tried[tuned.chosen];
    let weights = match (&chosen.q, &chosen.r) {
        (Some(q), Some(r)) => format!("--q {} --r {}", options(q), options(r)),
        _ => "the weights without --tune, which none of the others surpasses".to_string(),
    };
    format!(
        "tuned, of {} weights: {weights}: {}; without --tune: {}",
        tuned.tried.len(),
        figures(chosen),
        figures(&tuned.tried[0])
    )
}

/// Every digit, so that the options make the same gains.
fn options(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(f64::to_string).collect();
    values.join(",")
}
