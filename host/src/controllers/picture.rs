//! The table of controllers and conditions as a picture: one field each, the darker the more robots are held.

use maud::{Markup, PreEscaped, html};

const LEFT: usize = 150;
const TOP: usize = 110;
const WIDE: usize = 62;
const HIGH: usize = 26;

/// An SVG page: `fields[i][j]` is the share that controller `rows[i]` holds under `columns[j]`.
pub fn picture(title: &str, rows: &[&str], columns: &[&str], fields: &[Vec<f64>]) -> String {
    let (width, height) = (
        LEFT + WIDE * columns.len() + 100,
        TOP + HIGH * rows.len() + 20,
    );
    let svg = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox={ "0 0 " (width) " " (height) } font-family="sans-serif" font-size="12" {
            rect width="100%" height="100%" fill="white" {}
            text x="12" y="20" font-size="14" { (title) }
            @for (j, column) in columns.iter().enumerate() {
                @let x = LEFT + WIDE * j + WIDE / 2;
                text transform={ "translate(" (x) " " (TOP - 8) ") rotate(-35)" } { (column) }
            }
            @for (i, row) in rows.iter().enumerate() {
                text x=(LEFT - 8) y=(TOP + HIGH * i + 17) text-anchor="end" { (row) }
                @for (j, held) in fields[i].iter().enumerate() {
                    (field(LEFT + WIDE * j, TOP + HIGH * i, *held))
                }
            }
        }
    };
    format!("{}\n", svg.into_string())
}

fn field(x: usize, y: usize, held: f64) -> Markup {
    // From near white to a blue on which white letters read.
    let tone = |from: f64, to: f64| (from + (to - from) * held).round();
    let fill = format!(
        "rgb({},{},{})",
        tone(245.0, 20.0),
        tone(245.0, 80.0),
        tone(245.0, 150.0)
    );
    let ink = if held > 0.5 { "white" } else { "black" };
    html! {
        rect x=(x) y=(y) width=(WIDE - 2) height=(HIGH - 2) fill=(fill) {}
        text x=(x + WIDE / 2 - 1) y=(y + 17) text-anchor="middle" fill=(ink) {
            (PreEscaped(format!("{:.0} %", 100.0 * held)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::picture;

    #[test]
    fn every_field_tells_its_share() {
        let svg = picture("held", &["a", "b"], &["x<y"], &[vec![1.0], vec![0.125]]);
        for text in ["100 %", "12 %", "x&lt;y", ">a<", ">b<"] {
            assert!(svg.contains(text), "{text}: {svg}");
        }
    }
}
