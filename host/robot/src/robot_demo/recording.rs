//! Recordings of the virtual robot: excitation that the firmware plays, the robot hanging.

use super::hidden::HiddenRobot;
use crate::error::{Error, Result};
use crate::experiment::excite::{ExcitationKind, ExcitePlan, JointLimits, excite};
use crate::link::record::{GoalMotion, Recording, RobotRecorder, Stream, follow, read};
use crate::link::virtual_cm5::{Cm5Port, SimLink, set_up_model, spec_with_robot};
use crate::log::{LogRequest, LogSet};
use crate::output::write_new;
use handstand_shared::control_table::{CCW_MARGIN, CW_MARGIN, PUNCH};
use std::path::Path;

/// A motion of the hanging robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RecordedMotion {
    /// Name of its files.
    pub name: &'static str,
    /// What it holds.
    pub kind: ExcitationKind,
    /// Largest angle of shoulder and hip, rad: a drop is let go there.
    pub high_rad: [f64; 2],
    /// Known mass that is bolted onto the feet for it, kg.
    pub payload_kg: f64,
    /// Whether it is held out.
    pub is_held_out: bool,
}

/// The motions. Lag and dead zone show under way, friction of the bar and masses in a free swing;
/// so those that are held out are of both kinds, and the drops of poses that differ. A drop of each
/// kind carries a known mass: what grows with the load on the bar is told from what does not.
pub const MOTIONS: [RecordedMotion; 5] = [
    motion("a", ExcitationKind::Multisine, [0.6, 0.6], 0.0, false),
    motion("b", ExcitationKind::Drop, [0.6, 0.6], 0.0, false),
    motion("c", ExcitationKind::Drop, [0.6, 0.2], PAYLOAD_KG, false),
    motion("d", ExcitationKind::Multisine, [0.6, 0.6], 0.0, true),
    motion("e", ExcitationKind::Drop, [0.6, 0.4], PAYLOAD_KG, true),
];
/// Known mass that some motions carry, kg; nominal.toml says where.
pub const PAYLOAD_KG: f64 = 0.2;
/// Duration of each, s.
const EACH_S: f64 = 6.5;
/// Rows at the begin of a motion, and behind the moment at which torque goes off, that are left
/// out. When it went off is known within a tick only, and until then the servos hold the raised
/// pose with all they have.
const SETTLING_ROWS: usize = 12;

const fn motion(
    name: &'static str,
    kind: ExcitationKind,
    high_rad: [f64; 2],
    payload_kg: f64,
    is_held_out: bool,
) -> RecordedMotion {
    RecordedMotion {
        name,
        kind,
        high_rad,
        payload_kg,
        is_held_out,
    }
}

/// Records all motions into a folder, and what each is for.
///
/// # Errors
/// The firmware does not answer, or a file cannot be written.
pub fn record(robot: &HiddenRobot, dir: &Path) -> Result<LogSet> {
    let mut logs = LogSet {
        training: Vec::new(),
        held_out: Vec::new(),
    };
    for (number, motion) in (1..).zip(MOTIONS) {
        let goals = dir.join(format!("goals_{}.csv", motion.name));
        let log = dir.join(format!("{}.csv", motion.name));
        let excitation = excite(&plan(&motion, 10 * robot.answer.seed + number))?;
        write_new(&goals, &excitation.to_csv(), false)?;
        play(robot, &motion, &goals, &log)?;
        let rows = Some(rows(&read(&log)?));
        note_payload(&log, motion.payload_kg)?;
        let request = LogRequest { rows, path: log };
        if motion.is_held_out {
            logs.held_out.push(request)
        } else {
            logs.training.push(request)
        }
    }
    Ok(logs)
}

/// First and last row that is learned from or judged by: of a drop the free swing, of all others
/// the whole motion.
fn rows(recording: &Recording) -> (usize, usize) {
    let samples = &recording.samples;
    let off = samples.iter().position(|it| it.torque_on == Some(false));
    let first = off.unwrap_or(0) + SETTLING_ROWS;
    (
        first,
        samples.len().saturating_sub(SETTLING_ROWS).max(first),
    )
}

fn plan(motion: &RecordedMotion, seed: u64) -> ExcitePlan {
    let joint = |(servos, high_rad): ([u8; 2], f64)| JointLimits {
        servos: servos.to_vec(),
        low_rad: -0.6,
        high_rad,
        speed_rad_s: 2.5,
    };
    let [shoulder_rad, hip_rad] = motion.high_rad;
    ExcitePlan {
        joints: [([1, 2], shoulder_rad), ([11, 12], hip_rad)]
            .map(joint)
            .to_vec(),
        kinds: vec![motion.kind],
        each_s: EACH_S,
        hz: 100.0,
        band_hz: (0.8, 3.0),
        seed,
    }
}

/// Writes above a recording what the robot carried.
fn note_payload(log: &Path, payload_kg: f64) -> Result<()> {
    let recorded = std::fs::read_to_string(log).map_err(|error| Error::file(log, "read", error))?;
    write_new(
        log,
        &format!("# payload_kg = {payload_kg}\n{recorded}"),
        true,
    )
}

/// Plays goals through the firmware and writes down what its stream reports.
fn play(robot: &HiddenRobot, motion: &RecordedMotion, goals: &Path, log: &Path) -> Result<()> {
    let spec = spec_with_robot("ids=1-2+11-12,delay=0", Some(Path::new("true.toml")))?;
    let recording = read(goals)?;
    let goals = GoalMotion::of(&recording, goals)?;
    let mut bus = set_up_model(&spec, robot.carrying(motion.payload_kg)?)?;
    for servo in &mut bus.servos {
        // They regulate without a dead zone of their own: what is hidden is all that is missing.
        for register in [CW_MARGIN, CCW_MARGIN, PUNCH] {
            servo.set(register, 0);
        }
    }
    let port = Cm5Port::new(bus);
    let mut source = Stream::new(SimLink(port), &recording.ids)?;
    let mut recorder = RobotRecorder::create(log, &recording.ids, false)?;
    follow(&goals, &mut source, Some(&mut recorder), &|| true, &|_| {})?;
    recorder.finish()
}
