//! What a search among effects of a robot in space is spared.

use crate::space::{CRANE, run, swung};
use handstand::Model;
use handstand::fitting::{FitProblem, Horizon, coarsened, enough_to_search};
use handstand::log::{LogRequest, read};
use std::path::Path;

/// The crane's model with all its motions cut into windows of a tenth of a second.
fn crane(folder: &Path) -> (Model, FitProblem) {
    std::fs::write(folder.join("crane.urdf"), CRANE).unwrap();
    let arguments = [
        "import",
        "crane.urdf",
        "--space",
        "--driven",
        "-o",
        "m.toml",
    ];
    run(folder, &arguments);
    let model = Model::load(&folder.join("m.toml")).unwrap();
    let logs = (0..3).map(|number| {
        let file = folder.join(format!("{number}.csv"));
        std::fs::write(&file, swung(&model, number)).unwrap();
        LogRequest::whole(file)
    });
    let motions = read(&logs.collect::<Vec<_>>(), &model.log).unwrap();
    let data = FitProblem::new(&model, motions, Horizon::Seconds(0.1));
    (model, data)
}

#[test]
fn a_search_takes_enough_windows_of_all_motions_and_a_planar_one_all() {
    let folder = tempfile::tempdir().unwrap();
    let (mut model, data) = crane(folder.path());
    let all = data.windows.len();
    let enough = enough_to_search(data.clone(), &model);
    let readings = enough.samples() * enough.joints();
    // 27,000 readings in all.
    assert!((3400..4000).contains(&readings), "{readings}");
    for motion in 0..3 {
        let kept = enough.windows_of(motion).count() as f64;
        let of_motion = data.windows_of(motion).count() as f64;
        let share = kept / of_motion * all as f64 / enough.windows.len() as f64;
        assert!(
            (0.8..1.25).contains(&share),
            "{motion}: {kept} of {of_motion}"
        );
    }
    assert!(
        enough
            .windows
            .iter()
            .all(|window| data.windows.contains(window))
    );
    let few = data.recut(Horizon::Seconds(2.0));
    let kept = enough_to_search(few.clone(), &model);
    assert_eq!(
        kept.windows, few.windows,
        "fewer than the least are all kept"
    );
    model.robot = None;
    assert_eq!(enough_to_search(data, &model).windows.len(), all);
}

#[test]
fn steps_of_a_search_are_longer_where_no_prediction_tells() {
    let folder = tempfile::tempdir().unwrap();
    let (model, data) = crane(folder.path());
    let fine = Model {
        step_s: 0.000_25,
        ..model
    };
    let coarse = coarsened(&fine, &data);
    assert!(coarse.step_s > fine.step_s, "{}", coarse.step_s);
}
