//! What the program checks of a CM-5 over its line.

use super::steps::Check;
use super::{Person, StepOutcome, unknowns};
use crate::bridge::bridged;
use crate::error::{Error, Result};
use crate::{SerialLink, Session, cause_words, condition_words, fault_log};
use handstand_shared::control_table::{
    GOAL_POSITION, MOVING_SPEED, PRESENT_POSITION, TORQUE_ENABLE, TORQUE_LIMIT,
};
use handstand_shared::message::{
    ArmLimits, Cause, Command, Condition, Mode, Report, ServoList, StreamReport, Subject, Telemetry,
};
use handstand_shared::packed::SERVOS;
use handstand_shared::raw::{Supply, TorqueLimit};
use std::time::Duration;

/// A tenth of a servo's torque.
const TENTH: ArmLimits = ArmLimits {
    torque: TorqueLimit(102),
    ..ArmLimits::FULL
};
/// Pings of each servo.
const PINGS: usize = 20;
/// Codes that a servo may move while torque comes on: 1.5 deg.
const STILL: u16 = 5;
/// Torque has to be off so long after the last sign of life.
const OFF_WITHIN: Duration = Duration::from_millis(300);

/// What a check found.
pub(super) struct Found {
    pub outcome: StepOutcome,
    pub text: String,
    /// In the step's unit.
    pub value: Option<f64>,
}

impl Found {
    pub fn of(is_well: bool, text: &str) -> Self {
        let outcome = if is_well {
            StepOutcome::Passed
        } else {
            StepOutcome::Failed
        };
        Found {
            outcome,
            text: text.to_string(),
            value: None,
        }
    }

    pub fn number(outcome: StepOutcome, text: String, value: f64) -> Self {
        Found {
            outcome,
            text,
            value: Some(value),
        }
    }
}

/// Outcome and what was found; what the device does wrong is an outcome.
pub(super) fn measured<L: SerialLink>(
    check: Check,
    link: &mut L,
    ids: &[u8],
    person: &mut dyn Person,
) -> Result<Found> {
    if check.gives_torque()
        && let Some(id) = ids.first()
        && !person.allows_torque(*id)?
    {
        return Ok(Found {
            outcome: StepOutcome::NotDone,
            ..Found::of(false, "torque was not allowed")
        });
    }
    let plain = |outcome: CheckOutcome| outcome.map(|(is_well, text)| Found::of(is_well, &text));
    let checked = match check {
        Check::Gap => unknowns::gap(link, ids),
        Check::ResetFlags => unknowns::reset_flags(link),
        Check::Rate => unknowns::rate(link, ids),
        Check::Firmware => plain(firmware(link)),
        Check::Servos => plain(servos(link, ids)),
        Check::Supply => plain(supply(link, ids)),
        Check::Ticks => plain(ticks(link, ids)),
        Check::Stack => plain(stack(link)),
        Check::GyroZero => plain(gyro_zero(link, ids)),
        Check::GoalTorque => plain(goal_torque(link, ids)),
        Check::LimitedTorque => plain(limited_torque(link, ids)),
        Check::LinkLoss => plain(link_loss(link, ids)),
    };
    match checked {
        Err(error) if !matches!(error, Error::Usage(_)) => Ok(Found::of(false, &error.to_string())),
        found => found,
    }
}

type CheckOutcome = Result<(bool, String)>;

fn firmware<L: SerialLink>(link: &mut L) -> CheckOutcome {
    let mut session = Session::open(link)?;
    let telemetry = telemetry(&mut session)?;
    let is_watchdog = telemetry.reset.is_watchdog();
    let why = if is_watchdog {
        "its watchdog"
    } else {
        "power or reset"
    };
    let state = condition_words(session.hello.condition);
    Ok((!is_watchdog, format!("{state}; last started by {why}")))
}

fn servos<L: SerialLink>(link: &mut L, ids: &[u8]) -> CheckOutcome {
    let mut servos = bridged(link)?;
    servos.tries = 1;
    let mut found = Vec::new();
    for id in ids {
        let answers = (0..PINGS).filter(|_| servos.ping(*id).is_ok()).count();
        if answers < PINGS {
            found.push(format!("servo {id} answers {answers} of {PINGS}"));
        }
    }
    Ok(if found.is_empty() {
        (true, format!("{} servos, {PINGS} pings each", ids.len()))
    } else {
        (false, found.join(", "))
    })
}

fn supply<L: SerialLink>(link: &mut L, ids: &[u8]) -> CheckOutcome {
    let mut session = streaming(link, ids)?;
    stream(&mut session, Duration::from_millis(600))?;
    let supply_v = Supply(telemetry(&mut session)?.supply).to_v();
    Ok((supply_v >= 8.8, format!("{supply_v:.1} V")))
}

fn ticks<L: SerialLink>(link: &mut L, ids: &[u8]) -> CheckOutcome {
    let mut session = streaming(link, ids)?;
    stream(&mut session, Duration::from_millis(300))?;
    let before = telemetry(&mut session)?;
    stream(&mut session, Duration::from_secs(3))?;
    let after = telemetry(&mut session)?;
    let overruns = after.overruns.wrapping_sub(before.overruns);
    let longest_ms = f64::from(after.longest_tick_us) * 1e-3;
    let found = format!("longest {longest_ms:.1} ms, {overruns} too long");
    Ok((overruns == 0, found))
}

fn stack<L: SerialLink>(link: &mut L) -> CheckOutcome {
    let Telemetry {
        stack_used,
        stack_size,
        ..
    } = telemetry(&mut Session::open(link)?)?;
    if stack_size == 0 {
        return Ok((true, "simulated: it has none".to_string()));
    }
    let is_low = u32::from(stack_used) * 5 < u32::from(stack_size) * 4;
    Ok((is_low, format!("{stack_used} of {stack_size} bytes")))
}

fn gyro_zero<L: SerialLink>(link: &mut L, ids: &[u8]) -> CheckOutcome {
    let mut session = streaming(link, ids)?;
    let reports = stream(&mut session, Duration::from_secs(2))?;
    let codes = || reports.iter().map(|report| report.gyro);
    let (Some(least), Some(most)) = (codes().min(), codes().max()) else {
        return Ok((false, "no reports".to_string()));
    };
    let mean = codes().map(f64::from).sum::<f64>() / reports.len() as f64;
    let is_steady = most - least <= 4 && least >= 100 && most <= 923;
    Ok((is_steady, format!("code {mean:.1}, {least} to {most}")))
}

/// Torque is off before and after, whatever the goal does.
fn goal_torque<L: SerialLink>(link: &mut L, ids: &[u8]) -> CheckOutcome {
    let Some(&id) = ids.first() else {
        return Ok((false, "no servo".to_string()));
    };
    let mut servos = bridged(link)?;
    servos.set(id, TORQUE_ENABLE, 0)?;
    servos.set(id, TORQUE_LIMIT, TENTH.torque.0)?;
    let position = servos.get(id, PRESENT_POSITION)?;
    servos.set(id, GOAL_POSITION, position)?;
    let torque = servos.get(id, TORQUE_ENABLE)?;
    servos.set(id, TORQUE_ENABLE, 0)?;
    let left = servos.get(id, TORQUE_ENABLE)?;
    let found = match torque {
        0 => "it does not: torque enable stays 0",
        _ => "it does: torque enable becomes 1",
    };
    Ok((left == 0, found.to_string()))
}

fn limited_torque<L: SerialLink>(link: &mut L, ids: &[u8]) -> CheckOutcome {
    if let Some(id) = ids.first() {
        bridged(link)?.cm5_servo(*id)?;
    }
    let mut session = streaming(link, ids.get(..1).unwrap_or(ids))?;
    arm(&mut session)?;
    let reports = stream(&mut session, Duration::from_secs(1))?;
    session.obey(&Command::Disarm, "switch torque off")?;
    let codes = || reports.iter().map(|report| report.positions.get(0));
    let (Some(least), Some(most)) = (codes().min(), codes().max()) else {
        return Ok((false, "no reports".to_string()));
    };
    let conditions = || reports.iter().map(|report| report.condition);
    if let Some(other) = conditions().rev().find(|it| *it != Condition::StreamArmed) {
        return Ok((false, condition_words(other).to_string()));
    }
    let moved = most - least;
    let Some(&id) = ids.first() else {
        return Ok((false, "no servo".to_string()));
    };
    let mut servos = bridged(session.link())?;
    let held = [TORQUE_LIMIT, MOVING_SPEED].map(|register| servos.get(id, register));
    let [torque, speed] = held;
    let (torque, speed) = (torque?, speed?);
    let has_limits = (torque, speed) == (TENTH.torque.0, TENTH.speed.0);
    Ok((
        moved <= STILL && has_limits,
        format!("it moved {moved} codes; it holds limits of {torque} and {speed}"),
    ))
}

fn link_loss<L: SerialLink>(link: &mut L, ids: &[u8]) -> CheckOutcome {
    if let Some(id) = ids.first() {
        bridged(link)?.cm5_servo(*id)?;
    }
    let mut session = streaming(link, ids.get(..1).unwrap_or(ids))?;
    arm(&mut session)?;
    let begun = session.link().now();
    let mut off = None;
    // Listening is no sign of life.
    while session.link().now() - begun < Duration::from_millis(500) {
        if let Some((at, Report::Stream(report))) = session.next(Duration::from_millis(20))?
            && off.is_none()
            && matches!(report.condition, Condition::Fault(_))
        {
            off = Some((at - begun, report.condition));
        }
    }
    session.greet()?;
    let newest = fault_log(&mut session)?.first().map(|entry| entry.cause);
    let Some((after, condition)) = off else {
        return Ok((false, "torque stays on".to_string()));
    };
    let mut servos = bridged(session.link())?;
    let torque = match ids.first() {
        Some(id) => servos.get(*id, TORQUE_ENABLE)?,
        None => 0,
    };
    let is_well = after <= OFF_WITHIN
        && condition == Condition::Fault(Cause::LinkLost)
        && newest == Some(Cause::LinkLost)
        && torque == 0;
    let logged = newest.map_or("nothing", cause_words);
    let ms = after.as_millis();
    Ok((
        is_well,
        format!("off after {ms} ms; torque register {torque}; log: {logged}"),
    ))
}

/// A session that reads these servos, torque off.
pub(super) fn streaming<'a, L: SerialLink>(
    link: &'a mut L,
    ids: &[u8],
) -> Result<Session<&'a mut L>> {
    let mut list = ServoList {
        count: ids.len().min(SERVOS) as u8,
        ids: [0; SERVOS],
    };
    list.ids
        .iter_mut()
        .zip(ids)
        .for_each(|(slot, id)| *slot = *id);
    let mut session = Session::open(link)?;
    session.obey(&Command::Mode(Mode::Bridge), "stop")?;
    session.obey(&Command::ServoList(list), "take the list of servos")?;
    session.obey(&Command::Mode(Mode::Stream), "stream")?;
    Ok(session)
}

/// A tenth of torque, once the servos have told their supply.
fn arm<L: SerialLink>(session: &mut Session<L>) -> Result<()> {
    stream(session, Duration::from_secs(1))?;
    session.greet()?;
    let token = session.hello.token;
    let limits = TENTH;
    session.obey(&Command::Arm { token, limits }, "switch torque on")?;
    Ok(())
}

/// Reports for so long, with signs of life.
pub(super) fn stream<L: SerialLink>(
    session: &mut Session<L>,
    time: Duration,
) -> Result<Vec<StreamReport>> {
    let until = session.link().now() + time;
    let mut reports = Vec::new();
    while session.link().now() < until {
        session.send(&Command::KeepAlive)?;
        if let Some((_, Report::Stream(report))) = session.next(Duration::from_millis(20))? {
            reports.push(report);
        }
    }
    Ok(reports)
}

pub(super) fn telemetry<L: SerialLink>(session: &mut Session<L>) -> Result<Telemetry> {
    let ask = Command::Ask(Subject::Telemetry);
    let telemetry = session.fetch(&ask, |report| match report {
        Report::Telemetry(telemetry) => Some(*telemetry),
        _ => None,
    })?;
    Ok(telemetry)
}
