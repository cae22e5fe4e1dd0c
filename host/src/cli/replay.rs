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
//! A servo that does not answer, takes no positions (wheel mode) or has limits that leave a goal
//! out ends it before anything moves, with exit code 4. Exit code 1: a servo did not follow. One
//! that falls silent on the way is warned of, with the share of the samples it missed.
//!
//! Servos of Protocol 2.0 stop by their own bus watchdog when the line breaks, unless
//! `--no-watchdog`.
//!
//! `--json` prints `way` (`stream` or `adapter`), `watchdog` (whether theirs is on), `samples`,
//! `seconds`, `tracking_rms_rad` (to the goals sent), `repeat_rms_rad` (to the positions recorded),
//! `silent` (servos that fell silent: `servo`, `missed_share`), `not_followed` (servos that stood
//! where their goals did not: `servo`, `went_rad`, `goals_rad`), `stopped` (why, or null).

use super::flash::agreed;
use super::interrupt::Interrupt;
use super::port::Ids;
use super::robot::RobotArgs;
use super::{Console, ExitStatus, show::or_dash};
use handstand::link::id_ranges;
use handstand::link::record::{
    FollowedMotion, GoalMotion, MotionStop, Recording, RobotRecorder, SourceKind, follow, read,
};
use handstand::{Error, Result, output};
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
pub fn run(args: &ReplayArgs, console: &Console) -> Result<ExitStatus> {
    let recording = chosen(read(&args.motion)?, args)?;
    let motion = GoalMotion::of(&recording, &args.motion)?;
    if let Some(file) = &args.record {
        output::vacant(file, args.force)?;
    }
    console.say(&format!(
        "{}: {} servos, {:.1} s. The robot will move.",
        args.motion.display(),
        recording.ids.len(),
        motion.time_s.last().unwrap_or(&0.0)
    ));
    agreed(args.yes, "Is there room around it?")?;
    let interrupt = Interrupt::listen();
    let watchdog = !args.no_watchdog;
    let (mut source, way) = (args.robot).open_to_move(&recording.ids, args.adapter, watchdog)?;
    console.say(match way {
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
    let bar = console.bar(motion.time_s.len() as u64);
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
    for remark in source.remarks() {
        console.say(&format!("warning: {remark}"));
    }
    report(&followed, &recording.ids, way, console)
}

/// The recording of the servos that were named, or of all.
fn chosen(recording: Recording, args: &ReplayArgs) -> Result<Recording> {
    let Some(Ids(ids)) = &args.robot.ids else {
        return Ok(recording);
    };
    recording.of_servos(ids).ok_or_else(|| {
        let (file, own) = (args.motion.display(), id_ranges(&recording.ids));
        Error::usage(
            format!("--ids names a servo that {file} has no motion of: it has {own}"),
            "leave it out of --ids, or leave --ids out to move all",
        )
    })
}

fn report(
    followed: &FollowedMotion,
    ids: &[u8],
    way: SourceKind,
    console: &Console,
) -> Result<ExitStatus> {
    let (tracking, repeat) = (followed.tracking.value(), followed.repeat.value());
    let stopped = followed.stopped.as_ref().map(|why| match why {
        MotionStop::Interrupted => "Ctrl-C",
        MotionStop::Danger(why) => why,
    });
    let silent = silent(followed, ids);
    let still = not_followed(followed, ids);
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
        "not_followed": still
            .iter()
            .map(|(id, went, wanted)| json!({ "servo": id, "went_rad": went, "goals_rad": wanted }))
            .collect::<Vec<_>>(),
        "stopped": stopped,
    });
    let milli = |rad: Option<f64>| or_dash(rad, |rad| format!("{:.1} mrad", rad * 1e3));
    console.result(&data, || {
        let (tracking, repeat) = (milli(tracking), milli(repeat));
        format!("to the goals: {tracking} rms\nto the recording: {repeat} rms")
    })?;
    for (id, share) in silent {
        console.say(&format!(
            "warning: servo {id} did not answer in {:.1} % of the samples, which the errors leave \
             out; `handstand bus doctor` finds the cause",
            100.0 * share
        ));
    }
    for (id, went, wanted) in &still {
        console.say(&format!(
            "servo {id} did not follow: it went over {went:.3} rad where its goals go over \
             {wanted:.3} rad; is it blocked, or its torque limit too low? `handstand bus read {id}`"
        ));
    }
    match stopped {
        None => Ok(ExitStatus::answer(still.is_empty())),
        Some(why) => {
            console.say(&format!("stopped, torque is off: {why}"));
            Ok(ExitStatus::Stopped)
        }
    }
}

/// Servos that did not follow their goals: how far each went and was told to go, rad.
fn not_followed(followed: &FollowedMotion, ids: &[u8]) -> Vec<(u8, f64, f64)> {
    let servos = ids.iter().zip(&followed.travels);
    let still = servos.filter_map(|(id, travel)| Some((*id, travel.not_followed()?)));
    still
        .map(|(id, (went, wanted))| (id, went, wanted))
        .collect()
}

/// Servos that fell silent, each with the share of the samples that it missed.
fn silent(followed: &FollowedMotion, ids: &[u8]) -> Vec<(u8, f64)> {
    let servos = ids.iter().zip(&followed.silences);
    servos
        .filter_map(|(id, silence)| Some((*id, silence.share()?)))
        .collect()
}
