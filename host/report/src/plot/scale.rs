//! From values to places on the page, and where to put ticks.

/// Values beyond this are not drawn.
const LARGEST: f64 = 1e12;

/// Whether a value can be drawn at all.
pub(crate) fn drawable(value: f64) -> bool {
    value.abs() <= LARGEST
}

/// Lowest and highest drawable value with a share of the span to spare; 0 to 1 if there is none.
pub(crate) fn span(values: impl IntoIterator<Item = f64>, spare: f64) -> (f64, f64) {
    let (low, high) = values
        .into_iter()
        .filter(|value| drawable(*value))
        .fold((f64::MAX, f64::MIN), |(low, high), value| {
            (low.min(value), high.max(value))
        });
    if low > high {
        return (0.0, 1.0);
    }
    let smallest = 1e-9 + 1e-6 * low.abs().max(high.abs());
    if high - low < smallest {
        return (low - smallest, high + smallest);
    }
    (low - spare * (high - low), high + spare * (high - low))
}

/// A straight scale from values to places.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    /// Lowest and highest value.
    values: (f64, f64),
    /// Their places.
    places: (f64, f64),
}

impl Scale {
    /// `values` must not be empty, as [`span`] sees to.
    pub(crate) fn new(values: (f64, f64), places: (f64, f64)) -> Self {
        Self { values, places }
    }

    /// Place of a drawable value.
    pub(crate) fn place(&self, value: f64) -> f64 {
        let share = (value - self.values.0) / (self.values.1 - self.values.0);
        self.places.0 + share * (self.places.1 - self.places.0)
    }

    /// Place of a value, brought to the nearer end if it lies outside.
    pub(crate) fn held(&self, value: f64) -> f64 {
        self.place(value.clamp(self.values.0, self.values.1))
    }

    /// Places of the ends.
    pub(crate) fn ends(&self) -> (f64, f64) {
        self.places
    }

    /// Values at the ends and their places, for scripts.
    pub(super) fn as_data(&self) -> String {
        let ((low, high), (first, last)) = (self.values, self.places);
        format!("{low} {high} {first} {last}")
    }

    /// Round values inside, about `wanted` of them, with their labels.
    pub(crate) fn ticks(&self, wanted: usize) -> Vec<(f64, String)> {
        let (low, high) = self.values;
        let step = round_step((high - low) / wanted.max(1) as f64);
        let decimals = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        let first = (low / step).ceil() as i64;
        let last = (high / step).floor() as i64;
        (first..=last)
            .take(4 * wanted)
            .map(|index| index as f64 * step)
            .map(|value| (value, format!("{:.decimals$}", value + 0.0)))
            .collect()
    }
}

/// The next of 1, 2, 5 times a power of ten.
fn round_step(step: f64) -> f64 {
    let power = 10f64.powf(step.log10().floor());
    let digit = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|digit| digit * power >= step * (1.0 - 1e-9));
    digit.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        let ticks = Scale::new((low, high), (0.0, 100.0)).ticks(5);
        ticks.into_iter().map(|tick| tick.1).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels(0.0, 10.0), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(
            labels(-0.11, 0.12),
            ["-0.10", "-0.05", "0.00", "0.05", "0.10"]
        );
        assert_eq!(
            labels(1990.0, 2090.0),
            ["2000", "2020", "2040", "2060", "2080"]
        );
    }

    #[test]
    fn a_span_is_never_empty() {
        assert_eq!(span([], 0.1), (0.0, 1.0));
        assert_eq!(span([f64::NAN, f64::MAX], 0.1), (0.0, 1.0));
        let (low, high) = span([3.0], 0.1);
        assert!(low < 3.0 && high > 3.0);
    }
}
