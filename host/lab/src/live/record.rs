//! Recording what the servos do, live: as `handstand record`.

use super::pose::LinkPose;
use super::samples::{LiveChart, LiveSamples, Sender};
use super::slot::{LivePhase, LiveRobot};
use crate::error::Result;
use crate::link::SerialLink;
use crate::link::record::{RobotRecorder, RobotSample, is_cm5, open_source, record_samples};
use crate::model::Model;
use std::path::Path;
use std::time::Duration;

/// Period of samples through an adapter, and of a CM-5's.
const PERIOD: Duration = Duration::from_millis(10);

/// Records into `file` until its time is over or the run is stopped; what is said of it.
///
/// # Errors
/// The device failed, or the system refuses to write.
pub fn run(
    robot: &LiveRobot,
    mut link: Box<dyn SerialLink>,
    model: Option<&Model>,
    seconds: Option<f64>,
    file: &Path,
) -> Result<String> {
    let ids = &robot.access.ids;
    let streams = is_cm5(&mut link)?;
    let mut source = open_source(link, ids, streams, PERIOD)?;
    let mut recorder = RobotRecorder::create(file, ids, false)?;
    let charts = ids.iter().map(|id| LiveChart {
        title: format!("servo {id}"),
        unit: "rad",
    });
    robot.tell(LivePhase::Running {
        what: "recording".into(),
        charts: charts.collect(),
    });
    let (mut sender, pose) = (
        Sender::new(robot.samples().clone()),
        LinkPose::new(model, ids),
    );
    let recorded = record_samples(&mut *source, &mut recorder, seconds, |sample, _| {
        if let Some(sample) = sample {
            let angles = sample.joints.iter().map(|servo| servo.position_rad);
            sender.add(sample.time_s, angles, |last| {
                last.link_rad = pose.of_sample(sample);
                health(last, sample);
            });
        }
        robot.goes_on().unwrap_or(false)
    });
    recorder.finish()?;
    let tally = recorded?;
    Ok(format!(
        "{} samples in {:.2} s, {} answers missing",
        tally.samples,
        tally.seconds(),
        tally.missing
    ))
}

/// Supply and heat as this sample tells them.
fn health(last: &mut LiveSamples, sample: &RobotSample) {
    let servos = || sample.joints.iter();
    last.supply_v = servos().filter_map(|servo| servo.supply_v).reduce(f64::min);
    last.hottest_celsius = servos()
        .filter_map(|servo| servo.temperature_celsius)
        .reduce(f64::max);
}
