//! The closed loop with the plan: the measured one, then each model's.

use super::Report;
use super::page::{Section, table};
use crate::compare::{CLOSED_LOOP_LEGEND, Comparison, closed_loop_rows};
use maud::html;

pub(super) fn section(report: &Report) -> Option<Section> {
    let comparisons = report.comparisons.iter();
    let loops: Vec<_> = comparisons.filter_map(Comparison::named_loop).collect();
    let rows = closed_loop_rows(&loops);
    let (header, rows) = rows.split_first()?;
    let headings = html! {
        th { "Figure" }
        @for name in header.iter().skip(1) { th.number { (name) } }
    };
    let body = html! {
        @for row in rows {
            tr {
                @for (index, cell) in row.iter().enumerate() {
                    td.number[index > 0] { (cell) }
                }
            }
        }
    };
    Some(Section {
        id: "closed-loop",
        title: "Closed loop with the plan",
        lead: CLOSED_LOOP_LEGEND,
        body: table(&headings, &body),
    })
}
