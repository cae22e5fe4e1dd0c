//! Results of the trials: tables, CSV, a plot.

use super::ControllerTrial;
use crate::cli::show;
use handstand::output::table::or_empty;
use handstand::plot::heat_map;
use handstand::report::table::{columns_of, csv_of};
use handstand::study::LoopCondition;
use handstand::synth::controllers::ControllerDesign;

/// Three tables: share stabilised, region, and how well under the last condition.
pub fn text(
    trials: &[ControllerTrial],
    designs: &[&'static dyn ControllerDesign],
    conditions: &[&'static LoopCondition],
) -> String {
    let mut parts = vec![format!(
        "Robots stabilised, % of {}:\n{}",
        trials.first().map_or(0, |trial| trial.robots),
        matrix(trials, designs, conditions, |trial| percent(
            trial.stabilised
        ))
    )];
    if trials.iter().any(|trial| trial.region_rad.is_some()) {
        parts.push(format!(
            "Region: largest spread of starts of which 95 % are stabilised, deg:\n{}",
            matrix(trials, designs, conditions, region)
        ));
    }
    let degrees = |rad: Option<f64>| or_dash(rad.map(f64::to_degrees));
    let columns = columns_of::<ControllerTrial>()
        .text("Controller", |t| t.controller.to_string())
        .text("stabilised %", |t| percent(t.stabilised))
        .text("fallen %", |t| percent(t.fallen))
        .text("rms deg", |t| degrees(t.rms_angle_rad))
        .text("limit cycle deg", |t| degrees(t.limit_cycle_rad))
        .text("rms N m", |t| or_dash(t.rms_torque_nm));
    // Each by itself would fill pages; the file has them all.
    let few = conditions.len() <= 2;
    for condition in conditions.iter().filter(|c| few || c.id.starts_with("all")) {
        let own = trials
            .iter()
            .filter(|trial| trial.condition == condition.id);
        let table = show::table_of(own, &columns);
        parts.push(format!(
            "{}, of those stabilised:\n{table}",
            condition.title
        ));
    }
    parts.extend(show::held(trials.iter().map(|trial| trial.held).sum()));
    parts.join("\n\n")
}

/// A line for each controller, a column for each condition.
fn matrix(
    trials: &[ControllerTrial],
    designs: &[&'static dyn ControllerDesign],
    conditions: &[&'static LoopCondition],
    cell: impl Fn(&ControllerTrial) -> String,
) -> String {
    let mut table = show::wide_table();
    let header = std::iter::once("").chain(conditions.iter().map(|condition| condition.id));
    table.set_header(header);
    for id in designs.iter().map(|design| design.info().id) {
        let own = trials.iter().filter(|trial| trial.controller == id);
        table.add_row(std::iter::once(id.to_string()).chain(own.map(&cell)));
    }
    table.to_string()
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

fn or_dash(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.2}"))
}

fn region(trial: &ControllerTrial) -> String {
    let sign = if trial.region_open == Some(true) {
        ">"
    } else {
        ""
    };
    let degrees = |rad: f64| format!("{sign}{:.1}", rad.to_degrees());
    trial.region_rad.map_or(String::new(), degrees)
}

/// The shares as a heat map.
pub fn plot(
    trials: &[ControllerTrial],
    designs: &[&'static dyn ControllerDesign],
    conditions: &[&'static LoopCondition],
) -> String {
    let ids: Vec<&str> = designs.iter().map(|design| design.info().id).collect();
    let titles: Vec<&str> = conditions.iter().map(|condition| condition.title).collect();
    let shares = |id: &&str| {
        let own = trials.iter().filter(|trial| trial.controller == *id);
        own.map(|trial| trial.stabilised).collect()
    };
    let fields: Vec<Vec<f64>> = ids.iter().map(shares).collect();
    let title = "Robots stabilised by each controller under each condition";
    heat_map(title, &ids, &titles, &fields)
}

/// Everything, a line per trial.
pub fn csv(trials: &[ControllerTrial]) -> String {
    let columns = columns_of::<ControllerTrial>()
        .text("controller", |t| t.controller.to_string())
        .text("condition", |t| t.condition.to_string())
        .text("robots", |t| t.robots.to_string())
        .text("stabilised", |t| t.stabilised.to_string())
        .text("fallen", |t| t.fallen.to_string())
        .text("rms_angle_rad", |t| or_empty(t.rms_angle_rad))
        .text("limit_cycle_rad", |t| or_empty(t.limit_cycle_rad))
        .text("rms_torque_nm", |t| or_empty(t.rms_torque_nm))
        .text("region_rad", |t| or_empty(t.region_rad))
        .text("region_open", |t| or_empty(t.region_open));
    csv_of(trials, &columns)
}
