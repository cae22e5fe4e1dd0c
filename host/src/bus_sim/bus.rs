//! The bus: hears requests, and puts the servos' answers on the line in time.

use super::BYTE_NS;
use super::servo::Servo;
use handstand_shared::dynamixel::{BROADCAST, MAX_PACKET, Packet, Parser, Request, Status};
use std::collections::VecDeque;

/// From the request's last stop bit to the answer's first start bit with return delay 0, ns: a ping is quicker than the rest.
const PING_NS: u64 = 18_000;
const OTHER_NS: u64 = 22_000;

/// Servos on one line.
#[derive(Debug)]
pub struct Bus {
    /// The servos, in no order.
    pub servos: Vec<Servo>,
    parser: Box<Parser<MAX_PACKET>>,
    line: VecDeque<(u64, u8)>,
    now_ns: u64,
    /// Broadcasts that switched torque off, and when the last one ended, ns: what a safety test looks for.
    pub torque_offs: Vec<u64>,
}

impl Bus {
    /// Factory-new servos with these ids, except that they answer at once (return delay 0).
    pub fn new(ids: impl IntoIterator<Item = u8>) -> Self {
        Bus {
            servos: ids.into_iter().map(Servo::new).collect(),
            parser: Box::default(),
            line: VecDeque::new(),
            now_ns: 0,
            torque_offs: Vec::new(),
        }
    }

    /// The servo with this id.
    pub fn servo(&mut self, id: u8) -> Option<&mut Servo> {
        self.servos.iter_mut().find(|servo| servo.id() == id)
    }

    /// Lets the servos' own motors run until `now_ns`.
    pub fn advance(&mut self, now_ns: u64) {
        const STEP_NS: u64 = 1_000_000;
        while self.now_ns + STEP_NS <= now_ns {
            self.now_ns += STEP_NS;
            for servo in &mut self.servos {
                servo.step(STEP_NS as f64 * 1e-9);
            }
        }
    }

    /// A byte from the controller, whose last stop bit ended at `now_ns`.
    pub fn hear(&mut self, now_ns: u64, byte: u8) {
        self.advance(now_ns);
        for servo in &mut self.servos {
            if servo.faults.echo {
                self.line.push_back((now_ns, byte));
                break;
            }
        }
        let Some(packet) = self.parser.push(byte) else {
            return;
        };
        let Ok(request) = Request::parse(packet) else {
            return;
        };
        let id = packet.id();
        if is_torque_off(id, request) {
            self.torque_offs.push(now_ns);
        }
        let mut answers = Vec::new();
        for servo in &mut self.servos {
            if let Some(answer) = servo.hear(now_ns, id, request) {
                answers.push(answer);
            }
        }
        let begin_ns = now_ns
            + if request == Request::Ping {
                PING_NS
            } else {
                OTHER_NS
            };
        // Two servos with one id would answer into each other; the second waits here, which is kinder than a collision.
        for (bytes, delay_ns, place) in answers {
            self.put(begin_ns + delay_ns, &bytes, place);
        }
    }

    fn put(&mut self, from_ns: u64, bytes: &[u8], servo_id: u8) {
        let mut end_ns = from_ns.max(self.line.back().map_or(0, |(end, _)| *end));
        let servo = self.servo(servo_id);
        let stall = servo.map(|servo| servo.stall_phase_ns());
        for byte in bytes {
            let begin_ns = stall.map_or(end_ns, |phase| after_stall(end_ns, phase));
            end_ns = begin_ns + BYTE_NS;
            self.line.push_back((end_ns, *byte));
        }
    }

    /// When the next byte from the servos has arrived, if one is on its way, ns.
    pub fn next_ns(&self) -> Option<u64> {
        self.line.front().map(|(end, _)| *end)
    }

    /// The next byte from the servos that has arrived by `now_ns`, and when.
    pub fn take(&mut self, now_ns: u64) -> Option<(u64, u8)> {
        self.next_ns().filter(|end| *end <= now_ns)?;
        self.line.pop_front()
    }

    /// Whether any servo's torque is on.
    pub fn any_torque(&self) -> bool {
        self.servos.iter().any(Servo::torque_is_on)
    }

    /// Sends a request outright and returns the answer's bytes, without time passing: for setting up.
    pub fn ask(&mut self, id: u8, request: Request) -> Vec<u8> {
        let mut out = [0; MAX_PACKET];
        let length = request.emit(id, &mut out).unwrap_or(0);
        let now_ns = self.now_ns;
        out[..length]
            .iter()
            .for_each(|byte| self.hear(now_ns, *byte));
        let bytes = self
            .line
            .drain(..)
            .map(|(_, byte)| byte)
            .collect::<Vec<_>>();
        match Packet::new(&bytes) {
            Ok(packet) => Status::of(packet).data.to_vec(),
            Err(_) => Vec::new(),
        }
    }
}

fn is_torque_off(id: u8, request: Request) -> bool {
    id == BROADCAST
        && matches!(
            request,
            Request::Write {
                address: 24,
                data: [0, ..]
            }
        )
}

/// The motor's interrupt takes 130 us of every millisecond and holds back a byte that would begin in it.
fn after_stall(at_ns: u64, phase_ns: u64) -> u64 {
    const PERIOD_NS: u64 = 1_000_000;
    const LENGTH_NS: u64 = 130_000;
    let into = (at_ns + PERIOD_NS - phase_ns % PERIOD_NS) % PERIOD_NS;
    if into < LENGTH_NS {
        at_ns + LENGTH_NS - into
    } else {
        at_ns
    }
}
