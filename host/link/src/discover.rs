//! Who is on the bus: pings of one id after the other in Protocol 1.0, of all at once in 2.0.

use super::port::SerialLink;
use super::protocol::Protocol;
use super::servo_error::{ServoError, ServoResult};
use super::servos::Servos;
use super::status_error::StatusError;

/// So many ids are pinged one by one even where a broadcast did not find them.
const FEW: usize = 20;
/// How often an id that gives a sign of life is asked.
const TRIES: u8 = 3;

/// Ids that gave a sign of life.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Answering {
    /// Those that answer a ping, and what they complain of.
    pub sound: Vec<(u8, StatusError)>,
    /// Those at whose pings bytes came, but no sound answer: two servos of one id, noise, or a bad
    /// line.
    pub garbled: Vec<u8>,
}

impl Answering {
    /// Ids of those that answer.
    pub fn ids(&self) -> Vec<u8> {
        self.sound.iter().map(|(id, _)| *id).collect()
    }

    fn take(&mut self, id: u8, pinged: ServoResult<StatusError>) -> ServoResult<()> {
        match pinged {
            Ok(error) => self.sound.push((id, error)),
            Err(ServoError::NoResponse { .. }) => {}
            Err(ServoError::Port(error)) => return Err(ServoError::Port(error)),
            Err(_) => self.garbled.push(id),
        }
        Ok(())
    }
}

impl<L: SerialLink> Servos<L> {
    /// Those of `ids` that answer in this protocol, which is the servos' from now on. A silent id
    /// is asked `patience` times; `step` is told of each id.
    ///
    /// # Errors
    /// The port failed.
    pub fn answering_in(
        &mut self,
        protocol: Protocol,
        ids: &[u8],
        patience: u8,
        mut step: impl FnMut(),
    ) -> ServoResult<Answering> {
        self.protocol = Some(protocol);
        let mut found = Answering::default();
        // A servo that did not hear the broadcast, or was not heard, is asked by itself.
        let (heard, strays) = match protocol {
            Protocol::One => (Vec::new(), 0),
            Protocol::Two => self.ping_all()?,
        };
        let asks_all = protocol == Protocol::One || strays > 0 || ids.len() <= FEW;
        let tries = self.tries;
        for id in ids {
            step();
            if !asks_all && !heard.contains(id) {
                continue;
            }
            self.tries = patience;
            let mut pinged = self.ping(*id);
            let has_spoken = !matches!(
                pinged,
                Ok(_) | Err(ServoError::NoResponse { .. } | ServoError::Port(_))
            );
            if has_spoken || (pinged.is_err() && heard.contains(id)) {
                self.tries = TRIES;
                pinged = self.ping(*id);
            }
            self.tries = tries;
            found.take(*id, pinged)?;
        }
        Ok(found)
    }

    /// Those of `ids` that answer in the protocol that was set; else in 1.0, or in 2.0 where none
    /// does in that. The servos are left with the protocol in which they answer, if any does.
    ///
    /// # Errors
    /// The port failed.
    pub fn answering(&mut self, ids: &[u8]) -> ServoResult<Answering> {
        if let Some(protocol) = self.protocol {
            return self.answering_in(protocol, ids, TRIES, || ());
        }
        let one = self.answering_in(Protocol::One, ids, TRIES, || ())?;
        if !one.sound.is_empty() {
            return Ok(one);
        }
        let mut two = self.answering_in(Protocol::Two, ids, TRIES, || ())?;
        two.garbled.extend(one.garbled);
        two.garbled.sort_unstable();
        two.garbled.dedup();
        if two.sound.is_empty() {
            self.protocol = None;
        }
        Ok(two)
    }
}

/// Ids in words, `1-3, 7`; neighbours are drawn together.
pub fn id_ranges(ids: &[u8]) -> String {
    let mut runs: Vec<(u8, u8)> = Vec::new();
    for id in ids {
        match runs.last_mut() {
            Some((_, last)) if last.checked_add(1) == Some(*id) => *last = *id,
            _ => runs.push((*id, *id)),
        }
    }
    let word = |(first, last): &(u8, u8)| {
        if first == last {
            first.to_string()
        } else {
            format!("{first}-{last}")
        }
    };
    runs.iter().map(word).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
#[cfg(feature = "virtual-cm5")]
mod tests {
    use super::*;
    use crate::virtual_cm5::SimLink;

    fn answering(words: &str, ids: &[u8]) -> (Vec<u8>, Vec<u8>, Option<Protocol>) {
        let mut servos = Servos::new(SimLink::adapter(words).unwrap());
        let found = servos.answering(ids).unwrap();
        (found.ids(), found.garbled, servos.protocol)
    }

    #[test]
    fn those_that_answer_are_found_in_either_protocol() {
        let all: Vec<u8> = (1..=18).collect();
        for (words, protocol) in [("", Protocol::One), ("model=XL330-M288,", Protocol::Two)] {
            let found = answering(&format!("{words}ids=1-3+7,dead=2,drop=0.05"), &all);
            assert_eq!(found, (vec![1, 3, 7], vec![], Some(protocol)), "{words}");
        }
        assert_eq!(answering("ids=20-21", &all), (vec![], vec![], None));
    }

    /// Answers of two AX-12 that miss each other by a byte may be sound now and then.
    #[test]
    fn two_servos_of_one_id_are_not_overheard() {
        for ids in [(1..=18).collect(), (0..=252).collect::<Vec<u8>>()] {
            let (sound, garbled, _) = answering("model=XL330-M288,ids=1-4+3,delay=0", &ids);
            assert_eq!((sound, garbled), (vec![1, 2, 4], vec![3]));
            let (sound, garbled, _) = answering("ids=1-4+3,delay=0", &ids);
            let mut all = [sound, garbled].concat();
            all.sort_unstable();
            assert_eq!(all, [1, 2, 3, 4]);
        }
    }

    #[test]
    fn neighbours_are_drawn_together() {
        assert_eq!(id_ranges(&[1, 2, 3, 7, 254, 255]), "1-3, 7, 254-255");
        assert_eq!(id_ranges(&[]), "");
    }
}
