//! The closed loop with the plan: the measured one, then each model's.

use super::Report;
use super::page::Section;
use super::table::page_matrix;
use crate::compare::{CLOSED_LOOP_LEGEND, Comparison, closed_loop_rows};

pub(super) fn section(report: &Report) -> Option<Section> {
    let comparisons = report.comparisons.iter();
    let loops: Vec<_> = comparisons.filter_map(Comparison::named_loop).collect();
    let rows = closed_loop_rows(&loops);
    if rows.is_empty() {
        return None;
    }
    Some(Section {
        id: "closed-loop",
        title: "Closed loop with the plan",
        lead: CLOSED_LOOP_LEGEND,
        body: page_matrix(&rows),
    })
}
