//! How long the way from a sample to a torque takes: over the servo bus, and over the PC's serial line and back.
//!
//! The paper asks whether the delays of serial line, CM-5 and RS485 go with the sampling time. The servos' replies are
//! timed byte by byte; the frames are the project's own.

use handstand_shared::control_table::{GOAL_POSITION, PRESENT_POSITION};
use handstand_shared::dynamixel::timing::{BYTE_NS, REPLY_NS, byte_start_ns};
use handstand_shared::dynamixel::{BROADCAST, MAX_PACKET, Request, status_length};
use handstand_shared::frame::MAX_FRAME;
use handstand_shared::message::{Command, Condition, Report, StreamReport, encode};
use handstand_shared::packed::{Positions, SERVOS};
use handstand_shared::raw::ReturnDelay;

/// Speed of the PC's line, baud: what the CM-5 and its boot loader use.
const LINK_BAUD: f64 = 57_600.0;
/// Servos of the arms' and legs' joints that balance: shoulder and hip, left and right.
const BALANCING: u8 = 4;

/// The way from sample to torque, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing {
    /// Controller on board: four servos are read and told, return delay 0.
    pub on_board_s: f64,
    /// The same with the factory's return delay of 500 us.
    pub factory_s: f64,
    /// Controller on the PC: all servos are read and reported, the answer comes back, all are told.
    pub over_pc_s: f64,
}

/// Times it.
pub fn timing() -> Timing {
    let link_s = |bytes: usize| 10.0 * bytes as f64 / LINK_BAUD;
    let all = SERVOS as u8;
    let over_bus_s = read_s(all, ReturnDelay(0)) + tell_s(all);
    Timing {
        on_board_s: read_s(BALANCING, ReturnDelay(0)) + tell_s(BALANCING),
        factory_s: read_s(BALANCING, ReturnDelay::FACTORY) + tell_s(BALANCING),
        over_pc_s: over_bus_s + link_s(report_bytes()) + link_s(goal_bytes()),
    }
}

/// Asking servos for their positions, one after the other, s.
fn read_s(servos: u8, delay: ReturnDelay) -> f64 {
    let request = Request::Read {
        address: PRESENT_POSITION.address,
        count: 2,
    };
    let mut now_ns = 0;
    for id in 1..=servos {
        let length = request.emit(id, &mut [0; MAX_PACKET]).unwrap_or(0);
        now_ns += length as u64 * BYTE_NS + REPLY_NS + u64::from(delay.to_us()) * 1000;
        for _ in 0..status_length(2) {
            now_ns = byte_start_ns(now_ns, u64::from(id)) + BYTE_NS;
        }
    }
    now_ns as f64 * 1e-9
}

/// Telling servos goal and speed in one packet, s.
fn tell_s(servos: u8) -> f64 {
    let blocks: Vec<u8> = (1..=servos).flat_map(|id| [id, 0, 2, 0, 0]).collect();
    let request = Request::SyncWrite {
        address: GOAL_POSITION.address,
        width: 4,
        blocks: &blocks,
    };
    let length = request.emit(BROADCAST, &mut [0; MAX_PACKET]).unwrap_or(0);
    length as f64 * BYTE_NS as f64 * 1e-9
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

    /// Per servo 8 bytes there, 22 us, 8 bytes back; the motors' interrupts hold some answers up by 130 us at most.
    #[test]
    fn reading_takes_as_long_as_its_bytes() {
        let quick_s = f64::from(BALANCING) * 182e-6;
        let taken_s = read_s(BALANCING, ReturnDelay(0));
        assert!(
            taken_s >= quick_s - 1e-12 && taken_s <= quick_s + 4.0 * 130e-6,
            "{taken_s}"
        );
        let late_s = read_s(BALANCING, ReturnDelay::FACTORY) - taken_s;
        assert!((late_s - 4.0 * 500e-6).abs() <= 4.0 * 130e-6, "{late_s}");
        assert!((tell_s(18) - 98.0 * 10e-6).abs() < 1e-12);
    }

    #[test]
    fn the_pc_s_line_takes_longest() {
        let timing = timing();
        assert!(timing.on_board_s < timing.factory_s && timing.factory_s < timing.over_pc_s);
        assert!(report_bytes() > goal_bytes() && goal_bytes() > 23);
    }
}
