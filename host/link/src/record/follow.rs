//! A motion that servos follow, and how closely they do.

use super::{
    GoalMotion, RecordingTally, Rms, RobotRecorder, RobotSample, SampleSource, ServoSilence,
    ServoTravel,
};
use crate::error::{Error, Result};

/// Speed on the way to the first pose, rad/s.
const APPROACH_RAD_S: f64 = 0.5;

/// How a motion was followed.
#[derive(Debug, Default)]
pub struct FollowedMotion {
    /// The samples of the motion itself, without the ways to its first pose and back to it after
    /// torque was off.
    pub tally: RecordingTally,
    /// What each servo did not say in these samples, in the order of ids.
    pub silences: Vec<ServoSilence>,
    /// How far each was told to go and went while torque was on, in the order of ids.
    pub travels: Vec<ServoTravel>,
    /// Measured minus commanded angle, rad.
    pub tracking: Rms,
    /// Measured minus recorded angle, rad.
    pub repeat: Rms,
    /// Why it ended before the motion did; none if it did not.
    pub stopped: Option<MotionStop>,
}

/// Why a motion was not followed to its end.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MotionStop {
    /// The caller wanted no more.
    Interrupted,
    /// The robot had to be stopped; the source's own words.
    Danger(String),
}

/// Torque on, to the first pose at 0.5 rad/s, along the motion at its own speed, torque off: the
/// last whatever happened. Where the motion has torque off the servos are let go; when it comes
/// back they go to the pose of that moment as to the first. Every sample goes to `recorder`. Before
/// each, `goes_on` is asked; `progress` is told the place in the motion.
///
/// # Errors
/// A goal that a servo cannot get to, before torque; the device failed or fell silent, or the
/// recording cannot be written.
pub fn follow(
    motion: &GoalMotion,
    source: &mut dyn SampleSource,
    recorder: Option<&mut RobotRecorder>,
    goes_on: &dyn Fn() -> bool,
    progress: &dyn Fn(usize),
) -> Result<FollowedMotion> {
    source.may_reach(&motion.ranges())?;
    source.arm()?;
    let mut follower = MotionFollower {
        source,
        recorder,
        goes_on,
        followed: FollowedMotion {
            silences: vec![ServoSilence::default(); motion.goals_rad[0].len()],
            travels: vec![ServoTravel::default(); motion.goals_rad[0].len()],
            ..FollowedMotion::default()
        },
    };
    let outcome = match follower.approach(&motion.goals_rad[0]) {
        Ok(Some(begin_s)) => follower.run(motion, begin_s, progress),
        approached => approached.map(|_| ()),
    };
    let followed = follower.followed;
    let off = source.disarm();
    outcome?;
    off?;
    Ok(followed)
}

struct MotionFollower<'a> {
    source: &'a mut dyn SampleSource,
    recorder: Option<&'a mut RobotRecorder>,
    goes_on: &'a dyn Fn() -> bool,
    followed: FollowedMotion,
}

impl MotionFollower<'_> {
    /// To the first pose; when it got there, s, or none if it was stopped on its way.
    fn approach(&mut self, first: &[f64]) -> Result<Option<f64>> {
        let Some(here) = self.step(None)? else {
            return Ok(None);
        };
        let joints = here.joints.iter().zip(first);
        let from: Vec<f64> = joints
            .map(|(joint, goal)| joint.position_rad.unwrap_or(*goal))
            .collect();
        let far = from.iter().zip(first).map(|(from, to)| (to - from).abs());
        let approach_s = (far.fold(0.0, f64::max) / APPROACH_RAD_S).max(0.01);
        let begin_s = here.time_s;
        let mut now_s = begin_s;
        while now_s - begin_s < approach_s {
            let share = ((now_s - begin_s) / approach_s).clamp(0.0, 1.0);
            let between = from.iter().zip(first);
            let goals: Vec<f64> = between.map(|(a, b)| a + share * (b - a)).collect();
            let Some(sample) = self.step(Some(&goals))? else {
                return Ok(None);
            };
            now_s = sample.time_s;
        }
        Ok(Some(now_s))
    }

    /// Along the motion, which begins at `begin_s`.
    fn run(&mut self, motion: &GoalMotion, begin_s: f64, progress: &dyn Fn(usize)) -> Result<()> {
        let (mut begin_s, mut now_s, mut on) = (begin_s, begin_s, true);
        while let Some((at, goals)) = motion.at(now_s - begin_s) {
            if motion.torque_on[at] != on {
                on = !on;
                if !on {
                    self.source.disarm()?;
                } else {
                    self.source.arm()?;
                    let Some(there_s) = self.approach(&goals)? else {
                        break;
                    };
                    begin_s += there_s - now_s;
                }
            }
            let Some(sample) = self.step(on.then_some(&goals))? else {
                break;
            };
            now_s = sample.time_s;
            let followed = &mut self.followed;
            followed.tally.count(&sample);
            for (silence, joint) in followed.silences.iter_mut().zip(&sample.joints) {
                silence.count(joint.position_rad.is_some());
            }
            progress(at);
            if !on {
                continue;
            }
            let recorded = &motion.measured_rad[at];
            let joints = sample.joints.iter().zip(&mut followed.travels);
            for (((joint, travel), goal), recorded) in joints.zip(&goals).zip(recorded) {
                if let Some(now) = joint.position_rad {
                    travel.count(*goal, now);
                    followed.tracking.add(now - goal);
                    let repeat = &mut followed.repeat;
                    recorded.iter().for_each(|then| repeat.add(now - then));
                }
            }
        }
        Ok(())
    }

    /// A sample with these goals; none, and why, if it must stop.
    fn step(&mut self, goals: Option<&Vec<f64>>) -> Result<Option<RobotSample>> {
        for _ in 0..5 {
            if !(self.goes_on)() {
                self.followed.stopped = Some(MotionStop::Interrupted);
                return Ok(None);
            }
            if let Some(sample) = self.source.sample(goals.map(Vec::as_slice))? {
                if let Some(recorder) = &mut self.recorder {
                    recorder.write(&sample)?;
                }
                self.followed.stopped = self.source.danger().map(MotionStop::Danger);
                return Ok(Some(sample).filter(|_| self.followed.stopped.is_none()));
            }
        }
        Err(Error::device(
            "the CM-5 has sent nothing for half a second",
            "it switches torque off by itself; check line and battery",
        ))
    }
}
