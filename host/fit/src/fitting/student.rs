//! Student's t distribution.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// With more degrees of freedom the quantile is that of the normal distribution to 2e-4.
const MOST_FREEDOM: f64 = 1e4;

/// The value that 97.5 % of draws stay below: half the width of a 95 % interval, in standard
/// errors.
///
/// For `freedom` >= 1, not only whole numbers.
pub fn quantile_975(freedom: f64) -> f64 {
    let freedom = freedom.clamp(1.0, MOST_FREEDOM);
    StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |t| t.inverse_cdf(0.975))
}

#[cfg(test)]
mod tests {
    use super::quantile_975;

    #[test]
    fn the_quantiles_are_those_of_the_tables() {
        for (freedom, table) in [
            (1.0, 12.706),
            (1.3, 7.5005),
            (2.0, 4.303),
            (3.0, 3.182),
            (4.0, 2.776),
            (5.0, 2.571),
            (8.0, 2.306),
            (10.0, 2.228),
            (19.0, 2.093),
            (40.0, 2.021),
            (120.0, 1.980),
            (1e6, 1.960),
        ] {
            let found = quantile_975(freedom);
            assert!((found / table - 1.0).abs() < 3e-4, "{freedom}: {found}");
        }
    }

    #[test]
    fn fewer_degrees_of_freedom_reach_further() {
        let all = (10..400).map(|tenths| quantile_975(f64::from(tenths) / 10.0));
        let all: Vec<f64> = all.collect();
        assert!(all.windows(2).all(|pair| pair[1] < pair[0]), "{all:?}");
    }
}
