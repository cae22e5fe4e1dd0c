//! Recordings one after the other in one file: time begins anew, and a column may count them.

use super::Guess;
use crate::RawLog;

/// The column that steps exactly where time begins anew; what was found is said.
pub fn stepping_segment(log: &RawLog, time: usize, said: &mut Vec<Guess>) -> Option<String> {
    let restarts = steps(&log.columns[time], |before, after| after < before);
    if restarts.is_empty() {
        return None;
    }
    let columns = (0..log.columns.len()).filter(|index| *index != time);
    let mut stepping = columns.filter(|index| {
        let column = &log.columns[*index];
        column.iter().all(|value| value.is_finite())
            && steps(column, |before, after| before != after) == restarts
    });
    let times = match restarts.len() {
        1 => "once".to_string(),
        several => format!("{several} times"),
    };
    let found = stepping.next();
    said.push(match found {
        Some(index) => Guess::new(
            "segment",
            format!("column {:?}", log.names[index]),
            format!("time begins anew {times}, and it steps there"),
        ),
        None => Guess::new(
            "segment",
            "no column",
            format!(
                "time begins anew {times}, first in row {}, and no column steps there: add one \
                 that counts the recordings, or give row ranges",
                restarts[0]
            ),
        ),
    });
    found.map(|index| log.names[index].clone())
}

/// Rows before which two values differ so.
fn steps(values: &[f64], differ: impl Fn(f64, f64) -> bool) -> Vec<usize> {
    let pairs = values.windows(2).enumerate();
    let steps = pairs.filter(|(_, pair)| differ(pair[0], pair[1]));
    steps.map(|(row, _)| row + 1).collect()
}
