//! Servos of Protocol 2.0 on the bus: who answers an instruction, when, and with which bytes.
//!
//! Where the manual does not say what servos do, they do what is hardest for the host: behind a
//! servo that is missing in a sync read the others stay silent, and only packets that name a servo
//! restart its bus watchdog.

use super::x_servo::XServo;
use handstand_shared::control_table::x::{RETURN_DELAY, STATUS_LEVEL};
use handstand_shared::dynamixel2::*;
use std::collections::VecDeque;

/// A pause within an instruction for which a servo drops it, ns.
const GAP_NS: u64 = 1_500_000;
/// A servo's slot in the answer to a broadcast ping, ns; from what ROBOTIS's SDK waits for.
const PING_SLOT_NS: u64 = 3_000_000;

/// The servos of Protocol 2.0 on a line.
#[derive(Debug, Default)]
pub struct XLine {
    /// The servos, in any order.
    pub servos: Vec<XServo>,
    receiver: Box<Receiver<MAX_PACKET>>,
    heard_ns: u64,
}

/// Bytes for the controller, each with the end of its stop bit, ns.
type Sent = VecDeque<(u64, u8)>;

impl XLine {
    /// The servo with this id.
    pub fn servo(&mut self, id: u8) -> Option<&mut XServo> {
        self.servos.iter_mut().find(|servo| servo.id() == id)
    }

    /// Receive a byte, whose stop bit ended at `now_ns`, and put the servos' bytes on the line.
    pub(super) fn receive(&mut self, now_ns: u64, byte: u8, baud: u32, line: &mut Sent) {
        if self.servos.is_empty() {
            return;
        }
        if now_ns > self.heard_ns + GAP_NS {
            self.receiver.reset();
        }
        self.heard_ns = now_ns;
        let Some(packet) = self.receiver.push(byte) else {
            return;
        };
        let parameters: Vec<u8> = packet.parameters().collect();
        let Ok(request) = Request::parse(packet.instruction(), &parameters) else {
            return;
        };
        let id = packet.id();
        let talk = Talk {
            servos: &mut self.servos,
            baud,
            now_ns,
            free_ns: now_ns,
            line,
        };
        talk.obey(id, request);
    }
}

/// One instruction and its answers.
struct Talk<'a> {
    servos: &'a mut [XServo],
    baud: u32,
    now_ns: u64,
    /// When the line is free for the next answer.
    free_ns: u64,
    line: &'a mut Sent,
}

impl Talk<'_> {
    fn obey(mut self, id: u8, request: Request) {
        match request {
            Request::SyncRead {
                fast,
                address,
                count,
                ids,
            } => self.read_all(fast, ids.iter().map(|id| (*id, address, count))),
            Request::BulkRead { fast, items } => {
                let word = |low, high| u16::from_le_bytes([low, high]);
                let items = items.chunks_exact(5);
                self.read_all(
                    fast,
                    items.map(|i| (i[0], word(i[1], i[2]), word(i[3], i[4]))),
                );
            }
            Request::SyncWrite {
                address,
                count,
                blocks,
            } => {
                for block in blocks.chunks_exact(usize::from(count) + 1) {
                    self.write_to(block[0], address, &block[1..]);
                }
            }
            Request::BulkWrite { mut items } => {
                while let [id, a, b, c, d, rest @ ..] = items {
                    let count = usize::from(u16::from_le_bytes([*c, *d]));
                    let Some((data, others)) = rest.split_at_checked(count) else {
                        return;
                    };
                    self.write_to(*id, u16::from_le_bytes([*a, *b]), data);
                    items = others;
                }
            }
            Request::Ping if id == BROADCAST => {
                for slot in 0..=MAX_ID {
                    self.free_ns = self.now_ns + PING_SLOT_NS * u64::from(slot);
                    self.answer_one(slot, request);
                }
            }
            _ if id == BROADCAST => {
                let (baud, now_ns) = (self.baud, self.now_ns);
                let listening = |servo: &&mut XServo| is_listening(servo, baud, now_ns);
                for servo in self.servos.iter_mut().filter(listening) {
                    servo.execute(now_ns, request);
                }
            }
            _ => self.answer_one(id, request),
        }
    }

    fn find(&mut self, id: u8) -> Option<&mut XServo> {
        let (baud, now_ns) = (self.baud, self.now_ns);
        let servos = self.servos.iter_mut();
        let mut there = servos.filter(|servo| is_listening(servo, baud, now_ns));
        there.find(|servo| servo.id() == id)
    }

    fn write_to(&mut self, id: u8, address: u16, data: &[u8]) {
        let now_ns = self.now_ns;
        if let Some(servo) = self.find(id) {
            servo.heard_ns = now_ns;
            servo.write(now_ns, address, data);
        }
    }

    fn answer_one(&mut self, id: u8, request: Request) {
        let now_ns = self.now_ns;
        let Some(servo) = self.find(id) else {
            return;
        };
        let level = servo.get(STATUS_LEVEL);
        if servo.faults.corrupts_request() {
            let error = servo.error_byte(3);
            return self.send_status(id, error, &[]);
        }
        let ((code, data), from_level) = servo.execute(now_ns, request);
        let error = servo.error_byte(code);
        if level >= from_level {
            self.send_status(id, error, &data);
        }
    }

    /// Answers of several servos in turn, up to the first that is missing.
    fn read_all(&mut self, fast: bool, items: impl Iterator<Item = (u8, u16, u16)>) {
        let items: Vec<(u8, u16, u16)> = items.collect();
        let now_ns = self.now_ns;
        let mut parts = Vec::new();
        for (id, address, count) in &items {
            let Some(servo) = self.find(*id).filter(|servo| servo.get(STATUS_LEVEL) > 0) else {
                break;
            };
            servo.heard_ns = now_ns;
            servo.measure();
            let (code, mut data) = servo.read(*address, *count);
            let error = servo.error_byte(code);
            match fast {
                false => self.send_status(*id, error, &data),
                true => {
                    // The joint status has a place for its bytes, whatever it says.
                    data.resize(usize::from(*count), 0);
                    parts.push((*id, error, data));
                }
            }
        }
        if fast {
            let announced = items.iter().map(|(.., count)| usize::from(*count) + 4);
            self.send_fast(announced.sum(), &parts);
        }
    }

    fn send_fast(&mut self, announced: usize, parts: &[(u8, ErrorByte, Vec<u8>)]) {
        let written = parts.iter().map(|(id, error, data)| FastPart {
            id: *id,
            error: *error,
            data,
        });
        let mut out = [0; MAX_PACKET];
        let Some(length) = emit_fast_status(&mut out, announced, &written.collect::<Vec<_>>())
        else {
            return;
        };
        let Some(first) = parts.first().and_then(|(id, ..)| self.find(*id)) else {
            return;
        };
        let wait_ns = delay_ns(first);
        // The first servo's faults are the packet's.
        let Some((bytes, late_ns)) = first.faults.pass_as(out[..length].to_vec(), |_| ()) else {
            return;
        };
        self.put(&bytes, wait_ns + late_ns);
    }

    fn send_status(&mut self, id: u8, error: ErrorByte, data: &[u8]) {
        let mut out = [0; MAX_PACKET];
        let Some(length) = emit_status(&mut out, id, error, data) else {
            return;
        };
        // It may be silent from now on, as behind a write into EEPROM, but answers that.
        let Some(servo) = self.servos.iter_mut().find(|servo| servo.id() == id) else {
            return;
        };
        let wait_ns = delay_ns(servo);
        let another = |answer: &mut Vec<u8>| {
            let mut out = [0; MAX_PACKET];
            let other = id.wrapping_add(1) % MAX_ID;
            if let Some(length) = emit_status(&mut out, other, error, data) {
                *answer = out[..length].to_vec();
            }
        };
        let sent = servo.faults.pass_as(out[..length].to_vec(), another);
        match sent {
            Some((bytes, late_ns)) => self.put(&bytes, wait_ns + late_ns),
            // Lost on its way to the controller; the line was busy all the same.
            None => self.free_ns += wait_ns + byte_ns(self.baud) * length as u64,
        }
    }

    fn put(&mut self, bytes: &[u8], wait_ns: u64) {
        let before_ns = self.line.back().map_or(0, |(end, _)| *end);
        let mut end_ns = before_ns.max(self.free_ns + wait_ns);
        for byte in bytes {
            end_ns += byte_ns(self.baud);
            self.line.push_back((end_ns, *byte));
        }
        self.free_ns = end_ns;
    }
}

/// A byte of 8N1, ns.
fn byte_ns(baud: u32) -> u64 {
    10_000_000_000 / u64::from(baud.max(1))
}

fn delay_ns(servo: &XServo) -> u64 {
    servo.get(RETURN_DELAY) as u64 * 2_000 + servo.turnaround_ns
}

fn is_listening(servo: &XServo, baud: u32, now_ns: u64) -> bool {
    servo.understands(baud) && !servo.faults.dead && now_ns >= servo.silent_until_ns
}
