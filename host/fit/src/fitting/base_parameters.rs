//! Values that motions tell only together: which of them to hold, and what is told of the others.
//!
//! A motion shows fewer parameters than the links of a robot have, the base parameters: sums in
//! which one link's values stand for another's (Gautier 1991, Numerical calculation of the base
//! inertial parameters of robots, Journal of Robotic Systems 8, 485). Which values to hold is a
//! choice: here one after the other that which is told least, until what is left is told.

use super::covariance::{intervals, inverse};
use super::data::FitProblem;
use super::fit::Fit;
use crate::model::{Model, ParameterPath};
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// A standard error above this share of the value is no measurement: the 95 % interval reaches
/// half as far again either way.
const WIDE: f64 = 0.25;
/// A variance so many times what it would be if all others were known is theirs: a value that
/// nothing shows is not told better by holding others.
const SHARED: f64 = 10.0;
/// What a held value adds below this share of the combination is left out of it.
const SMALL: f64 = 0.05;
/// Two-sided 95 % of a normal distribution.
const NORMAL: f64 = 1.96;

/// A sum of values that the motions tell.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BaseParameter {
    /// Addresses, and how much of each value counts; the first whole, the others are held.
    pub terms: Vec<(String, f64)>,
    /// The unit, that of the first.
    pub unit: String,
    /// The sum.
    pub value: f64,
    /// Lower end of its 95 % interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// What is told of values that are told only together.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct BaseParameters {
    /// Addresses of the values to hold at what is known of them.
    pub held: Vec<String>,
    /// What the motions tell whatever those are.
    pub told: Vec<BaseParameter>,
}

/// The values of a fit that its motions tell only together; none where each is told, or nothing is.
/// `given` is the model before the fit: how large a value is said to be counts where the fit has
/// brought it to nothing.
pub(super) fn base_parameters(given: &Model, fit: &Fit, data: &FitProblem) -> BaseParameters {
    let Some((intervals, correlation)) = intervals(fit, data) else {
        return BaseParameters::default();
    };
    let errors = intervals.iter().map(|interval| interval.standard_error);
    let errors = DMatrix::from_diagonal(&DVector::from_iterator(intervals.len(), errors));
    let covariance = &errors * correlation * &errors;
    let values = fit.values();
    let sizes: Vec<f64> = { fit.free.iter().zip(&values) }
        .map(|(path, value)| path.get(given).unwrap_or(0.0).abs().max(value.abs()))
        .collect();
    let Some(grouped) = grouped(&covariance, &sizes) else {
        return BaseParameters::default();
    };
    let address = |place: usize| fit.free[place].to_string();
    let told = grouped.told.iter().map(|own| {
        let held = grouped.held.iter().zip(&own.shares);
        let held =
            held.filter(|(held, share)| (*share * sizes[**held]).abs() > SMALL * sizes[own.place]);
        let mut terms = vec![(address(own.place), 1.0)];
        let mut value = values[own.place];
        for (held, share) in held {
            terms.push((address(*held), *share));
            value += share * values[*held];
        }
        BaseParameter {
            terms,
            unit: fit.free[own.place].unit().to_string(),
            value,
            low: value - NORMAL * own.error,
            high: value + NORMAL * own.error,
        }
    });
    BaseParameters {
        held: grouped.held.iter().map(|place| address(*place)).collect(),
        told: told.collect(),
    }
}

/// Those of a fit's values that are to be held so that its motions tell the others, where they tell
/// only a mixture of some and so no error of any. The fit must have its derivatives.
pub(super) fn values_to_hold(fit: &Fit) -> Vec<ParameterPath> {
    let known = DMatrix::from_diagonal(&fit.value_prior().precision) + fit.weak_prior();
    let sizes: Vec<f64> = fit.values().iter().map(|value| value.abs()).collect();
    let covariance = inverse(&(fit.information().matrix + known));
    let grouped = covariance.and_then(|covariance| grouped(&covariance, &sizes));
    let held = grouped.map_or(Vec::new(), |grouped| grouped.held);
    held.into_iter().map(|place| fit.free[place]).collect()
}

/// Places of values to hold, and what that leaves of the others that were not told.
struct Grouped {
    held: Vec<usize>,
    told: Vec<Told>,
}

struct Told {
    place: usize,
    /// How much of each value that is held counts beside it.
    shares: Vec<f64>,
    /// Standard error of the sum.
    error: f64,
}

/// Holds values until none of the others is wide because of others; none where none is.
fn grouped(covariance: &DMatrix<f64>, sizes: &[f64]) -> Option<Grouped> {
    let wideness = |covariance: &DMatrix<f64>, place: usize| {
        covariance[(place, place)].max(0.0).sqrt() / sizes[place].max(f64::MIN_POSITIVE)
    };
    let all = 0..sizes.len();
    let was_wide: Vec<usize> = all.filter(|i| wideness(covariance, *i) > WIDE).collect();
    let mut held = Vec::new();
    let mut rest: Vec<usize> = (0..sizes.len()).collect();
    let mut left = covariance.clone();
    while rest.len() > 1 {
        let own = left.select_rows(&rest).select_columns(&rest);
        let Some(information) = inverse(&own) else {
            break;
        };
        let shared = (0..rest.len()).filter(|k| own[(*k, *k)] * information[(*k, *k)] > SHARED);
        let wide = shared
            .map(|k| rest[k])
            .filter(|place| wideness(&left, *place) > WIDE);
        let widest = wide.max_by(|a, b| wideness(&left, *a).total_cmp(&wideness(&left, *b)));
        let Some(widest) = widest else {
            break;
        };
        let column = left.column(widest).clone_owned();
        left -= &column * column.transpose() / column[widest];
        rest.retain(|place| *place != widest);
        held.push(widest);
    }
    if held.is_empty() {
        return None;
    }
    let of_held = covariance.select_rows(&held).select_columns(&held);
    let told_by_held = inverse(&of_held)?;
    let told = rest.into_iter().filter(|place| was_wide.contains(place));
    let told = told.map(|place| {
        let with = covariance.select_rows(&[place]).select_columns(&held);
        Told {
            place,
            shares: (-(with * &told_by_held)).iter().copied().collect(),
            error: left[(place, place)].max(0.0).sqrt(),
        }
    });
    Some(Grouped {
        told: told.collect(),
        held,
    })
}

#[cfg(test)]
mod tests {
    use super::grouped;
    use nalgebra::{DMatrix, dmatrix};

    fn covariance(jacobian: &DMatrix<f64>) -> DMatrix<f64> {
        (jacobian.transpose() * jacobian).try_inverse().unwrap()
    }

    /// Readings tell a sum of the first and half the second, to a tenth, and the third by itself.
    #[test]
    fn of_two_values_that_a_sum_is_told_of_one_is_held() {
        let jacobian = dmatrix![10.0, 5.0, 0.0; 0.0, 0.0, 100.0; 0.01, -0.01, 0.0];
        let grouped = grouped(&covariance(&jacobian), &[1.0, 1.0, 1.0]).unwrap();
        assert_eq!(grouped.held, [1]);
        assert_eq!(grouped.told.len(), 1);
        let told = &grouped.told[0];
        assert_eq!(told.place, 0);
        assert!((told.shares[0] - 0.5).abs() < 1e-3, "{:?}", told.shares);
        assert!((told.error - 0.1).abs() < 1e-3, "{}", told.error);
    }

    #[test]
    fn values_that_are_told_and_one_that_nothing_shows_are_left() {
        let told = dmatrix![100.0, 50.0; 50.0, 100.0];
        assert!(grouped(&covariance(&told), &[1.0, 1.0]).is_none());
        let blind = dmatrix![100.0, 0.0; 0.0, 0.1];
        assert!(grouped(&covariance(&blind), &[1.0, 1.0]).is_none());
    }

    /// One sum of three: two are held.
    #[test]
    fn as_many_are_held_as_sums_are_lacking() {
        let jacobian = dmatrix![10.0, 10.0, 10.0; 0.01, -0.01, 0.0; 0.0, 0.01, -0.02];
        let grouped = grouped(&covariance(&jacobian), &[1.0, 1.0, 1.0]).unwrap();
        assert_eq!((grouped.held.len(), grouped.told.len()), (2, 1));
        assert!(grouped.told[0].error < 0.11, "{}", grouped.told[0].error);
    }
}
