//! A chart as data: labels, curves; drawn as SVG or as text.

use super::axes::{Axes, Tone, at};
use super::scale::{Scale, span};
use super::text;
use maud::{Markup, html};

/// Ticks wanted across and up.
const COLUMNS: usize = 6;
const ROWS: usize = 5;

/// One chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What it shows; pages write it above, drawings do not hold it.
    pub title: String,
    /// Quantity along the bottom, with its unit.
    pub x_label: String,
    /// Quantity up the side, with its unit.
    pub y_label: String,
    /// Labels of x = 0, 1, 2, ...; empty for an axis of numbers. With categories the y axis
    /// begins at 0.
    pub categories: Vec<String>,
    /// What is drawn, the last in front.
    pub curves: Vec<Curve>,
    /// Lowest and highest x and y of the axes, as charts to be compared share them; those of the
    /// curves without.
    pub ends: Option<[(f64, f64); 2]>,
}

/// A curve, or dots.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name in the legend.
    pub name: String,
    /// Its colour.
    pub tone: Tone,
    /// Points; one that is not finite leaves a gap.
    pub points: Vec<(f64, f64)>,
    /// Lower and upper end of each point's interval; empty for none.
    pub intervals: Vec<[f64; 2]>,
    /// Drawn as dots rather than as a line.
    pub dots: bool,
}

impl Curve {
    /// A line.
    pub fn line(name: impl Into<String>, tone: Tone, points: Vec<(f64, f64)>) -> Self {
        Curve {
            name: name.into(),
            tone,
            points,
            intervals: Vec::new(),
            dots: false,
        }
    }

    /// Dots.
    pub fn dots(name: impl Into<String>, tone: Tone, points: Vec<(f64, f64)>) -> Self {
        Curve {
            dots: true,
            ..Curve::line(name, tone, points)
        }
    }

    /// A value for each category; none leaves a gap.
    pub fn by_category(
        name: impl Into<String>,
        tone: Tone,
        values: impl IntoIterator<Item = Option<f64>>,
    ) -> Self {
        let values = values.into_iter().enumerate();
        let point =
            |(place, value): (usize, Option<f64>)| (place as f64, value.unwrap_or(f64::NAN));
        Curve::line(name, tone, values.map(point).collect())
    }
}

impl Chart {
    /// A chart over an axis of numbers.
    pub fn new(
        title: impl Into<String>,
        x_label: &str,
        y_label: &str,
        curves: Vec<Curve>,
    ) -> Chart {
        Chart {
            title: title.into(),
            x_label: x_label.into(),
            y_label: y_label.into(),
            categories: Vec::new(),
            curves,
            ends: None,
        }
    }

    /// An SVG element `width` px by `height` px for a page with the style sheet of this module.
    pub fn svg(&self, width: f64, height: f64) -> Markup {
        html! {
            svg viewBox=(format!("0 0 {width} {height}")) role="img" aria-label=(self.title) {
                (self.drawn((0.0, 0.0), (width, height)))
            }
        }
    }

    /// As [`Chart::svg`], for a page whose script zooms along x.
    pub fn zoomable_svg(&self, width: f64, height: f64) -> Markup {
        let axes = self.axes((0.0, 0.0), (width, height));
        let curves = html! { @for curve in &self.curves { (self.mark(curve, &axes)) } };
        html! {
            svg viewBox=(format!("0 0 {width} {height}")) role="img" aria-label=(self.title) {
                g.columns { (axes.columns(COLUMNS)) }
                (axes.rows(ROWS, &self.y_label))
                g.ticks { (axes.x_labels(COLUMNS, &self.x_label)) }
                (axes.course(&curves))
            }
        }
    }

    /// The curves' names with their colours.
    pub fn legend(&self) -> Markup {
        html! {
            @for curve in &self.curves {
                span class={ "key " (curve.tone.class()) } { span.swatch {} (curve.name) }
            }
        }
    }

    /// As text of 61 columns and 14 lines: braille dots, grey curves dotted.
    pub fn text(&self) -> String {
        text::chart(self)
    }

    /// Gives charts the same axes: those that hold all of them.
    pub fn share_axes(charts: &mut [Chart]) {
        let spans: Vec<[(f64, f64); 2]> = charts.iter().map(|chart| chart.spans(0.04)).collect();
        let around = |axis: usize| {
            let ends = spans.iter().flat_map(|span| [span[axis].0, span[axis].1]);
            span(ends, 0.0)
        };
        let ends = [around(0), around(1)];
        charts.iter_mut().for_each(|chart| chart.ends = Some(ends));
    }

    /// Lowest and highest x and y, with a share of the height to spare.
    pub(super) fn spans(&self, spare: f64) -> [(f64, f64); 2] {
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let ends = self
            .curves
            .iter()
            .flat_map(|curve| curve.intervals.iter().flatten().copied());
        let y = points().map(|point| point.1).chain(ends);
        match self.categories.len() {
            0 => [span(points().map(|point| point.0), 0.0), span(y, spare)],
            count => [(-0.3, count as f64 - 0.7), span(y.chain([0.0]), spare)],
        }
    }

    /// Axes and curves in a rectangle with this upper left corner and this size, px.
    pub(super) fn drawn(&self, corner: (f64, f64), size: (f64, f64)) -> Markup {
        let axes = self.axes(corner, size);
        let categories = self.categories.iter().cloned().enumerate();
        let categories: Vec<(f64, String)> = categories
            .map(|(place, label)| (place as f64, label))
            .collect();
        html! {
            @if categories.is_empty() { (axes.columns(COLUMNS)) }
            (axes.rows(ROWS, &self.y_label))
            @match categories.is_empty() {
                true => (axes.x_labels(COLUMNS, &self.x_label)),
                false => (axes.x_texts(&categories, &self.x_label)),
            }
            @for curve in &self.curves { (self.mark(curve, &axes)) }
        }
    }

    fn axes(&self, (left, top): (f64, f64), (width, height): (f64, f64)) -> Axes {
        let [x, y] = self.ends.unwrap_or_else(|| self.spans(0.04));
        Axes {
            x: Scale::new(x, (left + 56.0, left + width - 12.0)),
            y: Scale::new(y, (top + height - 38.0, top + 26.0)),
        }
    }

    /// A curve; by category, its points are marked as well.
    fn mark(&self, curve: &Curve, axes: &Axes) -> Markup {
        let tone = curve.tone;
        html! {
            @if curve.dots {
                g class={ "dots " (tone.class()) } { (axes.dots(&curve.points, 1.8)) }
            } @else {
                (axes.curve(curve.points.iter().copied(), tone))
            }
            @if !self.categories.is_empty() {
                g class={ "area " (tone.class()) } {
                    @for ((x, _), ends) in curve.points.iter().zip(&curve.intervals) {
                        @let x = at(axes.x.place(*x));
                        @let [low, high] = ends.map(|y| at(axes.y.held(y)));
                        line class="error-bar" x1=(x) x2=(x) y1=(low) y2=(high) {}
                    }
                    (axes.dots(&curve.points, 3.0))
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_is_no_point_and_markup_is_escaped() {
        let chart = Chart {
            categories: ["0", "1", "2"].map(String::from).to_vec(),
            ..Chart::new(
                "a < b",
                "level",
                "share, %",
                vec![Curve::by_category(
                    "",
                    Tone::Blue,
                    [Some(1.0), None, Some(3.0)],
                )],
            )
        };
        let svg = chart.svg(400.0, 200.0).into_string();
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(svg.contains("a &lt; b") && !svg.contains("NaN"));
    }
}
