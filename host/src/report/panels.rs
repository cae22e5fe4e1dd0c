//! Small charts over the same steps, side by side in one SVG file that needs nothing beside it.

use super::scale::{Scale, span};
use super::svg::{Plot, Tone, at};
use maud::{Markup, PreEscaped, html};

/// One chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What its height counts, with its unit.
    pub title: String,
    /// Labels of the steps from left to right.
    pub steps: Vec<String>,
    /// What the steps are, with their unit.
    pub across: String,
    /// Its curves, at most three.
    pub curves: Vec<Curve>,
}

/// One curve: a value for each step.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name, shown where there are several; empty for none.
    pub name: String,
    /// Values; none leaves a gap.
    pub values: Vec<Option<f64>>,
    /// Ends of each value's interval; empty for none.
    pub intervals: Vec<[f64; 2]>,
}

const WIDTH: f64 = 430.0;
const HEIGHT: f64 = 250.0;
const HEAD: f64 = 44.0;
const TONES: [Tone; 3] = [Tone::After, Tone::Before, Tone::Floor];

const STYLE: &str = "
svg { font-family: system-ui, 'DejaVu Sans', sans-serif; }
.paper { fill: #fff; } .title { font-size: 17px; font-weight: 600; fill: #1b1f24; }
.grid { stroke: #d8dee4; } .tick { font-size: 11px; fill: #57606a; } .label { font-size: 11.5px; fill: #1b1f24; }
.line { fill: none; stroke: var(--tone); stroke-width: 1.8; stroke-linejoin: round; }
.dot { fill: var(--tone); } .whisker { stroke: var(--tone); stroke-width: 1.2; opacity: .55; }
.tone-after { --tone: #0072b2; } .tone-before { --tone: #d55e00; } .tone-floor { --tone: #009e73; }
";

/// The charts, two to a row, under a title.
pub fn panels(title: &str, panels: &[Panel]) -> String {
    let rows = panels.len().div_ceil(2);
    let (width, height) = (2.0 * WIDTH, HEAD + HEIGHT * rows as f64);
    let view = format!("0 0 {} {}", at(width), at(height));
    let drawn = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(view) width=(at(width)) height=(at(height)) {
            style { (PreEscaped(STYLE)) }
            rect class="paper" width=(at(width)) height=(at(height)) {}
            text class="title" x="20" y="28" { (title) }
            @for (index, panel) in panels.iter().enumerate() {
                @let (left, top) = (WIDTH * (index % 2) as f64, HEAD + HEIGHT * (index / 2) as f64);
                (draw(panel, left, top))
            }
        }
    };
    format!("{}\n", drawn.into_string())
}

fn draw(panel: &Panel, left: f64, top: f64) -> Markup {
    let last = panel.steps.len().saturating_sub(1) as f64;
    let heights = panel.curves.iter().flat_map(|curve| {
        let ends = curve.intervals.iter().flatten().copied();
        curve.values.iter().flatten().copied().chain(ends)
    });
    let plot = Plot {
        x: Scale::new((-0.3, last + 0.3), (left + 62.0, left + WIDTH - 18.0)),
        // From nothing up: these are all sizes and shares.
        y: Scale::new(
            span(heights.chain([0.0]), 0.04),
            (top + HEIGHT - 52.0, top + 30.0),
        ),
    };
    let (bottom, _) = plot.y.ends();
    let (begin, end) = plot.x.ends();
    html! {
        (plot.rows(5, &panel.title))
        @for (step, label) in panel.steps.iter().enumerate() {
            text class="tick" x=(at(plot.x.place(step as f64))) y=(at(bottom + 15.0)) text-anchor="middle" { (label) }
        }
        text class="label" x=(at((begin + end) / 2.0)) y=(at(bottom + 33.0)) text-anchor="middle" { (panel.across) }
        @for ((curve, tone), place) in panel.curves.iter().zip(TONES).zip([0.0, 1.0, 2.0]) {
            (stroke(curve, tone, &plot))
            @if panel.curves.len() > 1 {
                g class=(tone.class()) {
                    circle class="dot" cx=(at(end - 120.0)) cy=(at(top + 14.0 * place + 10.0)) r="3.5" {}
                    text class="tick" x=(at(end - 112.0)) y=(at(top + 14.0 * place + 14.0)) { (curve.name) }
                }
            }
        }
    }
}

fn stroke(curve: &Curve, tone: Tone, plot: &Plot) -> Markup {
    let points = || {
        let values = curve.values.iter().enumerate();
        values.map(|(step, value)| (step as f64, value.unwrap_or(f64::NAN)))
    };
    html! {
        g class=(tone.class()) {
            @for (step, [low, high]) in curve.intervals.iter().enumerate() {
                @let x = at(plot.x.place(step as f64));
                line class="whisker" x1=(x) x2=(x) y1=(at(plot.y.place(*low))) y2=(at(plot.y.place(*high))) {}
            }
            (plot.curve(points(), tone))
            @for (step, value) in points().filter(|point| point.1.is_finite()) {
                circle class="dot" cx=(at(plot.x.place(step))) cy=(at(plot.y.place(value))) r="3" {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_is_no_point_and_markup_is_escaped() {
        let svg = panels(
            "a < b",
            &[Panel {
                title: "share, %".into(),
                steps: ["0", "1", "2"].map(String::from).to_vec(),
                across: "level".into(),
                curves: vec![Curve {
                    name: String::new(),
                    values: vec![Some(1.0), None, Some(3.0)],
                    intervals: Vec::new(),
                }],
            }],
        );
        assert_eq!(svg.matches("<circle").count(), 2);
        assert!(svg.contains("a &lt; b") && !svg.contains("NaN"));
    }
}
