//! A table of shares as an SVG file: the larger a share, the darker its cell.

use super::file::document;
use maud::{Markup, html};

const LEFT: usize = 150;
const TOP: usize = 110;
const WIDE: usize = 62;
const HIGH: usize = 26;

/// An SVG file: `shares[i][j]`, 0 to 1, in row `rows[i]` and column `columns[j]`.
pub fn heat_map(title: &str, rows: &[&str], columns: &[&str], shares: &[Vec<f64>]) -> String {
    let width = LEFT + WIDE * columns.len() + 100;
    let height = TOP + HIGH * rows.len() + 20;
    let drawn = html! {
        @for (j, column) in columns.iter().enumerate() {
            @let x = LEFT + WIDE * j + WIDE / 2;
            text transform={ "translate(" (x) " " (TOP - 8) ") rotate(-35)" } { (column) }
        }
        @for (i, (row, shares)) in rows.iter().zip(shares).enumerate() {
            text x=(LEFT - 8) y=(TOP + HIGH * i + 17) text-anchor="end" { (row) }
            @for (j, share) in shares.iter().enumerate() {
                (cell(LEFT + WIDE * j, TOP + HIGH * i, *share))
            }
        }
    };
    document(title, (width as f64, height as f64), &drawn)
}

fn cell(x: usize, y: usize, share: f64) -> Markup {
    // From near white to a blue on which white letters read.
    let [red, green, blue] = [20.0, 80.0, 150.0].map(|to| (245.0 + (to - 245.0) * share).round());
    let ink = if share > 0.5 { "white" } else { "black" };
    let fill = format!("rgb({red},{green},{blue})");
    html! {
        rect x=(x) y=(y) width=(WIDE - 2) height=(HIGH - 2) fill=(fill) {}
        text x=(x + WIDE / 2 - 1) y=(y + 17) text-anchor="middle" fill=(ink) {
            (format!("{:.0} %", 100.0 * share))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::heat_map;

    #[test]
    fn every_cell_tells_its_share() {
        let svg = heat_map("held", &["a", "b"], &["x<y"], &[vec![1.0], vec![0.125]]);
        for text in ["100 %", "12 %", "x&lt;y", ">a<", ">b<"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
    }
}
