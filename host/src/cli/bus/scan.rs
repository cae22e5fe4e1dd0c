//! `bus scan`: pings every id in Protocol 1.0, all at once in 2.0, and reads what answers.
//!
//! `--protocol` leaves the other one out. A servo that answers a ping and no reading is listed with
//! the reason, and so is one whose model is not known, without values.

use crate::cli::port::{AnyLink, Ids, Port, id_list};
use crate::cli::show::{or_dash, table_of};
use crate::cli::{Console, ExitStatus};
use handstand::link::record::no_response;
use handstand::link::{Model, Protocol, ServoError, ServoResult, Servos, StatusError, id_ranges};
use handstand::report::table::columns_of;
use handstand::{Error, Result};
use handstand_shared::control_table::{self as ct, Item, Quantity, x};
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

/// A servo that answered a ping, and what it says; none of what it did not say, or what its model's
/// table, not known here, may have elsewhere.
#[derive(Debug, Serialize)]
pub struct FoundServo {
    pub id: u8,
    pub protocol: Protocol,
    pub model: Option<u16>,
    pub firmware: Option<u8>,
    pub return_delay_us: Option<u16>,
    pub status_level: Option<u16>,
    pub position_rad: Option<f64>,
    pub supply_v: Option<f64>,
    pub temperature_celsius: Option<u16>,
    pub error_flags: Vec<&'static str>,
    /// Why values are missing.
    pub fault: Option<String>,
}

/// Asks, shows.
pub fn run(args: &ScanArgs, console: &Console) -> Result<ExitStatus> {
    let mut servos = args.port.servos()?;
    let (found, _) = scan(&mut servos, &args.ids.0, console)?;
    console.result(&found, || table(&found))?;
    let asked = args.ids.0.len();
    console.say(&format!("{} of {asked} ids answer", found.len()));
    if found.is_empty() {
        Err(no_response())
    } else {
        Ok(ExitStatus::Done)
    }
}

fn table(found: &[FoundServo]) -> String {
    let columns = columns_of::<FoundServo>()
        .text("Id", |s| s.id.to_string())
        .text("Protocol", |s| s.protocol.to_string())
        .text("Model", |s| {
            or_dash(s.model, |number| model(s.protocol, number))
        })
        .text("Firmware", |s| {
            or_dash(s.firmware, |version| version.to_string())
        })
        .text("Return delay", |s| {
            or_dash(s.return_delay_us, |us| format!("{us} us"))
        })
        .text("Status level", |s| {
            or_dash(s.status_level, |level| level.to_string())
        })
        .text("Position", |s| or_dash(s.position_rad, degrees))
        .text("Supply", |s| or_dash(s.supply_v, |v| format!("{v:.1} V")))
        .text("Temp", |s| {
            or_dash(s.temperature_celsius, |c| format!("{c} C"))
        })
        .text("Error flags", |s| s.error_flags.join(", "));
    table_of(found, &columns).to_string()
}

/// An angle for people.
pub fn degrees(rad: f64) -> String {
    format!("{:.1} deg", rad.to_degrees())
}

/// The ids of those that answer.
///
/// # Errors
/// None answers; one does not tell what it is; or there are two of one id, as it seems.
pub fn answering(servos: &mut Servos<AnyLink>, ids: &[u8], console: &Console) -> Result<Vec<u8>> {
    let (found, garbled) = scan(servos, ids, console)?;
    if !found.is_empty() && !garbled.is_empty() {
        return Err(Error::device(
            format!(
                "servos answer, and so does what is none at id {}",
                id_ranges(&garbled)
            ),
            "`handstand bus doctor` finds the cause; --ids leaves it out",
        ));
    }
    if let Some(servo) = found.iter().find(|servo| servo.fault.is_some()) {
        let (id, fault) = (servo.id, servo.fault.as_deref().unwrap_or_default());
        return Err(Error::device(
            format!("servo {id}: {fault}"),
            "`handstand bus doctor` finds the cause; --ids leaves it out",
        ));
    }
    if found.is_empty() {
        Err(no_response())
    } else {
        Ok(found.iter().map(|servo| servo.id).collect())
    }
}

/// Pings these ids and reads what answers, in both protocols unless one was asked for. The servos
/// are left with the protocol that more of them speak. Also the ids at which only bytes came, which
/// are said.
///
/// # Errors
/// The port failed.
pub fn scan(
    servos: &mut Servos<AnyLink>,
    ids: &[u8],
    console: &Console,
) -> Result<(Vec<FoundServo>, Vec<u8>)> {
    let asked = servos.protocol;
    let mut found = Vec::new();
    let mut garbled = Vec::new();
    let mut ones = 0;
    for protocol in [Protocol::One, Protocol::Two] {
        if asked.is_some_and(|asked| asked != protocol) {
            continue;
        }
        let bar = console.bar(ids.len() as u64);
        // A silent id is asked once: most are.
        let answering = servos.answering_in(protocol, ids, 1, || bar.inc(1))?;
        for (id, error) in answering.sound {
            found.push(read(servos, id, error)?);
        }
        garbled.extend(answering.garbled);
        if protocol == Protocol::One {
            ones = found.len();
        }
    }
    if asked.is_none() && 2 * ones >= found.len() {
        servos.protocol = Some(Protocol::One);
    }
    garbled.sort_unstable();
    garbled.dedup();
    garbled.retain(|id| found.iter().all(|servo| servo.id != *id));
    if !garbled.is_empty() {
        console.say(&garbled_words(&garbled));
    }
    for servo in &found {
        if let Some(fault) = &servo.fault {
            console.say(&format!("id {}: {fault}", servo.id));
        }
    }
    Ok((found, garbled))
}

/// What is to be said of ids at whose pings bytes came that were no answer.
pub fn garbled_words(ids: &[u8]) -> String {
    let several = if ids.len() == 1 { "id" } else { "ids" };
    format!(
        "{several} {}: bytes came, but no sound answer: two servos of one id, a wrong --baud, or a \
         bad line; `handstand bus doctor` tells them apart",
        id_ranges(ids)
    )
}

/// What a servo that answered a ping says.
fn read(servos: &mut Servos<AnyLink>, id: u8, error: StatusError) -> Result<FoundServo> {
    let protocol = servos.detect(id)?;
    let mut found = FoundServo {
        id,
        protocol,
        model: None,
        firmware: None,
        return_delay_us: None,
        status_level: None,
        position_rad: None,
        supply_v: None,
        temperature_celsius: None,
        error_flags: match protocol {
            Protocol::One => error.names(),
            Protocol::Two => Vec::new(),
        },
        fault: None,
    };
    if let Err(error) = read_into(&mut found, servos, error) {
        found.fault = Some(why(protocol, error.port()?));
    }
    Ok(found)
}

fn read_into(
    found: &mut FoundServo,
    servos: &mut Servos<AnyLink>,
    error: StatusError,
) -> ServoResult<()> {
    let id = found.id;
    let identity = servos.identify(id)?;
    found.model = Some(identity.number);
    found.firmware = Some(identity.firmware);
    found.position_rad = match servos.known_model(id)? {
        Model::One(_) => {
            let servo = servos.one_servo(id)?;
            // As the line has it: the sign is the mode's.
            let code = servos.code(id, &Item::of_register(&ct::PRESENT_POSITION))?;
            servo.angle_rad(code as u16)
        }
        Model::Two(_) => {
            let code = servos.code(id, &x::PRESENT_POSITION)?;
            Quantity::Position.si(code, None).map(|(rad, _)| rad)
        }
    };
    if servos.surplus() > 0 {
        found.fault = Some("its answers come double: two servos of this id".into());
    }
    if error.has_alert() {
        found.error_flags = servos.hardware_errors(id)?;
    }
    found.return_delay_us = Some(2 * servos.get(id, ct::RETURN_DELAY)?);
    found.status_level = Some(servos.get(id, ct::STATUS_LEVEL)?);
    found.supply_v = Some(f64::from(servos.get(id, ct::PRESENT_SUPPLY)?) * 0.1);
    found.temperature_celsius = Some(servos.get(id, ct::PRESENT_TEMPERATURE)?);
    Ok(())
}

/// Why a servo that answers a ping says no more.
fn why(protocol: Protocol, error: ServoError) -> String {
    match error {
        ServoError::NoResponse { .. } => {
            "it answers PING, but no reading: its status level is 0, or answers are lost".into()
        }
        ServoError::Garbled { .. } | ServoError::UnexpectedId { .. } => {
            "it answers PING, but its readings are garbled: two servos of this id, or a bad line"
                .into()
        }
        ServoError::UnknownModel { number, .. } => format!(
            "model {number} of Protocol {protocol}, whose control table is not known \
             (docs/servos.md): its values are left out"
        ),
        ServoError::Refused { error, .. } => {
            format!("it refuses a reading: {}", error.names().join(", "))
        }
        other => other.to_string(),
    }
}

fn model(protocol: Protocol, number: u16) -> String {
    Model::of(protocol, number).map_or_else(|| number.to_string(), |model| model.name().to_string())
}
