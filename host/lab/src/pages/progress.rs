//! How far long work is: one bar, the best so far in words and picture, and what ends it.

use crate::plot::{Bar, Tone};
use crate::session::ShownUnit;
use maud::{Markup, html};

/// The box, which a script shows while something runs; errors of the best so far are in `unit`.
pub fn progress(unit: Option<ShownUnit>) -> Markup {
    html! {
        div #progress hidden data-error-unit=[unit.map(|unit| unit.error_unit)]
            data-error-per-si=[unit.map(|unit| unit.error_per_si)] {
            div.row {
                span #what {}
                progress aria-label="Progress" {}
                span.note #left {}
                button #stop type="button" { "Stop" }
            }
            @if unit.is_some() { (best()) }
        }
    }
}

/// The best so far; its bar is the script's.
fn best() -> Markup {
    let bar = Bar {
        mark: Some(0.0),
        ..Bar::new(0.0, 1.0, Tone::Blue)
    };
    html! {
        div #best hidden {
            div.best-bars {
                span { "model as given" }
                (Bar::new(1.0, 1.0, Tone::Orange).draw())
                span.number #best-before {}
                span { "best so far: " b #best-name {} }
                (bar.draw())
                span.number #best-error {}
            }
            div.row {
                button #accept type="button" { "Take the best so far" }
                span.note { "Ends the search and judges what it found; what was not tried is said. \
                             The thin line is the noise floor, " span #best-floor {} "." }
            }
        }
    }
}
