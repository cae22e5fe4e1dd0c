//! Recordings of the virtual robot: excitation that the firmware plays, the robot hanging.

use super::hidden::HiddenRobot;
use crate::error::Result;
use crate::experiment::excite::{ExcitationKind, ExcitePlan, JointLimits, excite};
use crate::link::record::{GoalMotion, RobotRecorder, Stream, follow, read};
use crate::link::virtual_cm5::{Cm5Port, SimLink, set_up_model, spec_with_robot};
use crate::log::{LogRequest, LogSet};
use crate::output::write_new;
use std::path::Path;

/// The motions: name, what it holds, and whether it is held out.
pub const MOTIONS: [(&str, ExcitationKind, bool); 3] = [
    ("a", ExcitationKind::Multisine, false),
    ("b", ExcitationKind::Drop, false),
    ("c", ExcitationKind::Multisine, true),
];
/// Duration of each, s.
const EACH_S: f64 = 5.0;

/// Records all motions into a folder, and what each is for.
///
/// # Errors
/// The firmware does not answer, or a file cannot be written.
pub fn record(robot: &HiddenRobot, dir: &Path) -> Result<LogSet> {
    let mut logs = LogSet {
        training: Vec::new(),
        held_out: Vec::new(),
    };
    for (number, (name, kind, is_held_out)) in (1..).zip(MOTIONS) {
        let goals = dir.join(format!("goals_{name}.csv"));
        let log = dir.join(format!("{name}.csv"));
        let excitation = excite(&plan(kind, 10 * robot.answer.seed + number))?;
        write_new(&goals, &excitation.to_csv(), false)?;
        play(robot, &goals, &log)?;
        let request = LogRequest {
            path: log,
            rows: Some(rows(kind)),
        };
        match is_held_out {
            true => logs.held_out.push(request),
            false => logs.training.push(request),
        }
    }
    Ok(logs)
}

/// First and last row that is learned from or judged by: 3 s of a multisine, the lift and the drop.
fn rows(kind: ExcitationKind) -> (usize, usize) {
    match kind {
        ExcitationKind::Drop => (50, 400),
        _ => (50, 350),
    }
}

fn plan(kind: ExcitationKind, seed: u64) -> ExcitePlan {
    let joint = |servos: [u8; 2]| JointLimits {
        servos: servos.to_vec(),
        low_rad: -0.6,
        high_rad: 0.6,
        speed_rad_s: 2.5,
    };
    ExcitePlan {
        joints: [[1, 2], [11, 12]].map(joint).to_vec(),
        kinds: vec![kind],
        each_s: EACH_S,
        hz: 100.0,
        band_hz: (0.8, 3.0),
        seed,
    }
}

/// Plays goals through the firmware and writes down what its stream reports.
fn play(robot: &HiddenRobot, goals: &Path, log: &Path) -> Result<()> {
    let spec = spec_with_robot("ids=1-2+11-12,delay=0", Some(Path::new("true.toml")))?;
    let recording = read(goals)?;
    let motion = GoalMotion::of(&recording, goals)?;
    let port = Cm5Port::new(set_up_model(&spec, robot.model()?)?);
    let mut source = Stream::new(SimLink(port), &recording.ids)?;
    let mut recorder = RobotRecorder::create(log, &recording.ids, false)?;
    follow(&motion, &mut source, Some(&mut recorder), &|| true, &|_| {})?;
    recorder.finish()
}
