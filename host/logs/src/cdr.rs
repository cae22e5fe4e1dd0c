//! `sensor_msgs/msg/JointState` and `Imu` as ROS 2 serialises them: CDR, little endian (OMG
//! DDS-XTypes 1.3, XCDR1), by the crate `cdr-encoding`: 29 lines fewer than by hand.

use byteorder::{BigEndian, LittleEndian};
use serde::{Deserialize, Serialize};

/// The schema's name.
pub const NAME: &str = "sensor_msgs/msg/JointState";
/// The schema, as ROS 2 writes it into recordings.
pub const SCHEMA: &str = "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n\
================================================================================\nMSG: std_msgs/Header\n\
builtin_interfaces/Time stamp\nstring frame_id\n\
================================================================================\nMSG: builtin_interfaces/Time\n\
int32 sec\nuint32 nanosec\n";

/// Header that says: XCDR1, little endian.
const HEADER: [u8; 4] = [0, 1, 0, 0];

/// A message's content.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct JointStateMessage {
    /// Stamp, ns.
    pub stamp_ns: u64,
    /// Joints.
    pub name: Vec<String>,
    /// Angle of each, rad, or empty.
    pub position: Vec<f64>,
    /// Speed of each, rad/s, or empty.
    pub velocity: Vec<f64>,
    /// Effort of each, or empty.
    pub effort: Vec<f64>,
}

#[derive(Serialize, Deserialize)]
struct Header {
    sec: i32,
    nanosec: u32,
    frame_id: String,
}

impl Header {
    fn of(stamp_ns: u64, frame_id: &str) -> Header {
        Header {
            // Seconds beyond 2038 do not fit the message's type.
            sec: i32::try_from(stamp_ns / 1_000_000_000).unwrap_or(i32::MAX),
            nanosec: (stamp_ns % 1_000_000_000) as u32,
            frame_id: frame_id.to_string(),
        }
    }

    fn stamp_ns(&self) -> Option<u64> {
        let second = u64::try_from(self.sec).ok()?;
        Some(second * 1_000_000_000 + u64::from(self.nanosec))
    }
}

/// The message as its schema says.
#[derive(Serialize, Deserialize)]
struct JointState {
    header: Header,
    name: Vec<String>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

impl JointStateMessage {
    /// The bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let state = self.clone();
        written(&JointState {
            header: Header::of(self.stamp_ns, ""),
            name: state.name,
            position: state.position,
            velocity: state.velocity,
            effort: state.effort,
        })
    }

    /// Reads the bytes; none if they are no such message.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let state: JointState = read(bytes)?;
        Some(JointStateMessage {
            stamp_ns: state.header.stamp_ns()?,
            name: state.name,
            position: state.position,
            velocity: state.velocity,
            effort: state.effort,
        })
    }
}

/// Name of the schema of a gyro's measurements.
pub const IMU_NAME: &str = "sensor_msgs/msg/Imu";
/// The schema, as ROS 2 writes it into recordings.
pub const IMU_SCHEMA: &str = "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n\
float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n\
float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n\
float64[9] linear_acceleration_covariance\n\
================================================================================\nMSG: std_msgs/Header\n\
builtin_interfaces/Time stamp\nstring frame_id\n\
================================================================================\nMSG: builtin_interfaces/Time\n\
int32 sec\nuint32 nanosec\n\
================================================================================\nMSG: geometry_msgs/Quaternion\n\
float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n\
================================================================================\nMSG: geometry_msgs/Vector3\n\
float64 x\nfloat64 y\nfloat64 z\n";
/// The frame a gyro is fixed to.
const IMU_FRAME: &str = "link1";

/// A gyro's measurement: the rate about y, the bar's axis; orientation and acceleration are not
/// measured, which -1 in front of their covariances says.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ImuMessage {
    /// Stamp, ns.
    pub stamp_ns: u64,
    /// Angular rate of the first link, rad/s.
    pub rate_rad_s: f64,
}

/// The message as its schema says.
#[derive(Serialize, Deserialize)]
struct Imu {
    header: Header,
    orientation: [f64; 4],
    orientation_covariance: [f64; 9],
    angular_velocity: [f64; 3],
    angular_velocity_covariance: [f64; 9],
    linear_acceleration: [f64; 3],
    linear_acceleration_covariance: [f64; 9],
}

/// That a quantity is not measured.
const NOT_MEASURED: [f64; 9] = [-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];

impl ImuMessage {
    /// The bytes.
    pub fn to_bytes(self) -> Vec<u8> {
        written(&Imu {
            header: Header::of(self.stamp_ns, IMU_FRAME),
            orientation: [0.0, 0.0, 0.0, 1.0],
            orientation_covariance: NOT_MEASURED,
            angular_velocity: [0.0, self.rate_rad_s, 0.0],
            angular_velocity_covariance: [0.0; 9],
            linear_acceleration: [0.0; 3],
            linear_acceleration_covariance: NOT_MEASURED,
        })
    }

    /// Reads the bytes; none if they are no such message.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let imu: Imu = read(bytes)?;
        Some(ImuMessage {
            stamp_ns: imu.header.stamp_ns()?,
            rate_rad_s: imu.angular_velocity[1],
        })
    }
}

fn written(message: &impl Serialize) -> Vec<u8> {
    let mut out = HEADER.to_vec();
    // Writing to memory does not fail.
    let _ = cdr_encoding::to_writer::<_, LittleEndian, _>(&mut out, message);
    out
}

/// Behind the header: XCDR1 in either byte order, whatever its options.
fn read<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Option<T> {
    let read = match bytes {
        [0, 0, _, _, rest @ ..] => cdr_encoding::from_bytes::<T, BigEndian>(rest),
        [0, 1, _, _, rest @ ..] => cdr_encoding::from_bytes::<T, LittleEndian>(rest),
        _ => return None,
    };
    read.ok().map(|(message, _)| message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_imu_literally() {
        let imu = ImuMessage {
            stamp_ns: 2_000_000_003,
            rate_rad_s: 1.0,
        };
        let bytes = imu.to_bytes();
        #[rustfmt::skip]
        let begin = [
            0, 1, 0, 0,
            2, 0, 0, 0, 3, 0, 0, 0,                            // stamp
            6, 0, 0, 0, b'l', b'i', b'n', b'k', b'1', 0, 0, 0, // frame_id, then padding
            0, 0, 0, 0,
        ];
        assert_eq!(bytes[..28], begin);
        assert_eq!(bytes.len(), 28 + 8 * 37);
        let number = |at: usize| {
            let from = 28 + 8 * at;
            f64::from_le_bytes(bytes[from..from + 8].try_into().unwrap())
        };
        let not_zero: Vec<(usize, f64)> = (0..37)
            .map(|at| (at, number(at)))
            .filter(|(_, number)| *number != 0.0)
            .collect();
        // w of no turn, no orientation, the rate about y, no acceleration.
        assert_eq!(not_zero, [(3, 1.0), (4, -1.0), (14, 1.0), (28, -1.0)]);
        assert_eq!(ImuMessage::of(&bytes), Some(imu));
        assert!((0..bytes.len()).all(|length| ImuMessage::of(&bytes[..length]).is_none()));
    }

    #[test]
    fn damaged_lengths_are_refused_and_reserve_nothing() {
        let begin = [
            &HEADER[..],
            &[2, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0],
        ]
        .concat();
        let most = u32::MAX.to_le_bytes();
        let none = [0; 4];
        for tail in [&[most][..], &[none, most], &[none, none, none, most]] {
            let bytes = [&begin[..], tail.as_flattened()].concat();
            assert_eq!(JointStateMessage::of(&bytes), None);
        }
        let before_1970 = [&HEADER[..], &[0xff; 4], &[0; 24]].concat();
        assert_eq!(JointStateMessage::of(&before_1970), None);
    }

    #[test]
    fn a_message_literally() {
        let state = JointStateMessage {
            stamp_ns: 2_000_000_003,
            name: vec!["a".to_string()],
            position: vec![1.0],
            velocity: vec![],
            effort: vec![-2.0],
        };
        let bytes = state.to_bytes();
        #[rustfmt::skip]
        let expected = [
            0, 1, 0, 0,
            2, 0, 0, 0, 3, 0, 0, 0,                  // stamp
            1, 0, 0, 0, 0, 0, 0, 0,                  // frame_id "", then padding
            1, 0, 0, 0, 2, 0, 0, 0, b'a', 0, 0, 0,   // name
            1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f, // position: 1.0
            0, 0, 0, 0, 1, 0, 0, 0,                  // velocity, effort
            0, 0, 0, 0, 0, 0, 0, 0xc0,               // -2.0
        ];
        assert_eq!(bytes, expected);
        // The same as a big-endian computer writes it.
        #[rustfmt::skip]
        let big_endian = [
            0, 0, 0, 0,
            0, 0, 0, 2, 0, 0, 0, 3,
            0, 0, 0, 1, 0, 0, 0, 0,
            0, 0, 0, 1, 0, 0, 0, 2, b'a', 0, 0, 0,
            0, 0, 0, 1, 0x3f, 0xf0, 0, 0, 0, 0, 0, 0,
            0, 0, 0, 0, 0, 0, 0, 1,
            0xc0, 0, 0, 0, 0, 0, 0, 0,
        ];
        assert_eq!(JointStateMessage::of(&big_endian), Some(state.clone()));
        assert_eq!(JointStateMessage::of(&bytes), Some(state));
        assert!((0..bytes.len()).all(|length| JointStateMessage::of(&bytes[..length]).is_none()));
    }
}
