//! `handstand replay MOTION.csv|MOTION.mcap`: the servos do again what a recording says.
//!
//! The recording's goals are followed, or its positions where it has no goals (a motion shown by
//! hand). Torque goes on, the servos go to the first pose at 0.5 rad/s, then the motion runs at its
//! own speed, and torque goes off; also after Ctrl-C and any error. It is stopped, with exit code
//! 5, if a servo reports overload, overheating or a wrong supply, or if the CM-5 lets the robot
//! down. It asks before it moves anything, unless `--yes`.
//!
//! ```console
//! $ handstand replay swing.mcap --record again.mcap --port /dev/ttyUSB0
//! ```
//!
//! `--json` prints `samples`, `seconds`, `tracking_rms_rad` (to the goals sent), `repeat_rms_rad`
//! (to the positions recorded), `stopped` (why, or null).

use super::flash::agreed;
use super::interrupt::Interrupt;
use super::robot::Robot;
use super::{ExitStatus, Talk, show::or_dash};
use handstand::link::record::{
    FollowedMotion, GoalMotion, MotionStop, RobotRecorder, follow, read,
};
use handstand::{Result, output};
use serde_json::json;
use std::path::PathBuf;

/// Let the servos repeat a recording.
#[derive(Debug, clap::Args)]
pub struct ReplayArgs {
    /// Recording to follow
    motion: PathBuf,
    #[command(flatten)]
    robot: Robot,
    /// Record what happens
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Do not ask
    #[arg(long)]
    yes: bool,
    /// Replace the recording if it exists
    #[arg(long)]
    force: bool,
}

/// Follows the motion.
pub fn run(args: &ReplayArgs, talk: &Talk) -> Result<ExitStatus> {
    let recording = read(&args.motion)?;
    let motion = GoalMotion::of(&recording, &args.motion)?;
    let mut robot = args.robot.clone();
    robot.ids.0 = recording.ids.clone();
    if let Some(file) = &args.record {
        output::vacant(file, args.force)?;
    }
    talk.say(&format!(
        "{}: {} servos, {:.1} s. The robot will move.",
        args.motion.display(),
        recording.ids.len(),
        motion.time_s.last().unwrap_or(&0.0)
    ));
    agreed(args.yes, "Is there room around it?")?;
    let interrupt = Interrupt::listen();
    let mut source = robot.open()?;
    let create = |file: &PathBuf| RobotRecorder::create(file, &recording.ids, args.force);
    let mut recorder = args.record.as_ref().map(create).transpose()?;
    interrupt.at_once(source.emergency_off());
    let bar = talk.bar(motion.time_s.len() as u64);
    let followed = follow(
        &motion,
        &mut *source,
        recorder.as_mut(),
        &|| !interrupt.has_come(),
        &|place| bar.set_position(place as u64),
    )?;
    drop(bar);
    if let Some(recorder) = recorder {
        recorder.finish()?;
    }
    report(&followed, talk)
}

fn report(followed: &FollowedMotion, talk: &Talk) -> Result<ExitStatus> {
    let (tracking, repeat) = (followed.tracking.value(), followed.repeat.value());
    let stopped = followed.stopped.as_ref().map(|why| match why {
        MotionStop::Interrupted => "Ctrl-C",
        MotionStop::Danger(why) => why,
    });
    let data = json!({
        "samples": followed.tally.samples,
        "seconds": followed.tally.seconds(),
        "tracking_rms_rad": tracking,
        "repeat_rms_rad": repeat,
        "stopped": stopped,
    });
    let milli = |rad: Option<f64>| or_dash(rad, |rad| format!("{:.1} mrad", rad * 1e3));
    talk.result(&data, || {
        let (tracking, repeat) = (milli(tracking), milli(repeat));
        format!("to the goals: {tracking} rms\nto the recording: {repeat} rms")
    })?;
    match stopped {
        None => Ok(ExitStatus::Done),
        Some(why) => {
            talk.say(&format!("stopped, torque is off: {why}"));
            Ok(ExitStatus::Stopped)
        }
    }
}
