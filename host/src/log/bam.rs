//! Reads the JSON logs of Rhoban's BAM bench: one position-driven joint, angles in rad.
//!
//! An object with facts of the run (`mass`, `length`, `kp`, `vin`, `motor`, `trajectory`) and
//! `entries`, each with `timestamp` (s), `position`, `goal_position` (rad), and often `speed`,
//! `input_volts`, `torque_enable`.

use super::read::LEAST_ROWS;
use super::reading_limit::LARGEST_READING;
use super::reason::LogReason;
use super::request::LogRequest;
use super::{Motion, MotionSource};
use crate::error::{Error, Place, Result};
use crate::model::ArmFigures;
use crate::output::number::hex;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::path::Path;

/// How far a bench's mass and moment may lie off the model's, as a share: a model's link counts the
/// arm and what was fitted, the bench its weight.
const TOLERANCE: f64 = 0.25;

/// What the logs of one rig have in common.
#[derive(Debug, Default)]
pub(super) struct BamBench {
    /// The first log that names its gain, and the gain.
    kp: Option<(String, f64)>,
}

/// Reads the log, or the entries asked for, as one motion.
///
/// The mass in the file belongs to the model, so the motion carries no payload; with `length`, it
/// must be that of the model's one link, and `kp` that of the logs before. Speed, supply and
/// `torque_enable` are taken where every entry has them. `source.lines` holds entries, counted from
/// 1.
///
/// # Errors
/// Broken JSON with its line and column; a missing or wrong value with its entry and key; time that
/// does not increase; fewer than [`LEAST_ROWS`] entries; mass, length or gain of another rig.
pub(super) fn read(
    request: &LogRequest,
    arm: Option<ArmFigures>,
    bench: &mut BamBench,
) -> Result<Motion> {
    let path = &request.path;
    let bytes = std::fs::read(path).map_err(|source| Error::file(path, "read", source))?;
    let log: Value = serde_json::from_slice(&bytes).map_err(|error| {
        let place = Place::at(path, error.line().max(1), error.column().max(1));
        let message = error.to_string();
        Error::refused(place, LogReason::NotJson { message })
    })?;
    let refuse = |reason| Error::refused(Place::file(path), reason);
    bench.check(&log, arm, &request.name()).map_err(refuse)?;
    let all = log.get("entries").and_then(Value::as_array);
    let all = all.ok_or_else(|| refuse(LogReason::NoEntries))?;
    let entries = all.len();
    let (first, last) = request.rows.unwrap_or((0, entries.saturating_sub(1)));
    if first >= entries || last >= entries || last - first + 1 < LEAST_ROWS {
        return Err(refuse(LogReason::EntryRange {
            first,
            last,
            entries,
        }));
    }
    let entries = Entries {
        path,
        list: &all[first..=last],
        first,
    };
    let time_s = entries.numbers("timestamp")?;
    if let Some(late) = time_s.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(refuse(LogReason::EntryTime {
            entry: first + late + 1,
            time_s: time_s[late + 1],
            previous_s: time_s[late],
        }));
    }
    Ok(Motion {
        name: request.name(),
        source: MotionSource {
            path: path.clone(),
            sha256: hex(Sha256::digest(&bytes)),
            lines: (first + 1, last + 1),
        },
        position_rad: vec![entries.numbers("position")?],
        velocity_rad_s: vec![entries.optional("speed")?],
        rate_rad_s: vec![None],
        input: vec![Some(entries.goals()?)],
        supply_v: entries.optional("input_volts")?,
        torque_on: entries.flags("torque_enable")?,
        time_s,
        payload_kg: 0.0,
        turned: false,
    })
}

impl BamBench {
    /// Holds a log's figures against the model's, and its gain against the logs before.
    fn check(&mut self, log: &Value, arm: Option<ArmFigures>, name: &str) -> Result<(), LogReason> {
        let number = |key: &str| log.get(key).and_then(Value::as_f64);
        if let (Some(arm), Some(mass_kg), Some(length_m)) = (arm, number("mass"), number("length"))
        {
            let rod_kg = number("arm_mass").unwrap_or(0.0);
            let (found_kg, found_kg_m) = (mass_kg + rod_kg, (mass_kg + rod_kg / 2.0) * length_m);
            let compared = [
                ("mass", found_kg, arm.mass_kg, "kg"),
                (
                    "mass times length",
                    found_kg_m,
                    arm.mass_kg * arm.com_m.abs(),
                    "kg m",
                ),
            ];
            for (quantity, found, expected, unit) in compared {
                if (found - expected).abs() > TOLERANCE * expected {
                    return Err(LogReason::OtherRig {
                        quantity,
                        found,
                        expected,
                        unit,
                    });
                }
            }
        }
        match (number("kp"), &self.kp) {
            (Some(found), Some((first, expected))) if found != *expected => {
                let (expected, first) = (*expected, first.clone());
                Err(LogReason::OtherGain {
                    found,
                    expected,
                    first,
                })
            }
            (Some(kp), None) => {
                self.kp = Some((name.to_string(), kp));
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

struct Entries<'a> {
    path: &'a Path,
    list: &'a [Value],
    first: usize,
}

impl Entries<'_> {
    fn numbers(&self, key: &'static str) -> Result<Vec<f64>> {
        let numbered = self.list.iter().enumerate();
        numbered
            .map(|(index, entry)| self.number(index, key, entry.get(key)))
            .collect()
    }

    fn optional(&self, key: &'static str) -> Result<Option<Vec<f64>>> {
        match self.has(key) {
            true => self.numbers(key).map(Some),
            false => Ok(None),
        }
    }

    /// Goals; a released servo may have none, and then keeps its last.
    fn goals(&self) -> Result<Vec<f64>> {
        let key = "goal_position";
        let mut held = None;
        let mut goals = Vec::with_capacity(self.list.len());
        for (index, entry) in self.list.iter().enumerate() {
            let released = entry
                .get("torque_enable")
                .is_some_and(|on| flag(on) == Some(false));
            match (entry.get(key), held) {
                (None | Some(Value::Null), Some(goal)) if released => goals.push(goal),
                (value, _) => goals.push(self.number(index, key, value)?),
            }
            held = goals.last().copied();
        }
        Ok(goals)
    }

    fn flags(&self, key: &'static str) -> Result<Option<Vec<bool>>> {
        if !self.has(key) {
            return Ok(None);
        }
        let numbered = self.list.iter().enumerate();
        let flags = numbered.map(|(index, entry)| {
            let value = entry.get(key);
            value
                .and_then(flag)
                .ok_or_else(|| self.wrong(index, key, value, "true or false"))
        });
        flags.collect::<Result<_>>().map(Some)
    }

    fn has(&self, key: &'static str) -> bool {
        self.list
            .iter()
            .all(|entry| entry.get(key).is_some_and(|value| !value.is_null()))
    }

    fn number(&self, index: usize, key: &'static str, value: Option<&Value>) -> Result<f64> {
        let number = value
            .and_then(Value::as_f64)
            .ok_or_else(|| self.wrong(index, key, value, "a number"))?;
        match key == "timestamp" || number.abs() <= LARGEST_READING {
            true => Ok(number),
            false => Err(self.wrong(index, key, value, "a reading of at most 1000000")),
        }
    }

    fn wrong(
        &self,
        index: usize,
        key: &'static str,
        value: Option<&Value>,
        expected: &'static str,
    ) -> Error {
        let found = value.map_or("nothing".to_string(), |value| {
            value.to_string().chars().take(40).collect()
        });
        let reason = LogReason::WrongEntry {
            entry: self.first + index,
            key,
            found,
            expected,
        };
        Error::refused(Place::file(self.path), reason)
    }
}

fn flag(value: &Value) -> Option<bool> {
    value
        .as_bool()
        .or_else(|| value.as_f64().map(|number| number != 0.0))
}
