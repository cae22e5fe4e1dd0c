//! Writes a motion as a CSV log.

use crate::model::{Column, ColumnMean, LogColumns};
use crate::motion::Motion;

/// The text of a log that [`super::read`] reads back to the same motion under the same columns.
///
/// `comments` go first, each line behind `# `; payload, orientation and segment, where the columns
/// name them, follow as `# key = value`. Values are in each column's unit, rounded to 12
/// significant digits. A column the motion has no values for is left out.
pub fn to_csv(motion: &Motion, columns: &LogColumns, comments: &[String]) -> String {
    let mut text = String::new();
    if let Some(payload) = &columns.payload {
        let written = written(payload, motion.payload_kg);
        text += &format!("# {} = {written}\n", payload.name);
    }
    if let Some(name) = &columns.turned {
        text += &format!("# {name} = {}\n", u8::from(motion.turned));
    }
    if let Some(name) = &columns.segment {
        text += &format!("# {name} = 0\n");
    }
    for line in comments.iter().flat_map(|comment| comment.lines()) {
        text += &format!("# {line}\n");
    }
    let series = series(motion, columns);
    let mut rows = ::csv::Writer::from_writer(Vec::new());
    // Writing to memory does not fail, and every record is as long as the header.
    let _ = rows.write_record(series.iter().map(|(name, _)| *name));
    for sample in 0..motion.len() {
        let _ = rows.write_record(series.iter().map(|(_, values)| match values {
            Values::Numbers(column, values) => written(column, values[sample]),
            Values::Flags(values) => u8::from(values[sample]).to_string(),
        }));
    }
    text += &String::from_utf8_lossy(&rows.into_inner().unwrap_or_default());
    text
}

enum Values<'a> {
    Numbers(&'a Column, &'a [f64]),
    Flags(&'a [bool]),
}

fn series<'a>(motion: &'a Motion, columns: &'a LogColumns) -> Vec<(&'a str, Values<'a>)> {
    fn numbers<'a>(column: &'a Column, values: &'a [f64]) -> (&'a str, Values<'a>) {
        (&column.name, Values::Numbers(column, values))
    }
    let mut series = vec![numbers(&columns.time, &motion.time_s)];
    for (i, joint) in columns.joints.iter().enumerate() {
        let own = [
            (&joint.position, Some(&motion.position_rad[i])),
            (&joint.velocity, motion.velocity_rad_s[i].as_ref()),
            (
                &joint.rate,
                motion.rate_rad_s.get(i).and_then(Option::as_ref),
            ),
            (&joint.input, motion.input[i].as_ref()),
        ];
        for (mean, values) in own {
            let columns = mean.iter().flat_map(ColumnMean::columns);
            series.extend(
                values
                    .into_iter()
                    .flat_map(|values| columns.clone().map(move |column| numbers(column, values))),
            );
        }
    }
    if let (Some(column), Some(values)) = (&columns.supply, &motion.supply_v) {
        series.push(numbers(column, values));
    }
    if let (Some(name), Some(values)) = (&columns.torque_on, &motion.torque_on) {
        series.push((name, Values::Flags(values)));
    }
    series
}

/// The inverse of [`Column::to_si`], as text; nothing of what was not measured.
fn written(column: &Column, si: f64) -> String {
    if si.is_nan() {
        return String::new();
    }
    let sign = if column.reversed { -1.0 } else { 1.0 };
    let value = sign * (si - column.offset) / column.unit.si;
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    // Zero from either side is written the same.
    (rounded + 0.0).to_string()
}
