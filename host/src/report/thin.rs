//! Long curves in few points: of each pixel column the lowest and the highest, so that no peak is lost.

use super::scale::{Scale, drawable};
use std::fmt::Write as _;

/// A place on the page.
type Place = (f64, f64);

/// The `d` of an SVG path through the points; what can't be drawn leaves a gap.
pub(super) fn path(points: impl IntoIterator<Item = (f64, f64)>, x: &Scale, y: &Scale) -> String {
    let mut thin = Thin::default();
    for (across, up) in points {
        if drawable(across) && drawable(up) {
            thin.push((x.place(across), y.place(up)));
        } else {
            thin.lift();
        }
    }
    thin.lift();
    thin.path
}

/// Pen that writes a column when the curve leaves it.
#[derive(Default)]
struct Thin {
    path: String,
    /// Points the pen has set since it was lifted.
    set: usize,
    column: Option<Column>,
}

/// Lowest and highest place in a pixel column with their order of arrival.
struct Column {
    pixel: f64,
    seen: usize,
    low: (usize, Place),
    high: (usize, Place),
}

impl Thin {
    fn push(&mut self, place: Place) {
        let pixel = place.0.floor();
        match &mut self.column {
            Some(column) if column.pixel == pixel => column.push(place),
            _ => {
                self.write();
                self.column = Some(Column {
                    pixel,
                    seen: 0,
                    low: (0, place),
                    high: (0, place),
                });
            }
        }
    }

    fn write(&mut self) {
        let Some(Column { low, high, .. }) = self.column.take() else {
            return;
        };
        let (first, second) = if low.0 <= high.0 {
            (low, high)
        } else {
            (high, low)
        };
        self.set(first.1);
        if second.0 != first.0 {
            self.set(second.1);
        }
    }

    fn set(&mut self, place: Place) {
        let pen = if self.set == 0 { 'M' } else { 'L' };
        write!(self.path, "{pen}{:.1} {:.1}", place.0, place.1).expect("a string takes all");
        self.set += 1;
    }

    /// A lone point becomes a dot under a round pen.
    fn lift(&mut self) {
        self.write();
        if self.set == 1 {
            self.path.push_str("h0");
        }
        self.set = 0;
    }
}

impl Column {
    fn push(&mut self, place: Place) {
        self.seen += 1;
        if place.1 < self.low.1.1 {
            self.low = (self.seen, place);
        }
        if place.1 > self.high.1.1 {
            self.high = (self.seen, place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(pixels: f64) -> Scale {
        Scale::new((0.0, 1.0), (0.0, pixels))
    }

    #[test]
    fn a_lone_peak_survives_thinning() {
        let peak = |index: usize| if index == 12_345 { 1.0 } else { 0.0 };
        let points = (0..20_000).map(|index| (index as f64 / 20_000.0, peak(index)));
        let path = path(points, &unit(700.0), &unit(100.0));
        assert!(path.len() < 20_000, "{}", path.len());
        assert!(path.contains(" 100.0"));
    }

    #[test]
    fn gaps_and_single_points() {
        let points = [(0.0, 0.0), (0.5, 0.5), (0.6, f64::NAN), (1.0, 1.0)];
        let path = path(points, &unit(10.0), &unit(10.0));
        assert_eq!(path, "M0.0 0.0L5.0 5.0M10.0 10.0h0");
    }
}
