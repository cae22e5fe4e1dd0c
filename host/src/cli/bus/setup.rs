//! `bus setup`: what 100 Hz needs, and ids one servo at a time.
//!
//! The factory's return delay of 500 us alone makes a round of 18 servos last longer than 10 ms;
//! status level 1 spares the answers to writes. A new id is given only while a single servo is
//! connected: two of one id would both get it. Twenty readings tell two from one, unless both stand
//! at the same code and are equally warm. Servos of Protocol 2.0 take these settings with torque
//! off, and no id above 252.

use super::changes::{self, RegisterChange};
use super::scan::answering;
use crate::cli::port::{Ids, Port, id_list};
use crate::cli::{Console, ExitStatus};
use handstand::link::doctor::read_test;
use handstand::{Error, Result};
use handstand_shared::control_table::{ID, RETURN_DELAY, STATUS_LEVEL};
use serde_json::json;

/// Prepare servos.
#[derive(Debug, clap::Args)]
pub struct SetupArgs {
    #[command(flatten)]
    port: Port,
    /// Servos to prepare
    #[arg(long, default_value = "0-253", value_parser = id_list)]
    ids: Ids,
    /// Code of the return delay, 2 us each
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=254))]
    return_delay: u16,
    /// Which requests are answered: 0 PING, 1 reading, 2 all
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(0..=2))]
    status_level: u16,
    /// Give the one servo that is connected this id
    #[arg(long, value_name = "ID", value_parser = clap::value_parser!(u8).range(0..=253))]
    new_id: Option<u8>,
}

/// Scans, sets what differs, reads back.
pub fn run(args: &SetupArgs, console: &Console) -> Result<ExitStatus> {
    let mut servos = args.port.servos()?;
    let mut ids = answering(&mut servos, &args.ids.0, console)?;
    let mut changes = Vec::new();
    if let Some(new) = args.new_id {
        let [only] = ids[..] else {
            return Err(Error::usage(
                format!("{} servos answer: {ids:?}", ids.len()),
                "connect the one that gets the new id, and no other",
            ));
        };
        if args.ids.0.len() < 254 {
            return Err(Error::usage(
                "a new id needs a scan of all ids",
                "leave --ids out: another servo might hear it too",
            ));
        }
        let readings = read_test(&mut servos, only)?;
        if readings.is_twice() {
            return Err(Error::device(
                format!("two servos have the id {only}: {}", readings.evidence()),
                "both would get the new id: connect one of the two, and no other",
            ));
        }
        if only != new {
            servos.set(only, ID, u16::from(new))?;
            changes.push(RegisterChange {
                id: new,
                register: servos.item(new, ID)?,
                before: i32::from(only),
                code: i32::from(new),
            });
        }
        ids = vec![new];
    }
    let bar = console.bar(ids.len() as u64);
    for id in &ids {
        for (register, code) in [
            (RETURN_DELAY, args.return_delay),
            (STATUS_LEVEL, args.status_level),
        ] {
            let before = servos.get(*id, register)?;
            if before != code {
                servos.set(*id, register, code)?;
                changes.push(RegisterChange {
                    id: *id,
                    register: servos.item(*id, register)?,
                    before: i32::from(before),
                    code: i32::from(code),
                });
            }
        }
        bar.inc(1);
    }
    drop(bar);
    let (ready, changed) = (ids.len(), changes.len());
    let said = format!("{ready} servos are ready; {changed} registers were changed");
    let data = json!({ "ids": ids, "changes": changes });
    changes::report(&data, &changes, "Now", &said, console)
}
