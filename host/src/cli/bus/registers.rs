//! `bus read`, `bus write`: single registers.

use crate::cli::{ExitStatus, Talk, port::Port, show::table_of};
use handstand::model::suggest::suggest;
use handstand::output::table::{TableColumn, or_empty};
use handstand::{Error, Result};
use handstand_shared::control_table::{self as ct, Access, REGISTERS, Register};
use handstand_shared::raw::{MovingSpeed, Position, Signed};
use serde::Serialize;
use serde_json::json;

/// Read registers of a servo.
#[derive(Debug, clap::Args)]
pub struct ReadArgs {
    /// Id of the servo
    id: u8,
    /// Registers by name or address; all without
    #[arg(value_parser = register)]
    registers: Vec<Register>,
    #[command(flatten)]
    port: Port,
}

/// Write a register of a servo.
#[derive(Debug, clap::Args)]
pub struct WriteArgs {
    /// Id of the servo
    id: u8,
    /// Register by name or address
    #[arg(value_parser = register)]
    register: Register,
    /// Its new code
    code: u16,
    #[command(flatten)]
    port: Port,
}

/// What a register of a servo holds.
#[derive(Serialize)]
struct RegisterContent {
    address: u8,
    register: &'static str,
    code: u16,
    means: String,
    #[serde(skip)]
    default: Option<u16>,
}

/// A register by name, however spelt, or by address.
pub fn register(text: &str) -> Result<Register, String> {
    let found = match text.parse() {
        Ok(address) => Register::at(address),
        Err(_) => Register::named(text),
    };
    found.copied().ok_or_else(|| {
        let names: Vec<&str> = REGISTERS.iter().map(|r| r.name).collect();
        format!("no such register; {}", suggest(text, &names))
    })
}

/// Reads, shows.
pub fn read(args: &ReadArgs, talk: &Talk) -> Result<ExitStatus> {
    let mut servos = args.port.servos()?;
    let wanted = if args.registers.is_empty() {
        REGISTERS
    } else {
        &args.registers
    };
    let mut contents = Vec::new();
    for register in wanted {
        let code = servos.get(args.id, *register)?;
        contents.push(RegisterContent {
            address: register.address,
            register: register.name,
            code,
            means: meaning(*register, code),
            default: (register.access == Access::Write).then_some(register.default),
        });
    }
    talk.result(&contents, || {
        let columns: &[TableColumn<RegisterContent>] = &[
            ("Address", &|c| c.address.to_string()),
            ("Register", &|c| c.register.to_string()),
            ("Code", &|c| c.code.to_string()),
            ("Means", &|c| c.means.clone()),
            ("Default", &|c| or_empty(c.default)),
        ];
        table_of(&contents, columns).to_string()
    })?;
    Ok(ExitStatus::Done)
}

/// Writes, reads back, shows.
pub fn write(args: &WriteArgs, talk: &Talk) -> Result<ExitStatus> {
    let WriteArgs {
        id, register, code, ..
    } = args;
    if register.access == Access::Read {
        return Err(Error::usage(
            format!("`{}` can only be read", register.name),
            "the servo measures it",
        ));
    }
    if !(register.min..=register.max).contains(code) {
        return Err(Error::usage(
            format!("{code} is no code of `{}`", register.name),
            format!("give {} to {}", register.min, register.max),
        ));
    }
    let mut servos = args.port.servos()?;
    let before = servos.get(*id, *register)?;
    servos.set(*id, *register, *code)?;
    let name = register.name;
    let data = json!({ "id": id, "register": name, "before": before, "code": code });
    talk.result(&data, || format!("servo {id}: {name} {before} -> {code}"))?;
    Ok(ExitStatus::Done)
}

/// A code in words.
pub fn meaning(register: Register, code: u16) -> String {
    let speed = |code: u16| {
        format!(
            "{:.2} rad/s",
            f64::from(Signed(code).get()) * Signed::SPEED_LSB_RAD_S
        )
    };
    match register {
        ct::GOAL_POSITION | ct::PRESENT_POSITION | ct::CW_LIMIT | ct::CCW_LIMIT => {
            format!("{:.1} deg", Position(code).to_rad().to_degrees())
        }
        ct::MOVING_SPEED if code == 0 => "no limit".to_string(),
        ct::MOVING_SPEED => format!("{:.2} rad/s", MovingSpeed(code & 0x3ff).to_rad_s()),
        ct::PRESENT_SPEED => speed(code),
        ct::PRESENT_LOAD => format!(
            "{:.0} % of full output",
            f64::from(Signed(code).get()) * Signed::OUTPUT_LSB * 100.0
        ),
        ct::PRESENT_SUPPLY | ct::MIN_SUPPLY | ct::MAX_SUPPLY => {
            format!("{:.1} V", f64::from(code) * 0.1)
        }
        ct::PRESENT_TEMPERATURE | ct::MAX_TEMPERATURE => format!("{code} C"),
        ct::RETURN_DELAY => format!("{} us", 2 * code),
        ct::BAUD => format!("{} baud", ct::baud_of(code as u8)),
        ct::MAX_TORQUE | ct::TORQUE_LIMIT => format!("{:.0} %", f64::from(code) / 10.23),
        ct::STATUS_LEVEL => ["answers PING only", "answers reading", "answers all"]
            .get(usize::from(code))
            .unwrap_or(&"")
            .to_string(),
        _ => String::new(),
    }
}
