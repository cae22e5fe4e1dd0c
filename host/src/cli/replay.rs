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
use super::talk::Talk;
use super::{Outcome, input};
use handstand::link::record::{
    GoalMotion, RecordingTally, Rms, RobotRecorder, RobotSample, SampleSource, read,
};
use handstand::{Error, Result};
use serde_json::json;
use std::path::PathBuf;

/// Let the servos repeat a recording.
#[derive(Debug, clap::Args)]
pub struct Args {
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

/// Speed on the way to the first pose, rad/s.
const APPROACH_RAD_S: f64 = 0.5;

/// What it needs while it runs.
struct ReplayRun<'a> {
    source: Box<dyn SampleSource>,
    recorder: Option<RobotRecorder>,
    interrupt: Interrupt,
    tally: RecordingTally,
    tracking: Rms,
    repeat: Rms,
    talk: &'a Talk,
}

/// Follows the motion.
pub fn run(args: &Args, talk: &Talk) -> Result<Outcome> {
    let recording = read(&args.motion)?;
    let motion = GoalMotion::of(&recording, &args.motion)?;
    let mut robot = args.robot.clone();
    robot.ids.0 = recording.ids.clone();
    if let Some(file) = &args.record {
        input::vacant(file, args.force)?;
    }
    talk.say(&format!(
        "{}: {} servos, {:.1} s. The robot will move.",
        args.motion.display(),
        recording.ids.len(),
        motion.time_s.last().unwrap_or(&0.0)
    ));
    agreed(args.yes, "Is there room around it?")?;
    let interrupt = Interrupt::listen();
    let source = robot.open()?;
    let recorder = args
        .record
        .as_ref()
        .map(|file| RobotRecorder::create(file, &recording.ids, args.force))
        .transpose()?;
    let mut run = ReplayRun {
        source,
        recorder,
        interrupt,
        tally: RecordingTally::default(),
        tracking: Rms::default(),
        repeat: Rms::default(),
        talk,
    };
    run.interrupt.at_once(run.source.emergency_off());
    run.source.arm()?;
    // Whatever happens, torque goes off before anything is told.
    let outcome = run.follow(&motion);
    let off = run.source.disarm();
    let stopped = outcome?;
    off?;
    if let Some(recorder) = run.recorder.take() {
        recorder.finish()?;
    }
    run.report(stopped)
}

impl ReplayRun<'_> {
    /// Why it was stopped, if it was.
    fn follow(&mut self, motion: &GoalMotion) -> Result<Option<String>> {
        let first = &motion.goals_rad[0];
        let Some(here) = self.step(None)? else {
            return Ok(self.why());
        };
        let from: Vec<f64> = here
            .joints
            .iter()
            .zip(first)
            .map(|(joint, goal)| joint.position_rad.unwrap_or(*goal))
            .collect();
        let farthest = from
            .iter()
            .zip(first)
            .map(|(from, to)| (to - from).abs())
            .fold(0.0, f64::max);
        let (begin_s, approach_s) = (here.time_s, (farthest / APPROACH_RAD_S).max(0.01));
        let mut now_s = begin_s;
        while now_s - begin_s < approach_s {
            let share = ((now_s - begin_s) / approach_s).clamp(0.0, 1.0);
            let goals: Vec<f64> = from
                .iter()
                .zip(first)
                .map(|(from, to)| from + share * (to - from))
                .collect();
            match self.step(Some(&goals))? {
                Some(sample) => now_s = sample.time_s,
                None => return Ok(self.why()),
            }
        }
        let bar = self.talk.bar();
        bar.set_length(motion.time_s.len() as u64);
        let begin_s = now_s;
        while let Some((at, goals)) = motion.at(now_s - begin_s) {
            let Some(sample) = self.step(Some(&goals))? else {
                bar.finish_and_clear();
                return Ok(self.why());
            };
            now_s = sample.time_s;
            self.tally.count(&sample);
            self.judge(&sample, &goals, &motion.measured_rad[at]);
            bar.set_position(at as u64);
        }
        bar.finish_and_clear();
        Ok(None)
    }

    fn judge(&mut self, sample: &RobotSample, goals: &[f64], then: &[Option<f64>]) {
        for ((joint, goal), then) in sample.joints.iter().zip(goals).zip(then) {
            if let Some(now) = joint.position_rad {
                self.tracking.add(now - goal);
                then.iter().for_each(|then| self.repeat.add(now - then));
            }
        }
    }

    /// One sample; none if the robot must stop.
    fn step(&mut self, goals: Option<&[f64]>) -> Result<Option<RobotSample>> {
        for _ in 0..5 {
            if self.interrupt.has_come() {
                return Ok(None);
            }
            if let Some(sample) = self.source.sample(goals)? {
                if let Some(recorder) = &mut self.recorder {
                    recorder.write(&sample)?;
                }
                return Ok(if self.source.danger().is_some() {
                    None
                } else {
                    Some(sample)
                });
            }
        }
        Err(Error::device(
            "the CM-5 has sent nothing for half a second",
            "it switches torque off by itself; check line and battery",
        ))
    }

    fn why(&self) -> Option<String> {
        Some(self.source.danger().unwrap_or_else(|| "Ctrl-C".to_string()))
    }

    fn report(&self, stopped: Option<String>) -> Result<Outcome> {
        let (tracking, repeat) = (self.tracking.value(), self.repeat.value());
        if self.talk.json {
            self.talk.data(&json!({
                "samples": self.tally.samples,
                "seconds": self.tally.seconds(),
                "tracking_rms_rad": tracking,
                "repeat_rms_rad": repeat,
                "stopped": stopped,
            }))?;
        } else {
            let milli = |value: Option<f64>| {
                value.map_or("–".to_string(), |value| {
                    format!("{:.1} mrad", value * 1e3)
                })
            };
            self.talk.print(&format!(
                "to the goals: {} rms\nto the recording: {} rms",
                milli(tracking),
                milli(repeat)
            ))?;
        }
        match stopped {
            None => Ok(Outcome::Done),
            Some(why) => {
                self.talk.say(&format!("stopped, torque is off: {why}"));
                Ok(Outcome::Stopped)
            }
        }
    }
}
