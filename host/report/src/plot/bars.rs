//! Small drawings inside tables: bars and intervals.

use super::axes::{Tone, at};
use super::scale::{Scale, drawable, span};
use maud::{Markup, html};

/// A bar from 0 to `value` on a scale that ends at `full`, with a pale bar up to `ghost` and a thin
/// line at `mark`.
#[derive(Debug, Clone, Copy)]
pub struct Bar {
    /// What it shows.
    pub value: f64,
    /// Value at the right end.
    pub full: f64,
    /// Whose it is.
    pub tone: Tone,
    /// Where it came from.
    pub ghost: Option<f64>,
    /// A thin line to compare with.
    pub mark: Option<f64>,
}

impl Bar {
    /// A bar of `value` in a row whose full length is `full`.
    pub fn new(value: f64, full: f64, tone: Tone) -> Self {
        Self {
            value,
            full,
            tone,
            ghost: None,
            mark: None,
        }
    }

    /// As markup.
    pub fn draw(&self) -> Markup {
        let share = |value: f64| {
            let share = 1e3 * value / self.full;
            at(Some(share)
                .filter(|share| share.is_finite())
                .map_or(0.0, |s| s.clamp(0.0, 1e3)))
        };
        html! {
            svg.bar viewBox="0 0 1000 10" preserveAspectRatio="none" aria-hidden="true" {
                rect.trough x="0" y="0" width="1000" height="10" {}
                @if let Some(ghost) = self.ghost {
                    rect class={ "ghost " (self.tone.class()) } x="0" y="0" width=(share(ghost))
                        height="10" {}
                }
                rect class={ "area " (self.tone.class()) } x="0" y="0" width=(share(self.value))
                    height="10" {}
                @if let Some(mark) = self.mark {
                    @let x = share(mark);
                    line class="mark" x1=(x) x2=(x) y1="0" y2="10" {}
                }
            }
        }
    }
}

/// Largest drawable value, for the right end of a set of bars.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values
        .into_iter()
        .filter(|value| drawable(*value))
        .fold(0.0, f64::max)
}

/// An interval with its value; `off` is the value at which the effect vanishes, marked if there is
/// one.
pub fn interval(value: f64, low: f64, high: f64, off: Option<f64>) -> Markup {
    if ![value, low, high].into_iter().all(drawable) || low > high {
        return html! {};
    }
    let off = off.filter(|off| drawable(*off));
    // Without a value to compare with, a tenth of the value sets the scale.
    let around = [value - 0.1 * value.abs(), value + 0.1 * value.abs()];
    let values = match off {
        Some(off) => span([value, low, high, off], 0.06),
        None => span([low, high, value].into_iter().chain(around), 0.06),
    };
    let x = Scale::new(values, (4.0, 156.0));
    let [left, dot, right] = [low, value, high].map(|value| at(x.held(value)));
    html! {
        svg.interval viewBox="0 0 160 20" role="img" aria-label="interval" {
            line class="axis" x1="2" x2="158" y1="10" y2="10" {}
            @if let Some(off) = off {
                @let x = at(x.held(off));
                line class="off" x1=(x) x2=(x) y1="2" y2="18" {}
            }
            line class="line tone-blue thick" x1=(left) x2=(right) y1="10" y2="10" {}
            line class="line tone-blue" x1=(left) x2=(left) y1="5" y2="15" {}
            line class="line tone-blue" x1=(right) x2=(right) y1="5" y2="15" {}
            circle class="area tone-blue" cx=(dot) cy="10" r="3.5" {}
        }
    }
}
