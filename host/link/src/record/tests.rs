//! Recordings from simulated servos, whole and torn.

use super::*;
use crate::Servos;
use crate::virtual_cm5::SimLink;
use std::path::Path;
use std::time::Duration;

fn recorded(path: &Path, samples: usize) -> Vec<RobotSample> {
    let mut source = Adapter::new(
        Servos::new(SimLink::adapter("ids=1-3,delay=0,dead=2").unwrap()),
        &[1, 2, 3],
        Duration::from_millis(10),
    )
    .unwrap();
    let mut recorder = RobotRecorder::create(path, &[1, 2, 3], false).unwrap();
    source.arm().unwrap_err();
    let samples: Vec<RobotSample> = (0..samples)
        .map(|_| source.sample(None).unwrap().unwrap())
        .collect();
    samples
        .iter()
        .for_each(|sample| recorder.write(sample).unwrap());
    recorder.finish().unwrap();
    samples
}

fn same(a: &RobotSample, b: &RobotSample) -> bool {
    let near = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-6,
        (a, b) => a.is_none() && b.is_none(),
    };
    let gyro = |sample: &RobotSample| sample.gyro.map_or([None; 3], |gyro| gyro.values());
    (a.time_s - b.time_s).abs() < 1e-6
        && a.torque_on == b.torque_on
        && (gyro(a).into_iter().zip(gyro(b))).all(|(a, b)| near(a, b))
        && (a.joints.iter().zip(&b.joints)).all(|(a, b)| {
            a.values()
                .into_iter()
                .zip(b.values())
                .all(|(a, b)| near(a, b))
        })
}

#[test]
fn what_is_written_is_read_back_in_both_formats() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.csv", "a.mcap"] {
        let path = folder.path().join(name);
        let mut samples = recorded(&path, 50);
        let begun = if name == "a.mcap" {
            samples[0].time_s
        } else {
            0.0
        };
        samples.iter_mut().for_each(|sample| sample.time_s -= begun);
        let back = read(&path).unwrap();
        assert_eq!(back.ids, [1, 2, 3]);
        assert!(
            !back.torn && back.samples.len() == 50,
            "{name}: {}",
            back.samples.len()
        );
        assert!(
            back.samples.iter().zip(&samples).all(|(a, b)| same(a, b)),
            "{name}"
        );
        assert_eq!(back.samples[0].joints[1].position_rad, None);
        assert!(
            RobotRecorder::create(&path, &[1], false).is_err(),
            "{name} exists"
        );
    }
}

/// Wherever the file is cut, whole samples from the beginning are read, and the cut is told.
#[test]
fn a_torn_tail_is_dropped() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.csv", "a.mcap"] {
        let path = folder.path().join(name);
        let whole_samples = recorded(&path, 50);
        let bytes = std::fs::read(&path).unwrap();
        let header = bytes.len() - bytes.len() * 3 / 4;
        for cut in (header..bytes.len()).step_by(97) {
            std::fs::write(&path, &bytes[..cut]).unwrap();
            let back = read(&path).unwrap();
            let at_row_end = name == "a.csv" && bytes[cut - 1] == b'\n';
            assert!(back.torn || at_row_end, "{name}: cut at {cut}");
            assert!(back.samples.len() <= whole_samples.len());
            if name == "a.csv" {
                assert!(
                    back.samples
                        .iter()
                        .zip(&whole_samples)
                        .all(|(a, b)| same(a, b)),
                    "{name}: cut at {cut}"
                );
            }
        }
        std::fs::remove_file(&path).unwrap();
    }
}

#[test]
fn what_is_no_recording_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (name, content, said) in [
        ("a.csv", "time_s,angle\n0,1\n", "a.csv:1:1"),
        ("b.csv", "", "b.csv:1:1"),
        ("a.mcap", "no mcap", "not an MCAP file"),
        ("a.txt", "", "unknown format"),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, content).unwrap();
        let error = read(&path).unwrap_err();
        assert!(error.to_string().contains(said), "{name}: {error}");
    }
}

/// From a CM-5, without a plan and with one that has zero and scale.
#[test]
fn the_gyro_is_recorded_in_both_formats() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.csv", "a.mcap"] {
        for scale in [None, Some(0.02)] {
            let path = folder.path().join(format!("{}{name}", scale.is_some()));
            let samples: Vec<RobotSample> = (0..40)
                .map(|at| RobotSample {
                    time_s: f64::from(at) * 0.01,
                    joints: vec![ServoSample::default()],
                    gyro: Some(GyroSample {
                        code: f64::from(500 + at),
                        zero: scale.map(|_| 512.0),
                        rate_rad_s: scale.map(|scale| scale * f64::from(at - 12)),
                    }),
                    torque_on: scale.map(|_| at > 20),
                    has_current: false,
                })
                .collect();
            let mut recorder = RobotRecorder::create(&path, &[1], false).unwrap();
            samples
                .iter()
                .for_each(|sample| recorder.write(sample).unwrap());
            recorder.finish().unwrap();
            let back = read(&path).unwrap();
            assert_eq!(back.samples.len(), 40);
            assert!(
                samples.iter().zip(&back.samples).all(|(a, b)| same(a, b)),
                "{name}"
            );
        }
    }
    let csv = std::fs::read_to_string(folder.path().join("truea.csv")).unwrap();
    assert!(
        csv.lines()
            .next()
            .unwrap()
            .ends_with(",error1,gyro_code,gyro_zero,gyro_rad_s,torque_on")
    );
    assert!(csv.lines().nth(1).unwrap().ends_with(",500,512,-0.24,0"));
}

#[test]
fn a_cm5_s_samples_hold_its_gyro() {
    use crate::virtual_cm5::{Cm5Port, set_up, spec};
    let bus = set_up(&spec("ids=1-2,delay=0").unwrap()).unwrap();
    let mut source = Stream::new(SimLink(Cm5Port::new(bus)), &[1, 2]).unwrap();
    let sample = source.sample(None).unwrap().unwrap();
    let expected = GyroSample {
        code: 512.0,
        zero: None,
        rate_rad_s: None,
    };
    assert_eq!(sample.gyro, Some(expected));
}
