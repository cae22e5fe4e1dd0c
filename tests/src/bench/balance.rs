//! The robot in closed loop with the firmware: three links on a bar, two joints driven by servos in wheel mode.

use super::Bench;
use super::robot::{GYRO_STEP_RAD_S, GYRO_ZERO, Robot, STEP_MS, model};
use handstand::controllers::{Fitting, OnBoard, Timing, board_plan};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT, MOVING_SPEED};
use handstand_shared::crc::crc32;
use handstand_shared::frame::MAX_FRAME;
use handstand_shared::message::{
    Attitude, Command, Condition, GAIN_CHUNK, Hello, Mode, Refusal, Report, StreamReport, Subject,
    Telemetry, VERSION, encode,
};
use handstand_shared::plan::{Gyro, Plan};
use handstand_shared::raw::Signed;

/// After a report has arrived the host takes this long to say the attitude, ms.
pub(super) const HOST_MS: f64 = 1.0;

/// A report that has not to wait comes so long after its tick began, to its last byte, ms;
/// `cargo xtask bench-firmware --only "age of readings"` measures it.
pub const REPORT_MS: f64 = 14.5;
/// Period of the law, ms.
const PERIOD_MS: f64 = 10.0;

/// Where the CM-5 has the first link's attitude from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// The host says it after every report.
    Host,
    /// A gyro of 10 deg/s per code on the ADC, and nothing else.
    Gyro,
}

impl Source {
    /// When things happen.
    pub fn timing(self) -> Timing {
        match self {
            Source::Host => Timing::HOST_ATTITUDE,
            Source::Gyro => Timing::GYRO,
        }
    }

    /// The servos, and the gyro as it is wired.
    pub fn fitting(self) -> Fitting {
        let gyro = match self {
            Source::Host => Fitting::BIOLOID.gyro,
            Source::Gyro => Gyro {
                from_host: false,
                zero: GYRO_ZERO,
                scale: (GYRO_STEP_RAD_S / Attitude::RATE_LSB_RAD_S * 16.0).round() as i16,
            },
        };
        Fitting {
            gyro,
            ..Fitting::BIOLOID
        }
    }

    /// The machine in floating point and the plan of the paper's robot.
    ///
    /// # Panics
    /// The repository's own model cannot be read or designed for: a bug.
    pub fn plan(self) -> (OnBoard, Plan) {
        board_plan(&model(), &self.fitting(), &self.timing()).expect("a plan can be made")
    }
}

/// The simulated rig around the firmware.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// Share of full output below which a servo does not move; the plan believes in 8 %.
    pub dead_zone: f64,
    /// The robot's own eccentricity, m: each centre of mass so far beside its line. The plan knows none.
    pub eccentric_m: [f64; 3],
    /// Angles at the start from upright and straight, rad; at rest.
    pub start_rad: [f64; 3],
}

/// What became of the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Balanced {
    /// How long it stood, s.
    pub stood_s: f64,
    /// Root mean square of the first link's angle from upright after the first second, rad.
    pub rms_rad: f64,
    /// Root mean square of each joint's torque, N m.
    pub torque_rms_nm: [f64; 2],
    /// What the firmware said at the end; nothing where there is none.
    pub condition: Option<Condition>,
    /// The firmware's own account, its longest tick and its overruns since shortly before it was armed.
    pub telemetry: Option<Telemetry>,
    /// What each tick saw and commanded, as far as the line told.
    pub ticks: Vec<Tick>,
}

/// One tick of the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tick {
    /// The tick's number.
    pub number: u16,
    /// The first link's angle, both joints' in position codes from their centres, the first link's rate.
    pub readings: [i16; 4],
    /// The same with the other attitude, where one was arriving just as the tick began.
    pub or: Option<[i16; 4]>,
    /// Commands of shoulder and hip.
    pub commands: [i16; 2],
}

/// An attitude that arrives so close to a tick's beginning may have been seen by it or not, ms: for the beginning is known from
/// the reports alone. It happens after arming, whose answer makes the reports late, and so the host.
const DOUBT_MS: f64 = 1.0;

/// [`Source::plan`] with the attitude from the host.
pub fn plan() -> (OnBoard, Plan) {
    Source::Host.plan()
}

/// Makes driven servos turn without end, uploads the plan unless it is there, and waits for the law's moment with the robot as it
/// is: the token that arms, and the firmware's account so far.
///
/// # Errors
/// What the firmware refused; nothing if it did not answer.
pub fn ready(
    bench: &mut impl Bench,
    plan: &Plan,
    attitude: Attitude,
) -> Result<(u16, Option<Telemetry>), Option<Refusal>> {
    for id in [1, 2, 11, 12] {
        let servo = bench.bus().servo(id).expect("18 servos");
        servo.set(CW_LIMIT, 0);
        servo.set(CCW_LIMIT, 0);
        servo.free = false;
    }
    bench.run_ms(10.0);
    let hello = greet(bench)?;
    if hello.gains != plan.fingerprint() {
        upload(bench, plan)?;
    }
    command(bench, &Command::Mode(Mode::Balance))?;
    // Long before anything depends on the line, which has no room for it beside the reports.
    let telemetry = telemetry(bench);
    for _ in 0..25 {
        bench.say(&Command::Attitude(attitude));
        bench.run_ms(10.0);
    }
    Ok((hello.token, telemetry))
}

/// Uploads the plan and arms it, the first link upright and the servos at their centres.
///
/// # Errors
/// What the firmware refused; nothing if it did not answer.
pub fn arm_balance(bench: &mut impl Bench, plan: &Plan) -> Result<(), Option<Refusal>> {
    let (token, _) = ready(bench, plan, Attitude::default())?;
    command(bench, &Command::Arm { token })
}

/// Arms and lets the robot go; the host says the first link's attitude after every report.
///
/// # Errors
/// As [`arm_balance`].
pub fn balance(
    bench: &mut impl Bench,
    plan: &Plan,
    conditions: &Conditions,
    seconds: f64,
) -> Result<Balanced, Option<Refusal>> {
    let mut robot = Robot::new(conditions);
    robot.place(bench);
    let (token, before) = ready(bench, plan, robot.attitude())?;
    bench.forget();
    let sequence = bench.say(&Command::Arm { token });
    let mut run = Run::default();
    // Somebody holds it until torque is on.
    let begun_ms = bench.now_ms();
    while !bench.bus().any_torque() {
        run.step(bench, &robot);
        let answer = bench
            .reports()
            .into_iter()
            .find_map(|(_, report)| match report {
                Report::Answer(answer) if answer.sequence == sequence => answer.outcome.err(),
                _ => None,
            });
        if answer.is_some() || bench.now_ms() > begun_ms + 500.0 {
            return Err(answer);
        }
    }
    let mut balanced = run.fall_or_stand(bench, &mut robot, seconds);
    let after = telemetry(bench);
    balanced.telemetry = before.zip(after).map(|(before, after)| Telemetry {
        overruns: after.overruns - before.overruns,
        ..after
    });
    Ok(balanced)
}

fn telemetry(bench: &mut impl Bench) -> Option<Telemetry> {
    bench.forget();
    bench.say(&Command::Ask(Subject::Telemetry));
    bench.run_ms(50.0);
    let mut reports = bench.reports().into_iter();
    reports.find_map(|(_, report)| match report {
        Report::Telemetry(telemetry) => Some(telemetry),
        _ => None,
    })
}

fn greet(bench: &mut impl Bench) -> Result<Hello, Option<Refusal>> {
    bench.forget();
    bench.say(&Command::Hello { version: VERSION });
    wait(bench, |report| match report {
        Report::Hello(hello) => Some(Ok(hello)),
        _ => None,
    })
}

fn command(bench: &mut impl Bench, command: &Command) -> Result<(), Option<Refusal>> {
    bench.forget();
    let sequence = bench.say(command);
    wait(bench, |report| match report {
        Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome.map_err(Some)),
        _ => None,
    })
}

fn wait<T>(
    bench: &mut impl Bench,
    kind: impl Fn(Report) -> Option<Result<T, Option<Refusal>>>,
) -> Result<T, Option<Refusal>> {
    for _ in 0..600 {
        bench.run_ms(1.0);
        if let Some(found) = bench
            .reports()
            .into_iter()
            .find_map(|(_, report)| kind(report))
        {
            return found;
        }
    }
    Err(None)
}

/// Uploads a plan and has it kept.
fn upload(bench: &mut impl Bench, plan: &Plan) -> Result<(), Option<Refusal>> {
    let mut table = Vec::new();
    plan.bytes(|byte| table.push(byte));
    // As an adapter it takes our frames after a zero only; another mode needs none.
    command(bench, &Command::Mode(Mode::Stream))?;
    for (offset, piece) in (0..).step_by(GAIN_CHUNK).zip(table.chunks(GAIN_CHUNK)) {
        let mut bytes = [0; GAIN_CHUNK];
        bytes[..piece.len()].copy_from_slice(piece);
        command(bench, &Command::GainChunk { offset, bytes })?;
    }
    let (length, check) = (table.len() as u16, crc32(&table));
    command(bench, &Command::GainStore { length, check })
}

/// The host's part of a run, and what it writes down.
#[derive(Default)]
struct Run {
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
    fn fall_or_stand(
        mut self,
        bench: &mut impl Bench,
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
    fn step(&mut self, bench: &mut impl Bench, robot: &Robot) {
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
        bench.forget();
        // A host that hears nothing says something every 20 ms.
        let last_ms = self.said_ms.unwrap_or(f64::NEG_INFINITY);
        let due_ms = self.due_ms.unwrap_or(last_ms + 20.0);
        if now_ms >= due_ms {
            self.due_ms = None;
            let attitude = robot.attitude();
            self.said_ms = Some(now_ms);
            let command = Command::Attitude(attitude);
            bench.say(&command);
            let arrives_ms = now_ms + line_ms(&command);
            self.arrived
                .push((arrives_ms, [attitude.angle, attitude.rate]));
        }
        bench.turn_gyro(robot.gyro());
        bench.run_ms(STEP_MS);
    }

    fn hear(&mut self, arrived_ms: f64, report: &StreamReport) {
        self.condition = Some(report.condition);
        self.due_ms = Some(arrived_ms + HOST_MS);
        if report.condition == Condition::BalanceArmed {
            self.heard.push((arrived_ms, *report));
        }
    }

    /// What each tick saw and commanded: the attitude that had arrived when it began, and the commands before the next one's.
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
