//! Reads the JSON logs of Rhoban's BAM bench: one position-driven joint, angles in rad.
//!
//! An object with facts of the run (`mass`, `length`, `kp`, `vin`, `motor`, `trajectory`) and
//! `entries`, each with `timestamp` (s), `position`, `goal_position` (rad), and often `speed`,
//! `input_volts`, `torque_enable`.

use super::format::LogFormat;
use super::read::LEAST_ROWS;
use super::reading_limit::LARGEST_READING;
use super::request::LogRequest;
use super::table::{LogTable, TableFile};
use crate::error::{Error, Place, Result};
use crate::model::{Column, Dimension, JointColumns, LogColumns, RateSensor};
use crate::output::number::hex;
use crate::output::shortened;
use serde_json::Value;
use sha2::{Digest, Sha256};

/// How far a bench's mass, moment and length may lie off the model's, as a share: a model's link
/// counts the arm and what was fitted, the bench its weight.
const TOLERANCE: f64 = 0.25;

/// Keys of an entry, and what the table calls the weight.
const TIME: &str = "timestamp";
const POSITION: &str = "position";
const GOAL: &str = "goal_position";
const SPEED: &str = "speed";
const SUPPLY: &str = "input_volts";
const TORQUE_ON: &str = "torque_enable";
const PAYLOAD: &str = "payload_kg";

/// What the logs of one rig have in common.
#[derive(Debug, Default)]
pub(super) struct BamBench {
    /// The first log that names its gain, and the gain.
    kp: Option<(String, f64)>,
}

/// What a bench's log says of its arm: an even rod with a weight at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BenchFigures {
    /// The weight, kg.
    pub mass_kg: f64,
    /// The rod, kg; 0 where the log says nothing of it.
    pub arm_mass_kg: f64,
    /// From the joint to the weight, m.
    pub length_m: f64,
}

impl BenchFigures {
    fn of(log: &Value) -> Option<BenchFigures> {
        let number = |key: &str| log.get(key).and_then(Value::as_f64);
        Some(BenchFigures {
            mass_kg: number("mass")?,
            arm_mass_kg: number("arm_mass").unwrap_or(0.0),
            length_m: number("length")?,
        })
    }
}

/// Reads the entries asked for, and the columns that say what they are.
///
/// Where `columns` name a payload, each log's own weight is it, and the model's one link is the rod;
/// else the link is both. `kp` must be that of the logs before. Speed, supply and `torque_enable`
/// are taken where every entry has them. A row's line is its entry, counted from 1.
///
/// # Errors
/// Broken JSON with its line and column; a missing or wrong value with its entry and key; time that
/// does not increase; fewer than [`LEAST_ROWS`] entries; mass, length or gain of another rig; a
/// model of several joints.
pub(super) fn read(
    request: &LogRequest,
    columns: &LogColumns,
    bench: &mut BamBench,
) -> Result<(LogTable, LogColumns)> {
    let path = &request.path;
    let file = TableFile { path };
    let bytes = LogTable::bytes(path, LogFormat::Bam)?;
    let mut table = read_of(&bytes, request, Some(columns), bench)?;
    table.sha256 = hex(Sha256::digest(&bytes));
    let joints = columns.joints.len();
    if joints != 1 {
        return Err(file.wrong(
            format!("a log of BAM is of one joint, the model of {joints}"),
            "give it with the model of its bench's arm",
        ));
    }
    let own = own_columns(&table, columns.split_at_gap_s);
    Ok((table, own))
}

/// Reads a log without a model.
///
/// # Errors
/// As [`read`].
pub(super) fn read_alone(bytes: &[u8], file: TableFile) -> Result<LogTable> {
    let request = LogRequest::whole(file.path);
    read_of(bytes, &request, None, &mut BamBench::default())
}

/// The columns of a bench's table: its names and units are its own, whatever a model says.
fn own_columns(table: &LogTable, split_at_gap_s: Option<f64>) -> LogColumns {
    let column = |name: &str, dimension: Dimension| Column {
        name: name.to_string(),
        unit: dimension.si(),
        offset: 0.0,
        reversed: false,
        resolution: None,
        shift_s: 0.0,
    };
    let has = |name: &&str| table.names.iter().any(|own| own == name);
    let mean = |name: &str| Some(column(name, Dimension::Angle).into());
    let [speed, supply] = [SPEED, SUPPLY].map(|name| Some(name).filter(has));
    LogColumns {
        time: column(TIME, Dimension::Time),
        segment: None,
        supply: supply.map(|name| column(name, Dimension::Voltage)),
        torque_on: Some(TORQUE_ON).filter(has).map(str::to_string),
        payload: Some(column(PAYLOAD, Dimension::Mass)),
        payload_at_m: 0.0,
        payload_on: None,
        turned: None,
        joints: vec![JointColumns {
            position: mean(POSITION),
            velocity: speed.map(|name| column(name, Dimension::Speed).into()),
            rate: None,
            rate_sensor: RateSensor::default(),
            input: mean(GOAL),
        }],
        arm: None,
        split_at_gap_s,
    }
}

fn read_of(
    bytes: &[u8],
    request: &LogRequest,
    columns: Option<&LogColumns>,
    bench: &mut BamBench,
) -> Result<LogTable> {
    let path = &request.path;
    let log: Value = serde_json::from_slice(bytes).map_err(|error| {
        let place = Place::at(path, error.line().max(1), error.column().max(1));
        Error::data(
            place,
            format!("not JSON: {error}"),
            "was the recording broken off? Record again, or export CSV",
        )
    })?;
    let file = TableFile { path };
    let figures = BenchFigures::of(&log);
    let payload_kg = match columns {
        Some(columns) => payload_kg(&log, file, figures, columns)?,
        None => 0.0,
    };
    bench.check(&log, request)?;
    let entries = Entries::of(&log, request, file)?;
    let time_s = entries.times_s()?;
    let mut table = LogTable {
        constants: vec![(PAYLOAD.to_string(), payload_kg, 1)],
        is_si: true,
        bench: figures,
        first: entries.first,
        is_entries: true,
        ..LogTable::default()
    };
    let mut push = |name: &str, column: Option<Vec<f64>>| {
        if let Some(column) = column {
            table.names.push(name.to_string());
            table.columns.push(column);
        }
    };
    push(TIME, Some(time_s));
    push(POSITION, Some(entries.numbers(POSITION)?));
    push(GOAL, Some(entries.goals()?));
    push(SPEED, entries.optional(SPEED)?);
    push(SUPPLY, entries.optional(SUPPLY)?);
    let flags = entries.flags(TORQUE_ON)?;
    push(TORQUE_ON, flags.filter(|_| columns.is_some()));
    Ok(table)
}

/// The payload of a log, kg, once its figures agree with the model's.
fn payload_kg(
    log: &Value,
    file: TableFile,
    figures: Option<BenchFigures>,
    columns: &LogColumns,
) -> Result<f64> {
    let payload_kg = columns.payload.as_ref().map(|payload| {
        let value = log.get(&payload.name).and_then(Value::as_f64);
        let value = value.filter(|value| value.is_finite() && *value >= 0.0);
        value.map(|value| payload.to_si(value)).ok_or_else(|| {
            file.wrong(
                format!(
                    "no number '{}' beside the entries, which the model's payload is",
                    shortened(&payload.name)
                ),
                "payload = { column = \"mass\", unit = \"kg\", at_m = LENGTH } is the key of BAM",
            )
        })
    });
    let payload_kg = payload_kg.transpose()?;
    let (Some(arm), Some(bench)) = (columns.arm, figures) else {
        return Ok(payload_kg.unwrap_or(0.0));
    };
    let BenchFigures {
        mass_kg,
        arm_mass_kg: rod_kg,
        length_m,
    } = bench;
    let moment_kg_m = arm.mass_kg * arm.com_m.abs();
    let compared = match payload_kg {
        None => vec![
            ("mass", mass_kg + rod_kg, arm.mass_kg, "kg"),
            (
                "mass times length",
                (mass_kg + rod_kg / 2.0) * length_m,
                moment_kg_m,
                "kg m",
            ),
        ],
        Some(_) => vec![
            ("length", length_m, columns.payload_at_m.abs(), "m"),
            ("arm_mass", rod_kg, arm.mass_kg, "kg"),
        ],
    };
    // Of a rod whose mass the log does not say, nothing can be held against the model.
    let said = compared.into_iter().filter(|(_, found, ..)| *found > 0.0);
    for (quantity, found, expected, unit) in said {
        if (found - expected).abs() > TOLERANCE * expected {
            return Err(file.wrong(
                format!(
                    "the log's {quantity} is {found:.4} {unit}, the model has {expected:.4} {unit}"
                ),
                "mend the model's link; logs of several weights fit one model whose link is the \
                 arm alone, with payload = { column = \"mass\", unit = \"kg\", at_m = LENGTH } in \
                 its [log]",
            ));
        }
    }
    Ok(payload_kg.unwrap_or(0.0))
}

impl BamBench {
    /// Holds a log's gain against those of the logs before.
    fn check(&mut self, log: &Value, request: &LogRequest) -> Result<()> {
        let number = |key: &str| log.get(key).and_then(Value::as_f64);
        match (number("kp"), &self.kp) {
            (Some(found), Some((first, expected))) if found != *expected => {
                return Err(Error::data(
                    Place::file(&request.path),
                    format!("kp is {found}, and {expected} in {first}"),
                    "give the logs of one gain together: a model's drive has one gain",
                ));
            }
            (Some(kp), None) => self.kp = Some((request.name(), kp)),
            _ => {}
        }
        Ok(())
    }
}

struct Entries<'a> {
    file: TableFile<'a>,
    list: &'a [Value],
    first: usize,
}

impl Entries<'_> {
    /// Those asked for.
    fn of<'a>(log: &'a Value, request: &LogRequest, file: TableFile<'a>) -> Result<Entries<'a>> {
        let all = log.get("entries").and_then(Value::as_array);
        let all = all.ok_or_else(|| {
            file.wrong(
                "no list 'entries'",
                "a BAM log is an object with a list 'entries'; save the records of other JSON as \
                 CSV, in Python: pandas.read_json(\"log.json\").to_csv(\"log.csv\", index=False)",
            )
        })?;
        let entries = all.len();
        let (first, last) = request.rows.unwrap_or((0, entries.saturating_sub(1)));
        if first >= entries || last >= entries || last - first + 1 < LEAST_ROWS {
            return Err(file.wrong(
                format!("entries {first}-{last} of {entries}; at least {LEAST_ROWS} are needed"),
                "entries count from 0; record longer if there are too few",
            ));
        }
        let list = &all[first..=last];
        Ok(Entries { file, list, first })
    }

    /// Times, which increase, s.
    fn times_s(&self) -> Result<Vec<f64>> {
        let time_s = self.numbers(TIME)?;
        match time_s.windows(2).position(|pair| pair[1] <= pair[0]) {
            None => Ok(time_s),
            Some(late) => Err(self.file.wrong(
                format!(
                    "entry {}, timestamp: time does not increase: {} s after {} s",
                    self.first + late + 1,
                    time_s[late + 1],
                    time_s[late]
                ),
                "ask for a range of entries without the step, such as log.json:0-99",
            )),
        }
    }

    fn numbers(&self, key: &'static str) -> Result<Vec<f64>> {
        let numbered = self.list.iter().enumerate();
        numbered
            .map(|(index, entry)| self.number(index, key, entry.get(key)))
            .collect()
    }

    fn optional(&self, key: &'static str) -> Result<Option<Vec<f64>>> {
        if self.has(key) {
            self.numbers(key).map(Some)
        } else {
            Ok(None)
        }
    }

    /// Goals; a released servo may have none, and then keeps its last.
    fn goals(&self) -> Result<Vec<f64>> {
        let key = GOAL;
        let mut held = None;
        let mut goals = Vec::with_capacity(self.list.len());
        for (index, entry) in self.list.iter().enumerate() {
            let released = entry
                .get(TORQUE_ON)
                .is_some_and(|on| flag(on) == Some(false));
            match (entry.get(key), held) {
                (None | Some(Value::Null), Some(goal)) if released => goals.push(goal),
                (value, _) => goals.push(self.number(index, key, value)?),
            }
            held = goals.last().copied();
        }
        Ok(goals)
    }

    fn flags(&self, key: &'static str) -> Result<Option<Vec<f64>>> {
        if !self.has(key) {
            return Ok(None);
        }
        let numbered = self.list.iter().enumerate();
        let flags = numbered.map(|(index, entry)| {
            let value = entry.get(key);
            value
                .and_then(flag)
                .map(|on| f64::from(u8::from(on)))
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
        if key == TIME || number.abs() <= LARGEST_READING {
            Ok(number)
        } else {
            Err(self.wrong(index, key, value, "a reading of at most 1000000"))
        }
    }

    fn wrong(
        &self,
        index: usize,
        key: &'static str,
        value: Option<&Value>,
        expected: &str,
    ) -> Error {
        let found = value.map_or("nothing".to_string(), |value| {
            shortened(&value.to_string()).into_owned()
        });
        self.file.wrong(
            format!(
                "entry {}, {key}: {found} is not {expected}",
                self.first + index
            ),
            "leave the entry out by a range such as log.json:0-99, or record again",
        )
    }
}

fn flag(value: &Value) -> Option<bool> {
    value
        .as_bool()
        .or_else(|| value.as_f64().map(|number| number != 0.0))
}
