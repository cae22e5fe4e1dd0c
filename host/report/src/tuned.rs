//! What a search of weights found, in words.

use crate::study::{Tuned, WeightTrial};
use crate::synth::Weight;

/// The chosen weights as options, and how they compare with plain ones.
pub fn tuned_text(tuned: &Tuned) -> String {
    let figures = |place: usize| {
        let one = &tuned.tried[place];
        if one.region_rad == 0.0 {
            return "NOT stabilised".to_string();
        }
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
    let list = |values: &[f64]| Weight::Diagonal(values.to_vec());
    let WeightTrial { q, r, .. } = &tuned.tried[tuned.chosen];
    format!(
        "tuned, of {} weights: --q {} --r {}: {}; by Bryson's rule: {}; the paper's (--q 100): {}",
        tuned.tried.len(),
        list(q),
        list(r),
        figures(tuned.chosen),
        figures(0),
        figures(1)
    )
}
