//! Two axes that span a rectangle, and the marks between them.

use super::decimate;
use super::scale::{Scale, drawable};
use maud::{Markup, html};

/// Colour of a mark; the style sheet gives each a light and a dark one that the colour-blind tell
/// apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tone {
    /// As text.
    Ink,
    /// First of two that are compared.
    Orange,
    /// Second of two.
    Blue,
    /// Third.
    Green,
    /// For reference; its curves are dashed.
    Grey,
}

impl Tone {
    /// Class in the style sheet.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Ink => "tone-ink",
            Self::Orange => "tone-orange",
            Self::Blue => "tone-blue",
            Self::Green => "tone-green",
            Self::Grey => "tone-grey",
        }
    }
}

/// A coordinate, to a tenth of a pixel; 0 for what is not finite.
pub(crate) fn at(place: f64) -> String {
    let tenths = Some((10.0 * place).round()).filter(|tenths| tenths.is_finite());
    // Adding 0 makes a negative zero positive.
    format!("{:.1}", tenths.unwrap_or(0.0) / 10.0 + 0.0)
}

/// Two scales that span a rectangle.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axes {
    /// Left to right.
    pub(crate) x: Scale,
    /// Bottom to top: its first place is the lower edge.
    pub(crate) y: Scale,
}

impl Axes {
    /// Vertical grid lines, about `wanted`.
    pub(crate) fn columns(&self, wanted: usize) -> Markup {
        let (bottom, top) = self.y.ends();
        html! {
            @for (value, _) in self.x.ticks(wanted) {
                @let x = at(self.x.place(value));
                line class="grid" x1=(x) x2=(x) y1=(at(bottom)) y2=(at(top)) {}
            }
        }
    }

    /// Labels of the x axis at about `wanted` round values, and its title.
    pub(crate) fn x_labels(&self, wanted: usize, title: &str) -> Markup {
        self.x_texts(&self.x.ticks(wanted), title)
    }

    /// These labels of the x axis, and its title.
    pub(super) fn x_texts(&self, labels: &[(f64, String)], title: &str) -> Markup {
        let (bottom, _) = self.y.ends();
        let (left, right) = self.x.ends();
        html! {
            @for (value, text) in labels {
                text class="tick" x=(at(self.x.place(*value))) y=(at(bottom + 14.0))
                    text-anchor="middle" { (text) }
            }
            text class="label" x=(at((left + right) / 2.0)) y=(at(bottom + 29.0))
                text-anchor="middle" { (title) }
        }
    }

    /// Horizontal grid lines, about `wanted`, with labels on the left, and the axis' title above.
    pub(crate) fn rows(&self, wanted: usize, title: &str) -> Markup {
        let (left, right) = self.x.ends();
        let (_, top) = self.y.ends();
        html! {
            @for (value, text) in self.y.ticks(wanted) {
                @let y = self.y.place(value);
                line class="grid" x1=(at(left)) x2=(at(right)) y1=(at(y)) y2=(at(y)) {}
                text class="tick" x=(at(left - 6.0)) y=(at(y + 3.5)) text-anchor="end" { (text) }
            }
            text class="label" x=(at(left)) y=(at(top - 7.0)) { (title) }
        }
    }

    /// What is drawn along x, with the scales that a page's script needs to stretch it.
    pub(crate) fn course(&self, drawn: &Markup) -> Markup {
        html! { g.course data-x=(self.x.as_data()) data-y=(self.y.as_data()) { (drawn) } }
    }

    /// A curve, decimated to the pixels; a point that cannot be drawn leaves a gap.
    pub(crate) fn curve(&self, points: impl IntoIterator<Item = (f64, f64)>, tone: Tone) -> Markup {
        let path = decimate::path(points, &self.x, &self.y);
        html! {
            @if !path.is_empty() {
                path class={ "line " (tone.class()) } d=(path) {}
            }
        }
    }

    /// Dotted lines from bottom to top, where something begins.
    pub(crate) fn starts(&self, places: impl IntoIterator<Item = f64>) -> Markup {
        let (bottom, top) = self.y.ends();
        let places = places.into_iter().filter(|x| drawable(*x));
        let line = |x| format!("M{} {}V{}", at(self.x.place(x)), at(bottom), at(top));
        let lines: String = places.map(line).collect();
        html! { @if !lines.is_empty() { path class="start" d=(lines) {} } }
    }

    /// Points as dots of this radius, px.
    pub(super) fn dots(&self, points: &[(f64, f64)], radius: f64) -> Markup {
        html! {
            @for (x, y) in points.iter().filter(|(x, y)| drawable(*x) && drawable(*y)) {
                circle cx=(at(self.x.place(*x))) cy=(at(self.y.place(*y))) r=(radius) {}
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
