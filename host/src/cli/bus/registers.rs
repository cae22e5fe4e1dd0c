//! `bus read`, `bus write`: single registers.

use crate::cli::port::{AnyLink, Port};
use crate::cli::{Console, ExitStatus, show::table_of};
use handstand::link::{Model, OneMode, OneServo, ServoError, Servos};
use handstand::model::suggest::suggest;
use handstand::output::table::or_empty;
use handstand::report::table::columns_of;
use handstand::{Error, Result};
use handstand_shared::control_table::{self as ct, Access, Item, Register, x};
use serde::Serialize;
use serde_json::json;

/// Read registers of a servo.
#[derive(Debug, clap::Args)]
pub struct ReadArgs {
    /// Id of the servo
    id: u8,
    /// Registers by name or address; all without
    registers: Vec<String>,
    #[command(flatten)]
    port: Port,
}

/// Write a register of a servo.
#[derive(Debug, clap::Args)]
pub struct WriteArgs {
    /// Id of the servo
    id: u8,
    /// Register by name or address
    register: String,
    /// Its new code
    #[arg(allow_negative_numbers = true)]
    code: i32,
    #[command(flatten)]
    port: Port,
}

/// What a register of a servo holds.
#[derive(Serialize)]
struct RegisterContent {
    address: u16,
    register: &'static str,
    code: i32,
    means: String,
    /// In SI, where the register has a unit (Protocol 2.0).
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'static str>,
    #[serde(skip)]
    default: Option<u16>,
}

/// A row by name, however spelt, or by address.
fn row(items: &[Item], text: &str) -> Result<Item> {
    let found = match text.parse::<u16>() {
        Ok(address) => items.iter().find(|item| item.address == address),
        Err(_) => items.iter().find(|item| item.is_named(text)),
    };
    found.copied().ok_or_else(|| {
        let names: Vec<&str> = items.iter().map(|item| item.name).collect();
        Error::usage(
            format!("there is no register `{text}`"),
            suggest(text, &names),
        )
    })
}

/// Reads, shows.
pub fn read(args: &ReadArgs, console: &Console) -> Result<ExitStatus> {
    let mut servos = args.port.servos()?;
    let items = servos.items(args.id)?;
    let named = args.registers.iter().map(|text| row(&items, text));
    let named = named.collect::<Result<Vec<_>>>()?;
    let wanted = if named.is_empty() { &items } else { &named };
    let mut contents = Vec::new();
    for item in wanted {
        let code = servos.code(args.id, item)?;
        contents.push(content(&mut servos, args.id, item, code)?);
    }
    console.result(&contents, || {
        let columns = columns_of::<RegisterContent>()
            .text("Address", |c| c.address.to_string())
            .text("Register", |c| c.register.to_string())
            .text("Code", |c| c.code.to_string())
            .text("Means", |c| c.means.clone())
            .text("Default", |c| or_empty(c.default));
        table_of(&contents, &columns).to_string()
    })?;
    Ok(ExitStatus::Done)
}

fn content(
    servos: &mut Servos<AnyLink>,
    id: u8,
    item: &Item,
    code: i32,
) -> Result<RegisterContent> {
    let (address, register) = (item.address, item.name);
    if let Model::Two(model) = servos.known_model(id)? {
        let si = item.quantity.si(code, model.current_lsb_a);
        return Ok(RegisterContent {
            address,
            register,
            code,
            means: x_meaning(item, code, si),
            value: si.map(|(value, _)| value),
            unit: si.map(|(_, unit)| unit),
            default: None,
        });
    }
    let servo = servos.one_servo(id)?;
    let row = u8::try_from(address).ok().and_then(Register::at);
    let row = row.filter(|row| row.name == register);
    // The factory's codes of the other models are not in the table.
    let own =
        row.filter(|row| row.access == Access::Write && servo.model.number == ct::MODEL.default);
    Ok(RegisterContent {
        address,
        register,
        code,
        means: row.map_or(String::new(), |row| meaning(*row, code, &servo)),
        value: None,
        unit: None,
        default: own.map(|row| row.default),
    })
}

/// Writes, reads back, shows.
pub fn write(args: &WriteArgs, console: &Console) -> Result<ExitStatus> {
    let (id, code) = (args.id, args.code);
    let mut servos = args.port.servos()?;
    let item = match servos.items(id) {
        // At status level 0 it does not tell its model, and this register is what helps.
        Err(ServoError::NoResponse { .. })
            if Item::of_register(&ct::STATUS_LEVEL).is_named(&args.register)
                && servos.ping(id).is_ok() =>
        {
            Item::of_register(&ct::STATUS_LEVEL)
        }
        items => row(&items?, &args.register)?,
    };
    if item.access == Access::Read {
        return Err(Error::usage(
            format!("`{}` can only be read", item.name),
            "the servo measures it",
        ));
    }
    if !(item.min..=item.max).contains(&code) {
        return Err(Error::usage(
            format!("{code} is no code of `{}`", item.name),
            format!("give {} to {}", item.min, item.max),
        ));
    }
    let before = match servos.code(id, &item) {
        Err(ServoError::NoResponse { .. }) if item.name == ct::STATUS_LEVEL.name => None,
        before => Some(before?),
    };
    servos.set_code(id, &item, code)?;
    let name = item.name;
    let data = json!({ "id": id, "register": name, "before": before, "code": code });
    console.result(&data, || {
        let before = before.map_or("?".to_string(), |code| code.to_string());
        format!("servo {id}: {name} {before} -> {code}")
    })?;
    Ok(ExitStatus::Done)
}

/// A code of a servo of Protocol 2.0 in words.
fn x_meaning(item: &Item, code: i32, si: Option<(f64, &str)>) -> String {
    let of_bits = |code| {
        x::hardware_errors(code as u8)
            .collect::<Vec<_>>()
            .join(", ")
    };
    match (*item, si) {
        (x::PROFILE_VELOCITY | x::PROFILE_ACCELERATION, _) if code == 0 => "no limit".to_string(),
        (x::BUS_WATCHDOG, _) if code == 0 => "off".to_string(),
        (x::BUS_WATCHDOG, _) if code < 0 => "tripped: write 0 to clear it".to_string(),
        (_, Some((angle_rad, "rad"))) => format!("{:.1} deg", angle_rad.to_degrees()),
        (_, Some((value, "degC"))) => format!("{value:.0} C"),
        (_, Some((share, "of full output"))) => format!("{:.1} % of full output", share * 100.0),
        (x::RETURN_DELAY, Some((value_s, _))) => format!("{:.0} us", value_s * 1e6),
        (_, Some((value, unit))) => format!("{value:.3} {unit}"),
        (x::BAUD, _) => x::baud_of(code as u8).map_or(String::new(), |b| format!("{b} baud")),
        (x::SHUTDOWN | x::HARDWARE_ERROR, _) => of_bits(code),
        (x::OPERATING_MODE, _) => match code {
            0 => "current",
            1 => "velocity",
            3 => "position",
            4 => "extended position",
            5 => "current-based position",
            16 => "PWM",
            _ => "",
        }
        .to_string(),
        (x::STATUS_LEVEL, _) => level(code),
        _ => String::new(),
    }
}

fn level(code: i32) -> String {
    let words = ["answers PING only", "answers reading", "answers all"];
    let word = usize::try_from(code).ok().and_then(|code| words.get(code));
    word.unwrap_or(&"").to_string()
}

/// A code of a servo of Protocol 1.0 in words.
fn meaning(register: Register, code: i32, servo: &OneServo) -> String {
    const NONE: &str = "no code that it can have";
    let word = code as u16;
    match register {
        ct::GOAL_POSITION | ct::PRESENT_POSITION => {
            let angle = servo.angle_rad(word);
            angle.map_or(NONE.to_string(), |rad| {
                format!("{:.1} deg", rad.to_degrees())
            })
        }
        ct::CW_LIMIT | ct::CCW_LIMIT => match servo.mode {
            OneMode::Wheel => "wheel mode".to_string(),
            OneMode::MultiTurn => "multi-turn mode".to_string(),
            OneMode::Joint => format!("{:.1} deg", servo.angle_of(code).to_degrees()),
        },
        ct::MOVING_SPEED if code == 0 => "no limit".to_string(),
        ct::MOVING_SPEED | ct::PRESENT_SPEED => {
            let speed = servo.speed_rad_s(word);
            let magnitude = |w: f64| {
                if register == ct::MOVING_SPEED {
                    w.abs()
                } else {
                    w
                }
            };
            speed.map_or(NONE.to_string(), |w| format!("{:.2} rad/s", magnitude(w)))
        }
        ct::PRESENT_LOAD => servo.load(word).map_or(NONE.to_string(), |share| {
            format!("{:.0} % of full output", share * 100.0)
        }),
        ct::PRESENT_SUPPLY | ct::MIN_SUPPLY | ct::MAX_SUPPLY => {
            format!("{:.1} V", f64::from(code) * 0.1)
        }
        ct::PRESENT_TEMPERATURE | ct::MAX_TEMPERATURE => format!("{code} C"),
        ct::RETURN_DELAY => format!("{} us", 2 * code),
        ct::BAUD => format!("{} baud", servo.model.baud_of(code as u8)),
        ct::MAX_TORQUE | ct::TORQUE_LIMIT => format!("{:.0} %", f64::from(code) / 10.23),
        ct::STATUS_LEVEL => level(code),
        ct::MODEL => servo.model.name.to_string(),
        _ => String::new(),
    }
}
