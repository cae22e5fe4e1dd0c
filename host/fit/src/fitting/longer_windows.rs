//! Windows as long as the fitted model allows.
//!
//! Windows are cut before anything is fitted, by how start errors grow in the model as it is given.
//! With too little friction or inertia they grow faster than on the rig, and the windows are
//! shorter than need be: values fitted over them are close, yet not so close that a run of the
//! whole motion follows it. Where the fitted model leaves nothing but noise, and its errors grow
//! less, the fit goes on over the windows that follow from it.

use super::data::FitProblem;
use super::fit::{Fit, FitOptions};
use super::horizon::Horizon;
use super::staged::{LONGER_S, SHORT_S, Stages};
use super::ways::{best_fit, leaves_noise};
use crate::model::{Model, ParameterPath};

/// The [best fit](best_fit) over windows that are cut for `model`, or, where half as many suffice
/// the fitted one, over those; with the windows that it is of. `horizon` is that of `data`.
pub fn best_fit_in_longest_windows(
    model: &Model,
    free: &[ParameterPath],
    data: FitProblem,
    horizon: Horizon,
) -> (Fit, FitProblem) {
    let found = best_fit(model, free, &data);
    if !leaves_noise(&found) {
        return (found, data);
    }
    let Some(longer) = data.lengthened(&found.model, horizon) else {
        return (found, data);
    };
    match went_on(&found, &data, &longer) {
        Some(on) => (on, longer),
        None => (found, data),
    }
}

/// A fit gone on with by stages to longer windows; none where it leaves more than noise there.
fn went_on(found: &Fit, windows: &FitProblem, longer: &FitProblem) -> Option<Fit> {
    let now_s = windows.longest_window_s();
    let all = SHORT_S.iter().chain(LONGER_S).copied();
    let lengths_s: Vec<f64> = all.filter(|length_s| *length_s > now_s).collect();
    let mut stages = Stages::after(found, windows, &found.free, longer);
    stages.through(&lengths_s);
    let mut on = stages.end(FitOptions::default());
    on.simulations += found.simulations;
    leaves_noise(&on).then_some(on)
}

#[cfg(test)]
mod tests {
    use super::super::log_tests::{driven, even};
    use super::*;
    use crate::fitting::{fit, refit};
    use crate::motion::{Motion, Split};
    use std::path::Path;

    /// An arm that a torque swings over the top.
    const ARM: &str = r#"
[rig]
name = "arm"
angle_zero = "hanging"
step_s = 0.005

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

[[effect]]
kind = "coulomb"
joint = 1
torque_nm = 0.015

[[effect]]
kind = "torque_scale"
joint = 1
factor = 1.0

[log]
time = { column = "t", unit = "s" }

[[log.joint]]
position = { column = "q", unit = "rad", resolution_rad = 0.005 }
input = { column = "u", unit = "N m" }
"#;

    /// A motion of the arm, of 20 s, and its free values.
    fn swing() -> (Model, Motion, Vec<ParameterPath>) {
        let truth = Model::parse(ARM, Path::new("arm.toml")).unwrap();
        let torque_nm = |t: f64| 0.16 * (2.2 * t).sin() + 0.1 * (5.1 * t + 1.0).sin();
        let time_s = even(2000, 100.0);
        let input = time_s.iter().map(|t| torque_nm(*t)).collect();
        let motion = driven(&truth, &[0.0], time_s, vec![Some(input)]);
        let angles = motion.position_rad[0].iter();
        let farthest_rad = angles.fold(0.0_f64, |most, q| most.max(q.abs()));
        assert!(farthest_rad > 3.5, "{farthest_rad}");
        let free = [
            "viscous@1.coefficient_nm_s_rad",
            "coulomb@1.torque_nm",
            "link1.inertia_kg_m2",
            "torque_scale@1.factor",
        ];
        (
            truth,
            motion,
            free.map(|path| path.parse().unwrap()).to_vec(),
        )
    }

    #[test]
    fn values_that_make_errors_grow_shorten_no_window_of_the_fit() {
        let (truth, motion, free) = swing();
        let whole = FitProblem::new(&truth, vec![motion.clone()], Horizon::Whole);
        let split = Split {
            training: vec![motion.clone()],
            held_out: Vec::new(),
        };
        for factors in [[0.25, 0.25, 1.0, 0.5], [0.2, 2.0, 0.1, 2.5]] {
            let mut start = truth.clone();
            for (path, factor) in free.iter().zip(factors) {
                assert!(path.set(&mut start, factor * path.get(&truth).unwrap()));
            }
            let cut = FitProblem::new(&start, vec![motion.clone()], Horizon::Whole);
            assert!(cut.windows.len() > 10, "{:?}", cut.windows);
            let fitted = refit(&start, &free, &split, None, &|_| {}).unwrap();
            assert_eq!(fitted.windows[0].window_s, None, "{factors:?}");
            let freely = best_fit(&fitted.model, &[], &whole).rms(&whole);
            assert!(freely < 1.05 * whole.floor(), "{factors:?}: {freely}");
        }
    }

    #[test]
    fn a_start_shows_again_where_the_arm_passes_upright() {
        let truth = Model::parse(ARM, Path::new("arm.toml")).unwrap();
        let time_s = even(2000, 100.0);
        let torque_nm = |t: f64| {
            let slow = 0.16 * (2.2 * t).sin() + 0.1 * (4.1 * t + 1.0).sin();
            (2.0 * t).min(1.0) * (slow + 0.05 * (9.0 * t + 2.0).sin())
        };
        let input = time_s.iter().map(|t| torque_nm(*t)).collect();
        let motion = driven(&truth, &[0.0], time_s, vec![Some(input)]);
        let whole = FitProblem::new(&truth, vec![motion], Horizon::Whole);
        let left = best_fit(&truth, &[], &whole).rms(&whole);
        assert!(left < 1.05 * whole.floor(), "{left}");
    }

    #[test]
    fn what_short_windows_tell_too_badly_for_the_whole_goes_there_by_stages() {
        let (truth, motion, free) = swing();
        let short = FitProblem::new(&truth, vec![motion], Horizon::Seconds(0.2));
        let whole = short.recut(Horizon::Whole);
        let found = best_fit(&truth, &free, &short);
        let starts = whole.window_starts_from(&short, &found.window_starts);
        let options = FitOptions::default();
        let at_once = fit(&found.model, &free, &whole, Some(&starts), options);
        assert!(!leaves_noise(&at_once));
        assert!(went_on(&found, &short, &whole).is_some());
    }
}
