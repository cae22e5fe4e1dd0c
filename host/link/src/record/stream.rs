//! Servos read by a CM-5 with Handstand's firmware.

use super::reach::{GoalRange, one_held, one_may_reach};
use super::report_reader::ReportReader;
use super::sample::{RobotSample, ServoSample};
use super::source::{EmergencyOff, SampleSource, send_twice};
use crate::error::{Error, Result};
use crate::{
    OneServo, SerialLink, ServoError, Session, account_words, condition_words, is_let_down,
};
use handstand_shared::message::{
    ArmLimits, Command, Condition, Mode, Report, ServoList, Subject, Telemetry,
};
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::raw::Position;
use std::collections::VecDeque;
use std::time::Duration;

/// Goals that are kept until a report says that they are obeyed: those of a sixth of a second, far
/// fewer than frames have numbers.
const MOST_SENT: usize = 16;

const TELEMETRY: Command = Command::Ask(Subject::Telemetry);

/// Servos behind a CM-5 that reads them itself and reports 100 times a second.
pub struct Stream<L: SerialLink> {
    session: Session<L>,
    ids: Vec<u8>,
    /// What each is; none of one that did not answer when it was asked.
    servos: Vec<Option<OneServo>>,
    reader: ReportReader,
    /// Goals that were sent and not yet obeyed, each with the number of its frame.
    sent: VecDeque<(u8, Vec<Position>)>,
    /// The goals that the servos have.
    goals: Option<Vec<Position>>,
    /// Where all stood in the newest report that has them all.
    stood: Option<Vec<Position>>,
    armed: bool,
    condition: Condition,
    /// The CM-5's account of itself when it began to let the robot down.
    account: Option<Telemetry>,
}

/// Disarms the CM-5 from another thread; none on a line that ends with the program.
pub fn emergency_off<L: SerialLink>(session: &mut Session<L>) -> Option<EmergencyOff> {
    let off = [Command::Disarm, Command::Mode(Mode::Bridge)];
    let off = off.map(|command| session.bytes(&command)).concat();
    Some(send_twice(session.link().second_writer()?, Vec::new(), off))
}

impl<L: SerialLink> Stream<L> {
    /// Greets the firmware, names the servos, starts the stream. They are taken for AX-12 with
    /// their factory's limits, as the firmware does: `open_source` asks them first, and gives what
    /// it heard to [`Stream::of_servos`].
    ///
    /// # Errors
    /// No firmware, or it refuses.
    pub fn new(link: L, ids: &[u8]) -> Result<Self> {
        let servos = ids.iter().map(|id| Some(OneServo::ax_12(*id)));
        Stream::of_servos(link, ids, servos.collect())
    }

    /// The same of servos that were asked for model and limits, as [`Servos::cm5_servo`] does, in
    /// the order of ids. What one says that did not answer then is left out, and it is not moved:
    /// nobody knows what its codes mean.
    ///
    /// # Errors
    /// As [`Stream::new`].
    ///
    /// [`Servos::cm5_servo`]: crate::Servos::cm5_servo
    pub fn of_servos(link: L, ids: &[u8], servos: Vec<Option<OneServo>>) -> Result<Self> {
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
        let begun = session.link().now();
        Ok(Stream {
            reader: ReportReader::new(ids, begun, &telemetry),
            session,
            ids: ids.to_vec(),
            servos,
            sent: VecDeque::new(),
            goals: None,
            stood: None,
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

    /// Goals that were sent count from the tick on whose report says that they are obeyed.
    fn take_obeyed(&mut self, obeyed: u8) {
        let known = self
            .sent
            .iter()
            .position(|(sequence, _)| *sequence == obeyed);
        if let Some((_, goals)) = known.and_then(|at| self.sent.drain(..=at).next_back()) {
            self.goals = Some(goals);
        }
    }

    /// # Errors
    /// A servo that did not tell its model.
    fn all_known(&self) -> Result<()> {
        match self.servos.iter().position(Option::is_none) {
            Some(place) => Err(ServoError::NoResponse {
                id: self.ids[place],
            }
            .into()),
            None => Ok(()),
        }
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
            let packed = Positions::pack(goals.iter().map(|goal| goal.0));
            let sequence = self.session.send(&Command::Goals(packed))?;
            self.sent.push_back((sequence, goals));
            if self.sent.len() > MOST_SENT {
                self.sent.pop_front();
            }
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
            let stood = (0..self.ids.len()).map(|place| report.position(place).map(Position));
            self.stood = stood.collect::<Option<_>>().or(self.stood.take());
            self.take_obeyed(report.obeyed);
            let goals = self.goals.as_deref();
            let goal_rad = |place: usize| Some(goals?.get(place)?.to_rad());
            let mut sample = self.reader.sample(time, &report, goal_rad);
            for (joint, servo) in sample.joints.iter_mut().zip(&self.servos) {
                if servo.is_none() {
                    *joint = ServoSample::default();
                }
            }
            return Ok(Some(sample));
        }
    }

    fn arrival_s(&self, _newest: &RobotSample) -> f64 {
        self.reader.arrival_s
    }

    fn may_reach(&mut self, goals: &[GoalRange]) -> Result<()> {
        let mut pairs = self.servos.iter().flatten().zip(goals);
        self.all_known()?;
        pairs.try_for_each(|(servo, goals)| one_may_reach(servo, *goals))
    }

    fn remarks(&self) -> Vec<String> {
        let mut remarks = self.reader.odd.remarks();
        if let Err(error) = self.all_known() {
            remarks.push(format!(
                "{error} when it was asked for its model: its columns are empty"
            ));
        }
        remarks
    }

    fn arm(&mut self) -> Result<()> {
        // The first round of supply readings must be over, or it refuses.
        let mut heard = vec![false; self.ids.len()];
        for _ in 0..40 {
            let sample = self.sample(None)?;
            let joints = sample.iter().flat_map(|sample| &sample.joints);
            for (heard, joint) in heard.iter_mut().zip(joints) {
                *heard |= joint.position_rad.is_some();
            }
        }
        self.session.greet()?;
        // The CM-5 would move the others without it.
        if let Some((&id, _)) = self.ids.iter().zip(heard).find(|(_, heard)| !heard) {
            return Err(ServoError::NoResponse { id }.into());
        }
        for (servo, stood) in (self.servos.iter().flatten()).zip(self.stood.iter().flatten()) {
            one_held(servo, i32::from(stood.0))?;
        }
        let token = self.session.hello.token;
        let limits = ArmLimits::FULL;
        self.session
            .obey(&Command::Arm { token, limits }, "switch torque on")?;
        self.armed = true;
        // The firmware's first goals: where they stand.
        self.goals = self.stood.clone();
        self.sent.clear();
        Ok(())
    }

    fn disarm(&mut self) -> Result<()> {
        self.armed = false;
        // The ticks in which torque goes off are part of a recording.
        self.session.keeps_ticks = true;
        let obeyed = self.session.obey(&Command::Disarm, "switch torque off");
        self.session.keeps_ticks = false;
        Ok(obeyed?)
    }

    fn emergency_off(&mut self) -> Option<EmergencyOff> {
        emergency_off(&mut self.session)
    }

    fn danger(&self) -> Option<String> {
        let is_down = self.armed && is_let_down(self.condition);
        is_down.then(|| {
            let why = self.account.map_or(String::new(), |account| {
                format!(": {}", account_words(&account))
            });
            format!("the CM-5 is {}{why}", condition_words(self.condition))
        })
    }
}

impl<L: SerialLink> Drop for Stream<L> {
    fn drop(&mut self) {
        // Nobody is left who could be told that it failed; the firmware switches off by itself when
        // the line is silent.
        if self.armed {
            let _ = self.disarm();
        }
        // Waited for: whoever opens the line next would hear reports instead of servos.
        let _ = self.session.obey(&Command::Mode(Mode::Bridge), "stop");
    }
}
