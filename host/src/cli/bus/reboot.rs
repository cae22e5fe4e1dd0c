//! `bus reboot`: restarts servos of Protocol 2.0. After a shutdown by a hardware error it is the
//! only way to torque again, besides switching the power off. RAM returns to its defaults and the
//! turn count is forgotten.

use crate::cli::port::{Ids, Port, id_list};
use crate::cli::{Console, ExitStatus};
use handstand::link::{Protocol, ServoError};
use handstand::{Error, Result};
use serde_json::json;

/// Restart servos.
#[derive(Debug, clap::Args)]
pub struct RebootArgs {
    /// Servos to restart
    #[arg(value_parser = id_list)]
    ids: Ids,
    #[command(flatten)]
    port: Port,
}

/// Restarts one after the other, and reads what is left of their hardware errors.
pub fn run(args: &RebootArgs, console: &Console) -> Result<ExitStatus> {
    let mut servos = args.port.servos()?;
    let mut rebooted = Vec::new();
    let mut is_well = true;
    for id in &args.ids.0 {
        if servos.detect(*id)? == Protocol::One {
            return Err(Error::usage(
                format!("servo {id} is asked in Protocol 1.0, which cannot restart it"),
                "an AX-12 recovers when its torque limit is written: docs/bus.md",
            ));
        }
        servos.reboot(*id)?;
        let errors = match servos.hardware_errors(*id) {
            Err(ServoError::UnknownModel { number, .. }) => {
                console.say(&format!(
                    "servo {id} is back; where model {number} keeps its errors is not known"
                ));
                rebooted.push(json!({ "id": id, "error_flags": null }));
                continue;
            }
            errors => errors?,
        };
        is_well &= errors.is_empty();
        console.say(&if errors.is_empty() {
            format!("servo {id} is back")
        } else {
            format!(
                "servo {id} is back, and still reports: {}",
                errors.join(", ")
            )
        });
        rebooted.push(json!({ "id": id, "error_flags": errors }));
    }
    if console.json {
        console.data(&rebooted)?;
    }
    Ok(ExitStatus::answer(is_well))
}
