//! An SVG file that needs nothing beside it.

use super::axes::at;
use super::chart::{Chart, Curve};
use maud::{Markup, PreEscaped, html};

/// Size of a chart, px.
const WIDTH: f64 = 430.0;
const HEIGHT: f64 = 250.0;
/// Height of the title's line, px.
const HEAD: f64 = 44.0;

/// Charts two to a row under a title, as an SVG file.
pub fn svg_file(title: &str, charts: &[Chart]) -> String {
    let height = HEAD + HEIGHT * charts.len().div_ceil(2) as f64;
    let drawn = html! {
        @for (index, chart) in charts.iter().enumerate() {
            @let corner = (WIDTH * (index % 2) as f64, HEAD + HEIGHT * (index / 2) as f64);
            (chart.drawn(corner, (WIDTH, HEIGHT)))
            @if chart.curves.len() > 1 {
                @for (line, curve) in chart.curves.iter().enumerate() {
                    (key(curve, corner.0 + WIDTH - 138.0, corner.1 + 14.0 * line as f64 + 10.0))
                }
            }
        }
    };
    document(title, (2.0 * WIDTH, height), &drawn)
}

fn key(curve: &Curve, x: f64, y: f64) -> Markup {
    html! {
        circle class={ "area " (curve.tone.class()) } cx=(at(x)) cy=(at(y)) r="3.5" {}
        text class="tick" x=(at(x + 8.0)) y=(at(y + 4.0)) { (curve.name) }
    }
}

/// The file around a drawing of this width and height, px.
pub(super) fn document(title: &str, (width, height): (f64, f64), drawn: &Markup) -> String {
    let view = format!("0 0 {width} {height}");
    let file = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(view) width=(width) height=(height)
            font-family="system-ui, 'DejaVu Sans', sans-serif" font-size="12" {
            style { (PreEscaped(super::STYLE)) }
            rect width="100%" height="100%" fill="var(--paper)" {}
            text x="20" y="28" font-size="17" font-weight="600" fill="var(--ink)" { (title) }
            (drawn)
        }
    };
    format!("{}\n", file.into_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Tone;

    /// A browser reads a file of SVG as XML, in which a bare `<` or `&` is an error.
    #[test]
    fn a_file_names_its_curves_and_is_escaped() {
        let curves = ["a & b", "c"].map(|name| Curve::line(name, Tone::Blue, vec![(0.0, 1.0)]));
        let file = svg_file("x < y", &[Chart::new("", "t", "v", curves.to_vec())]);
        for text in ["x &lt; y", "a &amp; b", "--blue:"] {
            assert!(file.contains(text), "{text}: {file}");
        }
    }
}
