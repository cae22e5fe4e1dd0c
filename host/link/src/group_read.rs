//! Reading several servos of Protocol 2.0 at once: sync, fast sync and bulk read. Each servo has a
//! result of its own.

use super::exchange::PROCESSING;
use super::port::{SerialLink, read_some};
use super::protocol::Protocol;
use super::reply::{Reading, statuses};
use super::servo_error::{ServoError, ServoResult};
use super::servo_rows::Model;
use super::servos::Servos;
use super::status_error::StatusError;
use handstand_shared::dynamixel2::{BROADCAST, HEADER, MAX_PACKET, Request, fast_parts};
use std::collections::BTreeMap;

/// What is read of one servo.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct GroupItem {
    /// The servo.
    pub id: u8,
    /// First register.
    pub address: u16,
    /// Bytes.
    pub count: u16,
}

impl<L: SerialLink> Servos<L> {
    /// What each item says, in their order. All of one address and length are a sync read, a fast
    /// one where every servo's firmware has it and `identify` has asked them; others a bulk read.
    /// An id may come once.
    ///
    /// A servo that is missing may silence those behind it: the missing ones are asked again, the
    /// first of them last, [`Servos::tries`] times in all.
    ///
    /// # Errors
    /// [`ServoError::Port`] only.
    pub fn read_group(&mut self, items: &[GroupItem]) -> ServoResult<Vec<ServoResult<Reading>>> {
        let mut found = BTreeMap::new();
        let mut wanted = items.to_vec();
        for attempt in 0..self.tries.max(1) {
            if wanted.is_empty() {
                break;
            }
            self.retries += u64::from(attempt > 0);
            // A joint status is worth little where a servo is missing.
            let fast = attempt == 0 && self.all_fast(&wanted);
            let room = MAX_PACKET / 2;
            for some in wanted.chunks(in_one_packet(&wanted, room)) {
                self.read_once(some, fast, &mut found)?;
            }
            wanted.retain(|item| !found.contains_key(&item.id));
            if !wanted.is_empty() {
                wanted.rotate_left(1);
            }
        }
        let of = |item: &GroupItem| match found.remove(&item.id) {
            Some(reading) => {
                if reading.data.len() == usize::from(item.count) {
                    Ok(reading)
                } else {
                    Err(ServoError::Refused {
                        id: item.id,
                        error: reading.error,
                    })
                }
            }
            None => Err(ServoError::NoResponse { id: item.id }),
        };
        Ok(items.iter().map(of).collect())
    }

    fn all_fast(&self, items: &[GroupItem]) -> bool {
        items.iter().all(|item| {
            let known = self.identities.get(&item.id);
            known.is_some_and(|it| {
                matches!(it.model, Some(Model::Two(model)) if model.has_fast_read(it.firmware))
            })
        })
    }

    fn read_once(
        &mut self,
        items: &[GroupItem],
        fast: bool,
        found: &mut BTreeMap<u8, Reading>,
    ) -> ServoResult<()> {
        let echoes = self.echoes()?;
        self.link().clear()?;
        let sent = packet(items, fast);
        self.link().send(&sent)?;
        let echo = if echoes { sent.len() } else { 0 };
        let answer = answer_bytes(items, fast);
        let line = self.link().line_time(sent.len() + echo + answer);
        let waits = items
            .iter()
            .map(|item| self.return_delay(item.id) + PROCESSING);
        let delay = if fast {
            waits.max().unwrap_or_default()
        } else {
            waits.sum()
        };
        let deadline = self.link().now() + line + delay + self.link().latency();
        // Bytes are taken apart when as many came as were asked for, not at each of them.
        let bytes = read_some(self.link(), deadline, |bytes| {
            bytes.len() >= echo + answer && all(&read(&bytes[echo..], items, fast), items)
        })?;
        let bytes = bytes.get(echo..).unwrap_or(&[]);
        for (id, reading) in read(bytes, items, fast) {
            if items.iter().any(|item| item.id == id) && !reading.error.is_corrupted_request() {
                found.entry(id).or_insert(reading);
            }
        }
        Ok(())
    }
}

/// Bytes of request and answers of one read of these servos without stuffing: the line's limit.
pub fn group_read_bytes(items: &[GroupItem], fast: bool) -> usize {
    packet(items, fast).len() + answer_bytes(items, fast)
}

fn answer_bytes(items: &[GroupItem], fast: bool) -> usize {
    let counts = items.iter().map(|item| usize::from(item.count));
    if fast {
        8 + counts.map(|count| count + 4).sum::<usize>()
    } else {
        counts.map(|count| Protocol::Two.status_length(count)).sum()
    }
}

/// How many of these items fit a packet, at least one.
fn in_one_packet(items: &[GroupItem], room: usize) -> usize {
    let longest = items.iter().map(|item| usize::from(item.count) + 5).max();
    (room / longest.unwrap_or(1)).max(1)
}

fn packet(items: &[GroupItem], fast: bool) -> Vec<u8> {
    let Some(first) = items.first() else {
        return Vec::new();
    };
    let same = |item: &GroupItem| (item.address, item.count) == (first.address, first.count);
    let mut out = [0; MAX_PACKET];
    let length = if items.iter().all(same) {
        let ids: Vec<u8> = items.iter().map(|item| item.id).collect();
        let read = Request::SyncRead {
            fast,
            address: first.address,
            count: first.count,
            ids: &ids,
        };
        read.emit(BROADCAST, &mut out)
    } else {
        let of = |item: &GroupItem| {
            let ([a, b], [c, d]) = (item.address.to_le_bytes(), item.count.to_le_bytes());
            [item.id, a, b, c, d]
        };
        let items: Vec<u8> = items.iter().flat_map(of).collect();
        let items = &items;
        Request::BulkRead { fast, items }.emit(BROADCAST, &mut out)
    };
    out[..length.unwrap_or(0)].to_vec()
}

fn read(bytes: &[u8], items: &[GroupItem], fast: bool) -> Vec<(u8, Reading)> {
    if !fast {
        return statuses(bytes);
    }
    let begin = bytes.windows(4).position(|four| four == HEADER);
    let lengths = items.iter().map(|item| usize::from(item.count));
    let parts = fast_parts(&bytes[begin.unwrap_or(bytes.len())..], lengths);
    let reading = |part: handstand_shared::dynamixel2::FastPart| Reading {
        error: StatusError::Byte(part.error),
        data: part.data.to_vec(),
    };
    parts.map(|part| (part.id, reading(part))).collect()
}

fn all(found: &[(u8, Reading)], items: &[GroupItem]) -> bool {
    items
        .iter()
        .all(|item| found.iter().any(|(id, _)| *id == item.id))
}
