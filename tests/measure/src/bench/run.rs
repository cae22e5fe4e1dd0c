//! The host's part while the robot is balanced: it hears reports, says attitudes, and writes down
//! what each tick saw.

use super::SimulatedCm5;
use super::balance::{Balanced, Tick};
use super::robot::{Robot, STEP_MS};
use handstand_shared::control_table::MOVING_SPEED;
use handstand_shared::frame::MAX_FRAME;
use handstand_shared::message::{Command, Condition, Report, StreamReport, encode};
use handstand_shared::raw::Signed;

/// After a report has arrived the host takes this long to say the attitude, ms.
pub(super) const HOST_MS: f64 = 1.0;

/// A report that has not to wait comes so long after its tick began, to its last byte, ms;
/// `cargo xtask bench-firmware --only "age of readings"` measures it.
pub const REPORT_MS: f64 = 14.8;
/// Period of the law, ms.
const PERIOD_MS: f64 = 10.0;

/// An attitude that arrives so close to a tick's beginning may have been seen by it or not, ms: for
/// the beginning is known from the reports alone. It happens after arming, whose answer makes the
/// reports late, and so the host.
const DOUBT_MS: f64 = 1.0;

/// The host's part of a run, and what it writes down.
#[derive(Default)]
pub(super) struct Run {
    /// When the next attitude is due, ms.
    due_ms: Option<f64>,
    /// When an attitude was said last, ms.
    said_ms: Option<f64>,
    /// Angles and rates said, and when they had arrived.
    arrived: Vec<(f64, [i16; 2])>,
    /// What the servos were commanded, step by step.
    commanded: Vec<(f64, [i16; 2])>,
    /// Reports of ticks of the law, and when they arrived.
    heard: Vec<(f64, StreamReport)>,
    condition: Option<Condition>,
}

impl Run {
    pub(super) fn fall_or_stand(
        mut self,
        bench: &mut impl SimulatedCm5,
        robot: &mut Robot,
        seconds: f64,
    ) -> Balanced {
        let mut square = [0.0; 3];
        let mut counted = 0;
        let begun_ms = bench.now_ms();
        let mut robot_ms = 0.0;
        while robot_ms < seconds * 1e3 && !robot.has_fallen() {
            let torque_nm = robot.torques(bench);
            self.step(bench, robot);
            // The logic in process lets a whole tick pass at once.
            while robot_ms + STEP_MS <= bench.now_ms() - begun_ms + 1e-6 {
                robot.advance(torque_nm);
                robot_ms += STEP_MS;
                if robot_ms > 1e3 {
                    counted += 1;
                    let values = [robot.lean_rad(), torque_nm[0], torque_nm[1]];
                    (square.iter_mut().zip(values)).for_each(|(sum, value)| *sum += value * value);
                }
            }
            robot.place(bench);
        }
        let stood_s = robot_ms.min(seconds * 1e3) * 1e-3;
        let rms = square.map(|sum: f64| (sum / f64::from(counted.max(1))).sqrt());
        Balanced {
            stood_s,
            rms_rad: rms[0],
            torque_rms_nm: [rms[1], rms[2]],
            condition: self.condition,
            telemetry: None,
            ticks: self.ticks(),
        }
    }

    /// Hears reports, says attitudes, and lets time pass.
    pub(super) fn step(&mut self, bench: &mut impl SimulatedCm5, robot: &Robot) {
        let now_ms = bench.now_ms();
        let commanded = [1, 11].map(|id| {
            let servo = bench.bus().servo(id).expect("18 servos");
            Signed(servo.get(MOVING_SPEED)).get()
        });
        self.commanded.push((now_ms, commanded));
        for (arrived_ms, report) in bench.reports() {
            if let Report::Stream(report) = report {
                self.hear(arrived_ms, &report);
            }
        }
        bench.clear();
        // A host that hears nothing says something every 20 ms.
        let last_ms = self.said_ms.unwrap_or(f64::NEG_INFINITY);
        let due_ms = self.due_ms.unwrap_or(last_ms + 20.0);
        if now_ms >= due_ms {
            self.due_ms = None;
            let attitude = robot.attitude();
            self.said_ms = Some(now_ms);
            let command = Command::Attitude(attitude);
            bench.send(&command);
            let arrives_ms = now_ms + line_ms(&command);
            self.arrived
                .push((arrives_ms, [attitude.angle, attitude.rate]));
        }
        bench.set_gyro(robot.gyro());
        bench.run_ms(STEP_MS);
    }

    fn hear(&mut self, arrived_ms: f64, report: &StreamReport) {
        self.condition = Some(report.condition);
        self.due_ms = Some(arrived_ms + HOST_MS);
        if report.condition == Condition::BalanceArmed {
            self.heard.push((arrived_ms, *report));
        }
    }

    /// What each tick saw and commanded: the attitude that had arrived when it began, and the
    /// commands before the next one's.
    ///
    /// Ticks begin every 10 ms; of all reports the one that waited least on the line tells when.
    fn ticks(&self) -> Vec<Tick> {
        let Some((_, first)) = self.heard.first() else {
            return Vec::new();
        };
        let since_first =
            |report: &StreamReport| f64::from(report.tick.wrapping_sub(first.tick)) * PERIOD_MS;
        let from_first = self
            .heard
            .iter()
            .map(|(at, report)| at - since_first(report));
        let first_ms = from_first.fold(f64::INFINITY, f64::min) - REPORT_MS;
        let tick = |(_, report): &(f64, StreamReport)| {
            let began_ms = first_ms + since_first(report);
            let seen = |by_ms: f64| last_before(&self.arrived, by_ms).copied();
            let attitude = seen(began_ms)?;
            let mut doubtful = [seen(began_ms - DOUBT_MS), seen(began_ms + DOUBT_MS)]
                .into_iter()
                .flatten();
            let commands = *last_before(&self.commanded, began_ms + PERIOD_MS)?;
            let codes: Vec<u16> = report.positions.codes().collect();
            let joint = |place: usize| codes[place] as i16 - 512;
            let readings = |[angle, rate]: [i16; 2]| [angle, joint(0), joint(10), rate];
            Some(Tick {
                number: report.tick,
                readings: readings(attitude),
                or: doubtful.find(|other| *other != attitude).map(readings),
                commands,
            })
        };
        self.heard.iter().filter_map(tick).collect()
    }
}

fn last_before<T>(list: &[(f64, T)], at_ms: f64) -> Option<&T> {
    let after = list.partition_point(|(when, _)| *when <= at_ms);
    list.get(after.checked_sub(1)?).map(|(_, value)| value)
}

/// How long a command takes on the line, ms.
fn line_ms(command: &Command) -> f64 {
    let mut frame = [0; MAX_FRAME];
    let length = encode(0, command, &mut frame).expect("every command fits");
    length as f64 * 10.0 / 57.6
}
