//! Student's t distribution.

use std::f64::consts::PI;

/// The value that 97.5 % of draws stay below: half the width of a 95 % interval, in standard errors.
///
/// For `freedom` >= 1, not only whole numbers. Hill (1970), CACM algorithm 396; relative error below 1e-3.
pub(crate) fn quantile_975(freedom: f64) -> f64 {
    const TAILS: f64 = 0.05;
    /// NormalEquations quantile of 97.5 %.
    const NORMAL: f64 = 1.959964;
    let n = freedom.max(1.0);
    if n < 1.0 + 1e-9 {
        return 1.0 / (TAILS * PI / 2.0).tan();
    }
    let a = 1.0 / (n - 0.5);
    let b = 48.0 / (a * a);
    let mut c = ((20700.0 * a / b - 98.0) * a - 16.0) * a + 96.36;
    let d = ((94.5 / (b + c) - 3.0) / b + 1.0) * (a * PI / 2.0).sqrt() * n;
    let mut y = (d * TAILS).powf(2.0 / n);
    if y > 0.05 + a {
        let x = -NORMAL;
        y = x * x;
        if n < 5.0 {
            c += 0.3 * (n - 4.5) * (x + 0.6);
        }
        c += (((0.05 * d * x - 5.0) * x - 7.0) * x - 2.0) * x + b;
        y = (((((0.4 * y + 6.3) * y + 36.0) * y + 94.5) / c - y - 3.0) / b + 1.0) * x;
        y = (a * y * y).exp_m1();
    } else {
        y = ((1.0 / (((n + 6.0) / (n * y) - 0.089 * d - 0.822) * (n + 2.0) * 3.0)
            + 0.5 / (n + 4.0))
            * y
            - 1.0)
            * (n + 1.0)
            / (n + 2.0)
            + 1.0 / y;
    }
    (n * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::quantile_975;

    #[test]
    fn the_quantiles_are_those_of_the_tables() {
        for (freedom, table) in [
            (1.0, 12.706),
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
            assert!((found / table - 1.0).abs() < 2e-3, "{freedom}: {found}");
        }
    }

    #[test]
    fn fewer_degrees_of_freedom_reach_further() {
        let all = (10..400).map(|tenths| quantile_975(f64::from(tenths) / 10.0));
        let all: Vec<f64> = all.collect();
        assert!(all.windows(2).all(|pair| pair[1] < pair[0]), "{all:?}");
    }
}
