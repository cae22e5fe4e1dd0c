//! Eigenvalues of a general matrix, and the distance of its modes from uncontrollability.

use super::error::DesignError;
use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector, Schur, stack};

/// Most steps in the search for an eigenvalue; it takes two or three.
const MOST_STEPS: usize = 300;

/// Eigenvalues, those with the largest real part first.
///
/// # Errors
/// Entries that are no numbers.
pub fn poles(a: &DMatrix<f64>) -> Result<Vec<Complex<f64>>, DesignError> {
    if a.iter().all(|value| value.is_finite()) {
        let (rest, isolated) = isolated(a.clone());
        // Balancing squares the entries: near 1, none overflows.
        let size = 2f64.powi(a.amax().max(f64::MIN_POSITIVE).log2() as i32);
        let scaled = rest / size;
        let mut balanced = scaled.clone();
        balance_parlett_reinsch(&mut balanced);
        // Balanced they are more exact, but five like loops with sums stand still so.
        if let Some(mut poles) = eigenvalues(balanced).or_else(|| eigenvalues(scaled)) {
            poles.iter_mut().for_each(|pole| *pole *= size);
            poles.extend(isolated.into_iter().map(Complex::from));
            poles.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
            return Ok(poles);
        }
    }
    Err(no_eigenvalues())
}

pub(super) fn no_eigenvalues() -> DesignError {
    DesignError::model(
        "the eigenvalues of the system matrix cannot be found",
        "look for entries that are not numbers or of very different size",
    )
}

/// A matrix without the states that act on no other or on which no other acts, and their
/// eigenvalues, which stand on the diagonal: those of past inputs that nothing reads any more are
/// 0. They come out exactly, and the QR steps may stand still where many of them are left in
/// (Parlett, Reinsch, Numerische Mathematik 13 (1969) 293).
fn isolated(mut a: DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    let mut values = Vec::new();
    let alone = |a: &DMatrix<f64>, i: usize| {
        let others = || (0..a.nrows()).filter(move |j| *j != i);
        others().all(|j| a[(i, j)] == 0.0) || others().all(|j| a[(j, i)] == 0.0)
    };
    while let Some(place) = (0..a.nrows()).find(|i| alone(&a, *i)) {
        values.push(a[(place, place)]);
        a = a.remove_row(place).remove_column(place);
    }
    (a, values)
}

/// All eigenvalues, in no order; `None` if the QR steps do not converge.
///
/// nalgebra's steps stand still on a few matrices, such as the cyclic shift of four states: their
/// shifts are eigenvalues of all of its blocks. Reflected, such a matrix has the same eigenvalues
/// and loses that symmetry.
fn eigenvalues(a: DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    let n = a.nrows();
    if n == 0 {
        return Some(Vec::new());
    }
    let most_steps = MOST_STEPS * n;
    let schur = Schur::try_new(a.clone(), f64::EPSILON, most_steps).or_else(|| {
        let normal = DVector::from_fn(n, |i, _| (1.0 + i as f64).sqrt()).normalize();
        let reflection = DMatrix::identity(n, n) - 2.0 * &normal * normal.transpose();
        Schur::try_new(&reflection * a * &reflection, f64::EPSILON, most_steps)
    })?;
    Some(schur.complex_eigenvalues().as_slice().to_vec())
}

/// Sorts poles per sample, those nearest to the unit circle first, or outside it.
pub(super) fn slowest_first(poles: &mut [Complex<f64>]) {
    poles.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
}

/// Largest modulus of poles.
pub(super) fn largest(poles: &[Complex<f64>]) -> f64 {
    poles.iter().map(|pole| pole.norm()).fold(0.0, f64::max)
}

/// A mode and its controllability margin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Its eigenvalue, 1/s or per sample.
    pub pole: Complex<f64>,
    /// Least singular value of [A - pole I, B] (or of that over C), over the largest of A or B (or
    /// C): 0 where uncontrollable.
    pub margin: f64,
    /// The state in which it shows most, counted from 0.
    pub state: usize,
}

/// The modes of A with how far each is from being uncontrollable through B (Popov, Belevitch,
/// Hautus).
///
/// # Errors
/// As [`poles`].
pub fn modes(a: &DMatrix<f64>, b: &DMatrix<f64>) -> Result<Vec<Mode>, DesignError> {
    let poles = poles(a)?;
    let complex = |m: &DMatrix<f64>| m.map(|value| Complex::new(value, 0.0));
    let (n, size) = (a.nrows(), a.norm().max(b.norm()).max(f64::MIN_POSITIVE));
    let (a, b) = (complex(a), complex(b));
    let mode = |pole: Complex<f64>| {
        let shifted = &a - DMatrix::from_diagonal_element(n, n, pole);
        let svd = stack![shifted, b].svd(true, false);
        let least = svd.singular_values.imin();
        let left = svd
            .u
            .map(|u| DVector::from_column_slice(u.column(least).as_slice()));
        Mode {
            pole,
            margin: svd.singular_values[least] / size,
            state: left.map_or(0, |left| left.map(|z| z.norm()).imax()),
        }
    };
    Ok(poles.into_iter().map(mode).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Sorted so that nearly equal ones pair up.
    fn sorted(mut values: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
        let key = |z: &Complex<f64>| ((1e6 * z.re).round(), (1e6 * z.im).round());
        values.sort_by(|a, b| key(a).partial_cmp(&key(b)).unwrap());
        values
    }

    /// The loop of an arm of five joints, each with a sum of its angle: five poles are 0.995 to six
    /// digits, and balanced the steps stand still.
    #[test]
    fn like_loops_have_poles() {
        let text = include_str!("../../../tests/data/like_loops.json");
        let rows: Vec<Vec<f64>> = serde_json::from_str(text).unwrap();
        let a = DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j]);
        let mut found = poles(&a).unwrap();
        slowest_first(&mut found);
        assert_eq!(found.len(), 20);
        // By NumPy.
        for (at, wanted) in [(0, 0.9950119954694765), (5, 0.8183373505404276), (16, 0.0)] {
            assert!((found[at].norm() - wanted).abs() < 1e-6, "{found:?}");
        }
    }

    proptest! {
        #[test]
        fn they_are_those_that_the_matrix_was_made_with(
            n in 1usize..12,
            values in prop::collection::vec(-3.0f64..3.0, 12),
            mix in prop::collection::vec(-1.0f64..1.0, 144),
            pairs in 0usize..6,
        ) {
            // Blocks [re, im; -im, re] and single values, seen through a well-conditioned change of
            // basis.
            let diagonal = DVector::from_column_slice(&values[..n]);
            let mut blocks = DMatrix::from_diagonal(&diagonal);
            let mut expected: Vec<Complex<f64>> =
                values[..n].iter().map(|v| Complex::new(*v, 0.0)).collect();
            for pair in 0..pairs.min(n / 2) {
                let (i, re, im) = (2 * pair, values[2 * pair], 0.3 + values[2 * pair + 1].abs());
                blocks[(i, i)] = re;
                blocks[(i + 1, i + 1)] = re;
                blocks[(i, i + 1)] = im;
                blocks[(i + 1, i)] = -im;
                expected[i] = Complex::new(re, im);
                expected[i + 1] = Complex::new(re, -im);
            }
            let mixed = DMatrix::from_fn(n, n, |i, j| 0.3 * mix[12 * i + j] / n as f64);
            let basis = mixed + DMatrix::identity(n, n);
            let matrix = &basis * blocks * basis.clone().try_inverse().unwrap();
            let found = eigenvalues(matrix).unwrap();
            prop_assert_eq!(found.len(), n);
            // Nearly equal ones are ill-conditioned: compare sums of powers.
            for power in 1..=3 {
                let sum = |values: &[Complex<f64>]| -> Complex<f64> {
                    values.iter().map(|z| z.powi(power)).sum()
                };
                let off = (sum(&found) - sum(&expected)).norm();
                prop_assert!(off < 1e-9, "{found:?} {expected:?}");
            }
            for z in &expected {
                let nearest = found.iter().map(|f| (f - z).norm()).fold(f64::INFINITY, f64::min);
                prop_assert!(nearest < 1e-4, "{z} {found:?}");
            }
        }
    }

    #[test]
    fn those_of_awkward_matrices() {
        assert!(
            eigenvalues(DMatrix::zeros(4, 4))
                .unwrap()
                .iter()
                .all(|z| z.norm() == 0.0)
        );
        // A cyclic shift: ordinary shifts stand still on it.
        let shift = DMatrix::from_fn(4, 4, |i, j| if (i + 1) % 4 == j { 1.0 } else { 0.0 });
        let found = sorted(eigenvalues(shift).unwrap());
        let expected = [(-1.0, 0.0), (0.0, -1.0), (0.0, 1.0), (1.0, 0.0)];
        for (z, (re, im)) in found.iter().zip(expected) {
            assert!((z - Complex::new(re, im)).norm() < 1e-14, "{found:?}");
        }
        // Nilpotent.
        let jordan = DMatrix::from_fn(5, 5, |i, j| if i + 1 == j { 1.0 } else { 0.0 });
        assert!(eigenvalues(jordan).unwrap().iter().all(|z| z.norm() < 1e-3));
        assert!(eigenvalues(DMatrix::zeros(0, 0)).unwrap().is_empty());
        // The squares of its entries are beyond all numbers.
        let large = poles(&DMatrix::from_element(2, 2, 1e300)).unwrap();
        assert!((large[0].re / 2e300 - 1.0).abs() < 1e-14, "{large:?}");
    }
}
