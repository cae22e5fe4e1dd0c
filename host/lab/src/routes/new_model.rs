//! A model from the first log alone, or from the form, with the columns of that log and the
//! friction that was proposed.

use super::learn::begin_and_go;
use super::shown_model::ShownModel;
use super::{act_and_go, session};
use crate::effects::named;
use crate::error::Result;
use crate::model::edit::add_effect;
use crate::model::new_model::{ModelPlan, new_model_toml};
use crate::model::{EffectInstance, Model, effect_on};
use crate::reply::{Answer, LabError};
use crate::server::LabState;
use crate::session::{LabSession, SavedSession};
use axum::Json;
use axum::extract::{Path, State};
use serde::Deserialize;
use std::sync::Arc;

/// What the form says.
#[derive(Debug, Deserialize)]
pub(super) struct ModelForm {
    #[serde(flatten)]
    plan: ModelPlan,
    /// Friction of each joint; none where it is left out.
    #[serde(default)]
    friction: Vec<JointFriction>,
}

/// Friction of a joint.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
pub(super) struct JointFriction {
    viscous_nm_s_rad: Option<f64>,
    coulomb_nm: Option<f64>,
}

/// Makes a model from the form, and goes on to where it is compared.
pub(super) async fn make(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
    Json(form): Json<ModelForm>,
) -> Answer {
    session(&lab, number)?;
    act_and_go(lab, number, move |session, saved| {
        shown.check(saved)?;
        let toml = match with_columns(session, saved, &form.plan) {
            Some(toml) => toml,
            None => new_model_toml(&form.plan)?,
        };
        let toml = with_friction(toml, &form.friction)?;
        session.begin_model("made from the form", &toml)?;
        Ok(page_after(session))
    })
    .await
}

/// Begins to make a model from the first log alone, as `handstand init` does, and goes on to where
/// it is compared.
pub(super) async fn make_from_log(
    State(lab): State<Arc<LabState>>,
    Path(number): Path<u32>,
    shown: ShownModel,
) -> Answer {
    let what = "model from the log";
    begin_and_go(&lab, number, &shown, what, |session, report| {
        session.begin_estimated(report)?;
        Ok(Some(page_after(session)))
    })
}

/// Where the model reads a log, it is compared; else what is wrong is said beside the logs.
fn page_after(session: &LabSession) -> &'static str {
    let view = session.view();
    match session.evaluation(&view, view.current) {
        Ok(Some(_)) => "compare",
        _ => "data",
    }
}

/// The model of a form with the columns of the first log, where its names and values say which is
/// what.
fn with_columns(session: &LabSession, saved: &SavedSession, plan: &ModelPlan) -> Option<String> {
    let mut drives = plan.links.iter().map(|link| link.drive.as_str());
    let driven = drives.find(|drive| *drive != "passive");
    let head = "# Written from a form, with the columns that a log seems to have: pick others \
                where they are wrong.\n\n";
    session.draft(saved, driven)?.toml_of(plan, head).ok()
}

/// The model with friction at its joints; a value of 0 adds none.
fn with_friction(mut toml: String, friction: &[JointFriction]) -> Result<String, LabError> {
    let file = std::path::Path::new("model.toml");
    let model = Model::parse(&toml, file)?;
    for (joint, friction) in friction.iter().enumerate().take(model.link_count()) {
        for (id, value) in [
            ("viscous", friction.viscous_nm_s_rad),
            ("coulomb", friction.coulomb_nm),
        ] {
            let effect = named(id).and_then(|e| effect_on(e, Some(joint), &model.joints));
            if let (Some(effect), Some(value)) = (effect, value.filter(|value| *value != 0.0)) {
                let instance = EffectInstance {
                    effect,
                    joint: Some(joint),
                    values: vec![value],
                };
                toml = add_effect(&toml, file, &instance, None)?;
            }
        }
    }
    Ok(toml)
}
