//! Each fault that the simulated bus has, and the cause that is named for it.

use super::*;
use crate::SerialLink;
use crate::virtual_cm5::{AdapterPort, SimLink};
use handstand_shared::dynamixel::{MAX_PACKET, Status};

fn diagnose(words: &str, ids: &[u8]) -> BusDiagnosis {
    examine(SimLink::adapter(words).unwrap(), ids, None, |_| ()).unwrap()
}

/// The likeliest cause named for each fault that can be put into the bus.
#[test]
fn every_fault_is_named_first() {
    for (words, said) in [
        ("ids=1-4,delay=0,dead=3", "servo 3 is not there"),
        ("ids=1-4,delay=0,baud=34", "servos answer at 57600 baud"),
        ("ids=21-24,delay=0", "the ids are others"),
        (
            "ids=1-4,delay=0,drop=0.2",
            "the line is disturbed: answers are lost",
        ),
        (
            "ids=1-4,delay=0,flip=0.2",
            "bits are wrong on the way from the servos",
        ),
        (
            "ids=1-4,delay=0,corrupt_request=0.2",
            "bits are wrong on the way to the servos",
        ),
        (
            "ids=1-4,delay=0,late=0.2",
            "answers come later than the return delay allows",
        ),
        (
            "ids=1-4,delay=0,wrong_id=0.2",
            "servos answer with others' ids",
        ),
        ("ids=1-4+3,delay=0", "two servos have the id 3"),
        (
            "model=XL330-M288,ids=1-4+3,delay=0",
            "two servos have the id 3",
        ),
        ("ids=1-4,delay=0,overload=2", "servo 2 reports: overload"),
        ("ids=1-4,delay=0,hot=2", "servo 2 reports: overheat"),
        ("ids=1-4,delay=0,supply=5", "reports: voltage"),
        ("ids=1-4,delay=0,level=0", "has status level 0"),
        ("ids=1-4,delay=250", "servos 1-4 wait 500 us"),
        (
            "model=XL330-M288,ids=1-4,delay=0,dead=3",
            "servo 3 is not there",
        ),
        (
            "model=XL330-M288,ids=1-4,delay=0,baud=6",
            "servos answer at 4000000 baud",
        ),
        (
            "model=XL330-M288,ids=1-4,delay=0,flip=0.2",
            "bits are wrong on the way from the servos",
        ),
        (
            "model=XL330-M288,ids=1-4,delay=0,overload=2",
            "servo 2 reports: overload",
        ),
        ("model=XL330-M288,ids=1-4", "servos 1-4 wait 500 us"),
        ("ids=1-4,dead=1-4", "the servos have no power"),
        (
            "ids=1-4,dead=1-4,echo",
            "the adapter never lets the line go",
        ),
    ] {
        let diagnosis = diagnose(words, &[1, 2, 3, 4]);
        let first = &diagnosis
            .causes
            .first()
            .unwrap_or_else(|| panic!("{words}: no cause"))
            .cause;
        assert!(first.contains(said), "{words}: {:?}", diagnosis.causes);
    }
}

#[test]
fn a_shutdown_is_mended_by_a_reboot_and_a_wrong_protocol_named() {
    let diagnosis = diagnose("model=XL330-M288,ids=1-4,delay=0,hot=2", &[1, 2, 3, 4]);
    assert!(diagnosis.causes[0].remedy.contains("bus reboot 2"));
    assert_eq!(diagnosis.protocol, Some(Protocol::Two));
    let link = SimLink::adapter("model=XL330-M288,ids=1-4,delay=0").unwrap();
    let wrong = examine(link, &[1, 2], Some(Protocol::One), |_| ()).unwrap();
    let first = &wrong.causes[0].cause;
    assert!(first.contains("Protocol 2.0"), "{first}");
}

#[test]
fn a_bus_that_is_well_has_no_cause() {
    let diagnosis = diagnose("ids=1-4,delay=0", &[1, 2, 3, 4]);
    assert!(diagnosis.causes.is_empty(), "{:?}", diagnosis.causes);
    assert!(diagnosis.pings.iter().all(|test| test.answered == PINGS));
}

/// How the answers of two servos of one id meet on the line.
#[derive(Clone, Copy, PartialEq)]
enum Meeting {
    /// At the very same time: a zero wins.
    AtOnce,
    /// One behind the other, and both in one read, as an adapter with a latency timer delivers
    /// them.
    InOneRead,
    /// The second's alone every other time.
    InTurn,
}

/// A bus with two factory-fresh AX-12 of id 2: a ping they answer with the same bytes, and at once;
/// a reading with other positions.
struct Twins {
    inner: SimLink<AdapterPort>,
    meeting: Meeting,
    /// Whether a reading of id 2 is being answered.
    is_read: bool,
    readings: usize,
}

impl Twins {
    /// What the line carries where one of the two says this.
    fn both(&self, one: &[u8]) -> Vec<u8> {
        let Ok(packet) = handstand_shared::dynamixel::Packet::new(one) else {
            return one.to_vec();
        };
        let status = Status::of(packet);
        let mut data = status.data.to_vec();
        if let Some(low) = data.first_mut() {
            *low ^= 0xa5;
        }
        let (id, error, data) = (status.id, status.error, &data[..]);
        let mut out = [0; MAX_PACKET];
        let length = Status { id, error, data }.emit(&mut out).unwrap();
        let other = &out[..length];
        match self.meeting {
            Meeting::AtOnce => one.iter().zip(other).map(|(a, b)| a & b).collect(),
            Meeting::InOneRead => [one, other].concat(),
            Meeting::InTurn if self.readings.is_multiple_of(2) => one.to_vec(),
            Meeting::InTurn => other.to_vec(),
        }
    }
}

impl SerialLink for Twins {
    crate::port::left_to_inner!();

    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        // ff ff id length instruction: what both have alike they say alike.
        self.is_read = matches!(bytes, [0xff, 0xff, 2, _, 2, 36, ..]);
        self.readings += usize::from(self.is_read);
        self.inner.send(bytes)
    }

    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> Result<usize> {
        if !std::mem::take(&mut self.is_read) {
            return self.inner.receive(bytes, wait);
        }
        let mut one = Vec::new();
        loop {
            let mut some = [0; 64];
            match self.inner.receive(&mut some, wait)? {
                0 => break,
                count => one.extend_from_slice(&some[..count]),
            }
        }
        let both = self.both(&one);
        bytes[..both.len()].copy_from_slice(&both);
        Ok(both.len())
    }
}

#[test]
fn twins_that_answer_a_ping_alike_are_told_by_their_readings() {
    for meeting in [Meeting::AtOnce, Meeting::InOneRead, Meeting::InTurn] {
        let link = Twins {
            inner: SimLink::adapter("ids=1-3,delay=0").unwrap(),
            meeting,
            is_read: false,
            readings: 0,
        };
        let diagnosis = examine(link, &[1, 2, 3], None, |_| ()).unwrap();
        let pings = &diagnosis.pings[1];
        assert_eq!((pings.answered, pings.doubled), (PINGS, 0));
        let causes: Vec<&str> = diagnosis.causes.iter().map(|it| &it.cause[..]).collect();
        assert_eq!(causes, ["two servos have the id 2"]);
    }
}

#[test]
fn a_model_that_is_not_known_is_named_and_not_read() {
    let mut bus = crate::virtual_cm5::spec("ids=1-2,delay=0").unwrap().bus();
    bus.servos[1].set(handstand_shared::control_table::MODEL, 1_000);
    let link = SimLink(AdapterPort::new(bus));
    let diagnosis = examine(link, &[1, 2], None, |_| ()).unwrap();
    let causes: Vec<&str> = diagnosis.causes.iter().map(|it| &it.cause[..]).collect();
    assert_eq!(
        causes,
        ["servo 2 is of model 1000, whose control table is not known"]
    );
}
