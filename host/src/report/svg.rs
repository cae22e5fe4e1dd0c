//! Charts: axes with round ticks, curves, bands. Colours are tones that the style sheet gives.

use super::scale::Scale;
use super::thin;
use maud::{Markup, html};

/// Whose data a mark shows; the style sheet has a colour for each, told apart by the colour-blind too.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    /// What was measured.
    Measured,
    /// The first model.
    Before,
    /// The last model.
    After,
    /// What noise and resolution leave.
    Floor,
    /// What is there for reference.
    Quiet,
}

impl Tone {
    /// Class in the style sheet.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Measured => "tone-measured",
            Self::Before => "tone-before",
            Self::After => "tone-after",
            Self::Floor => "tone-floor",
            Self::Quiet => "tone-quiet",
        }
    }
}

/// A coordinate, to a tenth of a pixel; numbers that are none are never written.
pub(crate) fn at(place: f64) -> String {
    let tenths = (10.0 * place).round();
    let place = if tenths.is_finite() {
        tenths / 10.0
    } else {
        0.0
    };
    // Adding nothing makes a negative zero positive.
    format!("{:.1}", place + 0.0)
}

/// Two scales that span a rectangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plot {
    /// Left to right.
    pub(crate) x: Scale,
    /// Bottom to top: its first place is the lower edge.
    pub(crate) y: Scale,
}

impl Plot {
    /// Vertical grid lines.
    pub(crate) fn columns(&self, wanted: usize) -> Markup {
        let (bottom, top) = self.y.ends();
        html! {
            @for (value, _) in self.x.ticks(wanted) {
                @let x = at(self.x.place(value));
                line class="grid" x1=(x) x2=(x) y1=(at(bottom)) y2=(at(top)) {}
            }
        }
    }

    /// Labels below, and what they count.
    pub(crate) fn x_labels(&self, wanted: usize, label: &str) -> Markup {
        let (bottom, _) = self.y.ends();
        let (left, right) = self.x.ends();
        html! {
            @for (value, text) in self.x.ticks(wanted) {
                text class="tick" x=(at(self.x.place(value))) y=(at(bottom + 14.0)) text-anchor="middle" { (text) }
            }
            text class="label" x=(at((left + right) / 2.0)) y=(at(bottom + 29.0)) text-anchor="middle" { (label) }
        }
    }

    /// Horizontal grid lines with labels on the left, and what they count above them.
    pub(crate) fn rows(&self, wanted: usize, label: &str) -> Markup {
        let (left, right) = self.x.ends();
        let (_, top) = self.y.ends();
        html! {
            @for (value, text) in self.y.ticks(wanted) {
                @let y = self.y.place(value);
                line class="grid" x1=(at(left)) x2=(at(right)) y1=(at(y)) y2=(at(y)) {}
                text class="tick" x=(at(left - 6.0)) y=(at(y + 3.5)) text-anchor="end" { (text) }
            }
            text class="label" x=(at(left)) y=(at(top - 7.0)) { (label) }
        }
    }

    /// A curve, thinned to the pixels.
    pub(crate) fn curve(&self, points: impl IntoIterator<Item = (f64, f64)>, tone: Tone) -> Markup {
        let path = thin::path(points, &self.x, &self.y);
        html! {
            @if !path.is_empty() {
                path class={ "line " (tone.class()) } d=(path) {}
            }
        }
    }

    /// A band between two heights.
    pub(crate) fn band(&self, low: f64, high: f64, tone: Tone) -> Markup {
        let ((left, right), bottom, top) = (self.x.ends(), self.y.held(low), self.y.held(high));
        html! {
            rect class={ "band " (tone.class()) } x=(at(left)) width=(at(right - left)) y=(at(top))
                height=(at((bottom - top).max(0.0))) {}
        }
    }
}
