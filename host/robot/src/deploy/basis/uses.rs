//! Where a plan takes each effect of a model.

use super::{Board, ToldDrives};
use crate::effects::Site;
use crate::error::Result;
use crate::fitting::Candidate;
use crate::model::{EffectInstance, Model, upright};
use crate::synth::OmittedEffect;
use crate::synth::controllers::DesignModel;
use handstand_shared::observer::INPUTS;
use serde::Serialize;

/// What became of an effect, or of the drives' own figures.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EffectUse {
    /// The effect as `delay@all`, or `drive@2`.
    pub effect: String,
    /// Where the plan has it.
    pub place: UsePlace,
    /// In words, with its value.
    pub how: String,
}

/// The part of a plan that takes an effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum UsePlace {
    /// In the linear model that gains and observer are designed for.
    Gains,
    /// When inputs act and how old readings are.
    Observer,
    /// Jumped over between law and servo.
    Compensation,
    /// A limit of the torque.
    Limit,
    /// In no part: left to the feedback.
    Nowhere,
}

impl UsePlace {
    /// For people.
    pub fn name(self) -> &'static str {
        match self {
            UsePlace::Gains => "gains",
            UsePlace::Observer => "observer",
            UsePlace::Compensation => "compensation",
            UsePlace::Limit => "limit",
            UsePlace::Nowhere => "nowhere",
        }
    }
}

/// What was taken of delays and lags.
pub(super) struct TakenLags<'a> {
    pub told: &'a ToldDrives,
    /// Delay of each drive, and what the observer takes of it, s.
    pub late_s: [f64; INPUTS],
    pub taken_s: [f64; INPUTS],
    /// What the observer takes of each joint's sensor lag, s.
    pub aged_s: [f64; INPUTS],
    /// Whether the observer has a state for it; else, short or beside a lag of the torques, it is
    /// an age.
    pub own_state: [bool; INPUTS],
}

/// What became of the drives' figures, then of each effect.
pub(super) fn of(model: &Model, board: &Board, taken: &TakenLags) -> Result<Vec<EffectUse>> {
    let driven = model.driven_joints();
    let design = DesignModel::new(model, &upright(model), board.period_s)?;
    let drives = driven.iter().take(INPUTS).enumerate();
    let drives = drives.map(|(place, joint)| drive(model, board, place, *joint));
    let effects = model.effects.iter();
    let effects = effects.map(|effect| used(model, board, effect, &design.omitted, taken));
    Ok(drives.chain(effects).collect())
}

fn drive(model: &Model, board: &Board, place: usize, joint: usize) -> EffectUse {
    let full_nm = board.full_nm[place];
    let nominal_v = (model.joints[joint].drive.motor()).and_then(|motor| motor.nominal_supply_v);
    let at = nominal_v.map_or(String::new(), |volt| format!(", the model's at {volt} V"));
    EffectUse {
        effect: format!("drive@{}", joint + 1),
        place: UsePlace::Limit,
        how: format!(
            "{full_nm:.3} N m at full output{at}; at most {:.3} N m commanded",
            board.most_nm[place]
        ),
    }
}

fn used(
    model: &Model,
    board: &Board,
    instance: &EffectInstance,
    omitted: &[OmittedEffect],
    taken: &TakenLags,
) -> EffectUse {
    let driven = model.driven_joints();
    let places = driven.iter().take(INPUTS).enumerate();
    let place = places
        .filter(|(_, joint)| instance.acts_on(**joint, &model.joints[**joint]))
        .map(|(place, _)| place)
        .next();
    let info = instance.effect.info();
    let (told, value) = (taken.told, instance.values.first().copied().unwrap_or(0.0));
    let (to, how) = match (info.id, place) {
        ("delay", Some(place)) => (UsePlace::Observer, late(taken, place)),
        ("sensor_lag", Some(place)) => (UsePlace::Observer, aged(value, taken, place)),
        ("dead_zone" | "coulomb", Some(place)) => (
            UsePlace::Compensation,
            jumped(board, place, told.dead_zone.is_some()),
        ),
        ("torque_saturation", Some(_)) => (UsePlace::Limit, format!("{value} N m")),
        ("coulomb", None) => (
            UsePlace::Nowhere,
            "this joint has no drive that could overcome it".to_string(),
        ),
        _ => by_site(info.site, instance, omitted),
    };
    EffectUse {
        effect: Candidate::from(instance).to_string(),
        place: to,
        how,
    }
}

/// Of effects that no part of a plan is made for.
fn by_site(site: Site, instance: &EffectInstance, omitted: &[OmittedEffect]) -> (UsePlace, String) {
    let id = instance.effect.info().id;
    let why = omitted.iter().find(|it| it.effect.info().id == id);
    let how = match site {
        Site::Timing | Site::Encoder | Site::Rate | Site::Sensor => {
            "readings are taken as they come; the observer estimates an offset".to_string()
        }
        _ => match why {
            Some(omitted) => omitted.why.to_string(),
            None => return (UsePlace::Gains, "in the linear model".to_string()),
        },
    };
    (UsePlace::Nowhere, how)
}

fn late(taken: &TakenLags, place: usize) -> String {
    let whose = match taken.told.delay_s {
        Some(_) => "as told",
        None => "from command to torque",
    };
    part(taken.late_s[place], taken.taken_s[place], whose)
}

fn aged(all_s: f64, taken: &TakenLags, place: usize) -> String {
    let how = if taken.own_state[place] {
        "a filter's state"
    } else {
        "as the age of a reading"
    };
    part(all_s, taken.aged_s[place], how)
}

fn part(all_s: f64, taken_s: f64, how: &str) -> String {
    let [all_ms, taken_ms] = [all_s, taken_s].map(|s| 1e3 * s);
    if all_s - taken_s > 1e-6 {
        format!(
            "{taken_ms:.1} of {all_ms:.1} ms, {how}; the rest is later than the inputs that the \
             CM-5 keeps"
        )
    } else {
        format!("{all_ms:.1} ms, {how}")
    }
}

fn jumped(board: &Board, place: usize, is_told: bool) -> String {
    let lost = 100.0 * board.dead_zone[place];
    let told = if is_told { " as told" } else { "" };
    if board.least_nm[place] > 0.0 {
        format!(
            "{lost:.1} % of full output jumped over; torques below {:.3} N m wait",
            board.least_nm[place] / 2.0
        )
    } else {
        format!("{lost:.1} % of full output jumped over{told}")
    }
}
