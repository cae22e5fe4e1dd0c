//! Values of which data tell only a mixture: mass, centre of mass and inertia of a single link.

use super::fit::Fit;
use crate::model::ParameterPath;
use nalgebra::{DMatrix, SymmetricEigen};

/// Least information of a mixture, as a share of that of its values by themselves. Derivatives are
/// differences, right to some 1e-3; what they say of a direction below that is rounding, squared.
/// Motions in which start errors grow round more: there a mixture may go unnoticed.
const LEAST: f64 = 1e-6;
/// Share of a mixture from which a value belongs to it.
const BELONGS: f64 = 0.1;

/// The values in the mixture of which the data say least, where that is nothing; else none, nor
/// where one of them is known beforehand, which settles the mixture. The fit must have its
/// derivatives.
pub(super) fn untold_mixture(fit: &Fit) -> Vec<ParameterPath> {
    let places = mixed(&fit.information().matrix).into_iter();
    let mixed: Vec<ParameterPath> = places.map(|place| fit.free[place]).collect();
    if mixed
        .iter()
        .any(|path| fit.model.uncertain(*path).is_some())
    {
        return Vec::new();
    }
    mixed
}

/// Places of the values in the mixture that an information matrix leaves open.
fn mixed(information: &DMatrix<f64>) -> Vec<usize> {
    let count = information.nrows();
    let scale: Vec<f64> = (0..count).map(|i| information[(i, i)].sqrt()).collect();
    if count < 2 || scale.iter().any(|s| *s <= 0.0 || !s.is_finite()) {
        return Vec::new();
    }
    let scaled = DMatrix::from_fn(count, count, |r, c| {
        information[(r, c)] / (scale[r] * scale[c])
    });
    let eigen = SymmetricEigen::new(scaled);
    let least = eigen.eigenvalues.imin();
    if eigen.eigenvalues[least] > LEAST {
        return Vec::new();
    }
    let direction = eigen.eigenvectors.column(least);
    let belongs = |place: &usize| direction[*place].abs() > BELONGS;
    (0..count).filter(belongs).collect()
}

#[cfg(test)]
mod tests {
    use super::mixed;
    use nalgebra::dmatrix;

    #[test]
    fn values_in_a_mixture_that_nothing_tells_are_found_and_no_others() {
        // The first and the third say the same, by one factor; the second is known by itself.
        let jacobian = dmatrix![1.0, 0.0, 2.0; 2.0, 1.0, 4.0; 3.0, 5.0, 6.0; 1.0, -1.0, 2.0];
        assert_eq!(mixed(&(jacobian.transpose() * &jacobian)), [0, 2]);
    }

    #[test]
    fn values_that_are_hardly_told_apart_are_told() {
        let jacobian = dmatrix![1.0, 1.01; 2.0, 2.0; 3.0, 3.0];
        assert_eq!(mixed(&(jacobian.transpose() * &jacobian)), [0usize; 0]);
    }
}
