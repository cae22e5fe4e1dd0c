//! A rosbag2 in SQLite: joint states of its topics.

use super::joint_states::JointStates;
use super::sqlite::{Sqlite, Value};
use super::{LogTable, TableFile};
use crate::cdr::{JointStateMessage, NAME};
use crate::error::Result;
use std::collections::HashMap;

pub(super) fn read(bytes: &[u8], file: TableFile) -> Result<LogTable> {
    let broken = |why: &str| {
        file.wrong(
            why,
            "give a rosbag2 that was closed, not compressed: ros2 bag convert makes one",
        )
    };
    let bag = Sqlite::open(bytes).map_err(broken)?;
    let second = file.path.with_file_name(format!(
        "{}-wal",
        file.path.file_name().unwrap_or_default().to_string_lossy()
    ));
    if bag.has_log_of_writes() && second.metadata().is_ok_and(|facts| facts.len() > 0) {
        let remedy = "close the bag first: sqlite3 FILE 'PRAGMA wal_checkpoint(TRUNCATE)'";
        return Err(file.wrong(format!("rows are still in {}", second.display()), remedy));
    }
    let mut topics: HashMap<i64, String> = HashMap::new();
    bag.rows("topics", &mut |columns, (number, values)| {
        let value = |name: &str| value(columns, &values, name);
        let is_states = value("type").and_then(Value::text) == Some(NAME);
        let is_cdr = value("serialization_format").and_then(Value::text) == Some("cdr");
        if let (Some(name), true) = (value("name").and_then(Value::text), is_states && is_cdr) {
            topics.insert(integer(value("id")).unwrap_or(number), name.to_string());
        }
        Ok(())
    })
    .map_err(broken)?;
    let mut states = JointStates::default();
    let mut refused = None;
    let read = bag.rows("messages", &mut |columns, (number, values)| {
        let value = |name: &str| value(columns, &values, name);
        let topic = integer(value("topic_id")).and_then(|id| topics.get(&id));
        let (Some(topic), Some(Value::Bytes(data))) = (topic, value("data")) else {
            return Ok(());
        };
        let logged_ns = integer(value("timestamp")).unwrap_or(0) as u64;
        let taken = match JointStateMessage::of(data) {
            Some(message) => states.take(topic, logged_ns, &message, file),
            None => Err(broken(&format!("{topic}: message {number} is broken"))),
        };
        taken.map_err(|error| {
            refused = Some(error);
            "a message is refused"
        })
    });
    match (read, refused) {
        (_, Some(error)) => Err(error),
        (Err(why), None) => Err(broken(why)),
        (Ok(()), None) => states.table(file),
    }
}

fn value<'a>(columns: &[String], values: &'a [Value], name: &str) -> Option<&'a Value> {
    values.get(columns.iter().position(|column| column == name)?)
}

/// A whole number; the number of its row stands for a key that is null.
fn integer(value: Option<&Value>) -> Option<i64> {
    match value {
        Some(Value::Integer(value)) => Some(*value),
        _ => None,
    }
}
