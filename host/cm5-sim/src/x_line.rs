//! Servos of Protocol 2.0 on the bus: who answers an instruction, when, and with which bytes.
//!
//! Where the manual does not say what servos do, they do what is hardest for the host: behind a
//! servo that is missing in a sync read the others stay silent, and only packets that name a servo
//! restart its bus watchdog. Two of one id answer at once, and their answers collide.

use super::collision::received;
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

    /// The servos that hear what this id is told; two of one id are two.
    fn listening(&self, id: u8) -> Vec<usize> {
        let servos = self.servos.iter().enumerate();
        let hears = |servo: &XServo| is_listening(servo, self.baud, self.now_ns);
        let there = servos.filter(|(_, servo)| servo.id() == id && hears(servo));
        there.map(|(place, _)| place).collect()
    }

    fn write_to(&mut self, id: u8, address: u16, data: &[u8]) {
        for place in self.listening(id) {
            self.servos[place].heard_ns = self.now_ns;
            self.servos[place].write(self.now_ns, address, data);
        }
    }

    fn answer_one(&mut self, id: u8, request: Request) {
        let mut answers = Vec::new();
        for place in self.listening(id) {
            let servo = &mut self.servos[place];
            let level = servo.get(STATUS_LEVEL);
            if servo.faults.corrupts_request() {
                let error = servo.error_byte(3);
                answers.extend(self.status(place, id, error, &[]));
                continue;
            }
            // It may be silent from now on, as behind a write into EEPROM, but answers that.
            let ((code, data), from_level) = servo.execute(self.now_ns, request);
            let error = servo.error_byte(code);
            if level >= from_level {
                answers.extend(self.status(place, id, error, &data));
            }
        }
        self.put(&answers);
    }

    /// Answers of several servos in turn, up to the first that is missing.
    fn read_all(&mut self, fast: bool, items: impl Iterator<Item = (u8, u16, u16)>) {
        let items: Vec<(u8, u16, u16)> = items.collect();
        let mut parts = Vec::new();
        let mut twins = Vec::new();
        for (id, address, count) in &items {
            let mut there = self.listening(*id);
            there.retain(|place| self.servos[*place].get(STATUS_LEVEL) > 0);
            if there.is_empty() {
                break;
            }
            let mut answers = Vec::new();
            for (nth, place) in there.iter().enumerate() {
                let servo = &mut self.servos[*place];
                servo.heard_ns = self.now_ns;
                servo.measure();
                let (code, mut data) = servo.read(*address, *count);
                let error = servo.error_byte(code);
                if fast {
                    // The joint status has a place for its bytes, whatever it says.
                    data.resize(usize::from(*count), 0);
                    let own = if nth == 0 { &mut parts } else { &mut twins };
                    own.push((*place, *id, error, data));
                } else {
                    answers.extend(self.status(*place, *id, error, &data));
                }
            }
            self.put(&answers);
        }
        if fast {
            let announced = items.iter().map(|(.., count)| usize::from(*count) + 4);
            self.send_fast(announced.sum(), &parts, &twins);
        }
    }

    /// One packet of all parts; those of `twins`, the second servos of their ids, spoil it.
    fn send_fast(&mut self, announced: usize, parts: &[FastAnswer], twins: &[FastAnswer]) {
        let Some(first) = parts.first().map(|(place, ..)| *place) else {
            return;
        };
        let mut answers = Vec::new();
        for with_twins in [false, true] {
            if with_twins && twins.is_empty() {
                continue;
            }
            let written = parts.iter().map(|part| {
                let twin = twins.iter().find(|twin| with_twins && twin.1 == part.1);
                let (_, id, error, data) = twin.unwrap_or(part);
                FastPart {
                    id: *id,
                    error: *error,
                    data,
                }
            });
            let written: Vec<FastPart> = written.collect();
            let mut out = [0; MAX_PACKET];
            let Some(length) = emit_fast_status(&mut out, announced, &written) else {
                return;
            };
            let servo = &mut self.servos[first];
            let wait_ns = delay_ns(servo);
            // The first servo's faults are the packet's.
            if let Some((bytes, late_ns)) = servo.faults.pass_as(out[..length].to_vec(), |_| ()) {
                let wait_ns = wait_ns + late_ns;
                answers.push(Answer {
                    bytes,
                    wait_ns,
                    place: if with_twins { twins[0].0 } else { first },
                });
            }
        }
        self.put(&answers);
    }

    /// The status packet of the servo at this place; none, and the line was busy, where it is lost.
    fn status(&mut self, place: usize, id: u8, error: ErrorByte, data: &[u8]) -> Option<Answer> {
        let mut out = [0; MAX_PACKET];
        let length = emit_status(&mut out, id, error, data)?;
        let servo = &mut self.servos[place];
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
            Some((bytes, late_ns)) => Some(Answer {
                bytes,
                wait_ns: wait_ns + late_ns,
                place,
            }),
            // Lost on its way to the controller; the line was busy all the same.
            None => {
                self.free_ns += wait_ns + byte_ns(self.baud) * length as u64;
                None
            }
        }
    }

    /// Puts answers on the line, from when it is free; several at once collide.
    fn put(&mut self, answers: &[Answer]) {
        let before_ns = self.line.back().map_or(0, |(end, _)| *end);
        let (free_ns, byte_ns) = (self.free_ns, byte_ns(self.baud));
        let first = answers.iter().map(|answer| answer.place).min();
        let begins = |answer: &Answer| {
            let late_ns = if Some(answer.place) == first {
                0
            } else {
                twin_late_ns(answer.place, byte_ns)
            };
            let begin_ns = before_ns.max(free_ns + answer.wait_ns) + late_ns;
            let bytes = answer.bytes.clone().into_iter().zip(0..);
            bytes.map(move |(byte, nth): (u8, u64)| (begin_ns + nth * byte_ns, byte))
        };
        let sent: Vec<(u64, u8)> = answers.iter().flat_map(begins).collect();
        let heard: Vec<(u64, u8)> = match answers {
            [_] => sent
                .iter()
                .map(|(begin, byte)| (begin + byte_ns, *byte))
                .collect(),
            _ => received(&sent, byte_ns / 10),
        };
        if let Some((end_ns, _)) = heard.last() {
            self.free_ns = *end_ns;
        }
        self.line.extend(heard);
    }
}

/// Bytes of a servo's answer.
struct Answer {
    bytes: Vec<u8>,
    wait_ns: u64,
    /// Which servo's.
    place: usize,
}

/// A servo's part of a joint status: its place, id, error and data.
type FastAnswer = (usize, u8, ErrorByte, Vec<u8>);

/// How much later a servo answers than another one of its id: no two clocks are the same. Scattered
/// by its place, from a bit on and below a byte's time.
fn twin_late_ns(place: usize, byte_ns: u64) -> u64 {
    let bit_ns = byte_ns / 10;
    bit_ns * 7 / 10 + (place as u64 + 1) * 2_654_435_761 % (byte_ns - bit_ns)
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
