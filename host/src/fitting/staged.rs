//! Fits from values that are far off: short windows first, then longer ones.
//!
//! Over a short window no wrong value leads far astray, so the cost has few false valleys; over a
//! long one the values are known best. Each stage starts where the one before ended (Bock 1981,
//! multiple shooting; homotopy in the length of the windows).

use super::data::FitData;
use super::fit::{Fit, FitOptions};
use super::horizon::{Horizon, Window};
use super::node::Node;
use super::solve::{fit, guessed_nodes};
use crate::model::{Model, ParameterPath};

/// Seconds of one window, stage by stage.
const STAGES_S: [f64; 4] = [0.25, 0.5, 1.0, 2.0];

/// A stage need not end exactly where its cost is least.
const STAGE: FitOptions = FitOptions {
    iterations: 15,
    tolerance: 1e-3,
    rough: true,
    glance: false,
};

/// Root-mean-square weighted residual that leaves nothing to look for.
const AT_FLOOR: f64 = 1.15;

/// Where the stages of short windows end.
struct Near {
    model: Model,
    /// Start states of the windows that were to be fitted.
    nodes: Vec<Node>,
    simulations: usize,
}

fn stages(model: &Model, free: &[ParameterPath], data: &FitData) -> Near {
    let longest = data.windows.iter().map(|w| w.samples.len()).max();
    let mut near = Near {
        model: model.clone(),
        nodes: guessed_nodes(data),
        simulations: 0,
    };
    let mut before: Option<(Vec<Window>, Vec<Node>)> = None;
    for seconds in STAGES_S {
        let stage = data.recut(Horizon::Seconds(seconds));
        if stage.windows.iter().map(|w| w.samples.len()).max() >= longest {
            break;
        }
        let nodes = carried(before.as_ref(), &stage);
        let found = fit(&near.model, free, &stage, Some(&nodes), STAGE);
        near.model = found.model;
        near.simulations += found.simulations;
        before = Some((stage.windows, found.nodes));
    }
    near.nodes = carried(before.as_ref(), data);
    near
}

/// Start states of the windows of `data`: those of the windows before that start with the same
/// sample, else as the samples suggest. Guesses alone may lead a long window into a false valley.
fn carried(before: Option<&(Vec<Window>, Vec<Node>)>, data: &FitData) -> Vec<Node> {
    let known = |window: &Window| {
        let (windows, nodes) = before?;
        let start = |w: &Window| (w.motion, w.samples.start);
        let same = windows.iter().position(|w| start(w) == start(window))?;
        Some(nodes[same].clone())
    };
    let windows = data.windows.iter();
    windows
        .map(|window| known(window).unwrap_or_else(|| data.guessed(window)))
        .collect()
}

/// Fits the free parameters from values that may be several times off; windows as in `data`.
///
/// A plain fit that leaves nothing but noise is taken as it is. Otherwise the better one counts of
/// the plain fit and one that starts where the stages of short windows end.
pub fn fit_staged(model: &Model, free: &[ParameterPath], data: &FitData) -> Fit {
    let plain = fit(model, free, data, None, FitOptions::default());
    let mean = plain.residuals.cost() / plain.residuals.count().max(1) as f64;
    if mean.sqrt() < AT_FLOOR {
        return plain;
    }
    let mut staged = fit_through_stages(model, free, data, FitOptions::default());
    staged.simulations += plain.simulations;
    if staged.residuals.cost() < plain.residuals.cost() {
        staged
    } else {
        Fit {
            simulations: staged.simulations,
            ..plain
        }
    }
}

/// Fits from where the stages of short windows end.
pub fn fit_through_stages(
    model: &Model,
    free: &[ParameterPath],
    data: &FitData,
    options: FitOptions,
) -> Fit {
    let near = stages(model, free, data);
    let mut found = fit(&near.model, free, data, Some(&near.nodes), options);
    found.simulations += near.simulations;
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::log::{LogRequest, read};
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
        let data = FitData::new(&model, motions, Horizon::Seconds(4.0));
        let free: Vec<ParameterPath> = ["link1.inertia_kg_m2", "viscous@1.coefficient_nm_s_rad"]
            .map(|text| text.parse().unwrap())
            .to_vec();
        for factors in [[4.0, 4.0], [0.25, 0.25], [0.25, 4.0], [4.0, 0.25]] {
            let mut start = model.clone();
            for (path, factor) in free.iter().zip(factors) {
                assert!(path.set(&mut start, factor * path.get(&model).unwrap()));
            }
            let found = fit_staged(&start, &free, &data);
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
