//! Results of the trials: tables, CSV, JSON, a plot.

use super::super::show;
use super::Row;
use handstand::controllers::ControllerDesign;
use handstand::plot::heat_map;
use handstand::study::{Condition, Region};
use serde_json::{Value, json};

/// Three tables: share stabilised, region, and how well under the last condition.
pub fn text(
    rows: &[Row],
    designs: &[&'static dyn ControllerDesign],
    conditions: &[&'static Condition],
) -> String {
    let mut parts = vec![format!(
        "Robots stabilised, % of {}:\n{}",
        rows.first().map_or(0, |row| row.figures.runs),
        matrix(rows, designs, conditions, |row| percent(
            row.figures.stabilised_share
        ))
    )];
    if rows.iter().any(|row| row.region.is_some()) {
        parts.push(format!(
            "Region: largest spread of starts of which 95 % are stabilised, deg:\n{}",
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
            "stabilised %",
            "fallen %",
            "rms deg",
            "limit cycle deg",
            "rms N m",
        ]);
        for row in rows.iter().filter(|row| row.condition.id == condition.id) {
            table.add_row([
                row.design.info().id.to_string(),
                percent(row.figures.stabilised_share),
                percent(row.figures.fallen_share),
                or_dash(row.figures.rms_angle_rad.map(f64::to_degrees)),
                or_dash(row.figures.limit_cycle_rad.map(f64::to_degrees)),
                or_dash(row.figures.rms_torque_nm),
            ]);
        }
        parts.push(format!(
            "{}, of those stabilised:\n{table}",
            condition.title
        ));
    }
    parts.join("\n\n")
}

fn matrix(
    rows: &[Row],
    designs: &[&'static dyn ControllerDesign],
    conditions: &[&'static Condition],
    cell: impl Fn(&Row) -> String,
) -> String {
    let mut table = show::wide_table();
    let header = std::iter::once("").chain(conditions.iter().map(|condition| condition.id));
    table.set_header(header);
    for design in designs {
        let own = rows
            .iter()
            .filter(|row| row.design.info().id == design.info().id);
        table.add_row(std::iter::once(design.info().id.to_string()).chain(own.map(&cell)));
    }
    table.to_string()
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

fn or_dash(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.2}"))
}

fn degrees(region: Region) -> String {
    let sign = if region.open { ">" } else { "" };
    format!("{sign}{:.1}", region.spread_rad.to_degrees())
}

/// Heat map of the shares that were stabilised.
pub fn plot(
    rows: &[Row],
    designs: &[&'static dyn ControllerDesign],
    conditions: &[&'static Condition],
) -> String {
    let ids: Vec<&str> = designs.iter().map(|design| design.info().id).collect();
    let titles: Vec<&str> = conditions.iter().map(|condition| condition.title).collect();
    let fields: Vec<Vec<f64>> = ids
        .iter()
        .map(|id| {
            let own = rows.iter().filter(|row| row.design.info().id == *id);
            own.map(|row| row.figures.stabilised_share).collect()
        })
        .collect();
    heat_map(
        "Robots stabilised by each controller under each condition",
        &ids,
        &titles,
        &fields,
    )
}

/// One line for each trial.
pub fn csv(rows: &[Row]) -> String {
    let mut text = String::from(
        "controller,condition,robots,stabilised,fallen,rms_angle_rad,limit_cycle_rad,rms_torque_nm,region_rad,region_open\n",
    );
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for row in rows {
        let fields = [
            row.design.info().id.to_string(),
            row.condition.id.to_string(),
            row.figures.runs.to_string(),
            row.figures.stabilised_share.to_string(),
            row.figures.fallen_share.to_string(),
            number(row.figures.rms_angle_rad),
            number(row.figures.limit_cycle_rad),
            number(row.figures.rms_torque_nm),
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
        "controller": row.design.info().id,
        "condition": row.condition.id,
        "robots": row.figures.runs,
        "stabilised": row.figures.stabilised_share,
        "fallen": row.figures.fallen_share,
        "rms_angle_rad": row.figures.rms_angle_rad,
        "limit_cycle_rad": row.figures.limit_cycle_rad,
        "rms_torque_nm": row.figures.rms_torque_nm,
        "region_rad": row.region.map(|region| region.spread_rad),
        "region_open": row.region.map(|region| region.open),
    })
}
