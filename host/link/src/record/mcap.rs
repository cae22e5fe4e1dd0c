//! Recordings as MCAP: `/joint_states` and `/joint_goals` (ROS 2 `sensor_msgs/msg/JointState`;
//! `effort` is the load as a share of full output), `/imu` (`sensor_msgs/msg/Imu`: the gyro's rate,
//! where its zero and scale are known), and `/servo_health` (JSON: supply, temperature, error bits,
//! the gyro's code and zero). What a servo did not say is NaN or null.

use super::recorder::Writer;
use super::sample::{GyroSample, RobotSample, ServoSample};
use crate::error::{Error, Place, Result};
use crate::log::cdr::{IMU_NAME, IMU_SCHEMA, ImuMessage, JointStateMessage, NAME, SCHEMA};
use crate::log::mcap_messages::{McapEnd, messages};
use ::mcap::records::MessageHeader;
use ::mcap::{McapError, WriteOptions};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

const STATES: &str = "/joint_states";
const GOALS: &str = "/joint_goals";
const IMU: &str = "/imu";
const HEALTH: &str = "/servo_health";
const HEALTH_SCHEMA: &str = r#"{"type":"object","properties":{"supply_v":{"type":"array","items":{"type":["number","null"]}},"temperature_celsius":{"type":"array","items":{"type":["number","null"]}},"error":{"type":"array","items":{"type":["number","null"]}},"current_a":{"type":"array","items":{"type":["number","null"]}},"gyro_code":{"type":["number","null"]},"gyro_zero":{"type":["number","null"]},"torque_on":{"type":["boolean","null"]}}}"#;

/// Health of all servos, as JSON.
#[derive(Debug, Default, serde::Serialize, serde::Deserialize)]
struct Health {
    supply_v: Vec<Option<f64>>,
    temperature_celsius: Vec<Option<f64>>,
    error: Vec<Option<u8>>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    current_a: Vec<Option<f64>>,
    #[serde(default)]
    gyro_code: Option<f64>,
    #[serde(default)]
    gyro_zero: Option<f64>,
    #[serde(default)]
    torque_on: Option<bool>,
}

/// Writes chunks of about half a second, each with its own check.
pub(super) struct McapWriter {
    writer: ::mcap::Writer<BufWriter<File>>,
    names: Vec<String>,
    states: u16,
    goals: u16,
    health: u16,
    /// Once there is a rate.
    imu: Option<u16>,
    count: u32,
    begun_ns: u64,
}

fn broken(error: McapError) -> std::io::Error {
    match error {
        McapError::Io(error) => error,
        other => std::io::Error::other(other),
    }
}

impl McapWriter {
    /// Writes schemas and channels.
    pub fn new(file: File, ids: &[u8]) -> std::io::Result<Self> {
        let options = WriteOptions::new().compression(None).library("handstand");
        let mut writer = options.create(BufWriter::new(file)).map_err(broken)?;
        let none = BTreeMap::new();
        let state = writer
            .add_schema(NAME, "ros2msg", SCHEMA.as_bytes())
            .map_err(broken)?;
        let health = writer
            .add_schema(
                "handstand.ServoHealth",
                "jsonschema",
                HEALTH_SCHEMA.as_bytes(),
            )
            .map_err(broken)?;
        let since_epoch = std::time::SystemTime::now()
            .duration_since(std::time::UNIX_EPOCH)
            .unwrap_or_default();
        let mut writer = McapWriter {
            states: writer
                .add_channel(state, STATES, "cdr", &none)
                .map_err(broken)?,
            goals: writer
                .add_channel(state, GOALS, "cdr", &none)
                .map_err(broken)?,
            health: writer
                .add_channel(health, HEALTH, "json", &none)
                .map_err(broken)?,
            writer,
            imu: None,
            names: ids.iter().map(|id| format!("servo{id}")).collect(),
            count: 0,
            begun_ns: u64::try_from(since_epoch.as_nanos()).unwrap_or(0),
        };
        writer.flush()?;
        Ok(writer)
    }

    /// The channel of rates; made for the first of them.
    fn imu(&mut self) -> std::io::Result<u16> {
        if let Some(channel) = self.imu {
            return Ok(channel);
        }
        let schema = self
            .writer
            .add_schema(IMU_NAME, "ros2msg", IMU_SCHEMA.as_bytes());
        let schema = schema.map_err(broken)?;
        let channel = self
            .writer
            .add_channel(schema, IMU, "cdr", &BTreeMap::new());
        let channel = channel.map_err(broken)?;
        self.imu = Some(channel);
        Ok(channel)
    }

    fn put(&mut self, channel_id: u16, time_ns: u64, bytes: &[u8]) -> std::io::Result<()> {
        let header = MessageHeader {
            channel_id,
            sequence: self.count,
            log_time: time_ns,
            publish_time: time_ns,
        };
        self.writer
            .write_to_known_channel(&header, bytes)
            .map_err(broken)
    }
}

impl Writer for McapWriter {
    fn write(&mut self, sample: &RobotSample) -> std::io::Result<()> {
        let time_ns = self.begun_ns + (sample.time_s * 1e9) as u64;
        let all = |value: fn(&ServoSample) -> Option<f64>| {
            sample
                .joints
                .iter()
                .map(|joint| value(joint).unwrap_or(f64::NAN))
                .collect()
        };
        let state = JointStateMessage {
            stamp_ns: time_ns,
            name: self.names.clone(),
            position: all(|joint| joint.position_rad),
            velocity: all(|joint| joint.speed_rad_s),
            effort: all(|joint| joint.load),
        };
        self.put(self.states, time_ns, &state.to_bytes())?;
        if sample.joints.iter().any(|joint| joint.goal_rad.is_some()) {
            let goals = JointStateMessage {
                position: all(|joint| joint.goal_rad),
                velocity: Vec::new(),
                effort: Vec::new(),
                ..state
            };
            self.put(self.goals, time_ns, &goals.to_bytes())?;
        }
        if let Some(rate_rad_s) = sample.gyro.and_then(|gyro| gyro.rate_rad_s) {
            let imu = ImuMessage {
                stamp_ns: time_ns,
                rate_rad_s,
            };
            let channel = self.imu()?;
            self.put(channel, time_ns, &imu.to_bytes())?;
        }
        let each =
            |value: fn(&ServoSample) -> Option<f64>| sample.joints.iter().map(value).collect();
        let health = Health {
            gyro_code: sample.gyro.map(|gyro| gyro.code),
            gyro_zero: sample.gyro.and_then(|gyro| gyro.zero),
            torque_on: sample.torque_on,
            supply_v: each(|joint| joint.supply_v),
            temperature_celsius: each(|joint| joint.temperature_celsius),
            error: sample.joints.iter().map(|joint| joint.error).collect(),
            current_a: sample.currents(),
        };
        self.put(self.health, time_ns, &serde_json::to_vec(&health)?)?;
        self.count = self.count.wrapping_add(1);
        Ok(())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.writer.flush().map_err(broken)
    }

    fn finish(&mut self) -> std::io::Result<()> {
        self.writer.finish().map(|_| ()).map_err(broken)
    }
}

/// Ids, samples, and whether a torn tail was dropped.
pub(super) fn read(bytes: &[u8], path: &Path) -> Result<(Vec<u8>, Vec<RobotSample>, bool)> {
    let refused = |what: String| {
        Error::data(
            Place::file(path),
            what,
            "give a file that `handstand record` wrote",
        )
    };
    if !bytes.starts_with(::mcap::MAGIC) {
        return Err(refused("not an MCAP file".to_string()));
    }
    let (mut ids, mut samples) = (Vec::new(), Vec::<RobotSample>::new());
    let mut begun_ns = None;
    let end = messages(bytes, |message| {
        let time_ns = message.log_time_ns;
        let begun_ns = *begun_ns.get_or_insert(time_ns);
        match message.topic {
            STATES => {
                let state = JointStateMessage::of(message.data)
                    .ok_or_else(|| refused(format!("{STATES}: no joint states")))?;
                let servos: Vec<u8> = (state.name.iter())
                    .filter_map(|name| name.strip_prefix("servo")?.parse().ok())
                    .collect();
                let changed = !samples.is_empty() && servos != ids;
                if changed || servos.len() != state.name.len() {
                    let what = format!("{STATES}: the joints are not the same servos throughout");
                    return Err(refused(what));
                }
                ids = servos;
                let time_s = (time_ns - begun_ns.min(time_ns)) as f64 * 1e-9;
                samples.push(sample(&state, time_s));
            }
            GOALS => {
                let goals = JointStateMessage::of(message.data)
                    .ok_or_else(|| refused(format!("{GOALS}: no joint states")))?;
                for (joint, goal) in newest(&mut samples).iter_mut().zip(goals.position) {
                    joint.goal_rad = said(goal);
                }
            }
            IMU => {
                let imu = ImuMessage::of(message.data)
                    .ok_or_else(|| refused(format!("{IMU}: no measurement of a gyro")))?;
                if let Some(sample) = samples.last_mut() {
                    sample.gyro.get_or_insert_default().rate_rad_s = said(imu.rate_rad_s);
                }
            }
            HEALTH => {
                let health: Health = serde_json::from_slice(message.data)
                    .map_err(|error| refused(format!("{HEALTH}: {error}")))?;
                add_health(&health, &mut samples);
            }
            _ => {}
        }
        Ok(())
    });
    // What lies before the chunk that was being written when the program died is whole.
    Ok((ids, samples, end? != McapEnd::Complete))
}

/// Adds what the board and its servos say of themselves to the newest sample.
fn add_health(health: &Health, samples: &mut [RobotSample]) {
    if let Some(sample) = samples.last_mut() {
        let rate_rad_s = sample.gyro.and_then(|gyro| gyro.rate_rad_s);
        let values = [health.gyro_code, health.gyro_zero, rate_rad_s];
        sample.gyro = GyroSample::of(values);
        sample.torque_on = health.torque_on;
        sample.has_current = !health.current_a.is_empty();
    }
    for (at, joint) in newest(samples).iter_mut().enumerate() {
        joint.supply_v = health.supply_v.get(at).copied().flatten();
        joint.temperature_celsius = health.temperature_celsius.get(at).copied().flatten();
        joint.error = health.error.get(at).copied().flatten();
        joint.current_a = health.current_a.get(at).copied().flatten();
    }
}

/// Joints of the newest sample; none before the first.
fn newest(samples: &mut [RobotSample]) -> &mut [ServoSample] {
    samples
        .last_mut()
        .map_or(&mut [][..], |sample| &mut sample.joints)
}

fn said(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

fn sample(state: &JointStateMessage, time_s: f64) -> RobotSample {
    let at = |values: &[f64], place: usize| values.get(place).copied().and_then(said);
    let joints = (0..state.name.len()).map(|place| ServoSample {
        position_rad: at(&state.position, place),
        speed_rad_s: at(&state.velocity, place),
        load: at(&state.effort, place),
        ..ServoSample::default()
    });
    RobotSample {
        time_s,
        joints: joints.collect(),
        gyro: None,
        torque_on: None,
        has_current: false,
    }
}
