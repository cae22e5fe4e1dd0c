//! Servos read by a CM-5 with Handstand's firmware.

use super::sample::{GyroSample, RobotSample, ServoSample};
use super::source::{EmergencyOff, SampleSource, send_twice};
use crate::error::{Error, Result};
use crate::link::{SerialLink, Session, condition_words};
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::{
    ArmLimits, Attitude, Command, Condition, Mode, Report, ServoList, Subject, Telemetry,
};
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::raw::{Position, Supply};
use std::time::Duration;

const TELEMETRY: Command = Command::Ask(Subject::Telemetry);

/// Servos behind a CM-5 that reads them itself and reports 100 times a second.
pub struct Stream<L: SerialLink> {
    session: Session<L>,
    count: usize,
    begun: Duration,
    goals: Option<Vec<Position>>,
    /// Where all stood in the newest report that has them all.
    stood: Option<Vec<Position>>,
    housekeeping: Vec<ServoSample>,
    /// Zero of the gyro, and rad/s per code, if a plan on the CM-5 has them.
    gyro: Option<(u16, f64)>,
    armed: bool,
    condition: Condition,
    /// The CM-5's account of itself when it began to let the robot down.
    account: Option<Telemetry>,
}

impl<L: SerialLink> Stream<L> {
    /// Greets the firmware, names the servos, starts the stream.
    ///
    /// # Errors
    /// No firmware, or it refuses.
    pub fn new(link: L, ids: &[u8]) -> Result<Self> {
        if ids.is_empty() || ids.len() > SERVOS {
            return Err(Error::usage(
                format!("{} servos", ids.len()),
                format!("a stream has room for 1 to {SERVOS}"),
            ));
        }
        let mut session = Session::open(link)?;
        let mut list = ServoList {
            count: ids.len() as u8,
            ids: [0; SERVOS],
        };
        list.ids[..ids.len()].copy_from_slice(ids);
        session.obey(&Command::Mode(Mode::Bridge), "stop")?;
        session.obey(&Command::ServoList(list), "take the list of servos")?;
        session.obey(&Command::Mode(Mode::Stream), "stream")?;
        let telemetry: Telemetry = session.fetch(&TELEMETRY, |report| match report {
            Report::Telemetry(telemetry) => Some(*telemetry),
            _ => None,
        })?;
        let scale = f64::from(telemetry.gyro_scale) / 16.0 * Attitude::RATE_LSB_RAD_S;
        let begun = session.link().now();
        Ok(Stream {
            gyro: (scale != 0.0).then_some((telemetry.gyro_zero, scale)),
            session,
            count: ids.len(),
            begun,
            goals: None,
            stood: None,
            housekeeping: vec![ServoSample::default(); ids.len()],
            armed: false,
            condition: Condition::Stream,
            account: None,
        })
    }

    /// Asks the CM-5 for its account when it lets the robot down, once.
    fn ask_why(&mut self) {
        if !self.armed || self.account.is_some() || !is_let_down(self.condition) {
            return;
        }
        let told = self.session.fetch(&TELEMETRY, |report| match report {
            Report::Telemetry(telemetry) => Some(*telemetry),
            _ => None,
        });
        // A line that has died cannot tell.
        self.account = told.ok();
    }

    /// The talk with the firmware.
    pub fn session(&mut self) -> &mut Session<L> {
        &mut self.session
    }
}

impl<L: SerialLink> SampleSource for Stream<L> {
    fn sample(&mut self, goals_rad: Option<&[f64]>) -> Result<Option<RobotSample>> {
        if let Some(goals) = goals_rad.filter(|_| self.armed) {
            let goals: Vec<Position> = goals.iter().map(|goal| Position::from_rad(*goal)).collect();
            self.session.send(&Command::Goals(Positions::pack(
                goals.iter().map(|goal| goal.0),
            )))?;
            self.goals = Some(goals);
        } else {
            self.session.send(&Command::KeepAlive)?;
        }
        let deadline = self.session.link().now() + Duration::from_millis(100);
        loop {
            let left = deadline.saturating_sub(self.session.link().now());
            let Some((time, report)) = self.session.next(left)? else {
                return Ok(None);
            };
            let Report::Stream(report) = report else {
                continue;
            };
            self.condition = report.condition;
            self.ask_why();
            for (place, housekeeping) in report.housekeeping(self.count) {
                if housekeeping.error == 0xff {
                    continue;
                }
                if let Some(joint) = self.housekeeping.get_mut(place) {
                    let (speed, load) = (housekeeping.speed, housekeeping.load);
                    *joint = ServoSample::measured(
                        u16::from_le_bytes(speed),
                        u16::from_le_bytes(load),
                        housekeeping.supply,
                        housekeeping.temperature,
                        housekeeping.error,
                    );
                }
            }
            let stood = (0..self.count).map(|place| report.position(place).map(Position));
            self.stood = stood.collect::<Option<_>>().or(self.stood.take());
            let goal = |place: usize| {
                self.goals
                    .as_ref()
                    .and_then(|goals| goals.get(place))
                    .map(|goal| goal.to_rad())
            };
            let joints = (0..self.count).map(|place| ServoSample {
                position_rad: report.position(place).map(|code| Position(code).to_rad()),
                goal_rad: goal(place),
                // Each servo's turn comes every few ticks; between them nothing was measured.
                ..std::mem::take(&mut self.housekeeping[place])
            });
            let joints = joints.collect();
            let rate = |(zero, scale)| (f64::from(report.gyro) - f64::from(zero)) * scale;
            return Ok(Some(RobotSample {
                time_s: (time.saturating_sub(self.begun)).as_secs_f64(),
                joints,
                gyro: Some(GyroSample {
                    code: f64::from(report.gyro),
                    zero: self.gyro.map(|(zero, _)| f64::from(zero)),
                    rate_rad_s: self.gyro.map(rate),
                }),
                torque_on: torque(report.condition),
            }));
        }
    }

    fn arm(&mut self) -> Result<()> {
        // The first round of supply readings must be over, or it refuses.
        for _ in 0..40 {
            self.sample(None)?;
        }
        self.session.greet()?;
        let token = self.session.hello.token;
        let limits = ArmLimits::FULL;
        self.session
            .obey(&Command::Arm { token, limits }, "switch torque on")?;
        self.armed = true;
        // The firmware's first goals: where they stand.
        self.goals = self.stood.clone();
        Ok(())
    }

    fn disarm(&mut self) -> Result<()> {
        self.armed = false;
        Ok(self.session.obey(&Command::Disarm, "switch torque off")?)
    }

    fn emergency_off(&mut self) -> Option<EmergencyOff> {
        let off = [Command::Disarm, Command::Mode(Mode::Bridge)];
        let off = off.map(|command| self.session.bytes(&command)).concat();
        Some(send_twice(self.session.link().second_writer()?, off))
    }

    fn danger(&self) -> Option<String> {
        let is_down = self.armed && is_let_down(self.condition);
        is_down.then(|| {
            let why = self
                .account
                .map_or(String::new(), |account| words(&account));
            format!("the CM-5 is {}{why}", condition_words(self.condition))
        })
    }
}

/// Whether torque is on in this condition; none where it is not known.
fn torque(condition: Condition) -> Option<bool> {
    match condition {
        Condition::StreamArmed | Condition::BalanceArmed | Condition::Soft => Some(true),
        Condition::Stream | Condition::Balance | Condition::Fault(_) => Some(false),
        Condition::Bridge => None,
    }
}

fn is_let_down(condition: Condition) -> bool {
    matches!(condition, Condition::Soft | Condition::Fault(_))
}

/// What may have been the cause: silence of the line, a servo, the supply.
fn words(account: &Telemetry) -> String {
    let servo = account.tripped.map_or(String::new(), |tripped| {
        let names: Vec<&str> = ErrorBits(tripped.error).names().collect();
        match names.is_empty() {
            true => format!(", servo {} lost its torque", tripped.id),
            false => format!(", servo {} reports {}", tripped.id, names.join(" and ")),
        }
    });
    format!(
        ": the line was silent for {} ms at most{servo}, supply {:.1} V",
        account.longest_silence_ms,
        Supply(account.supply).to_v()
    )
}

impl<L: SerialLink> Drop for Stream<L> {
    fn drop(&mut self) {
        // Nobody is left who could be told that it failed; the firmware switches off by itself when
        // the line is silent.
        if self.armed {
            let _ = self.disarm();
        }
        let _ = self.session.send(&Command::Mode(Mode::Bridge));
    }
}
