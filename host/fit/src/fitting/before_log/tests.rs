//! Every effect that remembers, in logs that begin in the midst of what came before them.

use super::super::log_tests::{driven, even};
use super::super::{FitOptions, FitProblem, Horizon, fit};
use crate::effects::{EFFECTS, Needs, Scope, named};
use crate::model::{EffectInstance, Model, ParameterPath};
use crate::motion::Motion;
use std::path::Path;

/// Each effect that remembers, with values that show in the motion, and which of these are
/// refitted.
const REMEMBERING: &[(&str, &[f64], usize)] = &[
    ("delay", &[0.12], 1),
    ("slew_limit", &[1.24], 1),
    ("drive_lag", &[0.15], 1),
    ("fold_back", &[0.5, 0.1, 0.4], 1),
    ("thermal_drift", &[1.5, 4.0], 2),
    ("gear_backlash", &[0.01, 0.05], 1),
    ("gear_compliance", &[0.01, 4.0, 0.1], 2),
    ("pre_sliding", &[0.05, 0.5], 2),
    ("base_compliance", &[400.0, 0.5, 0.1], 1),
    ("sensor_lag", &[0.06], 1),
    ("backlash", &[0.04], 1),
    ("grip_slip", &[60.0], 1),
    ("rate_lag", &[0.06], 1),
];

/// Where a log begins in the motion, s: at rest away from the first goal, on the way to a goal, and
/// where a limit has long been reached.
const BEGINNINGS: [(&str, f64); 3] = [("at rest", 1.0), ("in motion", 1.17), ("loaded", 5.9)];

/// Most that the right values may leave, in standard deviations of the noise.
const MOST: f64 = 1.2;

/// A motor that turns to the angles it is told, its load hanging.
fn arm(id: &str, values: &[f64]) -> Model {
    let effect = named(id).unwrap();
    let rate = if effect.info().needs == Needs::RateSensor {
        "gyro = { column = \"w\", unit = \"rad/s\", resolution_rad_s = 0.005 }\n"
    } else {
        ""
    };
    let text = format!(
        "[rig]\nname = \"arm\"\nangle_zero = \"hanging\"\nstep_s = 0.005\n\
         [[link]]\ncom_m = 0.1\nmass_kg = 0.4\ninertia_kg_m2 = 2e-3\n\
         [[joint]]\ndrive = \"position\"\ngain_per_rad = 3.0\nstall_torque_nm = 1.5\n\
         no_load_speed_rad_s = 7.0\n\
         [log]\ntime = {{ column = \"t\", unit = \"s\" }}\n[[log.joint]]\n\
         position = {{ column = \"q\", unit = \"rad\", resolution_rad = 0.0005 }}\n{rate}\
         input = {{ column = \"u\", unit = \"rad\" }}\n"
    );
    let mut model = Model::parse(&text, Path::new("arm.toml")).unwrap();
    model.effects.push(EffectInstance {
        joint: (effect.info().scope != Scope::WholeRig).then_some(0),
        effect,
        values: values.to_vec(),
    });
    model
}

/// What the arm does: steps between goals, and two where it is pressed hard.
fn moved(model: &Model) -> Motion {
    let time_s = even(1000, 100.0);
    let goal = |t: &f64| match t {
        ..1.0 => 0.0,
        1.0..2.2 => 0.64,
        2.2..3.4 => -0.3,
        3.4..4.4 => 1.3,
        4.4..6.2 => 1.5,
        6.2..7.5 => 0.2,
        7.5..8.6 => -0.8,
        _ => 0.3,
    };
    let goals = vec![Some(time_s.iter().map(goal).collect())];
    driven(model, &[0.0], time_s, goals)
}

/// What a fit of these values leaves in windows of this length, as a share of the noise, and the
/// first value.
fn left(model: &Model, log: &Motion, horizon: Horizon, free: &[ParameterPath]) -> (f64, f64) {
    let data = FitProblem::new(model, vec![log.clone()], horizon);
    let fitted = fit(model, free, &data, None, FitOptions::default());
    let first = fitted.values().first().copied().unwrap_or(f64::NAN);
    (fitted.residuals.mean_square().sqrt(), first)
}

/// The first values of the effect.
fn first_values(model: &Model, count: usize) -> Vec<ParameterPath> {
    let instance = &model.effects[0];
    let info = instance.effect.info();
    let at = instance.joint.map_or("", |_| "@1");
    let keys = info.parameters[..count].iter().map(|own| own.key);
    let paths = keys.map(|key| format!("{}{at}.{key}", info.id));
    paths.map(|path| path.parse().unwrap()).collect()
}

#[test]
fn every_effect_that_remembers_is_looked_at() {
    for effect in EFFECTS {
        let parameters = effect.info().parameters.iter();
        let values: Vec<f64> = parameters.map(|parameter| parameter.starts[0]).collect();
        if effect.start_unknown(&values).is_some() {
            let id = effect.info().id;
            assert!(REMEMBERING.iter().any(|(own, ..)| *own == id), "{id}");
        }
    }
}

/// What the right values leave of a log that begins anywhere is noise, and wrong ones are mended.
#[test]
fn no_beginning_of_a_log_leaves_an_error_in_it() {
    let mut wrong = Vec::new();
    for (id, values, count) in REMEMBERING {
        let truth = arm(id, values);
        let whole = moved(&truth);
        let free = first_values(&truth, *count);
        let mut begun = truth.clone();
        for value in &mut begun.effects[0].values[..*count] {
            *value *= 1.2;
        }
        // A descent among knocks and jumps may end in a valley beside the deepest.
        let jumps = truth.effects[0].effect.difference() > 1e-3;
        let [most, most_fitted] = if jumps { [1.5, 2.5] } else { [MOST, MOST] };
        // A slip before the log is a zero that nothing tells from the file's, a warm motor is one
        // that is weaker, and a base begins at rest.
        let only_at_rest = ["grip_slip", "thermal_drift", "base_compliance"].contains(id);
        let beginnings = BEGINNINGS.iter().take(if only_at_rest { 1 } else { 3 });
        for (name, from_s) in beginnings {
            let log = whole.part((from_s * 100.0) as usize..whole.len());
            for horizon in [Horizon::Whole, Horizon::Seconds(0.5)] {
                // What a window takes over among knocks is another matter.
                if horizon != Horizon::Whole && *id == "gear_backlash" {
                    continue;
                }
                let (true_left, _) = left(&truth, &log, horizon, &[]);
                let (fitted_left, value) = left(&begun, &log, horizon, &free);
                let off = value / values[0] - 1.0;
                if true_left > most || fitted_left > most_fitted || off.abs() > 0.05 {
                    wrong.push(format!(
                        "{id} {name} {horizon:?}: {true_left:.2} times the noise, refitted \
                         {fitted_left:.2} at {value} for {}",
                        values[0]
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
