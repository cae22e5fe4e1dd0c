//! Why a servo gives no status packet: tests that tell the causes apart.

use super::port::Link;
use super::retry::Failure;
use super::servos::Servos;
use super::session::{Session, condition_words};
use crate::error::Result;
use handstand_shared::control_table::{PRESENT_SUPPLY, RETURN_DELAY, STATUS_LEVEL};
use handstand_shared::dynamixel::ErrorBits;
use handstand_shared::message::Condition;
use serde::Serialize;

/// How often each servo is pinged.
const PINGS: usize = 20;
/// Speeds servos are found at, likeliest first.
const BAUDS: [u32; 6] = [1_000_000, 57_600, 115_200, 500_000, 200_000, 9_600];

/// How one servo answered twenty pings.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Pulse {
    /// Its id.
    pub id: u8,
    /// Sound answers.
    pub answered: usize,
    /// No byte.
    pub silent: usize,
    /// Bytes, but no sound answer.
    pub garbled: usize,
    /// Another servo's answer.
    pub strangers: usize,
    /// What it complains of.
    pub errors: Vec<&'static str>,
}

/// A cause, how well the tests support it (0 to 1), and what to do.
#[derive(Debug, Clone, Serialize)]
pub struct Cause {
    /// What is wrong.
    pub cause: String,
    /// What was seen that says so.
    pub evidence: String,
    /// How to mend it.
    pub remedy: String,
    /// How strongly the evidence speaks for it, 0 to 1.
    pub weight: f64,
}

/// What was found; no cause means that all is well.
#[derive(Debug, Clone, Serialize)]
pub struct Diagnosis {
    /// Whether the adapter hears itself.
    pub echo: bool,
    /// Each servo asked.
    pub pulses: Vec<Pulse>,
    /// The likeliest first.
    pub causes: Vec<Cause>,
}

/// Examines the servos `ids`; `step` is told what is done next.
///
/// # Errors
/// The port failed.
pub fn examine<L: Link>(link: L, ids: &[u8], mut step: impl FnMut(&str)) -> Result<Diagnosis> {
    let mut servos = Servos::new(link);
    servos.tries = 1;
    step("listening for an echo");
    let echo = servos.echoes().map_err(|failure| failure.of(0))?;
    let mut pulses = Vec::new();
    for id in ids {
        step(&format!("servo {id}: {PINGS} pings"));
        pulses.push(pulse(&mut servos, *id)?);
    }
    let mut causes = Vec::new();
    if pulses.iter().all(|pulse| pulse.answered == 0) {
        nobody(&mut servos, ids, &pulses, &mut causes, &mut step)?;
    } else {
        some(&mut servos, &pulses, &mut causes)?;
    }
    causes.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    Ok(Diagnosis {
        echo,
        pulses,
        causes,
    })
}

fn cause(
    weight: f64,
    cause: impl Into<String>,
    evidence: impl Into<String>,
    remedy: impl Into<String>,
) -> Cause {
    Cause {
        cause: cause.into(),
        evidence: evidence.into(),
        remedy: remedy.into(),
        weight,
    }
}

fn pulse<L: Link>(servos: &mut Servos<L>, id: u8) -> Result<Pulse> {
    let mut pulse = Pulse {
        id,
        ..Pulse::default()
    };
    for round in 0..PINGS {
        match servos.ping(id) {
            Ok(errors) => {
                pulse.answered += 1;
                pulse.errors = errors.names().collect();
            }
            Err(Failure::Silent) => pulse.silent += 1,
            Err(Failure::Garbled(_) | Failure::Refused(_)) => pulse.garbled += 1,
            Err(Failure::Stranger(_)) => pulse.strangers += 1,
            Err(Failure::Port(error)) => return Err(error),
        }
        // A servo that is not there is not there: no need to ask so often.
        if round == 2 && pulse.silent == 3 {
            pulse.silent = PINGS;
            break;
        }
    }
    Ok(pulse)
}

/// Nobody answers: another speed, a controller that is no adapter now, no power, or the line is not connected.
fn nobody<L: Link>(
    servos: &mut Servos<L>,
    ids: &[u8],
    pulses: &[Pulse],
    causes: &mut Vec<Cause>,
    step: &mut impl FnMut(&str),
) -> Result<()> {
    if let Some(found) = firmware(servos, step)? {
        causes.push(found);
        return Ok(());
    }
    let own = servos.link().baud();
    for baud in BAUDS.into_iter().filter(|baud| *baud != own) {
        step(&format!("the same at {baud} baud"));
        servos.link().set_baud(baud)?;
        let here: Vec<u8> = ids
            .iter()
            .copied()
            .filter(|id| servos.ping(*id).is_ok())
            .collect();
        if !here.is_empty() {
            causes.push(cause(
                1.0,
                format!("the speed is wrong: servos answer at {baud} baud"),
                format!("silent at {own} baud, ids {here:?} answer at {baud}"),
                format!("use --baud {baud}"),
            ));
            servos.link().set_baud(own)?;
            return Ok(());
        }
    }
    servos.link().set_baud(own)?;
    step("all other ids");
    let others: Vec<u8> = (0..=253)
        .filter(|id| !ids.contains(id) && servos.ping(*id).is_ok())
        .collect();
    if !others.is_empty() {
        causes.push(cause(
            1.0,
            "the ids are others",
            format!("ids {others:?} answer, none of those asked"),
            format!(
                "use these ids, or give new ones: handstand bus setup --new-id {}",
                ids.first().unwrap_or(&1)
            ),
        ));
        return Ok(());
    }
    let garbled: usize = pulses.iter().map(|pulse| pulse.garbled).sum();
    if garbled > 0 {
        causes.push(cause(
            0.8,
            "bytes come back, but no sound packet: the speed is wrong, or two servos have one id",
            format!("{garbled} answers were garbled, none was sound, at any of {BAUDS:?} baud"),
            "connect a single servo and try again; then one after the other",
        ));
        return Ok(());
    }
    causes.extend(silence(servos.echoes().unwrap_or(false)));
    Ok(())
}

/// Whether a CM-5 with our firmware is there, but in a mode in which it is no adapter.
fn firmware<L: Link>(servos: &mut Servos<L>, step: &mut impl FnMut(&str)) -> Result<Option<Cause>> {
    step("greeting a CM-5");
    let Ok(session) = Session::open(Borrowed(servos.link())) else {
        return Ok(None);
    };
    let condition = session.hello.condition;
    Ok(Some(match condition {
        Condition::Bridge => cause(
            0.9,
            "the CM-5 is well, the servos behind it are silent: they have no power, or the bus cable is out",
            "the firmware answers as an adapter, no servo does",
            "switch the battery on; look at the servo cables, from the CM-5 outwards; are the servos' LEDs lit at power-on?",
        ),
        other => cause(
            1.0,
            "the CM-5 is no adapter now",
            format!("its firmware says: {}", condition_words(other)),
            "press its MODE button (a reset), or end the program that uses it",
        ),
    }))
}

/// Not a byte from anywhere: the tests cannot see further, so the causes are ranked by how common they are.
fn silence(echo: bool) -> Vec<Cause> {
    let evidence = "no byte came at any speed from any id, and no CM-5 answers";
    let mut causes = vec![
        cause(
            0.5,
            "the servos have no power",
            evidence,
            "switch the supply on: 9 to 12 V; each servo's LED flashes once",
        ),
        cause(
            0.3,
            "the data line is not connected, or a connector is turned",
            evidence,
            "check plug and cable; the middle pin is power, one outer pin is ground",
        ),
        cause(
            0.2,
            "the CM-5 runs another program than Handstand's firmware",
            evidence,
            "flash it: docs/flash.md",
        ),
    ];
    if echo {
        causes.insert(0, cause(
            0.6,
            "the adapter never lets the line go, or nothing else is on it",
            "the adapter hears itself, and nothing else",
            "check its direction control (half duplex), and that the servos' data wire reaches it",
        ));
    } else {
        causes.push(cause(
            0.1,
            "this is another device's port",
            evidence,
            "unplug the adapter and see which port disappears",
        ));
    }
    causes
}

/// Some answer: what is wrong with the others, or with how they answer.
fn some<L: Link>(servos: &mut Servos<L>, pulses: &[Pulse], causes: &mut Vec<Cause>) -> Result<()> {
    let total: usize = pulses
        .iter()
        .filter(|p| p.answered > 0)
        .map(|_| PINGS)
        .sum();
    let lost: usize = pulses
        .iter()
        .filter(|p| p.answered > 0)
        .map(|p| PINGS - p.answered)
        .sum();
    let poor: Vec<u8> = pulses
        .iter()
        .filter(|p| p.answered > 0 && p.answered < PINGS)
        .map(|p| p.id)
        .collect();
    for pulse in pulses.iter().filter(|pulse| pulse.answered == 0) {
        causes.push(missing(pulse));
    }
    if lost > 0 {
        let few = poor.len() == 1 && pulses.len() > 2;
        let what = if few {
            format!("servo {} or its cable is bad", poor[0])
        } else {
            "the line is disturbed".to_string()
        };
        let remedy = if few {
            "change its cable, then exchange the servo"
        } else {
            "look for loose plugs and a low supply; shorten the cables; keep the ground wire connected"
        };
        causes.push(cause(
            0.4 + 0.5 * lost as f64 / total as f64,
            what,
            format!("{lost} of {total} pings got no sound answer: ids {poor:?}"),
            remedy,
        ));
    }
    for pulse in pulses.iter().filter(|pulse| !pulse.errors.is_empty()) {
        let supply = servos.get(pulse.id, PRESENT_SUPPLY).ok();
        causes.push(complaint(pulse, supply));
    }
    for pulse in pulses.iter().filter(|pulse| pulse.answered > 0) {
        settings(servos, pulse.id, causes)?;
    }
    Ok(())
}

fn missing(pulse: &Pulse) -> Cause {
    let id = pulse.id;
    if pulse.garbled > 0 {
        return cause(
            0.85,
            format!("two servos have the id {id}"),
            format!(
                "{} of {PINGS} answers of id {id} were garbled, those of others are sound",
                pulse.garbled
            ),
            format!(
                "disconnect all others, connect one of the two, and give it a free id: handstand bus setup --new-id N; id {id} stays with the other"
            ),
        );
    }
    if pulse.strangers > 0 {
        return cause(
            0.8,
            format!("another servo answers for id {id}"),
            format!("{} of {PINGS} answers carried another id", pulse.strangers),
            "an adapter or servo is faulty: take servos off one by one",
        );
    }
    cause(
        0.7,
        format!(
            "servo {id} is not there: unplugged, without power, broken, or of another id or speed"
        ),
        format!("id {id} is silent, others on the same line answer"),
        "is it the last of its chain? check the cable before it; then connect it alone: `handstand bus scan` finds its id, `doctor` its speed",
    )
}

fn complaint(pulse: &Pulse, supply: Option<u16>) -> Cause {
    let (id, errors) = (pulse.id, pulse.errors.join(", "));
    let has = |bits: ErrorBits| bits.names().any(|name| pulse.errors.contains(&name));
    let remedy = if has(ErrorBits::OVERLOAD) {
        "take the load off it; it recovers when its torque limit is written, then torque enable"
    } else if has(ErrorBits::OVERHEAT) {
        "let it cool down"
    } else if has(ErrorBits::VOLTAGE) {
        "charge or exchange the battery; 9 to 12 V is right"
    } else {
        "see the error bits in docs/bus.md"
    };
    let volts = supply.map_or(String::new(), |code| {
        format!(" at {:.1} V", f64::from(code) * 0.1)
    });
    cause(
        0.6,
        format!("servo {id} complains of: {errors}"),
        format!("its status packets say so{volts}"),
        remedy,
    )
}

/// Settings under which a good servo looks silent or slow.
fn settings<L: Link>(servos: &mut Servos<L>, id: u8, causes: &mut Vec<Cause>) -> Result<()> {
    servos.tries = 3;
    let level = servos.get(id, STATUS_LEVEL);
    let delay = servos.get(id, RETURN_DELAY);
    servos.tries = 1;
    match level {
        Err(Failure::Port(error)) => return Err(error),
        Err(Failure::Silent) => causes.push(cause(
            0.75,
            format!("servo {id} has status level 0: it answers PING and nothing else"),
            "PING is answered, READ is not",
            format!("handstand bus write {id} \"status return level\" 1, though it cannot be read back until then"),
        )),
        _ => {}
    }
    if let Ok(code @ 1..) = delay {
        causes.push(cause(
            0.05 + f64::from(code) * 4e-4,
            format!("servo {id} waits {} us before it answers", 2 * code),
            format!("return delay time is {code}"),
            "too slow for 100 Hz with 18 servos: handstand bus setup",
        ));
    }
    Ok(())
}

/// A link that is lent.
struct Borrowed<'a, L>(&'a mut L);

impl<L: Link> Link for Borrowed<'_, L> {
    fn name(&self) -> &str {
        self.0.name()
    }
    fn baud(&self) -> u32 {
        self.0.baud()
    }
    fn set_baud(&mut self, baud: u32) -> Result<()> {
        self.0.set_baud(baud)
    }
    fn send(&mut self, bytes: &[u8]) -> Result<()> {
        self.0.send(bytes)
    }
    fn receive(&mut self, bytes: &mut [u8], wait: std::time::Duration) -> Result<usize> {
        self.0.receive(bytes, wait)
    }
    fn clear(&mut self) -> Result<()> {
        self.0.clear()
    }
    fn now(&self) -> std::time::Duration {
        self.0.now()
    }
    fn pause(&mut self, time: std::time::Duration) {
        self.0.pause(time);
    }
    fn latency(&self) -> std::time::Duration {
        self.0.latency()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{InProcess, SimWords};
    use super::*;

    fn diagnose(words: &str, ids: &[u8]) -> Diagnosis {
        let bus = words.parse::<SimWords>().unwrap().bus();
        examine(InProcess::new(bus), ids, |_| ()).unwrap()
    }

    /// The likeliest cause named for each fault that can be put into the bus.
    #[test]
    fn every_fault_is_named_first() {
        for (words, said) in [
            ("ids=1-4,delay=0,dead=3", "servo 3 is not there"),
            ("ids=1-4,delay=0,baud=34", "servos answer at 57600 baud"),
            ("ids=21-24,delay=0", "the ids are others"),
            ("ids=1-4,delay=0,drop=0.2", "the line is disturbed"),
            ("ids=1-4,delay=0,hot=2", "servo 2 complains of: overheat"),
            ("ids=1-4,delay=0,supply=5", "complains of: voltage"),
            ("ids=1-4,delay=0,level=0", "has status level 0"),
            ("ids=1-4,delay=250", "waits 500 us"),
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
    fn a_bus_that_is_well_has_no_cause() {
        let diagnosis = diagnose("ids=1-4,delay=0", &[1, 2, 3, 4]);
        assert!(diagnosis.causes.is_empty(), "{:?}", diagnosis.causes);
        assert!(diagnosis.pulses.iter().all(|pulse| pulse.answered == PINGS));
    }
}
