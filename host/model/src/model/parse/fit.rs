//! `[fit]`: which values are free, and within which bounds.

use crate::error::{Error, Problem, Result};
use crate::model::reader::Table;
use crate::model::{Model, ParameterPath};
use std::ops::Range;

/// A written number is rounded to six digits: so far beyond a bound, as a share, it is on it.
const ROUNDED: f64 = 1e-5;

/// Values that a fit keeps from low to high.
type Bounds = Vec<(ParameterPath, (f64, f64))>;

/// The values that `[fit]` frees, and its bounds.
pub(super) fn read(root: &Table, model: &Model) -> Result<(Vec<ParameterPath>, Bounds)> {
    let fit = root.table("fit")?;
    let Some(fit) = fit else {
        return Ok((of_effects(model), Vec::new()));
    };
    fit.only(&["free", "bounds", "fitted"])?;
    // Where values came from: for people and reports, so any content will do.
    fit.table("fitted")?;
    Ok((free(&fit, model)?, bounds(&fit, model)?))
}

fn of_effects(model: &Model) -> Vec<ParameterPath> {
    let effects = model.effects.iter();
    effects.flat_map(ParameterPath::of_effect).collect()
}

/// The values that are named, or else all of the effects'.
fn free(fit: &Table, model: &Model) -> Result<Vec<ParameterPath>> {
    let Some(named) = fit.texts("free")? else {
        return Ok(of_effects(model));
    };
    let mut free = Vec::new();
    for (text, span) in named {
        let (parameter, value) = value_at(fit, text, span.clone(), model)?;
        let problem = if !value.is_finite() {
            infinite(text)
        } else if free.contains(&parameter) {
            twice(text)
        } else {
            free.push(parameter);
            continue;
        };
        return Err(problem.at(fit.place(span)));
    }
    Ok(free)
}

/// A value that is infinite.
pub(super) fn infinite(path: &str) -> Problem {
    Problem::new(
        format!("`{path}` is infinite, so nothing can be fitted"),
        "give it a value to start from",
    )
}

/// A value that is named twice.
pub(super) fn twice(path: &str) -> Problem {
    Problem::new(format!("`{path}` is named twice"), "remove one")
}

/// An address, and the value that the model has there.
pub(super) fn value_at(
    fit: &Table,
    text: &str,
    span: Option<Range<usize>>,
    model: &Model,
) -> Result<(ParameterPath, f64)> {
    let parsed = crate::model::address::read_in(text, model.robot.as_ref());
    let parameter = parsed.map_err(|problem| problem.at(fit.place(span.clone())))?;
    let value = parameter.get(model).ok_or_else(|| {
        Error::data(
            fit.place(span),
            format!("`{text}` is not in this model"),
            "add its link, drive or effect, or remove it here",
        )
    })?;
    Ok((parameter, value))
}

/// The bounds of `[fit.bounds]`, by address.
fn bounds(fit: &Table, model: &Model) -> Result<Bounds> {
    let Some(table) = fit.table("bounds")? else {
        return Ok(Vec::new());
    };
    let mut bounds: Bounds = Vec::new();
    for key in table.keys() {
        let (parameter, value) = value_at(&table, key, table.key_span(key), model)?;
        let (low, high) = table
            .pair(key)?
            .unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let possible = parameter.possible();
        let problem = if bounds.iter().any(|(own, _)| *own == parameter) {
            twice(key)
        } else if !(low < high && low < possible.1 && high > possible.0) {
            let (least, most) = possible;
            Problem::new(
                format!("from {low} to {high} `{key}` has no possible value"),
                format!("write the lower one first; possible is {least} to {most}"),
            )
        } else if !(low - slack(low)..=high + slack(high)).contains(&value) {
            Problem::new(
                format!("`{key}` = {value} lies outside its bounds, {low} to {high}"),
                "a fit begins at the value: move it inside, or widen them",
            )
        } else {
            bounds.push((parameter, (low, high)));
            continue;
        };
        return Err(problem.at(table.place_of(key)));
    }
    Ok(bounds)
}

fn slack(bound: f64) -> f64 {
    if bound.is_finite() {
        ROUNDED * bound.abs()
    } else {
        0.0
    }
}
