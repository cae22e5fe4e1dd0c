//! `bus monitor`: rounds of readings, until Ctrl-C or `--rounds`. Nothing is written to the servos.

use super::scan::degrees;
use crate::cli::port::{AnyLink, DEFAULT_IDS, Ids, Port, chosen, id_list};
use crate::cli::show::{or_dash, table_of};
use crate::cli::{Console, ExitStatus, interrupt::Interrupt};
use handstand::Result;
use handstand::link::record::ServoSample;
use handstand::link::{Protocol, ServoError, ServoResult, Servos};
use handstand::report::table::columns_of;
use handstand_shared::control_table::PRESENT_POSITION;
use serde::Serialize;
use std::time::Duration;

/// Watch servos.
#[derive(Debug, clap::Args)]
pub struct MonitorArgs {
    #[command(flatten)]
    port: Port,
    /// Servos to watch; those of 1-18 that answer without
    #[arg(long, value_parser = id_list)]
    ids: Option<Ids>,
    /// Rounds to watch; until Ctrl-C without
    #[arg(long)]
    rounds: Option<u64>,
    /// Seconds between rounds
    #[arg(long, default_value_t = 1.0)]
    every: f64,
}

#[derive(Debug, Default, Serialize)]
struct ServoReading {
    id: u8,
    position_rad: Option<f64>,
    speed_rad_s: Option<f64>,
    load_share: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    current_a: Option<f64>,
    supply_v: Option<f64>,
    temperature_celsius: Option<u8>,
    error_flags: Vec<&'static str>,
}

#[derive(Debug, Serialize)]
struct MonitorRound {
    time_s: f64,
    servos: Vec<ServoReading>,
}

/// Reads and shows round by round. With `--json` all rounds at the end.
pub fn run(args: &MonitorArgs, console: &Console) -> Result<ExitStatus> {
    let every = Duration::try_from_secs_f64(args.every).unwrap_or(Duration::from_secs(1));
    let interrupt = Interrupt::listen();
    let mut servos = args.port.servos()?;
    let ids = chosen(
        args.ids.as_ref(),
        || Ok(servos.answering(&DEFAULT_IDS)?),
        console,
    )?;
    let mut rounds = Vec::new();
    for round in 0.. {
        if interrupt.has_come() || args.rounds.is_some_and(|most| round >= most) {
            break;
        }
        let time_s = servos.link().now().as_secs_f64();
        let mut seen = Vec::new();
        for id in &ids {
            seen.push(match ServoReading::ask(&mut servos, *id) {
                Ok(reading) => reading,
                Err(error) => {
                    let flag = match error.port()? {
                        ServoError::UnknownModel { .. } => "unknown model",
                        ServoError::NoResponse { .. } => "silent",
                        _ => "no sound answer",
                    };
                    ServoReading {
                        id: *id,
                        error_flags: vec![flag],
                        ..ServoReading::default()
                    }
                }
            });
        }
        if console.json {
            rounds.push(MonitorRound {
                time_s,
                servos: seen,
            });
        } else {
            console.print(&format!("{time_s:.2} s\n{}", text(&seen)))?;
        }
        let next = Duration::from_secs_f64(time_s) + every;
        while servos.link().now() < next && !interrupt.has_come() {
            let left = next.saturating_sub(servos.link().now());
            servos.link().pause(left.min(Duration::from_millis(100)));
        }
    }
    if console.json {
        console.data(&rounds)?;
    }
    Ok(ExitStatus::Done)
}

impl ServoReading {
    fn ask(servos: &mut Servos<AnyLink>, id: u8) -> ServoResult<Self> {
        if servos.detect(id)? == Protocol::Two {
            let (joint, errors) = ServoSample::ask(servos, id)?;
            return Ok(Self::of(id, &joint, errors));
        }
        let servo = servos.one_servo(id)?;
        // Registers 36 to 43: position, speed, load, supply, temperature.
        let reading = servos.read(id, u16::from(PRESENT_POSITION.address), 8)?;
        let joint = ServoSample::of_one(&servo, &reading).unwrap_or_default();
        Ok(Self::of(id, &joint, reading.error.names()))
    }

    fn of(id: u8, joint: &ServoSample, error_flags: Vec<&'static str>) -> Self {
        ServoReading {
            id,
            position_rad: joint.position_rad,
            speed_rad_s: joint.speed_rad_s,
            load_share: joint.load,
            current_a: joint.current_a,
            supply_v: joint.supply_v,
            temperature_celsius: joint.temperature_celsius.map(|celsius| celsius as u8),
            error_flags,
        }
    }
}

fn text(seen: &[ServoReading]) -> String {
    let columns = columns_of::<ServoReading>()
        .text("Id", |s| s.id.to_string())
        .text("Position", |s| or_dash(s.position_rad, degrees))
        .text("Speed", |s| {
            or_dash(s.speed_rad_s, |w| format!("{w:.2} rad/s"))
        })
        .text("Load", |s| match s.current_a {
            Some(current_a) => format!("{current_a:.3} A"),
            None => or_dash(s.load_share, |share| format!("{:.0} %", 100.0 * share)),
        })
        .text("Supply", |s| or_dash(s.supply_v, |v| format!("{v:.1} V")))
        .text("Temp", |s| {
            or_dash(s.temperature_celsius, |t| format!("{t} C"))
        })
        .text("Error flags", |s| s.error_flags.join(", "));
    table_of(seen, &columns).to_string()
}
