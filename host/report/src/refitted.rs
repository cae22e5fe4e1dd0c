//! A refitted model, for people and programs.

use super::table::{columns_of, table_of};
use crate::diagnose::how_to_measure;
use crate::fitting::{BaseParameters, FittedValue, Refitted, Undetermined, in_windows};
use crate::model::JointNames;
use crate::output::number::{exact, given, measured, short};
use crate::output::table::within_width;
use serde_json::{Value, json};

/// A refitted model for people: its values, then its errors; `before` says which model left the
/// error before. Links and joints are called as `names` has them.
pub fn refitted_text(refitted: &Refitted, before: &str, names: &JointNames) -> String {
    let on_bound = |on_bound: bool| if on_bound { "on its bound" } else { "" };
    let columns = columns_of::<FittedValue>()
        .text("Parameter", |v| names.in_text(&v.path))
        .text("Value", |v| exact(v.value))
        .text("95 % interval", |v| {
            format!("{} to {}", exact(v.low), exact(v.high))
        })
        .text("Unit", |v| v.unit.clone())
        .text("", |v| on_bound(v.on_bound).to_string());
    let table = within_width(table_of(&refitted.values, &columns), 100);
    let error = &refitted.error;
    let unit = error.quantity.milli();
    let motions = if error.held_out { "held out" } else { "fitted" };
    let [old, new, floor] =
        [error.before_rad, error.after_rad, error.floor_rad].map(|rad| exact(1e3 * rad));
    let mut lines = vec![
        table.to_string(),
        String::new(),
        format!(
            "Error on the motions {motions}: {old} {unit} {before} -> {new} {unit} for the new \
             one; noise alone leaves {floor} {unit}."
        ),
    ];
    lines.push(format!("The model ran {}.", in_windows(&refitted.windows)));
    if let Some(step_s) = refitted.shorter_step_s {
        lines.push(format!(
            "It needs shorter integration steps than it had: `step_s = {}` is written with it.",
            given(step_s)
        ));
    }
    let warnings = warnings(refitted).into_iter();
    lines.extend(warnings.map(|line| format!("warning: {line}")));
    names.in_text(&lines.join("\n"))
}

/// What to be wary of in a refitted model.
fn warnings(refitted: &Refitted) -> Vec<String> {
    let on_bound = refitted.values.iter().filter(|value| value.on_bound);
    let mut warnings: Vec<String> = on_bound
        .map(|value| format!("`{}` lies on its bound: no measurement of it", value.path))
        .collect();
    if !refitted.converged {
        warnings.push("the fit had not come to rest when its iterations ran out".to_string());
    }
    warnings.extend(refitted.unobserved.iter().cloned());
    warnings.extend(told_together(&refitted.together));
    warnings
}

/// Which values are told only together, what is told of them, and what to do.
fn told_together(together: &BaseParameters) -> Option<String> {
    if together.held.is_empty() {
        return None;
    }
    let counted = |(place, (path, share)): (usize, &(String, f64))| match place {
        0 => path.clone(),
        _ if *share < 0.0 => format!(" - {} {path}", short(-share)),
        _ => format!(" + {} {path}", short(*share)),
    };
    let sums = together.told.iter().map(|own| {
        let sum: String = own.terms.iter().enumerate().map(counted).collect();
        let value = measured(own.value, own.low, own.high, &own.unit);
        format!("  {sum} = {value}\n")
    });
    let held = together.held.iter().map(|path| format!("`{path}`"));
    let held = held.collect::<Vec<_>>().join(", ");
    Some(format!(
        "these motions tell of some values only sums:\n{}  hold {held} at what is known of them \
         (not free, or with their `[uncertainty]`), and the others are told",
        sums.collect::<String>()
    ))
}

/// What to do where motions do not determine the values of a fit.
pub fn remedy_of(refused: &Undetermined) -> String {
    let hold = match refused.hold.as_slice() {
        [] => refused.mixed.get(..1).unwrap_or_default(),
        hold => hold,
    };
    let measured = hold.iter().find_map(|path| how_to_measure(path));
    let measured = measured.map_or(String::new(), |how| format!(" ({how})"));
    let them = if hold.len() == 1 { "it" } else { "them" };
    match hold {
        [] => "fit fewer values, or record motions that show them".to_string(),
        [..] => format!(
            "leave `{}` out of the fit, at what is known of {them}{measured}: the others are told \
             then",
            hold.join("`, `")
        ),
    }
}

/// A refitted model for programs.
pub fn refitted_json(refitted: &Refitted) -> Value {
    json!({
        "values": refitted.values,
        "error": refitted.error,
        "horizon_s": refitted.horizon.seconds(),
        "windows": refitted.windows,
        "shorter_step_s": refitted.shorter_step_s,
        "converged": refitted.converged,
        "together": refitted.together,
        "warnings": warnings(refitted),
    })
}

#[cfg(test)]
mod tests {
    use super::told_together;
    use crate::fitting::{BaseParameter, BaseParameters};

    #[test]
    fn sums_that_are_told_stand_below_each_other() {
        let sum = BaseParameter {
            terms: vec![("link2.mass_kg".into(), 1.0), ("link3.com_m".into(), -0.25)],
            unit: "kg".into(),
            value: 0.2,
            low: 0.19,
            high: 0.21,
        };
        let together = BaseParameters {
            held: vec!["link3.com_m".into()],
            told: vec![sum],
        };
        let text = told_together(&together).unwrap();
        assert!(
            text.contains("\n  link2.mass_kg - 0.250 link3.com_m = 0.200 kg"),
            "{text}"
        );
        assert!(text.contains("hold `link3.com_m`"), "{text}");
        assert_eq!(told_together(&BaseParameters::default()), None);
    }
}
