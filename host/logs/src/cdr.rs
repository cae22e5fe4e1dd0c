//! `sensor_msgs/msg/JointState` and `Imu` as ROS 2 serialises them: CDR, little endian (OMG
//! DDS-XTypes 1.3, XCDR1).

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

impl JointStateMessage {
    /// The bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut out = HEADER.to_vec();
        // Seconds beyond 2038 do not fit the message's type.
        let second = i32::try_from(self.stamp_ns / 1_000_000_000).unwrap_or(i32::MAX);
        out.extend(second.to_le_bytes());
        out.extend(((self.stamp_ns % 1_000_000_000) as u32).to_le_bytes());
        put_text(&mut out, "");
        put_length(&mut out, self.name.len());
        self.name.iter().for_each(|name| put_text(&mut out, name));
        for values in [&self.position, &self.velocity, &self.effort] {
            put_length(&mut out, values.len());
            for value in values {
                align(&mut out, 8);
                out.extend(value.to_le_bytes());
            }
        }
        out
    }

    /// Reads the bytes; none if they are no such message.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let mut reader = CdrReader::new(bytes)?;
        let second = u64::from(i32::try_from(reader.length()?).ok()?.unsigned_abs());
        let nanosecond = u64::from(reader.length()?);
        reader.text()?;
        let names = reader.length()?;
        let name = (0..names).map(|_| reader.text()).collect::<Option<_>>()?;
        Some(JointStateMessage {
            stamp_ns: second * 1_000_000_000 + nanosecond,
            name,
            position: reader.numbers()?,
            velocity: reader.numbers()?,
            effort: reader.numbers()?,
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

/// Numbers of an Imu: orientation, rate and acceleration, each with a covariance behind it.
const IMU_NUMBERS: usize = 4 + 9 + 3 + 9 + 3 + 9;
const IMU_RATE: usize = 4 + 9 + 1;

impl ImuMessage {
    /// The bytes.
    pub fn to_bytes(self) -> Vec<u8> {
        let mut numbers = [0.0f64; IMU_NUMBERS];
        (numbers[3], numbers[4]) = (1.0, -1.0);
        numbers[IMU_RATE] = self.rate_rad_s;
        numbers[IMU_NUMBERS - 9] = -1.0;
        let mut out = HEADER.to_vec();
        let second = i32::try_from(self.stamp_ns / 1_000_000_000).unwrap_or(i32::MAX);
        out.extend(second.to_le_bytes());
        out.extend(((self.stamp_ns % 1_000_000_000) as u32).to_le_bytes());
        put_text(&mut out, IMU_FRAME);
        align(&mut out, 8);
        numbers
            .iter()
            .for_each(|number| out.extend(number.to_le_bytes()));
        out
    }

    /// Reads the bytes; none if they are no such message.
    pub fn of(bytes: &[u8]) -> Option<Self> {
        let mut reader = CdrReader::new(bytes)?;
        let second = u64::from(i32::try_from(reader.length()?).ok()?.unsigned_abs());
        let nanosecond = u64::from(reader.length()?);
        reader.text()?;
        let numbers: Option<Vec<f64>> = (0..IMU_NUMBERS).map(|_| reader.number()).collect();
        Some(ImuMessage {
            stamp_ns: second * 1_000_000_000 + nanosecond,
            rate_rad_s: *numbers?.get(IMU_RATE)?,
        })
    }
}

fn align(out: &mut Vec<u8>, to: usize) {
    let after = out.len() - HEADER.len();
    out.resize(HEADER.len() + after.next_multiple_of(to), 0);
}

fn put_length(out: &mut Vec<u8>, length: usize) {
    align(out, 4);
    out.extend((length as u32).to_le_bytes());
}

fn put_text(out: &mut Vec<u8>, text: &str) {
    put_length(out, text.len() + 1);
    out.extend(text.as_bytes());
    out.push(0);
}

struct CdrReader<'a> {
    bytes: &'a [u8],
    at: usize,
    big_endian: bool,
}

impl<'a> CdrReader<'a> {
    /// Behind the header: XCDR1 in either byte order, whatever its options.
    fn new(bytes: &'a [u8]) -> Option<Self> {
        let big_endian = match bytes.get(..HEADER.len())? {
            [0, 0, ..] => true,
            [0, 1, ..] => false,
            _ => return None,
        };
        Some(CdrReader {
            bytes,
            at: HEADER.len(),
            big_endian,
        })
    }

    fn take<const N: usize>(&mut self, align: usize) -> Option<[u8; N]> {
        self.at = (self.at - HEADER.len()).next_multiple_of(align) + HEADER.len();
        let bytes = self.bytes.get(self.at..self.at + N)?;
        self.at += N;
        let mut bytes: [u8; N] = bytes.try_into().ok()?;
        if self.big_endian {
            bytes.reverse();
        }
        Some(bytes)
    }

    fn length(&mut self) -> Option<u32> {
        self.take(4).map(u32::from_le_bytes)
    }

    fn number(&mut self) -> Option<f64> {
        self.take(8).map(f64::from_le_bytes)
    }

    fn text(&mut self) -> Option<String> {
        let length = self.length()? as usize;
        let end = self.at.checked_add(length)?;
        let bytes = self.bytes.get(self.at..end)?;
        self.at = end;
        String::from_utf8(bytes.strip_suffix(&[0])?.to_vec()).ok()
    }

    fn numbers(&mut self) -> Option<Vec<f64>> {
        let count = self.length()?;
        (0..count).map(|_| self.number()).collect()
    }
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
