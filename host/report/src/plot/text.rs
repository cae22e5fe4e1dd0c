//! A chart as text, its curves in braille dots.

use super::axes::Tone;
use super::chart::Chart;
use super::scale::Scale;
use crate::output::number::given;

/// Characters across and down.
const COLUMNS: usize = 60;
const ROWS: usize = 12;
/// Bits of a braille character's dots, 2 across and 4 down: Unicode numbers them 1 2 3 7 down
/// the left and 4 5 6 8 down the right.
const BITS: [[u8; 4]; 2] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];

/// Characters of a drawing.
type BrailleGrid = [[u8; COLUMNS]; ROWS];

/// Curves between two axes with their end values; grey curves show every fifth dot.
pub fn chart(chart: &Chart) -> String {
    let [x, y] = chart.spans(0.05);
    let across = Scale::new(x, (0.0, (2 * COLUMNS - 1) as f64));
    let down = Scale::new(y, ((4 * ROWS - 1) as f64, 0.0));
    let mut cells: BrailleGrid = [[0; COLUMNS]; ROWS];
    for curve in &chart.curves {
        let place = |&(x, y): &(f64, f64)| (across.held(x).round(), down.held(y).round());
        let dots: Vec<(f64, f64)> = curve.points.iter().map(place).collect();
        let every = if curve.tone == Tone::Grey { 5 } else { 1 };
        for dot in trail(&dots).into_iter().step_by(every) {
            set(&mut cells, dot);
        }
    }
    framed(&cells, chart, x, y)
}

fn set(cells: &mut BrailleGrid, (across, down): (f64, f64)) {
    let (across, down) = (across as usize, down as usize);
    cells[down / 4][across / 2] |= BITS[across % 2][down % 4];
}

/// Dots from each to the next without a gap.
fn trail(dots: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut trail = Vec::new();
    for ends in dots.windows(2) {
        let (from, to) = (ends[0], ends[1]);
        let (wide, high) = (to.0 - from.0, to.1 - from.1);
        let steps = wide.abs().max(high.abs()).max(1.0);
        trail.extend((0..=steps as usize).map(|step| {
            let share = step as f64 / steps;
            (
                (from.0 + share * wide).round(),
                (from.1 + share * high).round(),
            )
        }));
    }
    trail.dedup();
    trail
}

fn framed(cells: &BrailleGrid, chart: &Chart, x: (f64, f64), y: (f64, f64)) -> String {
    let mut lines = vec![format!("{:>9} {}", "", chart.y_label)];
    for (row, bits) in cells.iter().enumerate() {
        let mark = match row {
            0 => given(y.1),
            row if row == ROWS - 1 => given(y.0),
            _ => String::new(),
        };
        let dots = bits
            .iter()
            .filter_map(|bits| char::from_u32(0x2800 + u32::from(*bits)));
        lines.push(format!("{mark:>9} │{}", dots.collect::<String>()));
    }
    lines.push(format!("{:>9} └{}", "", "─".repeat(COLUMNS)));
    let (low, high) = (given(x.0), given(x.1));
    let room = COLUMNS.saturating_sub(low.chars().count() + high.chars().count());
    lines.push(format!("{:>9}  {low}{:^room$}{high}", "", chart.x_label));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::Curve;

    #[test]
    fn a_rising_line_goes_from_the_lower_left_to_the_upper_right() {
        let mut cells: BrailleGrid = [[0; COLUMNS]; ROWS];
        let last = ((2 * COLUMNS - 1) as f64, (4 * ROWS - 1) as f64);
        for dot in trail(&[(0.0, last.1), (last.0, 0.0)]) {
            set(&mut cells, dot);
        }
        assert_eq!(cells[ROWS - 1][0] & 0x40, 0x40);
        let corner = cells[0][COLUMNS - 1];
        assert_eq!(corner & 0x08 | corner & 0x80, 0x08);
        assert_eq!(cells[0][0], 0);
    }

    #[test]
    fn what_is_no_number_is_no_panic() {
        let points = vec![
            (0.0, f64::NAN),
            (f64::INFINITY, 1.0),
            (2.0, f64::NEG_INFINITY),
        ];
        let chart = Chart::new("", "x", "y", vec![Curve::line("", Tone::Blue, points)]);
        assert_eq!(chart.text().lines().count(), ROWS + 3);
    }
}
