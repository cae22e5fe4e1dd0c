//! Curves drawn in text, on braille signs.

use super::signature::Signature;

/// Text columns and rows of a drawing.
const COLUMNS: usize = 60;
const ROWS: usize = 12;
/// Dots of a braille sign, across and down.
const ACROSS: usize = 2;
const DOWN: usize = 4;

/// A signature as text: a line with the effect, dots without it.
pub(super) fn plot(signature: &Signature) -> String {
    let points = || signature.without.iter().chain(&signature.with);
    let x = span(points().map(|point| point.0), 0.0);
    let y = span(points().map(|point| point.1), 0.05);
    let mut canvas = Canvas::new(x, y);
    canvas.dotted(&signature.without);
    canvas.line(&signature.with);
    canvas.framed(signature.x_label, signature.y_label)
}

/// Lowest and highest value, with a share of the span to spare; never empty.
fn span(values: impl Iterator<Item = f64>, margin: f64) -> (f64, f64) {
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| {
        (low.min(value), high.max(value))
    });
    let spare = if high > low {
        margin * (high - low)
    } else {
        1.0
    };
    (low - spare, high + spare)
}

/// Braille signs of 2 x 4 dots each.
struct Canvas {
    x: (f64, f64),
    y: (f64, f64),
    signs: Vec<[u8; COLUMNS]>,
}

impl Canvas {
    fn new(x: (f64, f64), y: (f64, f64)) -> Self {
        Self {
            x,
            y,
            signs: vec![[0; COLUMNS]; ROWS],
        }
    }

    /// The nearest dot, from the top left.
    fn dot(&self, point: (f64, f64)) -> (f64, f64) {
        let share = |value: f64, (low, high): (f64, f64)| (value - low) / (high - low);
        let across = share(point.0, self.x) * (COLUMNS * ACROSS - 1) as f64;
        let down = (1.0 - share(point.1, self.y)) * (ROWS * DOWN - 1) as f64;
        (across.round(), down.round())
    }

    fn set(&mut self, (across, down): (f64, f64)) {
        // Unicode numbers the dots 1 2 3 7 down the left and 4 5 6 8 down the right.
        const BITS: [[u8; DOWN]; ACROSS] = [[0x01, 0x02, 0x04, 0x40], [0x08, 0x10, 0x20, 0x80]];
        let (across, down) = (across as usize, down as usize);
        self.signs[down / DOWN][across / ACROSS] |= BITS[across % ACROSS][down % DOWN];
    }

    /// Every dot from point to point.
    fn line(&mut self, points: &[(f64, f64)]) {
        for dot in self.trail(points) {
            self.set(dot);
        }
    }

    /// Every fifth dot.
    fn dotted(&mut self, points: &[(f64, f64)]) {
        for dot in self.trail(points).into_iter().step_by(5) {
            self.set(dot);
        }
    }

    fn trail(&self, points: &[(f64, f64)]) -> Vec<(f64, f64)> {
        let dots: Vec<(f64, f64)> = points.iter().map(|point| self.dot(*point)).collect();
        let mut trail: Vec<(f64, f64)> = dots
            .windows(2)
            .flat_map(|ends| joined(ends[0], ends[1]))
            .collect();
        trail.dedup();
        trail
    }

    fn framed(&self, x_label: &str, y_label: &str) -> String {
        let sign = |bits: &u8| char::from_u32(0x2800 + u32::from(*bits)).unwrap_or(' ');
        let blank = " ".repeat(9);
        let mut lines = vec![format!("{blank} {y_label}")];
        for (row, signs) in self.signs.iter().enumerate() {
            let mark = match row {
                0 => format!("{:>9}", rounded(self.y.1)),
                row if row == ROWS - 1 => format!("{:>9}", rounded(self.y.0)),
                _ => blank.clone(),
            };
            let drawn: String = signs.iter().map(sign).collect();
            lines.push(format!("{mark} │{drawn}"));
        }
        lines.push(format!("{blank} └{}", "─".repeat(COLUMNS)));
        let (low, high) = (rounded(self.x.0), rounded(self.x.1));
        let room = COLUMNS.saturating_sub(low.len() + high.len());
        lines.push(format!("{blank}  {low}{x_label:^room$}{high}"));
        lines.join("\n")
    }
}

/// Dots from one to the next without a gap, both ends included.
fn joined(from: (f64, f64), to: (f64, f64)) -> Vec<(f64, f64)> {
    let steps = (to.0 - from.0).abs().max((to.1 - from.1).abs()).max(1.0);
    let at = |step: usize| {
        let share = step as f64 / steps;
        (
            (from.0 + share * (to.0 - from.0)).round(),
            (from.1 + share * (to.1 - from.1)).round(),
        )
    };
    (0..=steps as usize).map(at).collect()
}

/// Three significant digits, without trailing zeros.
pub(super) fn rounded(value: f64) -> String {
    if value == 0.0 {
        return "0".to_string();
    }
    let places = (2.0 - value.abs().log10().floor()).clamp(0.0, 9.0) as usize;
    let text = format!("{value:.places$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_string()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rising_line_goes_from_the_lower_left_to_the_upper_right() {
        let mut canvas = Canvas::new((0.0, 1.0), (0.0, 1.0));
        canvas.line(&[(0.0, 0.0), (1.0, 1.0)]);
        assert_eq!(canvas.signs[ROWS - 1][0] & 0x40, 0x40);
        assert_eq!(
            canvas.signs[0][COLUMNS - 1] & 0x08 | canvas.signs[0][COLUMNS - 1] & 0x80,
            0x08
        );
        assert_eq!(canvas.signs[0][0], 0);
    }

    #[test]
    fn numbers_on_axes_are_short() {
        assert_eq!(rounded(0.0), "0");
        assert_eq!(rounded(-1.5), "-1.5");
        assert_eq!(rounded(0.012345), "0.0123");
        assert_eq!(rounded(50.0), "50");
    }
}
