//! Samples from a CM-5's stream reports.

use super::one_sample::{OddCodes, OneCodes};
use super::sample::{GyroSample, RobotSample, ServoSample};
use super::tick_clock::TickClock;
use crate::OneServo;
use handstand_shared::message::{Attitude, StreamReport, Telemetry};
use handstand_shared::raw::Position;
use std::time::Duration;

/// Turns stream reports into samples of the servos in the servo list's order.
#[derive(Debug)]
pub struct ReportReader {
    ids: Vec<u8>,
    begun: Duration,
    clock: TickClock,
    /// When the last report arrived, s.
    pub(super) arrival_s: f64,
    housekeeping: Vec<ServoSample>,
    /// Zero of the gyro, and rad/s per code, if a plan on the CM-5 has them.
    gyro: Option<(u16, f64)>,
    /// The report before.
    last: Option<StreamReport>,
    pub(super) odd: OddCodes,
}

impl ReportReader {
    /// Of the servos `ids`; times count from `begun`, the gyro's zero and scale are the CM-5's.
    pub fn new(ids: &[u8], begun: Duration, account: &Telemetry) -> Self {
        let scale = f64::from(account.gyro_scale) / 16.0 * Attitude::RATE_LSB_RAD_S;
        ReportReader {
            begun,
            clock: TickClock::default(),
            arrival_s: 0.0,
            housekeeping: vec![ServoSample::default(); ids.len()],
            ids: ids.to_vec(),
            gyro: (scale != 0.0).then_some((account.gyro_zero, scale)),
            last: None,
            odd: OddCodes::default(),
        }
    }

    /// The sample of a report that arrived at `time`; `goal_rad` tells each servo's goal. Its time
    /// is the tick's: when its report would have come had nothing made it late.
    pub fn sample(
        &mut self,
        time: Duration,
        report: &StreamReport,
        goal_rad: impl Fn(usize) -> Option<f64>,
    ) -> RobotSample {
        let count = self.housekeeping.len();
        for (place, housekeeping) in report.housekeeping(count) {
            if housekeeping.error == 0xff {
                continue;
            }
            if let Some(joint) = self.housekeeping.get_mut(place) {
                let codes = OneCodes {
                    position: None,
                    speed: u16::from_le_bytes(housekeeping.speed),
                    load: u16::from_le_bytes(housekeeping.load),
                    supply: housekeeping.supply,
                    temperature: housekeeping.temperature,
                    flags: housekeeping.error,
                };
                // Only servos with the AX-12's codes are behind a CM-5.
                let servo = OneServo::ax_12(self.ids.get(place).copied().unwrap_or_default());
                *joint = codes.sample(&servo, &mut self.odd);
            }
        }
        let joints = (0..count).map(|place| ServoSample {
            position_rad: report.position(place).map(|code| Position(code).to_rad()),
            goal_rad: goal_rad(place),
            // Each servo's turn comes every few ticks; between them nothing was measured.
            ..std::mem::take(&mut self.housekeeping[place])
        });
        let joints = joints.collect();
        let rate = |(zero, scale)| (f64::from(report.gyro) - f64::from(zero)) * scale;
        let torque_on = report.torque_was_on(self.last.as_ref());
        self.last = Some(*report);
        self.arrival_s = time.saturating_sub(self.begun).as_secs_f64();
        RobotSample {
            time_s: self.clock.time_s(report.tick, self.arrival_s),
            joints,
            gyro: Some(GyroSample {
                code: f64::from(report.gyro),
                zero: self.gyro.map(|(zero, _)| f64::from(zero)),
                rate_rad_s: self.gyro.map(rate),
            }),
            torque_on,
            has_current: false,
        }
    }
}
