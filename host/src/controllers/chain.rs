//! From the sample to the torque: what the way takes.
//!
//! A sample's way: every servo is read over the bus, the angles go up the serial line packed to 10 bits, the torques
//! come down again, and one SYNC_WRITE takes them to the servos. What computes takes under 1 ms wherever it is done
//! and is left out; the servo's own dead time, from command to movement, comes on top.

/// Servos on the bus.
const SERVOS: f64 = 18.0;

/// One read of four bytes with return delay 0, s: 8 + 10 bytes of 10 us and the servo's 22 us.
const READ_S: f64 = 0.2e-3;

/// What the factory's return delay adds to a read, s: 250 steps of 2 us.
const FACTORY_S: f64 = 0.5e-3;

/// SYNC_WRITE of 18 goals and speeds, s: 98 bytes of 10 us.
const WRITE_S: f64 = 0.98e-3;

/// Bytes of 18 packed angles with framing, one way.
const FRAME_BYTES: f64 = 27.0;

/// From command to movement, s, as published for the AX-12: shortest and longest.
pub const SERVO_DEAD_TIME_S: [f64; 2] = [17e-3, 50e-3];

/// A way from sample to servo.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chain {
    /// Name for people.
    pub title: &'static str,
    /// Baud of the serial line; none if the law runs on the CM-5.
    pub baud: Option<f64>,
    /// Whether the servos have the factory's return delay.
    pub factory: bool,
}

/// The ways there are.
pub const CHAINS: &[Chain] = &[
    Chain {
        title: "law on the CM-5, return delay 0",
        baud: None,
        factory: false,
    },
    Chain {
        title: "law on the PC, 115200 baud, return delay 0",
        baud: Some(115_200.0),
        factory: false,
    },
    Chain {
        title: "law on the PC, 57600 baud, return delay 0",
        baud: Some(57_600.0),
        factory: false,
    },
    Chain {
        title: "law on the PC, 57600 baud, factory return delay",
        baud: Some(57_600.0),
        factory: true,
    },
];

impl Chain {
    /// Bus, s.
    pub fn bus_s(&self) -> f64 {
        let read = READ_S + if self.factory { FACTORY_S } else { 0.0 };
        SERVOS * read + WRITE_S
    }

    /// Serial line, both ways, s.
    pub fn line_s(&self) -> f64 {
        self.baud
            .map_or(0.0, |baud| 2.0 * FRAME_BYTES * 10.0 / baud)
    }

    /// From sample to servo, s.
    pub fn total_s(&self) -> f64 {
        self.bus_s() + self.line_s()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ways_take_their_time() {
        let total: Vec<f64> = CHAINS
            .iter()
            .map(|chain| (1e4 * chain.total_s()).round() / 10.0)
            .collect();
        assert_eq!(total, [4.6, 9.3, 14.0, 23.0]);
    }
}
