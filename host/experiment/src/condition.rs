//! Conditions of an experiment that a person sets: a mass bolted on, the rig turned, the supply.

use crate::model::Model;
use crate::output::number::given;
use serde::Serialize;

/// Share of its nominal value at which the supply is set.
const OTHER_SUPPLY: f64 = 0.8;

/// Conditions of one experiment; the default is the rig as it stands.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Condition {
    /// Known mass bolted onto the last link, kg; onto a robot in space where its logs have it.
    pub payload_kg: f64,
    /// Where it is bolted on, m from the last joint of a planar chain.
    pub payload_at_m: f64,
    /// Whether the rig is turned by 180 degrees about the vertical.
    pub turned: bool,
    /// Supply to be set, V; none for what it is.
    pub supply_v: Option<f64>,
}

impl Condition {
    /// Every condition of a rig, the simplest first; `added_kg` is the known mass.
    pub(super) fn all(model: &Model, added_kg: f64) -> Vec<Condition> {
        let as_it_stands = Condition::default();
        let loaded = Condition {
            payload_kg: added_kg,
            payload_at_m: payload_at_m(model),
            ..as_it_stands
        };
        let turned = |condition| Condition {
            turned: true,
            ..condition
        };
        let has_place = if model.is_in_space() {
            model.log.payload_on.is_some()
        } else {
            loaded.payload_at_m > 0.0
        };
        let bolted = (added_kg > 0.0 && has_place).then_some(loaded);
        let mut all = Vec::new();
        for condition in std::iter::once(as_it_stands).chain(bolted) {
            all.push(condition);
            // Gravity means the same to a turned robot in space.
            if !model.is_in_space() {
                all.push(turned(condition));
            }
        }
        let motors = model.joints.iter().filter_map(|joint| joint.drive.motor());
        let nominal_v = motors.filter_map(|m| m.nominal_supply_v).reduce(f64::min);
        all.extend(nominal_v.map(|nominal_v| Condition {
            supply_v: Some(OTHER_SUPPLY * nominal_v),
            ..as_it_stands
        }));
        all.sort_by_key(Condition::changes);
        all
    }

    /// How many things a person must change.
    pub fn changes(&self) -> usize {
        usize::from(self.payload_kg > 0.0)
            + usize::from(self.turned)
            + usize::from(self.supply_v.is_some())
    }

    /// What a person does before the motion runs, a sentence each, with the column that logs it.
    pub fn instructions(&self, model: &Model) -> Vec<String> {
        let log = &model.log;
        let mut lines = Vec::new();
        if self.payload_kg > 0.0 {
            let (mass, at) = (given(self.payload_kg), given(self.payload_at_m));
            let place = match model.log.payload_on {
                None => format!("its centre {at} m from the last joint"),
                Some(place) => format!(
                    "its centre at {:?} m of link {}",
                    place.at_m,
                    place.link + 1
                ),
            };
            let column = match &log.payload {
                Some(column) => format!("write it in the column `{}`", column.name),
                None => format!(
                    "write it in a column of the log, and under [log] of the model: payload = \
                     {{ column = \"payload_kg\", unit = \"kg\", at_m = {at} }}"
                ),
            };
            lines.push(format!("Add a known mass of {mass} kg, {place}; {column}."));
        }
        if self.turned {
            let column = match &log.turned {
                Some(column) => format!("write 1 in the column `{column}`"),
                None => "write 1 in a column of the log, and under [log] of the model: turned = \
                         \"turned\""
                    .to_string(),
            };
            lines.push(format!(
                "Turn the rig by 180 degrees about the vertical; {column}."
            ));
        }
        if let Some(volts) = self.supply_v {
            let column = match &log.supply {
                Some(column) => format!("log it in the column `{}`", column.name),
                None => "log it in a column, and under [log] of the model: supply = { column = \
                         \"supply_v\", unit = \"V\" }"
                    .to_string(),
            };
            let volts = given(volts);
            lines.push(format!("Set the supply to {volts} V; {column}."));
        }
        lines
    }
}

/// Where a payload sits, m from the last joint: where the model's logs have it, or at the tip.
pub(super) fn payload_at_m(model: &Model) -> f64 {
    match model.log.payload {
        Some(_) => model.log.payload_at_m,
        None => model.links.last().map_or(0.0, |link| link.length_m),
    }
}

/// A known mass that a rig carries easily: three tenths of its link's, to one digit, kg.
pub(super) fn usual_mass_kg(model: &Model) -> f64 {
    let link = match model.log.payload_on {
        Some(place) => model.links.get(place.link),
        None => model.links.last(),
    };
    let share = 0.3 * link.map_or(0.0, |link| link.mass_kg);
    if share <= 0.0 {
        return 0.0;
    }
    // Through its text, so that 0.1 stays 0.1.
    format!("{share:.0e}").parse().unwrap_or(share)
}
