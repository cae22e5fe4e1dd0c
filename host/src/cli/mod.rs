//! Commands, one per file; each file's head is the command's manual.
//!
//! stdout carries data, stderr talk. Exit codes: 0 done, 1 the answer is no (a log refused, values that cannot
//! be determined), 2 the request makes no sense, 3 a file or its content is refused, 4 a device failed, 5 a
//! drive was stopped for safety, 101 a bug.

mod add;
mod bus;
mod challenge;
mod compare;
mod controllers;
mod delays;
mod demo;
mod deploy;
mod diagnose;
mod effects;
mod fit;
mod fitting;
mod flash;
mod gains;
mod given;
mod identify;
mod input;
mod interrupt;
mod latency;
mod log;
mod map;
mod name;
mod page;
mod paper;
mod port;
mod record;
mod replay;
mod robot;
mod robust;
mod show;
mod signals;
mod simulated;
mod study;
mod talk;
mod view;
mod virtual_robot;

use clap::{Parser, Subcommand};
use handstand::Result;
use talk::Talk;

/// Exit code of a bug.
pub const BUG: u8 = 101;

/// Compare a model of a servo arm or chain of links with measured logs, and find the missing physical effect.
#[derive(Debug, Parser)]
#[command(name = "handstand", version, max_term_width = 100, after_help = FIRST)]
pub struct Cli {
    /// Print data as JSON on stdout
    #[arg(long, global = true)]
    json: bool,
    /// Say nothing on stderr but errors
    #[arg(long, short, global = true)]
    quiet: bool,
    /// What to do
    #[command(subcommand)]
    pub command: Command,
}

const FIRST: &str = "A LOG is a CSV file, or some of its data rows counted from 0: drop.csv:26-139";

impl Cli {
    /// Where this run's words go.
    pub fn talk(&self) -> Talk {
        Talk::new(self.json, self.quiet)
    }
}

/// What there is to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compare models with logs
    Compare(compare::Args),
    /// Find the physical effect that is missing from a model
    Diagnose(diagnose::Args),
    /// Explain the physical effects the library knows
    Effects(effects::Args),
    /// Judge logs before they are learned from
    #[command(subcommand)]
    Log(log::Command),
    /// Fit a model's free values to logs
    Fit(fit::Args),
    /// Add an effect to a model, its values fitted to logs
    Add(add::Args),
    /// Find gains that balance a model, and write them for firmware
    Gains(Box<deploy::GainsCommand>),
    /// See what the closed loop of robot and controller bears
    #[command(subcommand)]
    Study(study::Command),
    /// Identify a servo as a black box: discrete-time models by prediction error
    Identify(identify::Args),
    /// Map what a servo does at rest: dead zone, saturation, supply
    #[command(subcommand)]
    Map(map::Command),
    /// Play a motion on a page
    View(view::Args),
    /// The paper's numbers, figures and findings beside our own
    Paper(paper::Args),
    /// Try yourself, or the program, on a virtual bench with a hidden effect
    #[command(subcommand)]
    Challenge(challenge::Command),
    /// Try controllers under everything the robot does to them
    Controllers(controllers::Args),
    /// Find the longest delay each controller survives
    Delays(delays::Args),
    /// See what gains make of robots whose masses are not the model's
    Robust(robust::Args),
    /// Watch the whole loop on such a bench
    Demo(demo::Args),
    /// Communicate with servos: scan, read, write, set up, monitor, back up, diagnose
    #[command(subcommand)]
    Bus(bus::Command),
    /// Record what servos do
    Record(record::Args),
    /// Let servos repeat a recording
    Replay(replay::Args),
    /// Measure where the time between PC and servos goes
    Latency(latency::Args),
    /// Bring gains for a model onto the CM-5, and read them back
    Deploy(Box<deploy::Args>),
    /// Write a program into the CM-5
    Flash(flash::Args),
    /// Offer simulated servos to any program as a serial port
    Virtual(virtual_robot::Args),
}

impl Command {
    /// Does it.
    ///
    /// # Errors
    /// Requests that make no sense, files that cannot be read or are refused.
    pub fn run(&self, talk: &Talk) -> Result<Outcome> {
        match self {
            Command::Compare(args) => compare::run(args, talk),
            Command::Diagnose(args) => diagnose::run(args, talk),
            Command::Effects(args) => effects::run(args, talk),
            Command::Log(log::Command::Check(args)) => log::check(args, talk),
            Command::Fit(args) => fit::run(args, talk),
            Command::Add(args) => add::run(args, talk),
            Command::Gains(args) => deploy::gains(args, talk),
            Command::Study(command) => study::run(command, talk),
            Command::Identify(args) => identify::run(args, talk),
            Command::Map(command) => map::run(command, talk),
            Command::View(args) => view::run(args, talk),
            Command::Paper(args) => paper::run(args, talk),
            Command::Challenge(command) => challenge::run(command, talk),
            Command::Controllers(args) => controllers::run(args, talk),
            Command::Delays(args) => delays::run(args, talk),
            Command::Robust(args) => robust::run(args, talk),
            Command::Demo(args) => demo::run(args, talk),
            Command::Bus(command) => bus::run(command, talk),
            Command::Record(args) => record::run(args, talk),
            Command::Replay(args) => replay::run(args, talk),
            Command::Latency(args) => latency::run(args, talk),
            Command::Deploy(args) => deploy::run(args, talk),
            Command::Flash(args) => flash::run(args, talk),
            Command::Virtual(args) => virtual_robot::run(args, talk),
        }
    }
}

/// How a command that ran to its end came out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It has done what was asked.
    Done,
    /// It ran, and the answer is no: the data cannot be used, the values cannot be determined.
    Refused,
    /// It was stopped to protect the robot.
    Stopped,
}

impl Outcome {
    /// The process's exit code.
    pub fn exit_code(self) -> u8 {
        match self {
            Outcome::Done => 0,
            Outcome::Refused => 1,
            Outcome::Stopped => 5,
        }
    }
}
