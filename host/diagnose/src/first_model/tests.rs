//! A first model reads the log that it was made from.

use super::*;
use crate::log::RawLog;

/// A servo that follows its goal, as a BAM bench writes it; the arm is heavier than its figures.
fn bam(mass_kg: f64) -> String {
    let entry = |k: u32| {
        let t = 0.01 * f64::from(k);
        let (goal, angle) = (0.8 * (3.0 * t).sin(), 0.7 * (3.0 * t - 0.35).sin());
        format!("{{\"timestamp\": {t}, \"position\": {angle}, \"goal_position\": {goal}}}")
    };
    let entries: Vec<String> = (0..600).map(entry).collect();
    format!(
        "{{\"mass\": {mass_kg}, \"arm_mass\": 0.016, \"length\": 0.14, \"kp\": 8, \"entries\": [{}]}}",
        entries.join(",")
    )
}

#[test]
fn a_bench_s_own_figures_stay_as_the_log_says() {
    let folder = tempfile::tempdir().unwrap();
    let loads = [0.07, 0.2].map(|kg| {
        let path = folder.path().join(format!("m{kg}.json"));
        std::fs::write(&path, bam(kg)).unwrap();
        LogRequest::whole(path)
    });
    let log = RawLog::read_request(&loads[0]).unwrap();
    let mut draft = Draft::of(&log, "a.json", None).unwrap();
    let stop = StopSwitch::default();
    estimate(&mut draft, &loads[0], &stop, &|_| {}).unwrap();
    let model = Model::parse(&draft.toml().unwrap(), Path::new("a.toml")).unwrap();
    let link = &model.links[0];
    assert_eq!((link.mass_kg, link.com_m), (0.016, 0.07));
    let free: Vec<String> = model.free.iter().map(ToString::to_string).collect();
    assert!(
        free.iter().all(|path| !path.starts_with("link")),
        "{free:?}"
    );
    // So it reads the logs of every load.
    assert_eq!(read(&loads, &model.log).unwrap().len(), 2);
    let origins = draft.values().unwrap();
    let mass = origins.iter().find(|value| value.path == "link1.mass_kg");
    assert_eq!(mass.unwrap().origin, crate::log::init::Origin::Given);
}

/// A fit of all values of as many joints takes hours.
#[test]
fn a_draft_of_many_joints_keeps_its_guesses_and_says_so() {
    let joints = MOST_JOINTS + 1;
    let names = (1..=joints).map(|joint| format!(",q{joint}_rad,goal{joint}_rad"));
    let mut text = format!("time_s{}\n", names.collect::<String>());
    for k in 0..60 {
        let t = 0.02 * f64::from(k);
        let cell = |joint: usize| {
            let (rate, phase) = (2.0 + 0.3 * joint as f64, joint as f64);
            let (goal, angle) = ((rate * t + phase).sin(), (rate * (t - 0.04) + phase).sin());
            format!(",{},{}", 0.4 * angle, 0.4 * goal)
        };
        text += &format!("{t}{}\n", (0..joints).map(cell).collect::<String>());
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.csv");
    std::fs::write(&path, text).unwrap();
    let request = LogRequest::whole(path);
    let log = RawLog::read_request(&request).unwrap();
    let mut draft = Draft::of(&log, "a.csv", None).unwrap();
    let (stop, heard) = (
        StopSwitch::default(),
        std::sync::atomic::AtomicUsize::new(0),
    );
    let hears = |_| {
        heard.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    estimate(&mut draft, &request, &stop, &hears).unwrap();
    let said = draft.guesses.last().unwrap();
    assert_eq!(
        (said.what.as_str(), said.guess.as_str()),
        ("values", "guesses alone")
    );
    assert!(
        said.why
            .starts_with("9 joints are too many to estimate at once"),
        "{}",
        said.why
    );
    assert_eq!(heard.into_inner(), 0);
}
