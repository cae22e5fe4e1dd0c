//! `handstand balance [MODEL.toml|PLAN.rs]`: balance the robot through the CM-5, and supervise it.
//!
//! With a model the plan is designed, as `handstand gains deploy` does with the same options; a
//! file that `--header` of that command wrote is taken as it is; without either the plan that the
//! CM-5 has is used. What the CM-5 does not have is uploaded and read back.
//!
//! ```console
//! $ handstand balance handstand.toml --port /dev/ttyUSB0 --gyro-per-code 0.0175
//! $ imu-lines | handstand balance handstand.toml --port /dev/ttyUSB0 --attitude lines --yes
//! $ handstand balance handstand.toml --port sim-cm5:robot=handstand.toml,start=held --yes
//! ```
//!
//! `--dry-run` designs the plan of a model, tries it out from ten starts as `handstand deploy`
//! does, says whether it holds the robot (exit code 1 where it does not) and reaches no CM-5;
//! `--json` then prints `fingerprint`, `effects`, `verdict`.
//!
//! Step by step: the driven servos get into wheel mode and all of `--ids` return delay 0, which
//! their EEPROM keeps (read back; `handstand bus restore` brings the old limits back); the servos
//! are named to the CM-5; it asks, unless `--yes`; after `--countdown` seconds torque comes on.
//! Hold the robot upright and straight until then. The CM-5 refuses to arm where something speaks
//! against it, and says what. A terminal shows joints, attitude, supply and latency as they are.
//!
//! `--attitude` says where the first link's attitude comes from: `gyro`, the gyro at the CM-5's
//! ADC; `lines`, an IMU or a camera that writes a line for each attitude to standard input, angle
//! from upright in rad and rate in rad/s, 100 times a second; `robot`, the simulated robot of
//! `--port sim-cm5:robot=..`, exactly. Unless given it is what the plan wants: the gyro, or the
//! simulated robot where there is one.
//!
//! After `--seconds`, at Ctrl-C and at the end of the lines the robot is let down softly: motors
//! stop, the torque limit falls to nothing in 160 ms. A second Ctrl-C switches torque off at once.
//! Exit code 5: the CM-5 let the robot down for its safety, or no attitude came any more.
//!
//! `--json` prints `ended` (`finished`, `interrupted`, `attitude_ended`, `stopped`), `cause` (in
//! words, null unless stopped), `balanced_s`, `lean_rms_rad`, `fingerprint`, `uploaded`, `changes`
//! (registers set: `id`, `register`, `before`), `longest_report_s`, `longest_attitude_s`,
//! `longest_silence_ms`, `tripped` (`id`, `error_flags`), `supply_v`, `samples`, `record`.

mod report;
mod source;

use super::deploy::board::BoardArgs;
use super::flash::agreed;
use super::input::within;
use super::interrupt::Interrupt;
use super::port::{AnyLink, Ids, Port, id_list};
use super::{Console, ExitStatus};
use handstand::deploy::balance::{
    BalanceStatus, BalanceWatch, Balancer, Supervision, check_attitude,
};
use handstand::link::record::{RobotRecorder, RobotSample};
use handstand::{Error, Result, output};
use handstand_shared::message::ArmLimits;
use handstand_shared::plan::Plan;
use handstand_shared::raw::TorqueLimit;
use indicatif::ProgressBar;
use report::{BalanceReport, live_table};
use source::{attitude, plan};
use std::path::PathBuf;

/// Samples between two drawings of the table: ten a second.
const DRAW_EVERY: u64 = 10;

/// Balance the robot through the CM-5.
#[derive(Debug, clap::Args)]
pub struct BalanceArgs {
    /// Model to design the plan for, or a plan that `gains deploy --header` wrote; without it the
    /// plan that the CM-5 has
    #[arg(value_name = "MODEL.toml|PLAN.rs")]
    plan: Option<PathBuf>,
    #[command(flatten)]
    port: Port,
    /// Servos that hold the robot, those that balance among them
    #[arg(long, default_value = "1-18", value_parser = id_list)]
    ids: Ids,
    #[command(flatten)]
    board: BoardArgs,
    /// Where the first link's attitude comes from
    #[arg(long, value_enum)]
    attitude: Option<AttitudeKind>,
    /// Torque limit of all servos, a share of full torque
    #[arg(long, default_value_t = 1.0)]
    torque: f64,
    /// Seconds until torque comes on
    #[arg(long, default_value_t = 3.0)]
    countdown: f64,
    /// How long; until Ctrl-C without
    #[arg(long)]
    seconds: Option<f64>,
    /// Record what the servos do, .csv or .mcap
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Replace the recording if it exists
    #[arg(long)]
    force: bool,
    /// Do not ask
    #[arg(long)]
    yes: bool,
    /// Try the model's plan out on the simulated robot; reach no CM-5
    #[arg(long, conflicts_with_all = ["record", "attitude"])]
    dry_run: bool,
}

/// Where the attitude comes from.
#[derive(Debug, Clone, Copy, PartialEq, clap::ValueEnum)]
enum AttitudeKind {
    /// The gyro at the CM-5's ADC
    Gyro,
    /// Lines on standard input: angle from upright, rad, and rate, rad/s
    Lines,
    /// The simulated robot
    Robot,
}

/// Sets up, arms, supervises, lets down.
pub fn run(args: &BalanceArgs, console: &Console) -> Result<ExitStatus> {
    let limits = checked(args)?;
    if args.dry_run {
        return source::dry_run(args, console);
    }
    let given = args
        .plan
        .as_deref()
        .map(|file| plan(args, file, console))
        .transpose()?;
    let interrupt = Interrupt::listen();
    let (link, robot) = args.port.open_with_attitude()?;
    let source = attitude(args, given.as_ref(), robot)?;
    let is_gyro = source.is_gyro();
    let mut balancer = Balancer::new(link, &args.ids.0, source)?;
    let plan = match given {
        Some(plan) => plan,
        None => balancer.stored_plan()?,
    };
    check_attitude(&plan, is_gyro)?;
    let mut report = BalanceReport {
        fingerprint: plan.fingerprint(),
        ..BalanceReport::default()
    };
    set_up(args, &plan, &mut balancer, &mut report, console)?;
    balancer.make_ready(&plan)?;
    agreed(
        args.yes,
        "Is the robot upright and straight, and room around it?",
    )?;
    let create = |file: &PathBuf| RobotRecorder::create(file, &args.ids.0, args.force);
    let mut recorder = args.record.as_ref().map(create).transpose()?;
    interrupt.at_once(balancer.emergency_off());
    let live = console.live();
    let how = Supervision {
        countdown_s: args.countdown,
        seconds: args.seconds,
        limits,
    };
    let mut terminal = Terminal {
        interrupt: &interrupt,
        live: &live,
        recorder: recorder.as_mut(),
        samples: 0,
    };
    let outcome = balancer.supervise(how, &mut terminal);
    live.finish_and_clear();
    if let Some(recorder) = recorder {
        report.samples = recorder.samples;
        recorder.finish()?;
    }
    let outcome = outcome?
        .ok_or_else(|| Error::usage("Ctrl-C before torque came on", "nothing was moved"))?;
    report.print(&outcome, &balancer.status, args.record.as_deref(), console)
}

/// The limits that torque comes on with.
fn checked(args: &BalanceArgs) -> Result<ArmLimits> {
    within("--countdown", args.countdown, 0.0, 60.0)?;
    within("--seconds", args.seconds.unwrap_or(1.0), 0.01, 1e6)?;
    let share = within("--torque", args.torque, 0.01, 1.0)?;
    if let Some(file) = &args.record {
        handstand::link::record::FileFormat::of(file)?;
        output::vacant(file, args.force)?;
    }
    if args.attitude == Some(AttitudeKind::Lines) && !args.yes {
        return Err(Error::usage(
            "standard input has the attitude: nobody can be asked there",
            "pass --yes if you mean it; --countdown leaves time to hold the robot",
        ));
    }
    Ok(ArmLimits {
        torque: TorqueLimit((share * 1023.0).round() as u16),
        ..ArmLimits::FULL
    })
}

/// The plan onto the CM-5, the servos into wheel mode.
fn set_up(
    args: &BalanceArgs,
    plan: &Plan,
    balancer: &mut Balancer<AnyLink>,
    report: &mut BalanceReport,
    console: &Console,
) -> Result<()> {
    let mut bytes = 0;
    plan.bytes(|_| bytes += 1);
    let bar = console.bar(bytes);
    report.uploaded = balancer.deploy(plan, |sent| bar.set_position(sent))?;
    drop(bar);
    let done = if report.uploaded {
        "uploaded"
    } else {
        "on the CM-5"
    };
    console.say(&format!("plan {:08X}: {done}", report.fingerprint));
    report.changes = balancer.wheel_changes(plan)?;
    if report.changes.is_empty() {
        console.say("servos: in wheel mode where driven, return delay 0");
        return Ok(());
    }
    let mut names: Vec<&str> = report.changes.iter().map(|c| c.register.name).collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let of = report.changes.iter().filter(|c| c.register.name == name);
        let of: Vec<String> = of.map(|c| format!("{} ({})", c.id, c.before)).collect();
        console.say(&format!(
            "{name} has to be 0, of servo (now): {}",
            of.join(", ")
        ));
    }
    agreed(
        args.yes,
        "These registers are kept without power. Write them?",
    )?;
    balancer.set_up(&report.changes)?;
    console.say("servos: now in wheel mode where driven, return delay 0");
    Ok(())
}

/// What a terminal shows while the robot is balanced, and Ctrl-C.
struct Terminal<'a> {
    interrupt: &'a Interrupt,
    live: &'a ProgressBar,
    recorder: Option<&'a mut RobotRecorder>,
    samples: u64,
}

impl BalanceWatch for Terminal<'_> {
    fn counts_down(&mut self, left_s: f64, at: (&RobotSample, &BalanceStatus)) -> Result<bool> {
        let table = live_table(at.1);
        self.live
            .set_message(format!("torque in {left_s:.0} s\n{table}"));
        Ok(!self.interrupt.has_come())
    }

    fn balances(&mut self, (sample, status): (&RobotSample, &BalanceStatus)) -> Result<bool> {
        if let Some(recorder) = &mut self.recorder {
            recorder.write(sample)?;
        }
        self.samples += 1;
        if self.samples.is_multiple_of(DRAW_EVERY) {
            self.live.set_message(live_table(status));
        }
        Ok(!self.interrupt.has_come())
    }
}
