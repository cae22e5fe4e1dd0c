//! `bus scan`: pings every id in Protocol 1.0, all at once in 2.0, and reads what answers.
//!
//! `--protocol` leaves the other one out.

use crate::cli::port::{AnyLink, Ids, Port, id_list};
use crate::cli::{ExitStatus, Talk, show::table_of};
use handstand::Result;
use handstand::link::record::no_response;
use handstand::link::{Protocol, ServoError, ServoResult, Servos, StatusError};
use handstand::output::table::TableColumn;
use handstand_shared::control_table::models::ServoModel;
use handstand_shared::control_table::{self as ct, Quantity, x};
use handstand_shared::raw::Position;
use serde::Serialize;

/// Scan the bus for servos.
#[derive(Debug, clap::Args)]
pub struct ScanArgs {
    #[command(flatten)]
    port: Port,
    /// Ids to ask
    #[arg(long, default_value = "0-253", value_parser = id_list)]
    ids: Ids,
}

/// A servo that answered.
#[derive(Debug, Serialize)]
pub struct FoundServo {
    pub id: u8,
    pub protocol: Protocol,
    pub model: u16,
    pub firmware: u16,
    pub return_delay_us: u16,
    pub status_level: u16,
    pub position_rad: f64,
    pub supply_v: f64,
    pub temperature_celsius: u16,
    pub error_flags: Vec<&'static str>,
}

/// Asks, shows.
pub fn run(args: &ScanArgs, talk: &Talk) -> Result<ExitStatus> {
    let mut servos = args.port.servos()?;
    let found = scan(&mut servos, &args.ids.0, talk)?;
    talk.result(&found, || table(&found))?;
    let asked = args.ids.0.len();
    talk.say(&format!("{} of {asked} ids answer", found.len()));
    match found.is_empty() {
        true => Err(no_response()),
        false => Ok(ExitStatus::Done),
    }
}

fn table(found: &[FoundServo]) -> String {
    let columns: &[TableColumn<FoundServo>] = &[
        ("Id", &|s| s.id.to_string()),
        ("Protocol", &|s| s.protocol.to_string()),
        ("Model", &|s| model(s)),
        ("Firmware", &|s| s.firmware.to_string()),
        ("Return delay", &|s| format!("{} us", s.return_delay_us)),
        ("Status level", &|s| s.status_level.to_string()),
        ("Position", &|s| degrees(s.position_rad)),
        ("Supply", &|s| format!("{:.1} V", s.supply_v)),
        ("Temp", &|s| format!("{} C", s.temperature_celsius)),
        ("Error flags", &|s| s.error_flags.join(", ")),
    ];
    table_of(found, columns).to_string()
}

/// An angle for people.
pub fn degrees(rad: f64) -> String {
    format!("{:.1} deg", rad.to_degrees())
}

/// The ids of those that answer.
///
/// # Errors
/// None answers.
pub fn answering(servos: &mut Servos<AnyLink>, ids: &[u8], talk: &Talk) -> Result<Vec<u8>> {
    let found = scan(servos, ids, talk)?;
    match found.is_empty() {
        true => Err(no_response()),
        false => Ok(found.iter().map(|servo| servo.id).collect()),
    }
}

/// Pings these ids and reads what answers, in both protocols unless one was asked for. The servos
/// are left with the protocol that more of them speak.
pub fn scan(servos: &mut Servos<AnyLink>, ids: &[u8], talk: &Talk) -> Result<Vec<FoundServo>> {
    let asked = servos.protocol;
    let mut found = Vec::new();
    if asked != Some(Protocol::Two) {
        servos.protocol = Some(Protocol::One);
        found = scan_one(servos, ids, talk)?;
    }
    if asked != Some(Protocol::One) {
        servos.protocol = Some(Protocol::Two);
        let ones = found.len();
        // A servo that did not hear the broadcast, or was not heard, is asked by itself.
        let all = servos.ping_all()?;
        for id in ids {
            let is_there = all.contains(id) || (ids.len() <= FEW && servos.ping(*id).is_ok());
            if is_there && let Ok(error) = servos.ping(*id) {
                found.push(read(servos, *id, error)?);
            }
        }
        if asked.is_none() && 2 * ones >= found.len() {
            servos.protocol = Some(Protocol::One);
        }
    }
    Ok(found)
}

/// So many ids are pinged one by one even where a broadcast did not find them.
const FEW: usize = 20;

fn scan_one(servos: &mut Servos<AnyLink>, ids: &[u8], talk: &Talk) -> Result<Vec<FoundServo>> {
    let bar = talk.bar(ids.len() as u64);
    let mut found = Vec::new();
    for id in ids {
        // A silent id is asked once: most are. One that says anything gets its tries.
        servos.tries = 1;
        let pinged = servos.ping(*id);
        servos.tries = 3;
        match pinged {
            Ok(error) => found.push(read(servos, *id, error)?),
            Err(ServoError::NoResponse { .. }) => {}
            Err(ServoError::Port(error)) => return Err(error),
            Err(_) => {
                if let Ok(error) = servos.ping(*id) {
                    found.push(read(servos, *id, error)?);
                } else {
                    talk.say(&format!(
                        "id {id}: bytes came, but no sound answer: two servos of this id, or a \
                         bad line"
                    ));
                }
            }
        }
        bar.inc(1);
    }
    Ok(found)
}

fn read(servos: &mut Servos<AnyLink>, id: u8, error: StatusError) -> ServoResult<FoundServo> {
    let protocol = servos.detect(id)?;
    let (position_rad, error_flags) = match protocol {
        Protocol::One => {
            let code = servos.get(id, ct::PRESENT_POSITION)?;
            (Position(code).to_rad(), error.names())
        }
        Protocol::Two => {
            let code = servos.code(id, &x::PRESENT_POSITION)?;
            let position = Quantity::Position.si(code, None);
            let names = match error.has_alert() {
                true => servos.hardware_errors(id)?,
                false => Vec::new(),
            };
            (position.map_or(0.0, |(rad, _)| rad), names)
        }
    };
    Ok(FoundServo {
        id,
        protocol,
        model: servos.get(id, ct::MODEL)?,
        firmware: servos.get(id, ct::FIRMWARE)?,
        return_delay_us: 2 * servos.get(id, ct::RETURN_DELAY)?,
        status_level: servos.get(id, ct::STATUS_LEVEL)?,
        position_rad,
        supply_v: f64::from(servos.get(id, ct::PRESENT_SUPPLY)?) * 0.1,
        temperature_celsius: servos.get(id, ct::PRESENT_TEMPERATURE)?,
        error_flags,
    })
}

fn model(servo: &FoundServo) -> String {
    if servo.protocol == Protocol::Two {
        let model = ServoModel::of(servo.model);
        return model.map_or_else(|| servo.model.to_string(), |model| model.name.to_string());
    }
    match servo.model {
        12 => "AX-12".to_string(),
        18 => "AX-18".to_string(),
        300 => "AX-12W".to_string(),
        other => other.to_string(),
    }
}
