//! Reads a design back from the JSON that `handstand gains --state-space FILE.json` writes.

use crate::error::{Error, Place, Problem, Result};
use crate::model::Model;
use serde_json::Value;
use std::path::Path;

/// Sampling times that can be simulated, s.
const SAMPLING_TIMES_S: std::ops::RangeInclusive<f64> = 1e-5..=10.0;

/// The law u = u0 - K (x - x0) that balances a robot, and when it is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct StateFeedbackPlan {
    /// K, one row per driven joint: for the angles of n joints, their speeds, then past inputs.
    pub k: Vec<Vec<f64>>,
    /// The pose that is held: an angle per joint in the model's convention, rad.
    pub pose_rad: Vec<f64>,
    /// Inputs that hold it, in SI of the drives.
    pub u0: Vec<f64>,
    /// Sampling time, s; none for gains in continuous time.
    pub ts_s: Option<f64>,
    /// Delay of the inputs that the design compensates, s.
    pub delay_s: f64,
}

/// What writes a plan.
const WRITE: &str = "write the plan with `handstand gains MODEL --state-space FILE.json`";

impl StateFeedbackPlan {
    /// Reads the plan of a robot like `model`.
    ///
    /// # Errors
    /// A file that cannot be read; a key that is missing, wrong, or does not
    /// fit the model's number of joints and drives.
    pub fn load(path: &Path, model: &Model) -> Result<StateFeedbackPlan> {
        let bytes = std::fs::read(path).map_err(|error| Error::file(path, "read", error))?;
        StateFeedbackPlan::parse(&bytes, path, model)
    }

    /// The same from the file's bytes; `path` stands for it in errors.
    ///
    /// # Errors
    /// As [`StateFeedbackPlan::load`].
    pub fn parse(bytes: &[u8], path: &Path, model: &Model) -> Result<StateFeedbackPlan> {
        let value: Value = serde_json::from_slice(bytes).map_err(|error| {
            let place = Place::at(path, error.line().max(1), error.column().max(1));
            Error::data(place, format!("not JSON: {error}"), WRITE)
        })?;
        plan(&value, model).map_err(|problem| problem.at(Place::file(path)))
    }
}

fn plan(value: &Value, model: &Model) -> Result<StateFeedbackPlan, Problem> {
    if value.get("integral").is_some_and(|it| !it.is_null()) {
        return Err(Problem::new(
            "`integral` is set: the plan's law acts on sums of angles too",
            "give the plan of a law on the states alone: `handstand gains --state-space \
             FILE.json` without --integral",
        ));
    }
    let joints = model.link_count();
    let drives = model.driven_joints().len();
    let sampled = value.get("sampled").filter(|sampled| !sampled.is_null());
    let timing = sampled.map(timing).transpose()?;
    let past = timing.map_or(0, |timing| timing.delayed_inputs);
    let states = past.saturating_mul(drives).saturating_add(2 * joints);
    let has = |key: &str, found: usize, needed: usize| {
        if found == needed {
            Ok(())
        } else {
            let plan_needs = format!("`{}` with this plan needs {needed}", model.name);
            Err(Problem::new(
                format!("`{key}` has {found} values, but {plan_needs}"),
                "give the plan that was made for this robot",
            ))
        }
    };
    let sized = |key: &str, list: Vec<f64>, needed| has(key, list.len(), needed).map(|()| list);
    let list = |key, needed| sized(key, numbers(key, value.get(key))?, needed);
    let u0 = list("u0", drives)?;
    let pose_rad = list("x0", states)?[..joints].to_vec();
    let rows = value.get("k").and_then(Value::as_array);
    let rows = rows.ok_or_else(|| wrong("k", value.get("k"), "a list of rows"))?;
    has("k", rows.len(), drives)?;
    let row = |(index, row)| {
        let key = format!("k[{index}]");
        sized(&key, numbers(&key, Some(row))?, states)
    };
    let k = rows.iter().enumerate().map(row).collect::<Result<_, _>>()?;
    if value.get("estimator").is_some_and(|e| !e.is_null()) {
        return Err(Problem::new(
            "`estimator` is set: the plan's law acts on estimated states",
            "compare with the plan of a robot that measures its states: `handstand gains \
             --state-space FILE.json` without --lqg",
        ));
    }
    Ok(StateFeedbackPlan {
        k,
        pose_rad,
        u0,
        ts_s: timing.map(|timing| timing.ts_s),
        delay_s: timing.map_or(0.0, |timing| timing.delay_s),
    })
}

/// When the law is computed and its inputs arrive.
#[derive(Clone, Copy)]
struct PlanTiming {
    ts_s: f64,
    delay_s: f64,
    delayed_inputs: usize,
}

fn timing(sampled: &Value) -> Result<PlanTiming, Problem> {
    let number = |key: &'static str, expected| {
        let value = sampled.get(key);
        let number = value.and_then(Value::as_f64).filter(|n| *n >= 0.0);
        number.ok_or_else(|| wrong(&format!("sampled.{key}"), value, expected))
    };
    let ts_s = number("ts_s", "a sampling time, s")?;
    if !SAMPLING_TIMES_S.contains(&ts_s) {
        let expected = "a sampling time from 1e-5 to 10 s";
        return Err(wrong("sampled.ts_s", sampled.get("ts_s"), expected));
    }
    let delay_s = number("delay_s", "a delay, s")?;
    let past = sampled.get("delayed_inputs");
    let delayed_inputs = past
        .and_then(Value::as_u64)
        .and_then(|count| usize::try_from(count).ok())
        .ok_or_else(|| wrong("sampled.delayed_inputs", past, "a number of past inputs"))?;
    // The delay is rounded in its last digit; a sample more would be another plan.
    if delay_s > (delayed_inputs as f64 + 1e-6) * ts_s {
        return Err(Problem::new(
            format!(
                "`sampled.delay_s` is {delay_s} s, but the gains hold {delayed_inputs} past inputs"
            ),
            WRITE,
        ));
    }
    Ok(PlanTiming {
        ts_s,
        delay_s,
        delayed_inputs,
    })
}

fn numbers(key: &str, value: Option<&Value>) -> Result<Vec<f64>, Problem> {
    let list = value.and_then(Value::as_array);
    let list = list.ok_or_else(|| wrong(key, value, "a list of numbers"))?;
    let number = |(index, value): (usize, &Value)| {
        let number = value.as_f64();
        number.ok_or_else(|| wrong(&format!("{key}[{index}]"), Some(value), "a number"))
    };
    list.iter().enumerate().map(number).collect()
}

fn wrong(key: &str, value: Option<&Value>, expected: &str) -> Problem {
    let found: String = value.map_or("nothing".to_string(), |value| {
        value.to_string().chars().take(40).collect()
    });
    Problem::new(format!("`{key}` holds {found}, not {expected}"), WRITE)
}
