//! MCAP: joint states as ROS 2 records them, and recordings of `handstand record`.
//!
//! Chunks may be compressed by lz4 or zstd. A torn file is read as far as it is whole.

use super::joint_states::JointStates;
use super::{LogTable, TableFile};
use crate::cdr::{IMU_NAME, ImuMessage, JointStateMessage, NAME};
use crate::error::Result;
use crate::mcap_messages::{McapEnd, McapMessage, messages};
use ::mcap::MAGIC;

/// Health of servos, in recordings of `handstand record`.
const HEALTH: &str = "handstand.ServoHealth";
/// Begin of the names of its joints.
const SERVO: &str = "servo";

#[derive(Default)]
struct Messages {
    states: JointStates,
    /// Rates of gyros, rad/s, with their time, ns; none where a message is broken. Whose they are
    /// is known at the end.
    rates: Vec<(u64, Option<f64>)>,
    /// Whether `handstand record` wrote it.
    is_own: bool,
}

pub(super) fn read(bytes: &[u8], file: TableFile) -> Result<LogTable> {
    let remedy = "give an MCAP file with joint states of ROS 2, or of `handstand record`";
    if !bytes.starts_with(MAGIC) {
        return Err(file.wrong("not an MCAP file", remedy));
    }
    let mut taken = Messages::default();
    let end = messages(bytes, |message| taken.take(message, file))?;
    match end {
        // What lies before the chunk that was being written when the recorder died is whole.
        McapEnd::Complete | McapEnd::Torn => {}
        McapEnd::Broken(why) => {
            let remedy = "record it again, or repair it: mcap recover";
            return Err(file.wrong(format!("a chunk is broken: {why}"), remedy));
        }
        McapEnd::Unknown(packing) => {
            let remedy = "write it uncompressed, or with lz4 or zstd: mcap compress";
            let what = format!("chunks are compressed by {packing:?}");
            return Err(file.wrong(what, remedy));
        }
    }
    let is_own = taken.is_own;
    for (stamp_ns, rate_rad_s) in taken.rates.into_iter().filter(|_| is_own) {
        let broken = || file.wrong("a measurement of the gyro is broken", "record it again");
        let rate_rad_s = rate_rad_s.ok_or_else(broken)?;
        taken
            .states
            .sample("gyro_rad_s".into(), stamp_ns, rate_rad_s);
    }
    let is_torn = end == McapEnd::Torn;
    if is_torn && taken.states.is_empty() {
        let what = "the file is broken off before its first chunk of joint states is whole";
        return Err(file.wrong(what, "record it again"));
    }
    let mut table = taken.states.table(file)?;
    table.warning = is_torn.then_some((
        "the file is broken off; what was recorded last is not in it",
        "what is whole is used; `mcap recover` makes a whole file of it",
    ));
    if is_own {
        table
            .names
            .iter_mut()
            .for_each(|name| *name = as_recorded(name));
    }
    Ok(table)
}

impl Messages {
    fn take(&mut self, message: McapMessage, file: TableFile) -> Result<()> {
        let McapMessage {
            topic, log_time_ns, ..
        } = message;
        let broken = || {
            let what = format!("{topic}: message {} is broken", message.sequence);
            file.wrong(what, "record it again")
        };
        match (message.schema, message.encoding) {
            (NAME, "cdr") => {
                let state = JointStateMessage::of(message.data).ok_or_else(broken)?;
                self.states.take(topic, log_time_ns, &state, file)?;
            }
            (IMU_NAME, "cdr") => {
                let imu = ImuMessage::of(message.data);
                self.rates
                    .push((log_time_ns, imu.map(|imu| imu.rate_rad_s)));
            }
            (HEALTH, "json") => {
                self.is_own = true;
                let health: serde_json::Value =
                    serde_json::from_slice(message.data).map_err(|_| broken())?;
                self.health(&health, log_time_ns);
            }
            _ => {}
        }
        Ok(())
    }

    /// Supply, temperature and errors of each servo, in the order of the joints.
    fn health(&mut self, health: &serde_json::Value, stamp_ns: u64) {
        for quantity in ["supply_v", "temperature_celsius", "error"] {
            let values = health.get(quantity).and_then(serde_json::Value::as_array);
            for (place, value) in values.into_iter().flatten().enumerate().take(254) {
                let name = format!("{HEALTH}/{place}.{quantity}");
                self.states
                    .sample(name, stamp_ns, value.as_f64().unwrap_or(f64::NAN));
            }
        }
        if let Some(on) = health.get("torque_on").and_then(serde_json::Value::as_bool) {
            self.states
                .sample("torque_on".into(), stamp_ns, f64::from(u8::from(on)));
        }
    }
}

/// A column's name as in a CSV recording: `q3_rad` for `servo3.position`.
fn as_recorded(name: &str) -> String {
    let (topic, column) = name.rsplit_once('/').unwrap_or(("", name));
    let parts = column.rsplit_once('.');
    let servo = |joint: &str| joint.strip_prefix(SERVO).map(str::to_string);
    match parts.and_then(|(joint, quantity)| Some((servo(joint)?, quantity))) {
        Some((id, "position")) if topic == "joint_goals" => format!("goal{id}_rad"),
        Some((id, "position")) => format!("q{id}_rad"),
        Some((id, "velocity")) => format!("dq{id}_rad_s"),
        Some((id, "effort")) => format!("load{id}"),
        _ => name.to_string(),
    }
}
