//! Fits from values that are far off: short windows first, then longer ones.
//!
//! Over a short window no wrong value leads far astray, so the cost has few false valleys; over a
//! long one the values are known best. Each stage starts where the one before ended (Bock 1981,
//! multiple shooting; homotopy in the length of the windows).

use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::horizon::{Horizon, Window};
use super::solve::{fit, guessed_window_starts};
use super::ways::{End, Route};
use super::window_start::WindowStart;
use crate::model::{Model, ParameterPath};

/// Seconds of one window, stage by stage, over which most valleys are true.
pub(super) const SHORT_S: &[f64] = &[0.25, 0.5, 1.0];
/// Those between them and whole motions.
pub(super) const LONGER_S: &[f64] = &[2.0, 4.0, 8.0];

/// A stage need not end exactly where its cost is least.
const STAGE: FitOptions = FitOptions {
    iterations: 15,
    tolerance: 1e-3,
    rough: true,
    glance: false,
};

/// Stages of windows that grow, and where the last one ended.
pub(super) struct Stages<'a> {
    model: Model,
    free: &'a [ParameterPath],
    data: &'a FitProblem,
    /// The windows of the last stage and their start states.
    before: Option<(Vec<Window>, Vec<WindowStart>)>,
    simulations: usize,
}

impl<'a> Stages<'a> {
    pub fn from(model: &Model, free: &'a [ParameterPath], data: &'a FitProblem) -> Self {
        Stages {
            model: model.clone(),
            free,
            data,
            before: None,
            simulations: 0,
        }
    }

    /// Goes on where `found` stands, a fit over other windows of the same motions.
    pub fn after(
        found: &Fit,
        windows: &FitProblem,
        free: &'a [ParameterPath],
        data: &'a FitProblem,
    ) -> Self {
        Stages {
            before: Some((windows.windows.clone(), found.window_starts.clone())),
            ..Stages::from(&found.model, free, data)
        }
    }

    /// Fits over windows of these lengths, one after the other, that are shorter than those of the
    /// data; false where none is.
    pub fn through(&mut self, lengths_s: &[f64]) -> bool {
        let longest = |data: &FitProblem| data.windows.iter().map(|w| w.samples.len()).max();
        let mut any = false;
        for &seconds in lengths_s {
            let stage = self.data.recut(Horizon::Seconds(seconds));
            if longest(&stage) >= longest(self.data) {
                break;
            }
            let window_starts = carried(self.before.as_ref(), &stage);
            let found = fit(&self.model, self.free, &stage, Some(&window_starts), STAGE);
            self.model = found.model;
            self.simulations += found.simulations;
            self.before = Some((stage.windows, found.window_starts));
            any = true;
        }
        any
    }

    /// The fit over the windows of the data from here.
    pub fn end(&mut self, options: FitOptions) -> Fit {
        let window_starts = match &self.before {
            Some(_) => carried(self.before.as_ref(), self.data),
            None => guessed_window_starts(self.data),
        };
        let mut found = fit(
            &self.model,
            self.free,
            self.data,
            Some(&window_starts),
            options,
        );
        found.simulations += std::mem::take(&mut self.simulations);
        found
    }

    /// The fits that end stages of short windows, and longer ones.
    pub fn ends(mut self) -> impl Iterator<Item = End> + 'a {
        let routes = [(Route::Short, SHORT_S), (Route::Longer, LONGER_S)];
        routes.into_iter().map_while(move |(route, lengths_s)| {
            let any = self.through(lengths_s);
            any.then(|| (route, self.end(FitOptions::default())))
        })
    }
}

/// Start states of the windows of `data`: those of the windows before that start with the same
/// sample, else as the samples suggest. Guesses alone may lead a long window into a false valley.
fn carried(
    before: Option<&(Vec<Window>, Vec<WindowStart>)>,
    data: &FitProblem,
) -> Vec<WindowStart> {
    let known = |window: &Window| {
        let (windows, window_starts) = before?;
        let start = |w: &Window| (w.motion, w.samples.start);
        let same = windows.iter().position(|w| start(w) == start(window))?;
        Some(window_starts[same].clone())
    };
    let windows = data.windows.iter();
    windows
        .map(|window| known(window).unwrap_or_else(|| data.guessed(window)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::ways::best_fit;
    use super::*;
    use handstand_logs::{LogRequest, read};
    use std::fmt::Write as _;
    use std::path::Path;

    const ARM: &str = r#"
[rig]
name = "arm"
angle_zero = "hanging"

[[link]]
com_m = 0.1
mass_kg = 0.2
inertia_kg_m2 = 0.002

[[joint]]
drive = "torque"

[[effect]]
kind = "viscous"
joint = 1
coefficient_nm_s_rad = 0.01

[log]
time = { column = "t", unit = "s" }

[[log.joint]]
position = { column = "q", unit = "rad" }
input = { column = "u", unit = "N m" }
"#;

    /// An arm that is swung over the top; RK4 in steps of 0.1 ms, read in steps of 5 mrad.
    fn log() -> String {
        let slope = |q: f64, w: f64, u: f64| (u - 0.1962 * q.sin() - 0.01 * w) / 0.004;
        let (mut q, mut w, mut text) = (0.0_f64, 0.0_f64, "t,q,u\n".to_owned());
        for k in 0..800 {
            let t = f64::from(k) / 100.0;
            let u = 0.16 * (2.2 * t).sin() + 0.1 * (5.1 * t + 1.0).sin();
            let read = (q / 0.005).round() * 0.005;
            writeln!(text, "{t},{read},{u}").unwrap();
            let h = 1e-4;
            for _ in 0..100 {
                let (w1, a1) = (w, slope(q, w, u));
                let (w2, a2) = (
                    w + h / 2.0 * a1,
                    slope(q + h / 2.0 * w1, w + h / 2.0 * a1, u),
                );
                let (w3, a3) = (
                    w + h / 2.0 * a2,
                    slope(q + h / 2.0 * w2, w + h / 2.0 * a2, u),
                );
                let (w4, a4) = (w + h * a3, slope(q + h * w3, w + h * a3, u));
                q += h / 6.0 * (w1 + 2.0 * w2 + 2.0 * w3 + w4);
                w += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
            }
        }
        text
    }

    #[test]
    fn a_swing_over_the_top_is_fitted_from_far_off() {
        let model = Model::parse(ARM, Path::new("arm.toml")).unwrap();
        let dir = tempfile::tempdir().unwrap();
        let file = dir.path().join("over.csv");
        std::fs::write(&file, log()).unwrap();
        let motions = read(&[LogRequest::whole(file)], &model.log).unwrap();
        let farthest = motions[0].position_rad[0]
            .iter()
            .fold(0.0_f64, |most, q| most.max(q.abs()));
        assert!(farthest > 3.5, "{farthest}");
        let data = FitProblem::new(&model, motions, Horizon::Seconds(4.0));
        let free: Vec<ParameterPath> = ["link1.inertia_kg_m2", "viscous@1.coefficient_nm_s_rad"]
            .map(|text| text.parse().unwrap())
            .to_vec();
        for factors in [[4.0, 4.0], [0.25, 0.25], [0.25, 4.0], [4.0, 0.25]] {
            let mut start = model.clone();
            for (path, factor) in free.iter().zip(factors) {
                assert!(path.set(&mut start, factor * path.get(&model).unwrap()));
            }
            let found = best_fit(&start, &free, &data);
            for (path, value) in free.iter().zip(found.values()) {
                let truth = path.get(&model).unwrap();
                assert!(
                    (value / truth - 1.0).abs() < 0.03,
                    "{factors:?}: {path} {value}"
                );
            }
        }
    }
}
