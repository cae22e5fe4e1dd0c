//! The one fit whose values are stated, by `diagnose`, `add`, `fit` and `drift`: several ways lead
//! to it.
//!
//! Over a long run the squared error has false valleys: a pendulum that comes to rest half a swing
//! sooner under more of one friction and less of another leaves little more than the right values
//! do, and a descent that ends there looks converged. So a fit is sought by several ways, from the
//! values as they are and through windows that grow, until two of them end in the lowest valley.
//! None ends above its start.

use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::polish::{polish, settle};
use super::solve::{fit, fit_start_states};
use super::staged::Stages;
use crate::model::{Model, ParameterPath};

/// Two fits whose squared errors differ by less than this share ended in one valley: of some
/// thousand samples, by less than one standard error of a value.
const ALIKE: f64 = 2e-4;

/// Root-mean-square weighted residual up to which two ways that agree are believed. Above it a
/// false valley may have drawn both, or the model lacks something; then every way is gone.
const NEAR_NOISE: f64 = 1.05;

/// By which windows a fit was led to those that count. Two that took one road may be led astray by
/// the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Route {
    /// None.
    Direct,
    /// Up to a second.
    Short,
    /// Through longer ones.
    Longer,
}

/// Where a way ends.
pub(super) type End = (Route, Fit);

/// The lowest of the fits that these ways end in; near the noise no more ways are gone once two by
/// different routes ended in the lowest valley. None of no way.
pub(super) fn lowest(ways: impl IntoIterator<Item = End>) -> Option<Fit> {
    let (mut best, mut simulations) = (None::<Fit>, 0);
    let mut ends: Vec<(Route, f64)> = Vec::new();
    for (route, fit) in ways {
        simulations += fit.simulations;
        let cost = fit.residuals.cost();
        ends.push((route, cost));
        let least = best
            .as_ref()
            .map_or(f64::INFINITY, |best| best.residuals.cost());
        if best.is_none() || cost < least {
            best = Some(fit);
        }
        if best.as_ref().is_some_and(leaves_noise) && is_confirmed(&ends) {
            break;
        }
    }
    best.map(|best| Fit {
        simulations,
        ..best
    })
}

/// Whether a fit leaves little more than noise.
pub(super) fn leaves_noise(fit: &Fit) -> bool {
    let samples = fit.residuals.count().max(1) as f64;
    (fit.residuals.cost() / samples).sqrt() < NEAR_NOISE
}

/// Whether two routes ended in the lowest valley.
fn is_confirmed(ends: &[(Route, f64)]) -> bool {
    let least = ends
        .iter()
        .map(|(_, cost)| *cost)
        .fold(f64::INFINITY, f64::min);
    let mut there = ends
        .iter()
        .filter(|(_, cost)| cost - least <= ALIKE * least);
    let first = there.next();
    first.is_some_and(|(route, _)| there.any(|(other, _)| other != route))
}

/// The ways from the values of a model: as they are, from the start states that suit them, and
/// through windows that grow.
pub(super) fn ways<'a>(
    model: &'a Model,
    free: &'a [ParameterPath],
    data: &'a FitProblem,
) -> impl Iterator<Item = End> + 'a {
    let direct = std::iter::once_with(|| (Route::Direct, directly(model, free, data)));
    direct.chain(Stages::from(model, free, data).ends())
}

/// The fit from the values as they are and the start states that suit them.
pub(super) fn directly(model: &Model, free: &[ParameterPath], data: &FitProblem) -> Fit {
    let start = fit_start_states(model, data);
    let options = FitOptions::default();
    let mut found = fit(model, free, data, Some(&start.window_starts), options);
    found.simulations += start.simulations;
    found
}

/// Fits the free parameters from the values of a model, which may be several times off; windows as
/// in `data`. It leaves no more than the model does as it is, its start states fitted.
pub fn best_fit(model: &Model, free: &[ParameterPath], data: &FitProblem) -> Fit {
    lowest(ways(model, free, data)).unwrap_or_else(|| directly(model, free, data))
}

/// A fit that was found, or a lower one that windows that grow lead to from the values of `given`;
/// as exactly as its values are stated.
pub fn stated_from(found: Fit, given: &Model, data: &FitProblem) -> Fit {
    let free = found.free.clone();
    let others = Stages::from(given, &free, data).ends();
    let best = lowest(std::iter::once((Route::Direct, found.clone())).chain(others));
    stated(best.unwrap_or(found), data)
}

/// A fit as exactly as its values are stated: on no stair, in steps that are not too long. The fit
/// must have its derivatives.
pub fn stated(found: Fit, data: &FitProblem) -> Fit {
    settle(polish(found, data, FitOptions::default()), data)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_valley_is_believed_when_two_routes_end_in_it_and_none_lower() {
        let [direct, short, longer] = [Route::Direct, Route::Short, Route::Longer];
        assert!(!is_confirmed(&[(short, 10.0)]));
        assert!(!is_confirmed(&[(short, 10.0), (short, 10.0)]));
        assert!(is_confirmed(&[(short, 10.0), (direct, 10.001)]));
        assert!(!is_confirmed(&[(short, 10.0), (direct, 10.1)]));
        assert!(!is_confirmed(&[
            (short, 10.0),
            (direct, 10.0),
            (longer, 9.0)
        ]));
        assert!(is_confirmed(&[(short, 9.0), (direct, 10.0), (longer, 9.0)]));
    }
}
