//! The calls that start a fit, or go on with one.

use super::covariance::inverse;
use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::levenberg_marquardt::LevenbergMarquardt;
use super::normal::NormalEquations;
use super::residual::{Residuals, residuals};
use super::window_start::{StartGuess, WindowStart};
use crate::model::{Model, ParameterPath};
use nalgebra::DVector;

/// Iterations of a fit with one value held, from the best one without.
const HOLDING: usize = 2;

impl Fit {
    /// Goes on fitting to the same data; a fit that has converged only gets the derivatives it
    /// lacks.
    pub fn resume(&self, data: &FitProblem, options: FitOptions) -> Fit {
        if self.converged && (self.fresh || options.rough) {
            return self.clone();
        }
        let iterations = if self.converged {
            0
        } else {
            options.iterations
        };
        let options = FitOptions {
            iterations,
            ..options
        };
        LevenbergMarquardt::new(self.clone(), data, guesses(data)).run(options)
    }

    /// The fit with one value held at a place, all others led there by the derivatives at hand;
    /// `None` where the value may not be there.
    pub(super) fn holding(&self, value: usize, at: f64, data: &FitProblem) -> Option<Fit> {
        let path = self.free[value];
        let mut start = self.without(value);
        let (low, high) = path.bounds(&self.model);
        let is_possible = (low..=high).contains(&at) && path.set(&mut start.model, at);
        is_possible.then_some(())?;
        start.residuals = residuals(&start.model, data, &start.window_starts);
        for (window, residual) in start.jacobian.iter_mut().zip(&start.residuals.windows) {
            window.residual.copy_from_slice(residual);
        }
        (start.converged, start.fresh) = (false, false);
        let options = FitOptions::iterations(HOLDING).glance();
        Some(LevenbergMarquardt::new(start, data, guesses(data)).run(options))
    }

    /// The fit with one of its values no longer free.
    fn without(&self, value: usize) -> Fit {
        let mut fit = self.clone();
        fit.free.remove(value);
        for window in &mut fit.jacobian {
            window.parameters = window.parameters.clone().remove_column(value);
        }
        fit
    }

    /// Fits a value of which nothing is taken for known beforehand, along with those that are free:
    /// the last one of them.
    pub fn with_unknown(&self, path: ParameterPath, data: &FitProblem, options: FitOptions) -> Fit {
        let known = self.free.iter().position(|own| *own == path);
        let mut from = known.map_or_else(|| self.clone(), |value| self.without(value));
        from.model.forget(&[path]);
        let model = from.model.clone();
        from.with_free(&model, &[path], data, options)
    }

    /// How far the values would move to what left these residuals at them, were all straight; not
    /// at all where the derivatives do not determine them.
    pub(super) fn moved_by(&self, other: &Residuals) -> DVector<f64> {
        let count = self.free.len();
        let mut windows = self.jacobian.clone();
        for (window, residual) in windows.iter_mut().zip(&other.windows) {
            window.residual.copy_from_slice(residual);
        }
        let [mut before, after] = [&self.jacobian, &windows]
            .map(|windows| NormalEquations::assemble(count, windows, 0.0));
        let gradient = before.gradient.clone();
        before.know(&self.value_prior());
        inverse(&before.matrix).map_or(DVector::zeros(count), |inverse| {
            inverse * (after.gradient - gradient)
        })
    }

    /// Whether nothing else is hidden where a window of this other model begins.
    fn hides_alike(&self, model: &Model, data: &FitProblem) -> bool {
        let [had, hidden] = [&self.model, model].map(|model| data.hidden(model));
        had.len() == hidden.len() && had.iter().zip(&hidden).all(|(a, b)| a.is_alike(b))
    }

    /// The fit of more parameters of `model` before its first step: what is left at the start that
    /// the model holds.
    pub fn at_start(&self, model: &Model, added: &[ParameterPath], data: &FitProblem) -> Fit {
        let mut window_starts = self.window_starts.clone();
        if !self.hides_alike(model, data) {
            (window_starts.iter_mut())
                .for_each(|window_start| window_start.forget_hidden(data.joints()));
        }
        Fit {
            model: model.clone(),
            free: [&self.free, added].concat(),
            residuals: residuals(model, data, &window_starts),
            window_starts,
            converged: false,
            simulations: 1,
            jacobian: Vec::new(),
            prior_weight: 1.0,
            fresh: false,
        }
    }

    /// Fits more parameters of `model`, which holds this fit's values and a start for the new ones.
    ///
    /// The derivatives by what was free before are taken over until steps contradict them: of the
    /// simulations of a short fit they would be most.
    pub fn with_free(
        &self,
        model: &Model,
        added: &[ParameterPath],
        data: &FitProblem,
        options: FitOptions,
    ) -> Fit {
        let hides_alike = self.hides_alike(model, data);
        let start = self.at_start(model, added, data);
        let mut run = LevenbergMarquardt::new(start, data, guesses(data));
        // A sensor that trails makes the start's acceleration matter; some effects have unknowns of
        // their own.
        let alike = hides_alike && self.model.trails() == model.trails();
        // What a window's start hides hangs on values, too, which the fit has moved.
        let mut windows = self.jacobian.iter().zip(&run.fit.window_starts);
        let is_sized = windows.all(|(known, own)| known.starts() == own.unknowns.len());
        if alike && is_sized && !self.jacobian.is_empty() {
            run.fit.jacobian = run.extended(&self.jacobian);
        }
        run.run(options)
    }
}

/// Fits the free parameters and every window's start state, which is guessed where none is given.
pub fn fit(
    model: &Model,
    free: &[ParameterPath],
    data: &FitProblem,
    window_starts: Option<&[WindowStart]>,
    options: FitOptions,
) -> Fit {
    let guesses = guesses(data);
    let window_starts = match window_starts {
        Some(window_starts) => window_starts.to_vec(),
        None => guesses.iter().map(|g| g.window_start.clone()).collect(),
    };
    let start = Fit {
        model: model.clone(),
        free: free.to_vec(),
        residuals: residuals(model, data, &window_starts),
        window_starts,
        converged: false,
        simulations: 1,
        jacobian: Vec::new(),
        prior_weight: 1.0,
        fresh: false,
    };
    LevenbergMarquardt::new(start, data, guesses).run(options)
}

/// Fits only the windows' start states: how the model, as it is, does on these motions.
pub fn fit_start_states(model: &Model, data: &FitProblem) -> Fit {
    fit(model, &[], data, None, FitOptions::iterations(8))
}

/// The same after a single step from what the samples around each window's start suggest: nearly
/// as good, in a fraction of the time.
pub fn fit_start_states_roughly(model: &Model, data: &FitProblem) -> Fit {
    fit(model, &[], data, None, FitOptions::iterations(1))
}

/// The start states that the samples around each window's start suggest.
pub fn guessed_window_starts(data: &FitProblem) -> Vec<WindowStart> {
    guesses(data)
        .into_iter()
        .map(|guess| guess.window_start)
        .collect()
}

fn guesses(data: &FitProblem) -> Vec<StartGuess> {
    data.windows.iter().map(|w| data.guess(w)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::log_tests::{ANGLE, driven, even, pendulum, swing};
    use super::*;
    use crate::fitting::{Candidate, Horizon};
    use std::path::Path;

    #[test]
    fn a_glance_takes_no_derivatives_again_and_goes_on_as_a_look() {
        let motions = [1.0, 0.5].map(|from_rad| {
            let truth = pendulum(ANGLE, 0.006);
            swing(&truth, &[from_rad], even(600, 100.0))
        });
        let believed = pendulum(ANGLE, 0.003);
        let data = FitProblem::new(&believed, motions.to_vec(), Horizon::Seconds(1.0));
        let friction: ParameterPath = "coulomb@1.torque_nm".parse().unwrap();
        let base = fit(&believed, &[friction], &data, None, FitOptions::default());
        // A spring that is not there: nothing leads down but derivatives of its own.
        let spring = Candidate::named("cable_spring@1", &base.model).unwrap();
        let mut model = base.model.clone();
        model.effects.push(spring.instance(&spring.starts()[0]));
        let added: Vec<ParameterPath> = spring.paths().collect();
        let tried = |options| base.with_free(&model, &added, &data, options);
        let look = tried(FitOptions::iterations(30).rough());
        let glance = tried(FitOptions::iterations(30).glance());
        // The start, a column for each value, and at most two tries a step.
        assert!(
            glance.simulations < look.simulations,
            "{}",
            glance.simulations
        );
        assert!(!glance.converged);
        let on = glance.resume(&data, FitOptions::iterations(30).rough());
        let cost = |fit: &Fit| fit.residuals.cost();
        assert!(
            (cost(&on) / cost(&look) - 1.0).abs() < 0.02,
            "{} {}",
            cost(&on),
            cost(&look)
        );
    }

    /// A gear whose motor weighs nothing hides none; one that a fit made heavier does.
    #[test]
    fn derivatives_of_other_starts_are_not_taken_over() {
        let text = "[rig]\nname = \"arm\"\nangle_zero = \"hanging\"\n[[link]]\ncom_m = 0.1\n\
             mass_kg = 0.4\ninertia_kg_m2 = 2e-3\n[[joint]]\ndrive = \"position\"\n\
             gain_per_rad = 3.0\nstall_torque_nm = 1.5\nno_load_speed_rad_s = 7.0\n\
             [[effect]]\nkind = \"gear_compliance\"\njoint = 1\ninertia_kg_m2 = 0.0\n\
             stiffness_nm_rad = 4.0\ndamping_ratio = 0.1\n[log]\n\
             time = { column = \"t\", unit = \"s\" }\n[[log.joint]]\n\
             position = { column = \"q\", unit = \"rad\", resolution_rad = 0.001 }\n\
             input = { column = \"u\", unit = \"rad\" }\n";
        let light = Model::parse(text, Path::new("arm.toml")).unwrap();
        let goal = even(200, 100.0).iter().map(|t| (5.0 * t).sin()).collect();
        let motion = driven(&light, &[0.0], even(200, 100.0), vec![Some(goal)]);
        let data = FitProblem::new(&light, vec![motion], Horizon::Seconds(1.0));
        let inertia = "gear_compliance@1.inertia_kg_m2".parse().unwrap();
        let mut base = fit(&light, &[inertia], &data, None, FitOptions::iterations(0));
        assert!(inertia.set(&mut base.model, 0.01));
        assert!(data.hidden(&light).len() < data.hidden(&base.model).len());
        let friction = Candidate::named("coulomb@1", &base.model).unwrap();
        let mut model = base.model.clone();
        model.effects.push(friction.instance(&[0.01]));
        let added: Vec<ParameterPath> = friction.paths().collect();
        let found = base.with_free(&model, &added, &data, FitOptions::iterations(4));
        assert_eq!(found.free.len(), 2);
        assert!(found.residuals.cost().is_finite());
    }
}
