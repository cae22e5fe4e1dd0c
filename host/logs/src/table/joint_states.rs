//! Joint states of one or several topics as one table.

use super::{LogTable, MOST_CELLS, TableFile};
use crate::cdr::JointStateMessage;
use crate::error::Result;
use std::collections::{BTreeMap, HashMap};

/// The topic whose messages are the rows, where it is there.
const STATES: &str = "/joint_states";
/// Behind a joint's name.
const QUANTITIES: [&str; 3] = ["position", "velocity", "effort"];

/// Messages as they come.
#[derive(Debug, Default)]
pub(super) struct JointStates {
    topics: BTreeMap<String, Topic>,
    /// Other series, held between their samples: stamp in ns, value.
    series: BTreeMap<String, Vec<(u64, f64)>>,
    /// Numbers that messages held, and cells they fill.
    values: usize,
    cells: usize,
}

#[derive(Debug, Default)]
struct Topic {
    joints: Vec<String>,
    index_of: HashMap<String, usize>,
    stamp_ns: Vec<u64>,
    /// Per joint its quantities, filled up to the last row that has one.
    columns: Vec<[Vec<f64>; 3]>,
}

impl JointStates {
    /// Takes a message, logged at this time.
    ///
    /// # Errors
    /// So many joints in so few messages that most of the table would be empty.
    pub fn take(
        &mut self,
        topic: &str,
        logged_ns: u64,
        message: &JointStateMessage,
        file: TableFile,
    ) -> Result<()> {
        let topic = self.topics.entry(topic.to_string()).or_default();
        let row = topic.stamp_ns.len();
        topic.stamp_ns.push(match message.stamp_ns {
            0 => logged_ns,
            stamp_ns => stamp_ns,
        });
        for (place, name) in message.name.iter().enumerate() {
            let joint = topic.index_of.get(name).copied().unwrap_or_else(|| {
                topic.joints.push(name.clone());
                topic.columns.push(Default::default());
                topic.index_of.insert(name.clone(), topic.joints.len() - 1);
                topic.joints.len() - 1
            });
            let quantities = [&message.position, &message.velocity, &message.effort];
            for (column, values) in topic.columns[joint].iter_mut().zip(quantities) {
                // A name that stands twice in one message counts once.
                if let Some(value) = values.get(place).filter(|_| column.len() <= row) {
                    self.values += 1;
                    self.cells += row + 1 - column.len();
                    column.resize(row, f64::NAN);
                    column.push(*value);
                }
            }
        }
        self.bounded(file)
    }

    /// Takes a sample of another series.
    pub fn sample(&mut self, name: String, stamp_ns: u64, value: f64) {
        self.series.entry(name).or_default().push((stamp_ns, value));
    }

    /// Whether no message came.
    pub fn is_empty(&self) -> bool {
        self.topics.is_empty()
    }

    fn bounded(&self, file: TableFile) -> Result<()> {
        if self.cells > (16 * self.values + 1_000_000).min(MOST_CELLS) {
            return Err(file.wrong(
                "joints come and go: most of its table would be empty",
                "record the joints of one robot in every message",
            ));
        }
        Ok(())
    }

    /// The table: a row for each message of `/joint_states`, or of the topic with most messages;
    /// other topics hold their last value. `time_s` counts from the first row.
    ///
    /// # Errors
    /// No message.
    pub fn table(mut self, file: TableFile) -> Result<LogTable> {
        let most = |topic: &&String| self.topics[*topic].stamp_ns.len();
        let longest = self.topics.keys().rev().max_by_key(most).cloned();
        let own = self.topics.remove(STATES);
        let Some(rows) = own.or_else(|| self.topics.remove(&longest?)) else {
            return Err(file.wrong(
                "no message of type sensor_msgs/msg/JointState",
                "record the topic of the joints' states",
            ));
        };
        let stamps = &rows.stamp_ns;
        let first_ns = stamps.first().copied().unwrap_or(0);
        let time_s = stamps
            .iter()
            .map(|ns| ns.wrapping_sub(first_ns) as i64 as f64 / 1e9);
        let mut table = LogTable {
            names: vec!["time_s".to_string()],
            columns: vec![time_s.collect()],
            is_si: true,
            ..LogTable::default()
        };
        let mut budget = self.values * 16 + 1_000_000;
        let prefix = |topic: &str| format!("{}/", topic.trim_start_matches('/'));
        let others = std::mem::take(&mut self.topics);
        let others = others
            .into_iter()
            .map(|(name, topic)| (prefix(&name), topic));
        let count = stamps.len();
        let own_stamps = rows.stamp_ns.clone();
        for (prefix, topic) in std::iter::once((String::new(), rows)).chain(others) {
            let places = if prefix.is_empty() {
                (0..count).map(Some).collect()
            } else {
                held_at(&topic.stamp_ns, &own_stamps)
            };
            for (joint, columns) in topic.joints.iter().zip(topic.columns) {
                for (quantity, column) in QUANTITIES.iter().zip(columns) {
                    if column.iter().all(|value| value.is_nan()) {
                        continue;
                    }
                    budget = budget.checked_sub(count).ok_or_else(|| {
                        file.wrong(
                            "most of its table would be empty",
                            "record one robot's joints",
                        )
                    })?;
                    let value = |place: &Option<usize>| {
                        place
                            .and_then(|row| column.get(row))
                            .copied()
                            .unwrap_or(f64::NAN)
                    };
                    table.names.push(format!("{prefix}{joint}.{quantity}"));
                    table.columns.push(places.iter().map(value).collect());
                }
            }
        }
        for (name, samples) in self.series {
            let stamps: Vec<u64> = samples.iter().map(|(ns, _)| *ns).collect();
            let places = held_at(&stamps, &own_stamps);
            let value = |place: &Option<usize>| place.map_or(f64::NAN, |row| samples[row].1);
            table.names.push(name);
            table.columns.push(places.iter().map(value).collect());
        }
        Ok(table)
    }
}

/// For each time the newest sample that is not later; stamps are taken as they come.
fn held_at(stamp_ns: &[u64], times_ns: &[u64]) -> Vec<Option<usize>> {
    let mut newest = 0;
    let place = |time_ns: &u64| {
        while stamp_ns.get(newest).is_some_and(|stamp| stamp <= time_ns) {
            newest += 1;
        }
        newest.checked_sub(1)
    };
    times_ns.iter().map(place).collect()
}
