//! MCAP: joint states as ROS 2 records them, and recordings of `handstand record`.
//!
//! Chunks may be compressed by lz4 or zstd. A torn file is read as far as it is whole.

use super::joint_states::JointStates;
use super::{LogTable, TableFile};
use crate::error::Result;
use crate::log::cdr::{IMU_NAME, ImuMessage, JointStateMessage, NAME};
use ::mcap::read::LinearReader;
use ::mcap::records::Record;
use ::mcap::{MAGIC, read::Options};
use std::borrow::Cow;
use std::collections::HashMap;
use std::io::Read as _;

/// Largest chunk, bytes; recorders write some MB.
const LARGEST_CHUNK: u64 = 1 << 30;
/// Health of servos, in recordings of `handstand record`.
const HEALTH: &str = "handstand.ServoHealth";
/// Begin of the names of its joints.
const SERVO: &str = "servo";

/// What a channel carries.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Carried {
    States,
    Imu,
    Health,
}

#[derive(Default)]
struct Messages {
    schemas: HashMap<u16, String>,
    channels: HashMap<u16, (String, Carried)>,
    states: JointStates,
    /// Whether `handstand record` wrote it.
    is_own: bool,
}

pub(super) fn read(bytes: &[u8], file: TableFile) -> Result<LogTable> {
    let remedy = "give an MCAP file with joint states of ROS 2, or of `handstand record`";
    if !bytes.starts_with(MAGIC) {
        return Err(file.wrong("not an MCAP file", remedy));
    }
    let records = LinearReader::new_with_options(bytes, Options::IgnoreEndMagic.into());
    let records = records.map_err(|error| file.wrong(error.to_string(), remedy))?;
    let mut messages = Messages::default();
    for record in records {
        match record {
            Ok(Record::Chunk { header, data }) => {
                let plain = plain(&header.compression, header.uncompressed_size, &data, file)?;
                for record in LinearReader::sans_magic(&plain).map_while(|record| record.ok()) {
                    messages.take(record, file)?;
                }
            }
            Ok(record) => messages.take(record, file)?,
            // The chunk that was being written when the recorder died; before it all is whole.
            Err(_) => break,
        }
    }
    let is_own = messages.is_own;
    let mut table = messages.states.table(file)?;
    if is_own {
        table
            .names
            .iter_mut()
            .for_each(|name| *name = as_recorded(name));
    }
    Ok(table)
}

/// A chunk's records.
fn plain<'a>(kind: &str, size: u64, data: &'a [u8], file: TableFile) -> Result<Cow<'a, [u8]>> {
    let broken = |why: &str| {
        file.wrong(
            format!("a chunk is broken: {why}"),
            "record it again, or repair it: mcap recover",
        )
    };
    if size > LARGEST_CHUNK {
        return Err(broken("it says that it is larger than 1 GiB"));
    }
    // A byte more tells a chunk that is longer than it says.
    let mut out = Vec::new();
    let read = match kind {
        "" => return Ok(Cow::Borrowed(data)),
        "lz4" => lz4_flex::frame::FrameDecoder::new(data)
            .take(size + 1)
            .read_to_end(&mut out),
        "zstd" => {
            let decoder = ruzstd::decoding::StreamingDecoder::new(data);
            let decoder = decoder.map_err(|error| broken(&error.to_string()))?;
            decoder.take(size + 1).read_to_end(&mut out)
        }
        other => {
            let remedy = "write it uncompressed, or with lz4 or zstd: mcap compress";
            return Err(file.wrong(format!("chunks are compressed by {other:?}"), remedy));
        }
    };
    read.map_err(|error| broken(&error.to_string()))?;
    match out.len() as u64 == size {
        true => Ok(Cow::Owned(out)),
        false => Err(broken("it is not as long as it says")),
    }
}

impl Messages {
    fn take(&mut self, record: Record, file: TableFile) -> Result<()> {
        match record {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let schema = self
                    .schemas
                    .get(&channel.schema_id)
                    .map_or("", String::as_str);
                let carried = match (schema, channel.message_encoding.as_str()) {
                    (NAME, "cdr") => Carried::States,
                    (IMU_NAME, "cdr") => Carried::Imu,
                    (HEALTH, "json") => Carried::Health,
                    _ => return Ok(()),
                };
                self.is_own |= carried == Carried::Health;
                self.channels.insert(channel.id, (channel.topic, carried));
            }
            Record::Message { header, data } => {
                let Some((topic, carried)) = self.channels.get(&header.channel_id) else {
                    return Ok(());
                };
                let (topic, carried) = (topic.clone(), *carried);
                let broken = || {
                    let what = format!("{topic}: message {} is broken", header.sequence);
                    file.wrong(what, "record it again")
                };
                match carried {
                    Carried::States => {
                        let state = JointStateMessage::of(&data).ok_or_else(broken)?;
                        self.states.take(&topic, header.log_time, &state, file)?;
                    }
                    Carried::Imu if self.is_own => {
                        let imu = ImuMessage::of(&data).ok_or_else(broken)?;
                        self.states
                            .sample("gyro_rad_s".into(), header.log_time, imu.rate_rad_s);
                    }
                    Carried::Imu => {}
                    Carried::Health => {
                        let health: serde_json::Value =
                            serde_json::from_slice(&data).map_err(|_| broken())?;
                        self.health(&health, header.log_time);
                    }
                }
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
