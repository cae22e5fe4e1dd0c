//! A designed law on the CM-5: its plan, uploaded and read back; its rehearsal on the firmware's
//! own logic; a robot balanced through the board, and the demonstration of all of it.

pub mod deploy;
#[cfg(feature = "virtual-cm5")]
pub mod robot_demo;

#[cfg(feature = "virtual-cm5")]
use handstand_challenge as challenge;
use handstand_control::synth;
#[cfg(feature = "virtual-cm5")]
use handstand_diagnose::diagnose;
#[cfg(feature = "virtual-cm5")]
use handstand_experiment as experiment;
use handstand_fit::fitting;
use handstand_link as link;
#[cfg(feature = "virtual-cm5")]
use handstand_logs as log;
#[cfg(feature = "virtual-cm5")]
use handstand_model::output;
use handstand_model::{dynamics, effects, error, model};
#[cfg(feature = "virtual-cm5")]
use handstand_report as report;
#[cfg(feature = "virtual-cm5")]
use handstand_report::plot;
#[cfg(feature = "virtual-cm5")]
use handstand_study as study;
