//! The robot in closed loop with the firmware: three links on a bar, two joints driven by servos in wheel mode.

use super::Bench;
use super::robot::{Robot, STEP_MS, model};
use handstand::controllers::{Fitting, OnBoard, Timing, board_plan};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT, MOVING_SPEED};
use handstand_shared::crc::crc32;
use handstand_shared::message::{
    Attitude, Command, Condition, GAIN_CHUNK, Hello, Mode, Refusal, Report, VERSION,
};
use handstand_shared::plan::Plan;
use handstand_shared::raw::Signed;

/// After a report has arrived the host takes this long to say the attitude, ms.
const HOST_MS: f64 = 1.0;

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
    /// The same with the other attitude, where one was just arriving when the tick began, and may have been seen or not.
    pub or: Option<[i16; 4]>,
    /// Commands of shoulder and hip.
    pub commands: [i16; 2],
}

/// Ticks after arming in which the answer, which goes before them, makes reports late, and so the host's attitudes.
const LATE_TICKS: usize = 8;

/// The machine in floating point and the plan of the paper's robot.
///
/// # Panics
/// The repository's own model cannot be read or designed for: a bug.
pub fn plan() -> (OnBoard, Plan) {
    board_plan(&model(), &Fitting::BIOLOID, &Timing::HOST_ATTITUDE).expect("a plan can be made")
}

/// Makes driven servos turn without end, uploads the plan unless it is there, and waits for the law's moment with the robot as it is.
///
/// # Errors
/// What the firmware refused; nothing if it did not answer.
pub fn ready(
    bench: &mut impl Bench,
    plan: &Plan,
    attitude: Attitude,
) -> Result<u16, Option<Refusal>> {
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
    for _ in 0..25 {
        bench.say(&Command::Attitude(attitude));
        bench.run_ms(10.0);
    }
    Ok(hello.token)
}

/// Uploads the plan and arms it, the first link upright and the servos at their centres.
///
/// # Errors
/// What the firmware refused; nothing if it did not answer.
pub fn arm_balance(bench: &mut impl Bench, plan: &Plan) -> Result<(), Option<Refusal>> {
    let token = ready(bench, plan, Attitude::default())?;
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
    let token = ready(bench, plan, robot.attitude())?;
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
    Ok(run.fall_or_stand(bench, &mut robot, seconds))
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
    /// What was said, and when.
    said: Vec<(f64, Attitude)>,
    /// What the servos were commanded, step by step.
    commanded: Vec<(f64, [i16; 2])>,
    ticks: Vec<Tick>,
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
            ticks: self.ticks,
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
        let last_ms = self.said.last().map_or(f64::NEG_INFINITY, |(at, _)| *at);
        let due_ms = self.due_ms.unwrap_or(last_ms + 20.0);
        if now_ms >= due_ms {
            self.due_ms = None;
            let attitude = robot.attitude();
            self.said.push((now_ms, attitude));
            bench.say(&Command::Attitude(attitude));
        }
        bench.run_ms(STEP_MS);
    }

    /// A report's last byte comes some 15 ms after its tick began, and 9 ms after that tick's commands.
    fn hear(&mut self, arrived_ms: f64, report: &handstand_shared::message::StreamReport) {
        self.condition = Some(report.condition);
        self.due_ms = Some(arrived_ms + HOST_MS);
        let commands = latest(&self.commanded, arrived_ms - 4.0);
        let codes: Vec<u16> = report.positions.codes().collect();
        let joint = |place: usize| codes[place] as i16 - 512;
        let seen = |before_ms: f64| {
            let Attitude { angle, rate } = latest(&self.said, arrived_ms - before_ms)?;
            Some([angle, joint(0), joint(10), rate])
        };
        if let (Some(readings), Some(commands), Condition::BalanceArmed) =
            (seen(17.0), commands, report.condition)
        {
            let mut doubtful = [seen(18.0), seen(16.0)].into_iter().flatten();
            let or = doubtful.find(|other| *other != readings && self.ticks.len() < LATE_TICKS);
            self.ticks.push(Tick {
                number: report.tick,
                readings,
                or,
                commands,
            });
        }
    }
}

/// What was noted last by then.
fn latest<T: Copy>(noted: &[(f64, T)], by_ms: f64) -> Option<T> {
    let mut noted = noted.iter().rev();
    let (_, value) = noted.find(|(at, _)| *at <= by_ms)?;
    Some(*value)
}
