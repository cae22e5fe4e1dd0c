//! The half-duplex bus: receives requests, and puts the servos' replies on the line in time.

use super::bad_checksum::BadChecksum;
use super::collision::{Sent, received};
use super::robot::Robot;
use super::servo::Servo;
use super::x_line::XLine;
use handstand_shared::control_table::{Register, TORQUE_ENABLE};
use handstand_shared::dynamixel::timing::{BYTE_NS, PING_REPLY_NS, REPLY_NS, byte_start_ns};
use handstand_shared::dynamixel::{BROADCAST, MAX_PACKET, Packet, Parser, Request, Status};
use std::collections::{BTreeMap, VecDeque};

/// Longest and shortest time from one regulation and measurement of servos to the next, ns.
const MOST_STEP_NS: u64 = 1_000_000;
const LEAST_STEP_NS: u64 = 50_000;

/// Servos on one line.
#[derive(Debug)]
pub struct Bus {
    /// The servos, in any order.
    pub servos: Vec<Servo>,
    /// Those of Protocol 2.0.
    pub x: XLine,
    robot: Option<Robot>,
    parser: Box<Parser<MAX_PACKET>>,
    bad_checksum: BadChecksum,
    /// Ends of the last bytes of the controller, ns, the newest last.
    heard_ns: VecDeque<u64>,
    line: VecDeque<(u64, u8)>,
    now_ns: u64,
    /// Time from one regulation and measurement of the servos to the next, ns.
    step_ns: u64,
    /// Ends of the broadcasts that switched torque off, ns: what a safety test looks for.
    pub torque_offs: Vec<u64>,
    /// End of the last packet to more than one servo that wrote to each address, ns.
    written_ns: BTreeMap<u8, u64>,
    /// Speed of the controller, baud; servos set to another speed do not understand it.
    pub line_baud: u32,
    /// Time from one byte of noise to the next, ns, if there is noise.
    noise_ns: Option<u64>,
    next_noise_ns: u64,
}

impl Bus {
    /// Factory-new servos with these ids, except that they reply at once (return delay 0). An id
    /// may come twice, as two servos fresh from the factory have it.
    pub fn new(ids: impl IntoIterator<Item = u8>) -> Self {
        let mut servos: Vec<Servo> = Vec::new();
        for id in ids {
            let mut servo = Servo::new(id);
            let same = servos.iter().filter(|other| other.id() == id).count();
            servo.serial += 256 * same as u64;
            servos.push(servo);
        }
        Bus {
            servos,
            x: XLine::default(),
            robot: None,
            parser: Box::default(),
            bad_checksum: BadChecksum::default(),
            heard_ns: VecDeque::new(),
            line: VecDeque::new(),
            now_ns: 0,
            step_ns: MOST_STEP_NS,
            torque_offs: Vec::new(),
            written_ns: BTreeMap::new(),
            line_baud: 1_000_000,
            noise_ns: None,
            next_noise_ns: 0,
        }
    }

    /// From `now_ns` on the controller hears a byte of noise every `every_ns`, at least a byte's
    /// time; `None` ends it. Where both meet, the noise is heard instead of the servos.
    pub fn set_noise(&mut self, now_ns: u64, every_ns: Option<u64>) {
        self.noise_ns = every_ns.map(|every_ns| every_ns.max(BYTE_NS));
        self.next_noise_ns = now_ns + self.noise_ns.unwrap_or(0);
    }

    /// The servo with this id.
    pub fn servo(&mut self, id: u8) -> Option<&mut Servo> {
        self.servos.iter_mut().find(|servo| servo.id() == id)
    }

    /// Attach a robot to its servos; the others stay free.
    pub fn attach(&mut self, mut robot: Robot) {
        let ids: Vec<u8> = robot.ids().collect();
        for servo in &mut self.servos {
            if ids.contains(&servo.id()) {
                servo.free = false;
            }
        }
        let step_ns = (robot.step_s() * 1e9).round() as u64;
        self.step_ns = step_ns.clamp(LEAST_STEP_NS, MOST_STEP_NS);
        // Shafts are where its joints are from the beginning.
        robot.step(&mut self.servos, 0.0);
        self.robot = Some(robot);
    }

    /// The attached robot.
    pub fn robot(&mut self) -> Option<&mut Robot> {
        self.robot.as_mut()
    }

    /// Advance the servos' motors, and the robot, to `now_ns`.
    pub fn advance(&mut self, now_ns: u64) {
        let step_s = self.step_ns as f64 * 1e-9;
        while self.now_ns + self.step_ns <= now_ns {
            self.now_ns += self.step_ns;
            if let Some(robot) = &mut self.robot {
                robot.step(&mut self.servos, step_s);
            }
            for servo in &mut self.servos {
                servo.step(step_s);
            }
            for servo in &mut self.x.servos {
                servo.step(self.now_ns, step_s);
            }
        }
    }

    /// Receive a byte from the controller, whose stop bit ended at `now_ns`.
    pub fn receive(&mut self, now_ns: u64, byte: u8) {
        self.advance(now_ns);
        self.heard_ns.push_back(now_ns);
        if self.heard_ns.len() > MAX_PACKET {
            self.heard_ns.pop_front();
        }
        let byte = self.collided(now_ns, byte);
        let mut faults = (self.servos.iter().map(|servo| &servo.faults))
            .chain(self.x.servos.iter().map(|servo| &servo.faults));
        if faults.any(|faults| faults.echo) {
            self.line.push_back((now_ns, byte));
        }
        self.x.receive(now_ns, byte, self.line_baud, &mut self.line);
        if let Some(id) = self.bad_checksum.push(byte) {
            self.reply(now_ns + REPLY_NS, |servo| servo.reject_checksum(id));
        }
        let Some(packet) = self.parser.push(byte) else {
            return;
        };
        let Ok(request) = Request::parse(packet) else {
            return;
        };
        let id = packet.id();
        let first = self.heard_ns.len().saturating_sub(packet.bytes().len());
        let first_ns = self.heard_ns.get(first).copied().unwrap_or(now_ns);
        let began_ns = first_ns.saturating_sub(BYTE_NS);
        if is_torque_off(id, request) {
            self.torque_offs.push(now_ns);
        }
        if id == BROADCAST
            && let Request::Write { address, .. } | Request::SyncWrite { address, .. } = request
        {
            self.written_ns.insert(address, now_ns);
        }
        let wait_ns = match request {
            Request::Ping => PING_REPLY_NS,
            _ => REPLY_NS,
        };
        // The request borrows the parser, so the line is filled from the other fields.
        let replies = replies(&mut self.servos, self.line_baud, |servo| {
            servo.execute((began_ns, now_ns), id, request)
        });
        put(&mut self.line, now_ns + wait_ns, &replies);
    }

    /// What the servos hear of a byte of the controller's while one of them still answers: the line
    /// is low while either pulls it low. Bits are not shifted against each other.
    fn collided(&self, now_ns: u64, byte: u8) -> u8 {
        let meets = |end_ns: u64| end_ns + BYTE_NS > now_ns && end_ns < now_ns + BYTE_NS;
        let line = self
            .line
            .iter()
            .take_while(|(end_ns, _)| *end_ns < now_ns + BYTE_NS);
        let met = line.filter(|(end_ns, _)| meets(*end_ns) && *end_ns != now_ns);
        met.fold(byte, |byte, (_, other)| byte & other)
    }

    fn reply(&mut self, from_ns: u64, of: impl FnMut(&mut Servo) -> Option<(Vec<u8>, u64)>) {
        let replies = replies(&mut self.servos, self.line_baud, of);
        put(&mut self.line, from_ns, &replies);
    }

    /// End of the next byte to the controller, ns, if one is pending.
    pub fn next_ns(&self) -> Option<u64> {
        let servo_ns = self.line.front().map(|(end, _)| *end);
        let noise_ns = self.noise_ns.map(|_| self.next_noise_ns);
        servo_ns.into_iter().chain(noise_ns).min()
    }

    /// The next byte to the controller that has ended by `now_ns`, and its end, ns.
    pub fn take(&mut self, now_ns: u64) -> Option<(u64, u8)> {
        let end_ns = self.next_ns().filter(|end| *end <= now_ns)?;
        let Some(every_ns) = self.noise_ns.filter(|_| self.next_noise_ns == end_ns) else {
            return self.line.pop_front();
        };
        self.next_noise_ns += every_ns;
        // What a servo sends meanwhile is spoilt.
        while self
            .next_servo_ns()
            .is_some_and(|servo_ns| servo_ns < end_ns + BYTE_NS)
        {
            self.line.pop_front();
        }
        Some((end_ns, (end_ns / 1000 * 101 / 7) as u8))
    }

    fn next_servo_ns(&self) -> Option<u64> {
        self.line.front().map(|(end, _)| *end)
    }

    /// Discard the bytes to the controller that end by `now_ns`.
    pub fn miss(&mut self, now_ns: u64) {
        while self.next_servo_ns().is_some_and(|end_ns| end_ns <= now_ns) {
            self.line.pop_front();
        }
        if let Some(every_ns) = self.noise_ns
            && now_ns >= self.next_noise_ns
        {
            self.next_noise_ns += ((now_ns - self.next_noise_ns) / every_ns + 1) * every_ns;
        }
    }

    /// When this register was last written to in a packet to more than one servo, ns.
    pub fn last_write_ns(&self, register: Register) -> Option<u64> {
        self.written_ns.get(&register.address).copied()
    }

    /// Whether any servo's torque is on.
    pub fn any_torque(&self) -> bool {
        self.servos.iter().any(Servo::torque_is_on)
            || self.x.servos.iter().any(|servo| servo.torque_is_on())
    }

    /// Send a request and return the parameters of its reply, without time passing: for setting up.
    pub fn transact(&mut self, id: u8, request: Request) -> Vec<u8> {
        let mut out = [0; MAX_PACKET];
        let length = request.emit(id, &mut out).unwrap_or(0);
        let now_ns = self.now_ns;
        (out[..length].iter()).for_each(|byte| self.receive(now_ns, *byte));
        let bytes: Vec<u8> = self.line.drain(..).map(|(_, byte)| byte).collect();
        match Packet::new(&bytes) {
            Ok(packet) => Status::of(packet).data.to_vec(),
            Err(_) => Vec::new(),
        }
    }
}

fn is_torque_off(id: u8, request: Request) -> bool {
    const ADDRESS: u8 = TORQUE_ENABLE.address;
    let off = |request| {
        matches!(
            request,
            Request::Write {
                address: ADDRESS,
                data: [0, ..]
            }
        )
    };
    id == BROADCAST && off(request)
}

/// A servo's reply.
struct Reply {
    bytes: Vec<u8>,
    delay_ns: u64,
    serial: u64,
}

/// Replies of the servos that run at this speed.
fn replies(
    servos: &mut [Servo],
    line_baud: u32,
    mut of: impl FnMut(&mut Servo) -> Option<(Vec<u8>, u64)>,
) -> Vec<Reply> {
    let servos = servos.iter_mut();
    let servos = servos.filter(|servo| servo.understands(line_baud));
    let replies = servos.filter_map(|servo| {
        let (bytes, delay_ns) = of(servo)?;
        let serial = servo.serial;
        Some(Reply {
            bytes,
            delay_ns,
            serial,
        })
    });
    replies.collect()
}

/// Put replies on the line, from `from_ns` on or when it is free.
fn put(line: &mut VecDeque<(u64, u8)>, from_ns: u64, replies: &[Reply]) {
    let free_ns = line.back().map_or(0, |(end, _)| *end);
    match replies {
        [] => {}
        [one] => {
            let sent = sent(one, from_ns, free_ns).into_iter();
            line.extend(sent.map(|(begin, byte)| (begin + BYTE_NS, byte)));
        }
        several => {
            let late = |reply: &Reply| sent(reply, from_ns + late_ns(reply.serial), free_ns);
            let all = several.iter().flat_map(late);
            line.extend(received(&all.collect::<Vec<_>>(), BYTE_NS / 10));
        }
    }
}

/// When each byte of a reply starts.
fn sent(reply: &Reply, from_ns: u64, free_ns: u64) -> Vec<Sent> {
    let mut end_ns = free_ns.max(from_ns + reply.delay_ns);
    let starts = reply.bytes.iter().map(|byte| {
        let start_ns = byte_start_ns(end_ns, reply.serial);
        end_ns = start_ns + BYTE_NS;
        (start_ns, *byte)
    });
    starts.collect()
}

/// How much later a servo replies than another one of its id: no two clocks are the same. Scattered
/// by a hash, below a byte's time.
fn late_ns(serial: u64) -> u64 {
    match serial / 256 {
        0 => 0,
        twin => 700 + twin * 2_654_435_761 % (BYTE_NS - 1_000),
    }
}
