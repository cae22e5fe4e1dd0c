//! Commands, one per file; each file's head is the command's manual.
//!
//! stdout carries data, stderr messages. Exit codes: 0 done, 1 the answer is no (a log refused,
//! values that cannot be determined, a loop that is not stabilised), 2 the request makes no sense,
//! 3 a file or its content is refused, 4 a device failed, 5 a drive was stopped for safety, 101 a
//! bug.

mod add;
#[cfg(feature = "robot")]
mod balance;
mod bus;
mod challenge;
mod compare;
mod completions;
mod console;
mod controllers;
mod delays;
mod demo;
#[cfg(feature = "virtual-cm5")]
mod demo_robot;
#[cfg(feature = "robot")]
mod deploy;
mod diagnose;
mod discover;
mod doctor;
mod drift;
mod effects;
mod excite;
mod fit;
mod flash;
mod gains;
mod gains_choice;
mod help;
mod identify;
mod import;
mod init;
mod input;
mod interrupt;
#[cfg(feature = "lab")]
mod lab;
mod latency;
mod log;
mod man;
mod map;
mod model;
mod next;
mod page;
mod paper;
mod port;
mod record;
mod replay;
mod robot;
mod robust;
mod servo_columns;
mod show;
mod simulated;
mod study;
mod view;
mod virtual_robot;
mod weight_arg;
mod welcome;

use clap::{CommandFactory as _, FromArgMatches as _, Parser, Subcommand};
use console::Console;
use handstand::Result;

/// Exit code of a bug.
pub const BUG: u8 = 101;

/// Measure a servo arm or chain of links, find the physical effect that its model lacks, and
/// balance it.
#[derive(Debug, Parser)]
#[command(name = "handstand", version, max_term_width = 100, after_help = FIRST)]
pub struct Cli {
    /// Print data as JSON on stdout
    #[arg(long, global = true)]
    json: bool,
    /// Print nothing on stderr but errors
    #[arg(long, short, global = true)]
    quiet: bool,
    /// The command to run; without one, where to begin
    #[command(subcommand)]
    pub command: Option<Command>,
}

const FIRST: &str = "A LOG is a CSV file, or some of its data rows counted from 0: drop.csv:26-139";

impl Cli {
    /// What was typed; help and complaints about it end the program.
    pub fn typed() -> Cli {
        let matches = help::grouped(Cli::command()).get_matches();
        Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit())
    }

    /// Runs the command; without one, says where to begin.
    ///
    /// # Errors
    /// As [`Command::run`].
    pub fn run(&self, console: &Console) -> Result<ExitStatus> {
        match &self.command {
            Some(command) => command.run(console),
            None => welcome::run(console),
        }
    }

    /// Where this run's output goes.
    pub fn console(&self) -> Console {
        Console::new(self.json, self.quiet)
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Start a model from a log: columns, units and links guessed
    Init(init::InitArgs),
    /// Compare a model's simulation with measured logs
    Compare(compare::CompareArgs),
    /// Diagnose which physical effect a model lacks, from logs
    Diagnose(diagnose::DiagnoseArgs),
    /// Discover the law that a model and the library lack, as an expression
    Discover(discover::DiscoverArgs),
    /// Propose the experiment that parts what a diagnosis leaves open, or tightens a value
    Next(Box<next::NextArgs>),
    /// List and explain the physical effects of the library
    Effects(effects::EffectsArgs),
    /// Draw, merge and check logs
    #[command(subcommand)]
    Log(log::LogCommand),
    /// Fit a model's free parameters to logs
    Fit(fit::FitArgs),
    /// Test whether a model's values differ between sessions or servos
    Drift(drift::DriftArgs),
    /// Add an effect to a model, its parameters fitted to logs
    Add(add::AddArgs),
    /// Synthesise LQR gains that balance a model, and export them for firmware
    #[cfg(feature = "robot")]
    Gains(Box<deploy::GainsCommand>),
    /// Synthesise LQR gains that balance a model, and export them for firmware
    #[cfg(not(feature = "robot"))]
    Gains(Box<gains::GainsArgs>),
    /// Study the closed loop's robustness by sweeps and Monte Carlo runs
    #[command(subcommand)]
    Study(study::StudyCommand),
    /// Import a model from another simulator's file: URDF, MJCF
    Import(import::ImportArgs),
    /// Export a model for other simulators
    #[command(subcommand)]
    Model(model::ModelCommand),
    /// Identify a servo's discrete-time black-box model by prediction error
    Identify(identify::IdentifyArgs),
    /// Estimate a servo's static maps: dead zone, saturation, supply
    #[command(subcommand)]
    Map(map::MapCommand),
    /// Animate a motion on an HTML page
    View(view::ViewArgs),
    /// Recompute the paper's numbers, figures and findings, and compare
    Paper(paper::PaperArgs),
    /// Practise diagnosis on a virtual bench with a hidden effect
    #[command(subcommand)]
    Challenge(challenge::ChallengeCommand),
    /// Simulate controllers in closed loop with the robot's non-idealities
    Controllers(controllers::ControllersArgs),
    /// Find the delay margin of each controller
    Delays(delays::DelaysArgs),
    /// Verify the robustness of gains to errors of the masses
    Robust(robust::RobustArgs),
    /// Demonstrate compare, diagnose and add on a virtual bench
    Demo(demo::DemoArgs),
    /// Compare, diagnose and improve a model in a browser
    #[cfg(feature = "lab")]
    Lab(lab::LabArgs),
    /// Scan, configure, monitor, back up and diagnose servos on a bus
    #[command(subcommand)]
    Bus(bus::BusCommand),
    /// Write the motions that a measurement needs, within given limits
    Excite(excite::ExciteArgs),
    /// Record servo states to a log
    Record(record::RecordArgs),
    /// Replay a motion on servos
    Replay(replay::ReplayArgs),
    /// Balance the robot through the CM-5, and supervise it
    #[cfg(feature = "robot")]
    Balance(Box<balance::BalanceArgs>),
    /// Measure the latency between PC and servos, stage by stage
    Latency(latency::LatencyArgs),
    /// Deploy a model's gains to the CM-5, and read them back
    #[cfg(feature = "robot")]
    Deploy(Box<deploy::DeployArgs>),
    /// Flash firmware into the CM-5
    Flash(flash::FlashArgs),
    /// Simulate servos behind a virtual serial port
    Virtual(virtual_robot::VirtualArgs),
    /// Check what this machine has: ports, permissions, optional tools
    Doctor(doctor::DoctorArgs),
    /// Print what a shell needs to complete commands and options
    Completions(completions::CompletionsArgs),
    /// Write manual pages, one for each command
    Man(man::ManArgs),
}

impl Command {
    /// Runs the command.
    ///
    /// # Errors
    /// Requests that make no sense, files that cannot be read or are refused.
    pub fn run(&self, console: &Console) -> Result<ExitStatus> {
        match self {
            Command::Init(args) => init::run(args, console),
            Command::Compare(args) => compare::run(args, console),
            Command::Diagnose(args) => diagnose::run(args, console),
            Command::Discover(args) => discover::run(args, console),
            Command::Next(args) => next::run(args, console),
            Command::Effects(args) => effects::run(args, console),
            Command::Log(command) => log::run(command, console),
            Command::Fit(args) => fit::run(args, console),
            Command::Drift(args) => drift::run(args, console),
            Command::Add(args) => add::run(args, console),
            #[cfg(feature = "robot")]
            Command::Gains(args) => deploy::gains(args, console),
            #[cfg(not(feature = "robot"))]
            Command::Gains(args) => gains::run(args, console),
            Command::Study(command) => study::run(command, console),
            Command::Import(args) => import::run(args, console),
            Command::Model(model::ModelCommand::Export(args)) => model::export(args, console),
            Command::Identify(args) => identify::run(args, console),
            Command::Map(command) => map::run(command, console),
            Command::View(args) => view::run(args, console),
            Command::Paper(args) => paper::run(args, console),
            Command::Challenge(command) => challenge::run(command, console),
            Command::Controllers(args) => controllers::run(args, console),
            Command::Delays(args) => delays::run(args, console),
            Command::Robust(args) => robust::run(args, console),
            Command::Demo(args) => demo::run(args, console),
            #[cfg(feature = "lab")]
            Command::Lab(args) => lab::run(args, console),
            Command::Bus(command) => bus::run(command, console),
            Command::Excite(args) => excite::run(args, console),
            Command::Record(args) => record::run(args, console),
            Command::Replay(args) => replay::run(args, console),
            #[cfg(feature = "robot")]
            Command::Balance(args) => balance::run(args, console),
            Command::Latency(args) => latency::run(args, console),
            #[cfg(feature = "robot")]
            Command::Deploy(args) => deploy::run(args, console),
            Command::Flash(args) => flash::run(args, console),
            Command::Virtual(args) => virtual_robot::run(args, console),
            Command::Doctor(args) => doctor::run(args, console),
            Command::Completions(args) => completions::run(args, console),
            Command::Man(args) => man::run(args, console),
        }
    }
}

/// How a command that ran to its end came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExitStatus {
    /// It has done what was asked.
    Done,
    /// It ran, and the answer is no: the data cannot be used, the values cannot be determined.
    Refused,
    /// It was stopped to protect the robot.
    Stopped,
}

impl ExitStatus {
    /// The answer to what was asked: yes or no.
    pub fn answer(yes: bool) -> Self {
        if yes {
            ExitStatus::Done
        } else {
            ExitStatus::Refused
        }
    }

    /// The process's exit code.
    pub fn exit_code(self) -> u8 {
        match self {
            ExitStatus::Done => 0,
            ExitStatus::Refused => 1,
            ExitStatus::Stopped => 5,
        }
    }
}
