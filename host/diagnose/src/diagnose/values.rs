//! Whether a value of the model file is wrong: the simplest explanation there is, so it is tried
//! before any missing effect.

use super::budget::{EVALUATION_STEPS, FINALISTS, FINISH, LOOK};
use super::evaluator::Evaluator;
use super::explanation::Explanation;
use super::findings::WrongValue;
use super::first_look::best_third;
use super::hypothesis::Hypothesis;
use crate::fitting::{Fit, FitOptions, FitProblem, FittedValue, fit, intervals};
use crate::model::{JointField, LinkField, Model, ParameterPath};
use rayon::prelude::*;

/// Iterations after which the fit of a value that is hopeless must have brought its squared error
/// below this share.
const STAGE: usize = 9;
const ON_ITS_WAY: f64 = 0.5;

impl Evaluator<'_> {
    /// Every value of the given model fitted alone, free or not; the best are evaluated, unless
    /// `least`, the squared error that others leave, makes them hopeless.
    pub fn try_values(&self, least: Option<f64>) -> Vec<Hypothesis> {
        self.fit_values(&self.given, &self.open_values(), least)
    }

    /// Every value that is not free, or is known beforehand, fitted along with those that are as if
    /// nothing were known of it; the best are evaluated, with `least` as above.
    pub fn try_values_refitted(&self, least: Option<f64>) -> Vec<Hypothesis> {
        let free = &self.base.search.free;
        if free.is_empty() {
            return Vec::new();
        }
        let mut paths = self.open_values();
        paths.retain(|path| !free.contains(path) || self.start.uncertain(*path).is_some());
        self.fit_values(&self.base, &paths, least)
    }

    /// Values of the given model that may be wrong.
    pub fn open_values(&self) -> Vec<ParameterPath> {
        let mut open = values_of(&self.start);
        open.retain(|path| !self.known.contains(path));
        open
    }

    /// Whether one other value of the file leaves nothing to explain: no set of several effects is
    /// as simple.
    pub fn is_value_that_explains(&self, explanation: Explanation) -> bool {
        use Explanation::{Value, ValueAndRefit};
        matches!(explanation, Value(value) | ValueAndRefit(value) if self.is_explained_by(value))
    }

    /// Fits a value to the end, or until it is seen that it stays hopeless: above the limit, and no
    /// longer on its way.
    fn finish(&self, value: &mut Hypothesis, limit: f64) {
        for _ in 0..FINISH.div_ceil(STAGE) {
            let before = value.search_mean;
            value.resume(&self.search, FitOptions::iterations(STAGE));
            let stays = value.search_mean > limit && value.search_mean > ON_ITS_WAY * before;
            if value.search.converged || stays {
                break;
            }
        }
    }

    fn fit_values(
        &self,
        from: &Hypothesis,
        paths: &[ParameterPath],
        least: Option<f64>,
    ) -> Vec<Hypothesis> {
        let glance = |&path: &ParameterPath| {
            let from = &from.search;
            let options = FitOptions::iterations(LOOK).glance();
            let search = from.with_unknown(path, &self.search, options);
            Hypothesis {
                values: vec![path],
                ..Hypothesis::new(Vec::new(), search)
            }
        };
        let mut values: Vec<Hypothesis> = paths.par_iter().map(glance).collect();
        let go_on = |values: &mut [Hypothesis], limit: f64, options: FitOptions| {
            let promising = values.par_iter_mut().filter(|v| v.search_mean <= limit);
            promising.for_each(|value| value.resume(&self.search, options));
            values.sort_by(Hypothesis::by_error);
        };
        // Short fits bring a value that is far off half of the way: what others leave that are
        // fitted to the end is no measure for it before it is, too.
        let looked_at = best_third(values.iter().map(|v| v.search_mean).collect());
        go_on(&mut values, looked_at, FitOptions::iterations(LOOK).rough());
        values.truncate(FINALISTS);
        let limit = self.limit(values.iter(), None);
        let hopeless = self.limit([].iter(), least);
        let promising = values.par_iter_mut().filter(|v| v.search_mean <= limit);
        promising.for_each(|value| self.finish(value, hopeless));
        values.sort_by(Hypothesis::by_error);
        let promising = self.promising(&values, least);
        self.evaluate_all(&mut values[..promising], least, || {
            self.course.step(EVALUATION_STEPS)
        });
        values
    }
}

impl Hypothesis {
    /// How far the values it changes are from those of the model, the farthest, in standard
    /// uncertainties.
    pub fn deviation(&self, given: &Model) -> f64 {
        let deviation = |path: &ParameterPath| {
            let value = path.get(&self.search.model);
            value.map_or(0.0, |value| given.deviation(*path, value))
        };
        self.values.iter().map(deviation).fold(0.0, f64::max)
    }
}

/// The model as given, nothing fitted but start states.
pub(super) fn as_given(model: &Model, search: &FitProblem) -> Hypothesis {
    let options = FitOptions::iterations(LOOK);
    Hypothesis::new(Vec::new(), fit(model, &[], search, None, options))
}

/// Addresses of the model's values that may be wrong. The length of the last link moves nothing, a
/// passive or ideal drive has no figures, and what is infinite is switched off.
pub(super) fn values_of(model: &Model) -> Vec<ParameterPath> {
    let last = model.link_count() - 1;
    let links = (0..=last).flat_map(|index| {
        let fields = LinkField::ALL.into_iter();
        let fields = fields.filter(move |field| index < last || *field != LinkField::Length);
        fields.map(move |field| ParameterPath::Link { index, field })
    });
    let joints = (0..=last).flat_map(|index| {
        let fields = JointField::ALL.into_iter();
        fields.map(move |field| ParameterPath::Joint { index, field })
    });
    let effects = model.effects.iter().flat_map(ParameterPath::of_effect);
    let all = links.chain(joints).chain(effects);
    all.filter(|path| path.get(model).is_some_and(f64::is_finite))
        .collect()
}

/// Values of one kind that one factor may have made wrong: masses and inertias of all links, stall
/// torques of all motors. None where they belong to one link or motor: an effect says that.
pub(super) fn kinds_of_values(model: &Model) -> Vec<Vec<ParameterPath>> {
    // What it belongs to, from 0.
    let inertial = |path: &ParameterPath| match path {
        ParameterPath::Link { index, field } => {
            matches!(field, LinkField::Mass | LinkField::Inertia).then_some(*index)
        }
        _ => None,
    };
    let torque = |path: &ParameterPath| match path {
        ParameterPath::Joint { index, field } => {
            let stall = [JointField::StallTorque, JointField::StallForce].contains(field);
            stall.then_some(*index)
        }
        _ => None,
    };
    let mut all = values_of(model);
    all.retain(|path| path.get(model) != Some(0.0));
    let of = |owner: &dyn Fn(&ParameterPath) -> Option<usize>| {
        let first = all.iter().find_map(owner);
        let several = all.iter().filter_map(owner).any(|own| Some(own) != first);
        let kind = all.iter().copied().filter(|path| owner(path).is_some());
        several.then(|| kind.collect::<Vec<ParameterPath>>())
    };
    [of(&inertial), of(&torque)].into_iter().flatten().collect()
}

/// Addresses of those of a fit's values that contradict the given model.
pub(super) fn contradicted_paths(
    given: &Model,
    fit: &Fit,
    data: &FitProblem,
) -> Vec<ParameterPath> {
    let Some((intervals, _)) = intervals(fit, data) else {
        return Vec::new();
    };
    let free = fit.free.iter().zip(intervals);
    let wrong = free.filter(|(path, interval)| {
        let given = path.get(given);
        given.is_some_and(|given| !(interval.low..=interval.high).contains(&given))
    });
    wrong.map(|(path, _)| *path).collect()
}

/// Fitted values beside those in the file.
pub(super) fn compared(given: &Model, fitted: &[FittedValue]) -> Vec<WrongValue> {
    let values = fitted.iter().filter_map(|fitted| {
        let path: ParameterPath = fitted.path.parse().ok()?;
        let known = given.uncertain(path);
        Some(WrongValue {
            within_uncertainty: known.is_some_and(|known| known.allows(fitted.value)),
            given: path.get(given)?,
            free: given.free.contains(&path) && given.uncertain(path).is_none(),
            fitted: fitted.clone(),
        })
    });
    values.collect()
}

/// Those of the fitted values whose interval leaves out the one in the file.
pub(super) fn contradicted(given: &Model, fitted: &[FittedValue]) -> Vec<WrongValue> {
    let mut wrong = compared(given, fitted);
    wrong.retain(|value| !(value.fitted.low..=value.fitted.high).contains(&value.given));
    wrong
}
