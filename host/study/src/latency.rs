//! The latency budget: how long a sample takes to become a torque, over the servo bus and the PC's
//! serial line.
//!
//! Every servo is read over the bus, the angles go up the line in a report, the goals come down
//! again, and one SYNC_WRITE takes them to the servos. Frames are the project's own, packets the
//! servos'. What computes takes under 1 ms wherever it is done and is left out; the servo's own
//! dead time, from command to movement, comes on top.

use handstand_shared::control_table::{GOAL_POSITION, PRESENT_POSITION};
use handstand_shared::dynamixel::{BROADCAST, MAX_PACKET, Request};
use handstand_shared::frame::MAX_FRAME;
use handstand_shared::message::{Command, Condition, Report, StreamReport, encode};
use handstand_shared::packed::{Positions, SERVOS};

/// Servos of the joints that balance: shoulder and hip, left and right.
const BALANCING: usize = 4;

/// A byte on the bus, s: ten bits at 1 Mbps.
const BUS_BYTE_S: f64 = 10e-6;

/// From a request to the answer of a servo with return delay 0, s.
const ANSWER_S: f64 = 22e-6;

/// What the factory's return delay adds to an answer, s: 250 steps of 2 us.
const FACTORY_S: f64 = 500e-6;

/// Bytes of a servo's answer besides those that were asked for.
const STATUS_BYTES: usize = 6;

/// From command to movement, s, as published for the AX-12: shortest and longest.
pub const SERVO_DEAD_TIME_S: [f64; 2] = [17e-3, 50e-3];

/// A way from sample to servo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignalPath {
    /// Servos that are read and commanded.
    pub servos: usize,
    /// Baud of the serial line; none if the law runs on the CM-5.
    pub baud: Option<f64>,
    /// Whether the servos have the factory's return delay.
    pub factory: bool,
}

/// The ways there are.
pub const SIGNAL_PATHS: &[SignalPath] = &[
    SignalPath::of(BALANCING, None, false),
    SignalPath::of(SERVOS, None, false),
    SignalPath::of(BALANCING, None, true),
    SignalPath::of(SERVOS, Some(115_200.0), false),
    SignalPath::of(SERVOS, Some(57_600.0), false),
    SignalPath::of(SERVOS, Some(57_600.0), true),
];

impl SignalPath {
    const fn of(servos: usize, baud: Option<f64>, factory: bool) -> Self {
        SignalPath {
            servos,
            baud,
            factory,
        }
    }

    /// Name for people.
    pub fn title(&self) -> String {
        let law = if self.baud.is_some() { "PC" } else { "CM-5" };
        let baud = self
            .baud
            .map_or(String::new(), |baud| format!(", {baud} baud"));
        let delay = if self.factory {
            "factory return delay"
        } else {
            "return delay 0"
        };
        format!("law on the {law}, {} servos{baud}, {delay}", self.servos)
    }

    /// Reading all servos one after the other and commanding them in one packet, s.
    pub fn bus_s(&self) -> f64 {
        let delay_s = if self.factory { FACTORY_S } else { 0.0 };
        self.servos as f64 * (read_s() + delay_s) + write_s(self.servos)
    }

    /// Serial line, report up and goals down, s.
    pub fn line_s(&self) -> f64 {
        let bytes = (report_bytes() + goal_bytes()) as f64;
        self.baud.map_or(0.0, |baud| 10.0 * bytes / baud)
    }

    /// From sample to servo, s.
    pub fn total_s(&self) -> f64 {
        self.bus_s() + self.line_s()
    }
}

/// Reading the position of a servo with return delay 0, s.
fn read_s() -> f64 {
    let count = 2;
    let request = Request::Read {
        address: PRESENT_POSITION.address,
        count,
    };
    let asked = request.emit(1, &mut [0; MAX_PACKET]).unwrap_or(0);
    let bytes = asked + STATUS_BYTES + usize::from(count);
    bytes as f64 * BUS_BYTE_S + ANSWER_S
}

/// Commanding goal and speed of servos in one packet, s.
fn write_s(servos: usize) -> f64 {
    let blocks: Vec<u8> = (1..=servos).flat_map(|id| [id as u8, 0, 2, 0, 0]).collect();
    let request = Request::SyncWrite {
        address: GOAL_POSITION.address,
        width: 4,
        blocks: &blocks,
    };
    let length = request.emit(BROADCAST, &mut [0; MAX_PACKET]).unwrap_or(0);
    length as f64 * BUS_BYTE_S
}

fn report_bytes() -> usize {
    let report = StreamReport {
        tick: 1000,
        condition: Condition::StreamArmed,
        obeyed: 0,
        positions: Positions::pack([512; SERVOS]),
        missing: [0; 3],
        housekeeping_from: 0,
        housekeeping: Default::default(),
        gyro: 0,
    };
    encode(0, &Report::Stream(report), &mut [0; MAX_FRAME]).unwrap_or(MAX_FRAME)
}

fn goal_bytes() -> usize {
    let goals = Command::Goals(Positions::pack([512; SERVOS]));
    encode(0, &goals, &mut [0; MAX_FRAME]).unwrap_or(MAX_FRAME)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A read takes 8 bytes there, 22 us, 8 bytes back.
    #[test]
    fn the_bus_takes_as_long_as_its_bytes() {
        assert!((read_s() - 182e-6).abs() < 1e-12, "{}", read_s());
        assert!((write_s(18) - 98.0 * 10e-6).abs() < 1e-12);
        let delay_s = SIGNAL_PATHS[2].total_s() - SIGNAL_PATHS[0].total_s();
        assert!((delay_s - 4.0 * 500e-6).abs() < 1e-12);
    }

    #[test]
    fn the_signal_paths_take_their_time() {
        let total = SIGNAL_PATHS.iter().map(|path| 1e3 * path.total_s());
        let rounded: Vec<f64> = total.map(|ms| (10.0 * ms).round() / 10.0).collect();
        assert_eq!(rounded, [1.0, 4.3, 3.0, 11.5, 18.8, 27.8]);
        assert!(report_bytes() > goal_bytes() && goal_bytes() > 23);
    }
}
