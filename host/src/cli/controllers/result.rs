//! What became of the robots: tables, CSV, JSON, a plot.

use super::super::show;
use super::Row;
use handstand::controllers::{Condition, Design, Region};
use handstand::plot::heat_map;
use serde_json::{Value, json};

/// Three tables: who is held, from how far, and how well under the last condition.
pub fn text(
    rows: &[Row],
    designs: &[&'static dyn Design],
    conditions: &[&'static Condition],
) -> String {
    let mut parts = vec![format!(
        "Robots held, % of {}:\n{}",
        rows.first().map_or(0, |row| row.tried.robots),
        matrix(rows, designs, conditions, |row| percent(row.tried.held))
    )];
    if rows.iter().any(|row| row.region.is_some()) {
        parts.push(format!(
            "Region: largest spread of starts of which 95 % are held, deg:\n{}",
            matrix(rows, designs, conditions, |row| row
                .region
                .map_or(String::new(), degrees))
        ));
    }
    for condition in conditions
        .iter()
        .filter(|c| conditions.len() <= 2 || c.id.starts_with("all"))
    {
        let mut table = show::table([
            "Controller",
            "held %",
            "fell %",
            "rms deg",
            "swing deg",
            "rms N m",
        ]);
        for row in rows.iter().filter(|row| row.condition.id == condition.id) {
            table.add_row([
                row.design.card().id.to_string(),
                percent(row.tried.held),
                percent(row.tried.fell),
                known(row.tried.rms_angle_rad.map(f64::to_degrees)),
                known(row.tried.swing_rad.map(f64::to_degrees)),
                known(row.tried.rms_torque_nm),
            ]);
        }
        parts.push(format!("{}, of those held:\n{table}", condition.title));
    }
    parts.join("\n\n")
}

fn matrix(
    rows: &[Row],
    designs: &[&'static dyn Design],
    conditions: &[&'static Condition],
    cell: impl Fn(&Row) -> String,
) -> String {
    let mut table = show::wide_table();
    let header = std::iter::once("").chain(conditions.iter().map(|condition| condition.id));
    table.set_header(header);
    for design in designs {
        let own = rows
            .iter()
            .filter(|row| row.design.card().id == design.card().id);
        table.add_row(std::iter::once(design.card().id.to_string()).chain(own.map(&cell)));
    }
    table.to_string()
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

fn known(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.2}"))
}

fn degrees(region: Region) -> String {
    let sign = if region.open { ">" } else { "" };
    format!("{sign}{:.1}", region.spread_rad.to_degrees())
}

/// The shares that were held, as a plot.
pub fn plot(
    rows: &[Row],
    designs: &[&'static dyn Design],
    conditions: &[&'static Condition],
) -> String {
    let ids: Vec<&str> = designs.iter().map(|design| design.card().id).collect();
    let titles: Vec<&str> = conditions.iter().map(|condition| condition.title).collect();
    let fields: Vec<Vec<f64>> = ids
        .iter()
        .map(|id| {
            let own = rows.iter().filter(|row| row.design.card().id == *id);
            own.map(|row| row.tried.held).collect()
        })
        .collect();
    heat_map(
        "Robots held by each controller under each condition",
        &ids,
        &titles,
        &fields,
    )
}

/// One line for each trial.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "controller,condition,robots,held,fell,rms_angle_rad,swing_rad,rms_torque_nm,region_rad,region_open\n",
    );
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for row in rows {
        let fields = [
            row.design.card().id.to_string(),
            row.condition.id.to_string(),
            row.tried.robots.to_string(),
            row.tried.held.to_string(),
            row.tried.fell.to_string(),
            number(row.tried.rms_angle_rad),
            number(row.tried.swing_rad),
            number(row.tried.rms_torque_nm),
            number(row.region.map(|region| region.spread_rad)),
            row.region
                .map_or(String::new(), |region| region.open.to_string()),
        ];
        text += &fields.join(",");
        text.push('\n');
    }
    text
}

/// One trial under its keys.
pub fn data(row: &Row) -> Value {
    json!({
        "controller": row.design.card().id,
        "condition": row.condition.id,
        "robots": row.tried.robots,
        "held": row.tried.held,
        "fell": row.tried.fell,
        "rms_angle_rad": row.tried.rms_angle_rad,
        "swing_rad": row.tried.swing_rad,
        "rms_torque_nm": row.tried.rms_torque_nm,
        "region_rad": row.region.map(|region| region.spread_rad),
        "region_open": row.region.map(|region| region.open),
    })
}
