//! Write the true state of a simulated robot to a file, and show it in one line.

use crate::error::{Error, Result};
use handstand_cm5_sim::{Bus, RobotState};
use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};

/// Receives the robot's states and writes them to a file.
pub struct StateLog {
    states: Option<Receiver<RobotState>>,
    log: Option<(PathBuf, BufWriter<File>)>,
    has_header: bool,
}

impl StateLog {
    /// Watch the robot on this bus; write to `log`, a new file, if one is named.
    ///
    /// # Errors
    /// A file is wanted and there is no robot, or it exists, or the system refuses it.
    pub fn of(bus: &mut Bus, log: Option<&Path>) -> Result<StateLog> {
        let states = bus.robot().map(|robot| {
            let (tell, states) = channel();
            robot.watch(tell);
            states
        });
        if states.is_none() && log.is_some() {
            return Err(Error::usage(
                "--log writes what a robot does, and there is none",
                "hang one on the servos: --robot MODEL.toml",
            ));
        }
        let create = |path: &Path| -> Result<_> {
            let file = File::create_new(path).map_err(|error| refused(path, error))?;
            Ok((path.to_path_buf(), BufWriter::new(file)))
        };
        Ok(StateLog {
            states,
            log: log.map(create).transpose()?,
            has_header: false,
        })
    }

    /// Write the states since the last call; returns the newest one in words, if there is one.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn newest(&mut self) -> Result<Option<String>> {
        let Some(states) = &self.states else {
            return Ok(None);
        };
        let mut newest = None;
        for state in states.try_iter() {
            if let Some((path, file)) = &mut self.log {
                let mut lines = String::new();
                if !self.has_header {
                    self.has_header = true;
                    header(&state, &mut lines);
                }
                row(&state, &mut lines);
                file.write_all(lines.as_bytes())
                    .map_err(|error| refused(path, error))?;
            }
            newest = Some(state);
        }
        Ok(newest.map(|state| words(&state)))
    }
}

fn refused(path: &Path, error: std::io::Error) -> Error {
    match error.kind() {
        std::io::ErrorKind::AlreadyExists => {
            Error::usage(format!("{} exists", path.display()), "choose another name")
        }
        _ => Error::file(path, "write", error),
    }
}

// Writing to a string does not fail.
fn header(state: &RobotState, out: &mut String) {
    out.push_str("time_s");
    for (joint, drive) in (1..).zip(&state.drive) {
        let _ = write!(out, ",q{joint}_rad,dq{joint}_rad_s");
        if drive.is_some() {
            let _ = write!(out, ",goal{joint}_rad,duty{joint},torque_on{joint}");
        }
    }
    out.push_str(",supply_v\n");
}

fn row(state: &RobotState, out: &mut String) {
    let _ = write!(out, "{:.3}", state.time_s);
    for (joint, drive) in state.drive.iter().enumerate() {
        let (angle, speed) = (state.angle_rad[joint], state.speed_rad_s[joint]);
        let _ = write!(out, ",{angle:.6},{speed:.6}");
        if let Some(drive) = drive {
            let on = u8::from(drive.torque_on);
            let _ = write!(out, ",{:.6},{:.5},{on}", drive.goal_rad, drive.duty);
        }
    }
    let _ = writeln!(out, ",{:.2}", state.supply_v);
}

fn words(state: &RobotState) -> String {
    let angles = state
        .angle_rad
        .iter()
        .map(|angle| format!("{:.1}", angle.to_degrees()));
    let is_on = state.drive.iter().flatten().any(|drive| drive.torque_on);
    format!(
        "{:.1} s: joints at {} deg, torque {}",
        state.time_s,
        angles.collect::<Vec<_>>().join(", "),
        if is_on { "on" } else { "off" }
    )
}
