//! What nobody publishes of a CM-5 and its servos, as far as the line can tell.

use super::StepOutcome;
use super::checks::{Found, stream, streaming, telemetry};
use crate::bridge::bridged;
use crate::error::Result;
use crate::{SerialLink, Session};
use handstand_shared::control_table::LED;
use handstand_shared::dynamixel::{BROADCAST, Request};
use handstand_shared::message::{ResetCause, StreamReport};
use std::time::Duration;

/// Silence that the firmware leaves between two writes that must both be obeyed, us.
const GAP_US: f64 = 200.0;
/// Bytes of silence that are tried at most: 3 ms.
const MOST_BYTES: usize = 18;
/// How often both writes must be obeyed.
const TRIES: usize = 20;
/// What a servo of return delay 0 takes of a tick, us: request, 22 us, answer; and as much again as
/// a motor interrupt and the answers of housekeeping take at most.
const SERVO_US: f64 = 350.0;

/// Two writes right behind each other, both to the LED, which nothing moves by: the servo ignores
/// the second where it comes too soon. Bytes of `FF` between them, which no servo takes for a
/// packet, put it off. As an adapter the CM-5 passes a byte on as the PC's line brings it, so there
/// is always the time of one.
pub(super) fn gap<L: SerialLink>(link: &mut L, ids: &[u8]) -> Result<Found> {
    let Some(&id) = ids.first() else {
        return Ok(Found::of(false, "no servo"));
    };
    let byte_us = 1e7 / f64::from(link.baud());
    let mut servos = bridged(link)?;
    for between in 0..=MOST_BYTES {
        let gap_us = byte_us * (between + 1) as f64 - 10.0;
        let mut obeyed = 0;
        for _ in 0..TRIES {
            servos.set(id, LED, 1)?;
            let mut bytes = led(1);
            bytes.resize(bytes.len() + between, 0xff);
            bytes.extend(led(0));
            servos.link().send(&bytes)?;
            // Until all is on the bus, and the servo is done with it.
            let line_s = byte_us * 1e-6 * bytes.len() as f64;
            servos
                .link()
                .pause(Duration::from_secs_f64(line_s) + Duration::from_millis(10));
            obeyed += usize::from(servos.get(id, LED)? == 0);
        }
        servos.set(id, LED, 0)?;
        if obeyed == TRIES {
            let outcome = if gap_us <= GAP_US {
                StepOutcome::Passed
            } else {
                StepOutcome::Deviates
            };
            let text = format!("servo {id} obeys both from {gap_us:.0} us on");
            return Ok(Found::number(outcome, text, gap_us));
        }
    }
    let most_ms = byte_us * (MOST_BYTES + 1) as f64 * 1e-3;
    let text = format!("servo {id} ignores the second of two writes {most_ms:.1} ms apart");
    Ok(Found::of(false, &text))
}

/// A write of the LED that no servo answers.
fn led(code: u8) -> Vec<u8> {
    let request = Request::Write {
        address: LED.address,
        data: &[code],
    };
    let mut out = [0; 16];
    let length = request.emit(BROADCAST, &mut out).unwrap_or(0);
    out[..length].to_vec()
}

/// Which flags of a reset the boot loader leaves.
pub(super) fn reset_flags<L: SerialLink>(link: &mut L) -> Result<Found> {
    let ResetCause(flags) = telemetry(&mut Session::open(link)?)?.reset;
    let outcome = match flags {
        0 => StepOutcome::Deviates,
        _ => StepOutcome::Passed,
    };
    let text = match flags {
        0 => "none is left: the boot loader clears them".to_string(),
        _ => format!("flags {flags:#06b}"),
    };
    Ok(Found::number(outcome, text, f64::from(flags)))
}

/// What the bus gives: reports a second, and the time of a servo in a tick.
pub(super) fn rate<L: SerialLink>(link: &mut L, ids: &[u8]) -> Result<Found> {
    let mut session = streaming(link, ids)?;
    stream(&mut session, Duration::from_millis(500))?;
    let begun = session.link().now();
    let reports = stream(&mut session, Duration::from_secs(3))?;
    let took = session.link().now() - begun;
    let told = telemetry(&mut session)?;
    let per_s = reports.len() as f64 / took.as_secs_f64();
    let servo_us = f64::from(told.tick_us) / ids.len().max(1) as f64;
    let heard = share_heard(&reports, ids.len());
    let text = format!(
        "{per_s:.1} reports/s, {:.1} % of the answers, {servo_us:.0} us of a tick for each servo",
        100.0 * heard
    );
    let is_whole = per_s >= 99.0 && heard >= 0.99;
    let outcome = match (is_whole, servo_us <= SERVO_US) {
        (false, _) => StepOutcome::Failed,
        (true, false) => StepOutcome::Deviates,
        (true, true) => StepOutcome::Passed,
    };
    Ok(Found::number(outcome, text, per_s))
}

fn share_heard(reports: &[StreamReport], servos: usize) -> f64 {
    let heard = |report: &StreamReport| (0..servos).filter(|at| report.is_present(*at)).count();
    let all: usize = reports.iter().map(heard).sum();
    all as f64 / (reports.len() * servos).max(1) as f64
}
