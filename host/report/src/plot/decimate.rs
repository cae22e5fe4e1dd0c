//! Min-max decimation: of each pixel column the lowest and the highest point, so that no peak is
//! lost.

use super::scale::{Scale, drawable};
use std::fmt::Write as _;

/// A place on the page, px.
type Pixel = (f64, f64);

/// The `d` of an SVG path through the points; what cannot be drawn leaves a gap.
pub(super) fn path(points: impl IntoIterator<Item = (f64, f64)>, x: &Scale, y: &Scale) -> String {
    let place = |(across, up): (f64, f64)| {
        (drawable(across) && drawable(up)).then(|| (x.place(across), y.place(up)))
    };
    let places: Vec<Option<Pixel>> = points.into_iter().map(place).collect();
    let mut path = String::new();
    for stroke in places.split(Option::is_none) {
        let stroke: Vec<Pixel> = stroke.iter().copied().flatten().collect();
        write_stroke(&mut path, &decimated(&stroke));
    }
    path
}

/// A lone point becomes a dot under a round pen.
fn write_stroke(path: &mut String, stroke: &[Pixel]) {
    for (index, (x, y)) in stroke.iter().enumerate() {
        let pen = if index == 0 { 'M' } else { 'L' };
        write!(path, "{pen}{x:.1} {y:.1}").expect("a string takes all");
    }
    if stroke.len() == 1 {
        path.push_str("h0");
    }
}

/// Lowest and highest point of each pixel column, in their order.
fn decimated(stroke: &[Pixel]) -> Vec<Pixel> {
    let mut kept = Vec::new();
    for column in stroke.chunk_by(|a, b| a.0.floor() == b.0.floor()) {
        let height = |index: &usize| column[*index].1;
        let first = |a: &usize, b: &usize| height(a).total_cmp(&height(b));
        let low = (0..column.len()).min_by(first);
        let high = (0..column.len()).min_by(|a, b| first(b, a));
        if let (Some(low), Some(high)) = (low, high) {
            kept.push(column[low.min(high)]);
            kept.extend((low != high).then(|| column[low.max(high)]));
        }
    }
    kept
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
