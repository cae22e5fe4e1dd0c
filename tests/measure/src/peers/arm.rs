//! The servo arm of `arm_log.py`: four parameters fitted to its logs, and its logs diagnosed.

use super::median_seconds;
use handstand::diagnose::{DiagnoseOptions, Verdict, diagnose};
use handstand::fitting::{
    FitOptions, FitProblem, Horizon, best_fit, best_fit_in_longest_windows, fit, fit_start_states,
};
use handstand::log::{LogRequest, read};
use handstand::model::ParameterPath;
use handstand::motion::Motion;
use handstand::{Error, Model, Result};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The four parameters, as the library addresses them and as `.truth.json` names them.
const FREE: [(&str, &str); 4] = [
    ("viscous@1.coefficient_nm_s_rad", "viscous"),
    ("coulomb@1.torque_nm", "coulomb"),
    ("link1.inertia_kg_m2", "inertia"),
    ("torque_scale@1.factor", "torque_constant"),
];

/// The start of the fit that is timed, against the truth: as in `fit_scipy.py`.
const FIXED_START: [f64; 4] = [2.0, 0.5, 2.0, 0.5];

/// Only its weight's moment is known, 0.2 kg at 0.1 m; a heavy mass close to the joint has the same
/// and next to no inertia about it, so that the whole inertia is free.
const MODEL: &str = r#"
[rig]
name = "arm"
angle_zero = "hanging"

[[link]]
com_m = 0.001
mass_kg = 20.0
inertia_kg_m2 = 0.004

[[joint]]
drive = "torque"

[[effect]]
kind = "viscous"
joint = 1
coefficient_nm_s_rad = 0.02

[[effect]]
kind = "coulomb"
joint = 1
torque_nm = 0.03

[[effect]]
kind = "torque_scale"
joint = 1
factor = 1.0

[log]
time = { column = "time_s", unit = "s" }

[[log.joint]]
position = { column = "position_rad", unit = "rad", resolution_rad = 0.00511327 }
input = { column = "torque_nm", unit = "N m" }
"#;

/// The arm at its true parameters, with logs.
#[derive(Debug, Clone)]
pub struct Arm {
    model: Model,
    free: Vec<ParameterPath>,
    truth: Vec<f64>,
    motions: Vec<Motion>,
}

/// How fits from many starts ended.
#[derive(Debug, Clone)]
pub struct Starts {
    /// Starts.
    pub count: usize,
    /// Those that end at no more than 1.1 times the floor, the error of the true parameters
    /// refitted, with every parameter within 10 % of the truth.
    pub converged: usize,
    /// The floor, rad.
    pub floor_rad: f64,
    /// Per start: error, rad, and the worst parameter's distance from the truth, relative.
    pub ends: Vec<(f64, f64)>,
    /// Seconds of a fit, median.
    pub seconds: f64,
}

impl Arm {
    /// Logs of `arm_log.py`, and the truth beside the first of them.
    ///
    /// # Errors
    /// A file that is missing or not what the script writes.
    pub fn load(logs: &[PathBuf]) -> Result<Arm> {
        let mut model = Model::parse(MODEL, Path::new("arm.toml"))?;
        let requests: Vec<LogRequest> = logs.iter().map(LogRequest::whole).collect();
        let motions = read(&requests, &model.log)?;
        let file = logs
            .first()
            .cloned()
            .unwrap_or_default()
            .with_extension("truth.json");
        let text = std::fs::read_to_string(&file).map_err(|e| Error::file(&file, "read", e))?;
        let sidecar: Value = serde_json::from_str(&text).unwrap_or_default();
        let mut free = Vec::new();
        for (path, name) in FREE {
            let path: ParameterPath = path.parse()?;
            if let Some(value) = sidecar["truth"][name].as_f64() {
                let known = path.set(&mut model, value);
                debug_assert!(known, "the model has all four");
            }
            free.push(path);
        }
        let truth = free.iter().filter_map(|path| path.get(&model)).collect();
        Ok(Arm {
            model,
            free,
            truth,
            motions,
        })
    }

    /// The model with each parameter off the truth by a factor.
    fn off_by(&self, factors: &[f64]) -> Model {
        let mut model = self.model.clone();
        for ((path, truth), factor) in self.free.iter().zip(&self.truth).zip(factors) {
            let known = path.set(&mut model, truth * factor);
            debug_assert!(known, "the model has all four");
        }
        model
    }

    /// Seconds of the four-parameter fit of the whole log, and the error it leaves, rad.
    pub fn fit_seconds(&self, repeats: usize) -> (f64, f64) {
        let start = self.off_by(&FIXED_START);
        let data = FitProblem::new(&self.model, self.motions.clone(), Horizon::Whole);
        let mut left = 0.0;
        let seconds = median_seconds(repeats, || {
            let found = fit(&start, &self.free, &data, None, FitOptions::default());
            left = found.rms(&data);
        });
        (seconds, left)
    }

    /// Fits by stages from seeded starts, each parameter up to a factor 5 off.
    pub fn starts(&self, count: usize, seed: u64) -> Starts {
        let judged = FitProblem::new(&self.model, self.motions.clone(), Horizon::Whole);
        let at_truth = fit(
            &self.model,
            &self.free,
            &judged,
            None,
            FitOptions::default(),
        );
        let floor_rad = at_truth
            .rms(&judged)
            .min(fit_start_states(&self.model, &judged).rms(&judged));
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (mut ends, mut times) = (Vec::new(), Vec::new());
        for _ in 0..count {
            let factors: Vec<f64> = self
                .free
                .iter()
                .map(|_| 5.0_f64.powf(rng.random_range(-1.0..1.0)))
                .collect();
            let start = self.off_by(&factors);
            let mut values = Vec::new();
            let mut left = 0.0;
            times.push(median_seconds(1, || {
                let data = FitProblem::new(&start, self.motions.clone(), Horizon::Whole);
                let (found, _) =
                    best_fit_in_longest_windows(&start, &self.free, data, Horizon::Whole);
                left = best_fit(&found.model, &[], &judged).rms(&judged);
                values = found.values();
            }));
            let off = values
                .iter()
                .zip(&self.truth)
                .map(|(v, truth)| (v / truth - 1.0).abs());
            ends.push((left, off.fold(0.0, f64::max)));
        }
        times.sort_by(f64::total_cmp);
        Starts {
            count,
            converged: ends
                .iter()
                .filter(|(left, off)| *left <= 1.1 * floor_rad && *off <= 0.1)
                .count(),
            floor_rad,
            ends,
            seconds: times.get(count / 2).copied().unwrap_or_default(),
        }
    }

    /// Seconds of a diagnosis of the arm without its Coulomb friction, the last log held out, and
    /// what it says.
    pub fn diagnose_seconds(&self) -> (f64, String) {
        let mut model = self.off_by(&FIXED_START);
        model
            .effects
            .retain(|effect| effect.effect.info().id != "coulomb");
        model.free = self
            .free
            .iter()
            .copied()
            .filter(|path| path.get(&model).is_some())
            .collect();
        let (held_out, training) = self
            .motions
            .split_last()
            .map_or((None, &[][..]), |(l, t)| (Some(l), t));
        let mut said = String::new();
        let seconds = median_seconds(1, || {
            let found = diagnose(
                &model,
                training.to_vec(),
                held_out.into_iter().cloned().collect(),
                &DiagnoseOptions::default(),
                &|_| {},
            );
            let kinds: Vec<&str> = found.effects.iter().map(|e| e.kind.as_str()).collect();
            said = match found.verdict {
                Verdict::Named => kinds.join("+"),
                other => format!("{other:?} {}", kinds.join("+")).to_lowercase(),
            };
        });
        (seconds, said)
    }
}
