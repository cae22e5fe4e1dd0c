//! The lab: the measuring loop in a browser, served from this machine to this machine.
//!
//! It holds no mathematics of its own: every number comes from the functions that the command line
//! calls, on the same files. `server` listens on the loopback interface, `guard` refuses whoever
//! does not know the token or comes from another page, `session` keeps what a person did (whole on
//! disk after every step), `live` watches and balances a robot at a port, `routes` answer requests,
//! `pages` draw them. Pages are made here; the scripts under `assets` draw curves and move sliders.

mod assets;
mod guard;
mod live;
mod pages;
mod reply;
mod routes;
mod server;
mod session;

use handstand_challenge as challenge;
use handstand_control::synth;
use handstand_diagnose::{diagnose, discover, first_model};
use handstand_experiment as experiment;
use handstand_fit::{compare, fitting};
use handstand_link as link;
use handstand_logs as log;
use handstand_model::{effects, error, model, motion, output};
use handstand_report as report;
use handstand_report::plot;
use handstand_robot::deploy;
use handstand_study as study;

pub use live::RobotAccess;
pub use server::{Lab, LabOptions};
pub use session::ProjectFiles;
