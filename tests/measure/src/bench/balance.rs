//! The robot in closed loop with the firmware: three links on a bar, two joints driven by servos in
//! wheel mode.

use super::SimulatedCm5;
use super::robot::{GYRO_STEP_RAD_S, GYRO_ZERO, Robot, model};
use super::run::Run;
use handstand::deploy::{self, Board, BoardLaw};
use handstand::synth::controllers::{BoardTiming, OnBoard};
use handstand_shared::control_table::{CCW_LIMIT, CW_LIMIT};
use handstand_shared::crc::crc32;
use handstand_shared::message::{
    ArmLimits, Attitude, Command, Condition, Hello, Mode, PLAN_CHUNK, Refusal, Report, Subject,
    Telemetry, VERSION,
};
use handstand_shared::plan::{Gyro, Plan};

/// The longest that a tick may take, us: 60 % of the period. More than that must fit into what is
/// left: what the tick did not meet while it was measured, and what is done between ticks.
pub const LONGEST_TICK_US: u16 = {
    use handstand_firmware::design::{COMMAND_US, FIRST_BYTE_US, TICK_US};
    use handstand_shared::packed::SERVOS;
    /// Every servo's answer meets the whole of a motor interrupt.
    const STALLS_US: u16 = 130 * SERVOS as u16;
    /// A servo does not answer and is asked again.
    const SILENT_US: u16 = 2 * FIRST_BYTE_US;
    let longest = TICK_US / 10 * 6;
    assert!(longest + STALLS_US + SILENT_US + COMMAND_US <= TICK_US);
    longest
};

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
    pub fn timing(self) -> BoardTiming {
        match self {
            Source::Host => BoardTiming::HOST_ATTITUDE,
            Source::Gyro => BoardTiming::GYRO,
        }
    }

    /// The servos, and the gyro as it is wired.
    pub fn board(self) -> Board {
        let gyro = match self {
            Source::Host => Board::BIOLOID.gyro,
            Source::Gyro => Gyro {
                from_host: false,
                zero: GYRO_ZERO,
                scale: (GYRO_STEP_RAD_S / Attitude::RATE_LSB_RAD_S * 16.0).round() as i16,
            },
        };
        // From the corners of 2 deg an ideal servo turns so far and so fast.
        Board {
            gyro,
            joint_range_rad: 1.5,
            joint_speed_rad_s: 20.0,
            ..Board::BIOLOID
        }
    }

    /// The machine in floating point and the plan of the paper's robot.
    ///
    /// # Panics
    /// The repository's own model cannot be read or designed for: a bug.
    pub fn plan(self) -> (OnBoard, Plan) {
        let (model, board) = (model(), self.board());
        let machine = deploy::observer_design(&model, &board, &self.timing());
        let machine = machine.expect("an observer can be designed");
        let plan = deploy::plan(&model, BoardLaw::Observer(&machine), &board);
        (machine, plan.expect("a plan can be made"))
    }
}

/// The simulated rig around the firmware.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// Share of full output below which a servo does not move; the plan believes in 8 %.
    pub dead_zone: f64,
    /// The robot's own eccentricity, m: each centre of mass so far beside its line. The plan knows
    /// none.
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
    /// The firmware's own account, its longest tick and its overruns since shortly before it was
    /// armed.
    pub telemetry: Option<Telemetry>,
    /// What each tick saw and commanded, as far as the line told.
    pub ticks: Vec<Tick>,
}

/// One tick of the law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tick {
    /// The tick's number.
    pub number: u16,
    /// The first link's angle, both joints' in position codes from their centres, the first link's
    /// rate.
    pub readings: [i16; 4],
    /// The same with the other attitude, where one was arriving just as the tick began.
    pub or: Option<[i16; 4]>,
    /// Commands of shoulder and hip.
    pub commands: [i16; 2],
}

/// [`Source::plan`] with the attitude from the host.
pub fn plan() -> (OnBoard, Plan) {
    Source::Host.plan()
}

/// Makes driven servos turn without end, uploads the plan unless it is there, and waits for the
/// law's moment with the robot as it is: the token that arms, and the firmware's account so far.
///
/// # Errors
/// What the firmware refused; nothing if it did not answer.
pub fn ready(
    bench: &mut impl SimulatedCm5,
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
    if hello.plan != plan.fingerprint() {
        upload(bench, plan)?;
    }
    command(bench, &Command::Mode(Mode::Balance))?;
    // Long before anything depends on the line, which has no room for it beside the reports.
    let telemetry = telemetry(bench);
    for _ in 0..25 {
        bench.send(&Command::Attitude(attitude));
        bench.run_ms(10.0);
    }
    Ok((hello.token, telemetry))
}

/// Uploads the plan and arms it, the first link upright and the servos at their centres.
///
/// # Errors
/// What the firmware refused; nothing if it did not answer.
pub fn arm_balance(bench: &mut impl SimulatedCm5, plan: &Plan) -> Result<(), Option<Refusal>> {
    let (token, _) = ready(bench, plan, Attitude::default())?;
    bench.clear();
    let sequence = bench.send(&arm(token));
    for _ in 0..60 {
        // It goes on being said: an old one is not balanced with.
        bench.send(&Command::Attitude(Attitude::default()));
        bench.run_ms(10.0);
        let outcome = bench
            .reports()
            .into_iter()
            .find_map(|(_, report)| match report {
                Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome),
                _ => None,
            });
        if let Some(outcome) = outcome {
            return outcome.map_err(Some);
        }
    }
    Err(None)
}

/// Torque on, with all the servos have.
fn arm(token: u16) -> Command {
    let limits = ArmLimits::FULL;
    Command::Arm { token, limits }
}

/// Arms and lets the robot go; the host says the first link's attitude after every report.
///
/// # Errors
/// As [`arm_balance`].
pub fn balance(
    bench: &mut impl SimulatedCm5,
    plan: &Plan,
    conditions: &Conditions,
    seconds: f64,
) -> Result<Balanced, Option<Refusal>> {
    let mut robot = Robot::new(conditions);
    robot.place(bench);
    // The firmware takes the mean code before arming for the gyro's zero.
    bench.set_gyro(robot.gyro());
    let (token, before) = ready(bench, plan, robot.attitude())?;
    bench.clear();
    let sequence = bench.send(&arm(token));
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

fn telemetry(bench: &mut impl SimulatedCm5) -> Option<Telemetry> {
    bench.clear();
    bench.send(&Command::Ask(Subject::Telemetry));
    bench.run_ms(50.0);
    let mut reports = bench.reports().into_iter();
    reports.find_map(|(_, report)| match report {
        Report::Telemetry(telemetry) => Some(telemetry),
        _ => None,
    })
}

fn greet(bench: &mut impl SimulatedCm5) -> Result<Hello, Option<Refusal>> {
    bench.clear();
    bench.send(&Command::Hello { version: VERSION });
    wait(bench, |report| match report {
        Report::Hello(hello) => Some(Ok(hello)),
        _ => None,
    })
}

fn command(bench: &mut impl SimulatedCm5, command: &Command) -> Result<(), Option<Refusal>> {
    bench.clear();
    let sequence = bench.send(command);
    wait(bench, |report| match report {
        Report::Answer(answer) if answer.sequence == sequence => Some(answer.outcome.map_err(Some)),
        _ => None,
    })
}

fn wait<T>(
    bench: &mut impl SimulatedCm5,
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
pub(super) fn upload(bench: &mut impl SimulatedCm5, plan: &Plan) -> Result<(), Option<Refusal>> {
    let mut table = Vec::new();
    plan.bytes(|byte| table.push(byte));
    // As an adapter it takes our frames after a zero only; another mode needs none.
    command(bench, &Command::Mode(Mode::Stream))?;
    for (offset, piece) in (0..).step_by(PLAN_CHUNK).zip(table.chunks(PLAN_CHUNK)) {
        let mut bytes = [0; PLAN_CHUNK];
        bytes[..piece.len()].copy_from_slice(piece);
        command(bench, &Command::PlanChunk { offset, bytes })?;
    }
    let (length, check) = (table.len() as u16, crc32(&table));
    command(bench, &Command::PlanStore { length, check })
}
