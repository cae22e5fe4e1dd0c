//! Where the first link's attitude comes from while the robot is balanced.

use crate::error::{Error, Place, Result};
use handstand_shared::message::Attitude;
use handstand_shared::plan::Plan;
use std::io::BufRead;
use std::path::Path;
use std::sync::{Arc, Mutex};

/// Where the first link's attitude comes from.
pub enum AttitudeSource {
    /// The gyro at the CM-5's ADC: nothing is sent.
    Gyro,
    /// Lines of an IMU or a camera.
    Lines(AttitudeLines),
    /// A simulated robot, which is asked; it answers where there is something newer.
    Simulated(Box<dyn FnMut() -> Option<Attitude> + Send>),
}

impl AttitudeSource {
    /// The newest attitude since the last call; none if there is no newer one. An old one is never
    /// given twice, so that the CM-5 knows how old it is.
    ///
    /// # Errors
    /// A line that is no attitude.
    pub fn newest(&mut self) -> Result<Option<Attitude>> {
        match self {
            AttitudeSource::Gyro => Ok(None),
            AttitudeSource::Lines(lines) => lines.newest(),
            AttitudeSource::Simulated(ask) => Ok(ask()),
        }
    }

    /// What is taken where nothing else is chosen: the gyro where the plan wants it or there is no
    /// simulated robot, else that robot.
    pub fn of_plan(plan: Option<&Plan>, robot: Option<AttitudeSource>) -> AttitudeSource {
        let wants_gyro = plan.is_some_and(|plan| !plan.gyro.from_host);
        robot
            .filter(|_| !wants_gyro)
            .unwrap_or(AttitudeSource::Gyro)
    }

    /// Whether it is the gyro at the CM-5's ADC.
    pub fn is_gyro(&self) -> bool {
        matches!(self, AttitudeSource::Gyro)
    }

    /// Whether it has ended: no attitude will ever come.
    pub fn has_ended(&self) -> bool {
        matches!(self, AttitudeSource::Lines(lines) if lines.has_ended())
    }
}

/// Whether a plan takes the attitude from where it comes from.
///
/// # Errors
/// It wants the gyro and gets another source, or the other way round.
pub fn check_attitude(plan: &Plan, is_gyro: bool) -> Result<()> {
    match (plan.gyro.from_host, is_gyro) {
        (true, true) => Err(Error::usage(
            "the plan wants the first link's attitude from the PC, and none is given",
            "--attitude lines takes it from standard input; or deploy with --gyro-per-code",
        )),
        (false, false) => Err(Error::usage(
            "the plan takes the first link's rate from the CM-5's gyro",
            "leave --attitude out, or deploy without --gyro-per-code",
        )),
        _ => Ok(()),
    }
}

/// What the reading thread has found.
#[derive(Debug, Default)]
struct ReaderState {
    newest: Option<Attitude>,
    error: Option<Error>,
    has_ended: bool,
}

/// Attitudes as lines of text: angle from upright, rad, and rate, rad/s, between them blanks or a
/// comma. Empty lines and those that begin with `#` are passed over.
#[derive(Debug)]
pub struct AttitudeLines {
    found: Arc<Mutex<ReaderState>>,
}

impl AttitudeLines {
    /// Reads `input` in a thread of its own until it ends; `name` names it in errors.
    pub fn read(input: impl BufRead + Send + 'static, name: &str) -> Self {
        let found = Arc::new(Mutex::new(ReaderState::default()));
        let (own, name) = (found.clone(), name.to_string());
        std::thread::spawn(move || {
            let end = read_all(input, &name, |attitude| {
                if let Ok(mut found) = own.lock() {
                    found.newest = Some(attitude);
                }
            });
            if let Ok(mut found) = own.lock() {
                found.error = end.err();
                found.has_ended = true;
            }
        });
        AttitudeLines { found }
    }

    fn newest(&mut self) -> Result<Option<Attitude>> {
        // A reader that panicked has left what it found.
        let mut found = self.found.lock().unwrap_or_else(|lock| lock.into_inner());
        match found.error.take() {
            Some(error) => Err(error),
            None => Ok(found.newest.take()),
        }
    }

    fn has_ended(&self) -> bool {
        let found = self.found.lock().unwrap_or_else(|lock| lock.into_inner());
        found.has_ended && found.newest.is_none() && found.error.is_none()
    }
}

fn read_all(input: impl BufRead, name: &str, mut give: impl FnMut(Attitude)) -> Result<()> {
    for (number, line) in (1..).zip(input.lines()) {
        let line = line.map_err(|error| Error::file(Path::new(name), "read", error))?;
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        give(attitude(line).ok_or_else(|| {
            Error::data(
                Place::at(Path::new(name), number, 1),
                format!("`{line}` is no attitude"),
                "give the first link's angle from upright, rad (at most 3.2), and its rate, rad/s \
                 (at most 32): `0.012 -0.3`",
            )
        })?);
    }
    Ok(())
}

/// An attitude from a line's two numbers.
fn attitude(line: &str) -> Option<Attitude> {
    let mut numbers = line
        .split([' ', '\t', ',', ';'])
        .filter(|part| !part.is_empty());
    let mut steps = |lsb: f64| {
        let value: f64 = numbers.next()?.parse().ok()?;
        let steps = (value / lsb).round();
        (steps.abs() <= f64::from(i16::MAX)).then_some(steps as i16)
    };
    let angle = steps(Attitude::ANGLE_LSB_RAD)?;
    let rate = steps(Attitude::RATE_LSB_RAD_S)?;
    numbers.next().is_none().then_some(Attitude { angle, rate })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> (Vec<[i16; 2]>, Option<String>) {
        let mut given = Vec::new();
        let end = read_all(text.as_bytes(), "stdin", |it| {
            given.push([it.angle, it.rate]);
        });
        (given, end.err().map(|error| error.to_string()))
    }

    #[test]
    fn lines_are_read_and_wrong_ones_are_named() {
        let (given, error) = all("# rad rad/s\n0.01 -0.5\n\n-0.02,0.25\n 3e-4\t1\n");
        assert_eq!(given, [[100, -500], [-200, 250], [3, 1000]]);
        assert_eq!(error, None);
        for wrong in ["0.1", "a b", "0.1 0.2 0.3", "4 0", "0 33", "nan 0"] {
            let (given, error) = all(&format!("0 0\n{wrong}\n"));
            assert_eq!(given.len(), 1, "{wrong}");
            assert!(error.unwrap().contains("stdin:2:1"), "{wrong}");
        }
    }

    /// What is not new is not given again: it would be taken for fresh.
    #[test]
    fn an_attitude_is_given_once() {
        let mut source = AttitudeSource::Lines(AttitudeLines::read(&b"0.1 0\n0.2 0\n"[..], "x"));
        let mut given = Vec::new();
        while !source.has_ended() {
            given.extend(source.newest().unwrap());
            std::thread::yield_now();
        }
        assert_eq!(given.last().unwrap().angle, 2000);
        assert!(given.len() <= 2);
        assert_eq!(source.newest().unwrap(), None);
    }
}
