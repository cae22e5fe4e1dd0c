//! The nearest minimum of a smooth function of many variables: quasi-Newton (BFGS; Nocedal, Wright,
//! Numerical Optimization, 2nd ed., algorithm 6.1) with steps that lower it enough (Armijo).

use nalgebra::{DMatrix, DVector};

/// Most steps.
const MOST_STEPS: usize = 200;

/// Halvings of a step.
const HALVINGS: usize = 40;

/// The search ends once a step lowers the function by less than this.
const STILL: f64 = 1e-9;

/// A value, and its gradient.
pub(super) type Slope = (f64, DVector<f64>);

/// Where `of` is least, searched downhill from `start`; none where `of` has no value there. Where
/// it has none elsewhere the search turns back.
pub(super) fn least(
    start: DVector<f64>,
    of: impl Fn(&DVector<f64>) -> Option<Slope>,
) -> Option<DVector<f64>> {
    let (mut value, mut slope) = of(&start)?;
    let (mut at, size) = (start, slope.len());
    let mut curvature = DMatrix::identity(size, size) / slope.norm().max(f64::MIN_POSITIVE);
    for _ in 0..MOST_STEPS {
        let mut way = -(&curvature * &slope);
        if way.dot(&slope) >= 0.0 {
            way = -&slope;
            curvature.fill_with_identity();
        }
        let Some((moved, next)) = step(&at, &way, (value, slope.dot(&way)), &of) else {
            break;
        };
        at += &moved;
        update(&mut curvature, &moved, &(&next.1 - &slope));
        let gained = value - next.0;
        (value, slope) = next;
        if gained < STILL {
            break;
        }
    }
    Some(at)
}

/// A step along `way` that lowers the value enough, with what is there.
fn step(
    at: &DVector<f64>,
    way: &DVector<f64>,
    (value, fall): (f64, f64),
    of: &impl Fn(&DVector<f64>) -> Option<Slope>,
) -> Option<(DVector<f64>, Slope)> {
    let mut reach = 1.0;
    for _ in 0..HALVINGS {
        let moved = way * reach;
        if let Some(next) = of(&(at + &moved))
            && next.0 <= value + 1e-4 * reach * fall
        {
            return Some((moved, next));
        }
        reach /= 2.0;
    }
    None
}

/// The update of the inverse curvature from a step and the change of slope along it (equation
/// 6.17); skipped where the function does not curve upwards.
fn update(inverse: &mut DMatrix<f64>, moved: &DVector<f64>, turned: &DVector<f64>) {
    let along = moved.dot(turned);
    if along <= 1e-12 * moved.norm() * turned.norm() {
        return;
    }
    let unit = DMatrix::<f64>::identity(moved.len(), moved.len());
    let left = &unit - moved * turned.transpose() / along;
    *inverse = &left * &*inverse * left.transpose() + moved * moved.transpose() / along;
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rosenbrock's valley: 100 (y - x^2)^2 + (1 - x)^2, least at (1, 1).
    fn valley(at: &DVector<f64>) -> Option<Slope> {
        let (x, y) = (at[0], at[1]);
        let off = y - x * x;
        let slope = DVector::from_vec(vec![-400.0 * x * off - 2.0 * (1.0 - x), 200.0 * off]);
        Some((100.0 * off * off + (1.0 - x).powi(2), slope))
    }

    #[test]
    fn a_bent_valley_is_followed_to_its_end() {
        let end = least(DVector::from_vec(vec![-1.2, 1.0]), valley).unwrap();
        assert!((end - DVector::from_element(2, 1.0)).norm() < 1e-3);
    }

    #[test]
    fn what_has_no_value_is_never_entered() {
        let wall = |at: &DVector<f64>| valley(at).filter(|_| at[0] < 0.5);
        let end = least(DVector::from_vec(vec![-1.2, 1.0]), wall).unwrap();
        assert!(end[0] < 0.5 && valley(&end).unwrap().0 < 0.5, "{end}");
        assert_eq!(least(DVector::from_vec(vec![0.7, 1.0]), wall), None);
    }
}
