//! `handstand replay MOTION.csv|MOTION.mcap`: the servos do again what a recording says, or what
//! any CSV with `time_s` and `goal1_rad` asks for.
//!
//! The goals are followed, or the positions of a recording without goals (a motion shown by hand).
//! Where a motion's `torque_on` is 0 the servos are let go. `-` is CSV from the standard input.
//! Torque goes on, the servos go to the first pose at 0.5 rad/s, then the motion runs at its own
//! speed, and torque goes off; also after Ctrl-C and any error. It is stopped, with exit code 5, if
//! a servo reports overload, overheating or a wrong supply, or if the CM-5 lets the robot down. It
//! asks before it moves anything, unless `--yes`.
//!
//! ```console
//! $ handstand replay swing.mcap --record again.mcap --port /dev/ttyUSB0
//! ```
//!
//! A CM-5 with Handstand's firmware reads the servos and sends the goals itself (`--stream`,
//! without being told): a line that breaks lets the robot down, and any of its buttons stops it.
//! `--adapter` passes the packets through it instead, and neither does.
//!
//! A servo that does not answer ends it before anything moves, with exit code 4; one that falls
//! silent on the way is warned of, with the share of the samples it missed.
//!
//! Servos of Protocol 2.0 stop by their own bus watchdog when the line breaks, unless
//! `--no-watchdog`.
//!
//! `--json` prints `way` (`stream` or `adapter`), `watchdog` (whether theirs is on), `samples`,
//! `seconds`, `tracking_rms_rad` (to the goals sent), `repeat_rms_rad` (to the positions recorded),
//! `silent` (servos that fell silent: `servo`, `missed_share`), `stopped` (why, or null).

use super::flash::agreed;
use super::interrupt::Interrupt;
use super::robot::RobotArgs;
use super::{ExitStatus, Talk, show::or_dash};
use handstand::link::record::{
    FollowedMotion, GoalMotion, MotionStop, RobotRecorder, SourceKind, follow, read,
};
use handstand::{Result, output};
use serde_json::json;
use std::path::PathBuf;

/// Let the servos repeat a recording.
#[derive(Debug, clap::Args)]
pub struct ReplayArgs {
    /// Recording or goals to follow; `-` for the standard input
    motion: PathBuf,
    #[command(flatten)]
    robot: RobotArgs,
    /// Use a CM-5 as an adapter, which it is not unless told: nothing lets the robot down then when
    /// the line breaks
    #[arg(long, conflicts_with = "stream")]
    adapter: bool,
    /// Leave the bus watchdog of servos of Protocol 2.0 off: nothing stops them then when the line
    /// breaks
    #[arg(long)]
    no_watchdog: bool,
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
    let (mut source, way) = robot.open_to_move(args.adapter, !args.no_watchdog)?;
    talk.say(match way {
        SourceKind::Stream => {
            "The CM-5 streams: any of its buttons stops the robot, and so does a dead line."
        }
        SourceKind::Group { watchdog: true } => {
            "Through an adapter: the servos' bus watchdog stops them when the line breaks."
        }
        SourceKind::Adapter | SourceKind::Group { watchdog: false } => {
            "Through an adapter: nothing stops the robot when the line breaks."
        }
    });
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
    report(&followed, &recording.ids, way, talk)
}

fn report(
    followed: &FollowedMotion,
    ids: &[u8],
    way: SourceKind,
    talk: &Talk,
) -> Result<ExitStatus> {
    let (tracking, repeat) = (followed.tracking.value(), followed.repeat.value());
    let stopped = followed.stopped.as_ref().map(|why| match why {
        MotionStop::Interrupted => "Ctrl-C",
        MotionStop::Danger(why) => why,
    });
    let silent = silent(followed, ids);
    let data = json!({
        "way": if way == SourceKind::Stream { "stream" } else { "adapter" },
        "watchdog": way == SourceKind::Group { watchdog: true },
        "samples": followed.tally.samples,
        "seconds": followed.tally.seconds(),
        "tracking_rms_rad": tracking,
        "repeat_rms_rad": repeat,
        "silent": silent
            .iter()
            .map(|(id, share)| json!({ "servo": id, "missed_share": share }))
            .collect::<Vec<_>>(),
        "stopped": stopped,
    });
    let milli = |rad: Option<f64>| or_dash(rad, |rad| format!("{:.1} mrad", rad * 1e3));
    talk.result(&data, || {
        let (tracking, repeat) = (milli(tracking), milli(repeat));
        format!("to the goals: {tracking} rms\nto the recording: {repeat} rms")
    })?;
    for (id, share) in silent {
        talk.say(&format!(
            "warning: servo {id} did not answer in {:.1} % of the samples, which the errors leave \
             out; `handstand bus doctor` finds the cause",
            100.0 * share
        ));
    }
    match stopped {
        None => Ok(ExitStatus::Done),
        Some(why) => {
            talk.say(&format!("stopped, torque is off: {why}"));
            Ok(ExitStatus::Stopped)
        }
    }
}

/// Servos that fell silent, each with the share of the samples that it missed.
fn silent(followed: &FollowedMotion, ids: &[u8]) -> Vec<(u8, f64)> {
    let servos = ids.iter().zip(&followed.silences);
    servos
        .filter_map(|(id, silence)| Some((*id, silence.share()?)))
        .collect()
}
