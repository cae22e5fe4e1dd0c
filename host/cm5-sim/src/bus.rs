//! The bus: hears requests, and puts the servos' answers on the line in time.

use super::BYTE_NS;
use super::collision::{Spoken, heard};
use super::ear::Ear;
use super::robot::Robot;
use super::servo::Servo;
use handstand_shared::dynamixel::{BROADCAST, MAX_PACKET, Packet, Parser, Request, Status};
use handstand_shared::timed_bus::TimedBus;
use std::collections::VecDeque;

/// From the request's last stop bit to the answer's first start bit with return delay 0, ns: a ping is quicker than the rest.
const PING_NS: u64 = 18_000;
const OTHER_NS: u64 = 22_000;

/// Servos on one line.
#[derive(Debug)]
pub struct Bus {
    /// The servos, in no order.
    pub servos: Vec<Servo>,
    robot: Option<Robot>,
    parser: Box<Parser<MAX_PACKET>>,
    ear: Ear,
    line: VecDeque<(u64, u8)>,
    now_ns: u64,
    /// Broadcasts that switched torque off, and when the last one ended, ns: what a safety test looks for.
    pub torque_offs: Vec<u64>,
    /// Speed at which the controller speaks and listens, baud; servos set to another do not understand it.
    pub line_baud: u32,
}

impl Bus {
    /// Factory-new servos with these ids, except that they answer at once (return delay 0). An id may come twice, as two
    /// servos fresh from the factory have it.
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
            robot: None,
            parser: Box::default(),
            ear: Ear::default(),
            line: VecDeque::new(),
            now_ns: 0,
            torque_offs: Vec::new(),
            line_baud: 1_000_000,
        }
    }

    /// The servo with this id.
    pub fn servo(&mut self, id: u8) -> Option<&mut Servo> {
        self.servos.iter_mut().find(|servo| servo.id() == id)
    }

    /// Hangs a robot on the servos; those it does not hang on stay free.
    pub fn hang(&mut self, mut robot: Robot) {
        let ids: Vec<u8> = robot.ids().collect();
        for servo in &mut self.servos {
            if ids.contains(&servo.id()) {
                servo.free = false;
            }
        }
        // Shafts are where its joints are from the beginning.
        robot.step(&mut self.servos, 0.0);
        self.robot = Some(robot);
    }

    /// The robot that hangs on the servos.
    pub fn robot(&mut self) -> Option<&mut Robot> {
        self.robot.as_mut()
    }

    /// Lets the servos' own motors, and the robot, run until `now_ns`.
    pub fn advance(&mut self, now_ns: u64) {
        const STEP_NS: u64 = 1_000_000;
        while self.now_ns + STEP_NS <= now_ns {
            self.now_ns += STEP_NS;
            if let Some(robot) = &mut self.robot {
                robot.step(&mut self.servos, STEP_NS as f64 * 1e-9);
            }
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
        if let Some(id) = self.ear.push(byte) {
            let answers = answers(&mut self.servos, self.line_baud, |servo| servo.mishear(id));
            put(&mut self.line, now_ns + OTHER_NS, &answers);
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
        let wait_ns = match request {
            Request::Ping => PING_NS,
            _ => OTHER_NS,
        };
        let hear = |servo: &mut Servo| servo.hear(now_ns, id, request);
        let answers = answers(&mut self.servos, self.line_baud, hear);
        put(&mut self.line, now_ns + wait_ns, &answers);
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

impl TimedBus for Bus {
    fn hear(&mut self, now_ns: u64, byte: u8) {
        Bus::hear(self, now_ns, byte);
    }

    fn take(&mut self, now_ns: u64) -> Option<(u64, u8)> {
        Bus::take(self, now_ns)
    }

    fn next_ns(&self) -> Option<u64> {
        Bus::next_ns(self)
    }

    fn advance(&mut self, now_ns: u64) {
        Bus::advance(self, now_ns);
    }

    fn rate_rad_s(&mut self) -> Option<f64> {
        self.robot().map(|robot| robot.rate_rad_s())
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

/// What a servo says.
struct Answer {
    bytes: Vec<u8>,
    delay_ns: u64,
    serial: u64,
}

/// What the servos that run at this speed say to something.
fn answers(
    servos: &mut [Servo],
    line_baud: u32,
    mut ask: impl FnMut(&mut Servo) -> Option<(Vec<u8>, u64)>,
) -> Vec<Answer> {
    let servos = servos.iter_mut();
    let servos = servos.filter(|servo| servo.understands(line_baud));
    let answers = servos.filter_map(|servo| {
        let (bytes, delay_ns) = ask(servo)?;
        let serial = servo.serial;
        Some(Answer {
            bytes,
            delay_ns,
            serial,
        })
    });
    answers.collect()
}

/// Puts answers on the line, from `begin_ns` on or when it is free.
fn put(line: &mut VecDeque<(u64, u8)>, begin_ns: u64, answers: &[Answer]) {
    let free_ns = line.back().map_or(0, |(end, _)| *end);
    match answers {
        [] => {}
        [one] => {
            let spoken = spoken(one, begin_ns, free_ns).into_iter();
            line.extend(spoken.map(|(begin, byte)| (begin + BYTE_NS, byte)));
        }
        several => {
            let late = |answer: &Answer| spoken(answer, begin_ns + late_ns(answer.serial), free_ns);
            let all = several.iter().flat_map(late);
            line.extend(heard(&all.collect::<Vec<_>>()));
        }
    }
}

/// When each byte of an answer begins.
fn spoken(answer: &Answer, from_ns: u64, free_ns: u64) -> Vec<Spoken> {
    let mut end_ns = free_ns.max(from_ns + answer.delay_ns);
    let begins = answer.bytes.iter().map(|byte| {
        let begin_ns = after_stall(end_ns, stall_phase_ns(answer.serial));
        end_ns = begin_ns + BYTE_NS;
        (begin_ns, *byte)
    });
    begins.collect()
}

/// How much later than its twin a servo begins: no two clocks are the same. Scattered by a hash, below a byte's time.
fn late_ns(serial: u64) -> u64 {
    match serial / 256 {
        0 => 0,
        twin => 700 + twin * 2_654_435_761 % (BYTE_NS - 1_000),
    }
}

/// When within each millisecond a servo's motor interrupt comes, ns: in each servo at another moment, scattered by a hash,
/// for servos started together would all stall a regular reader alike.
fn stall_phase_ns(serial: u64) -> u64 {
    ((serial * 2_654_435_761) >> 8) % 1_000_000
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
