//! What of a model another format holds, and what it does not.

use crate::dynamics::SlideAxis;
use crate::model::{EffectInstance, Model};
use serde::Serialize;
use std::borrow::Cow;

/// A part of a model that an export leaves out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NotCarried {
    /// The effect, or the drive's kind: `backlash`, `position`.
    pub part: String,
    /// Joint, counted from 1; none where the whole rig is meant.
    pub joint: Option<usize>,
    /// What a robot in space calls that joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint_name: Option<String>,
    /// Why.
    pub why: Cow<'static, str>,
}

impl NotCarried {
    /// A part of a joint, counted from 1, or of the whole rig.
    pub(super) fn new(
        part: impl Into<String>,
        joint: Option<usize>,
        why: impl Into<Cow<'static, str>>,
    ) -> Self {
        NotCarried {
            part: part.into(),
            joint,
            joint_name: None,
            why: why.into(),
        }
    }
}

/// Direction of a slide in the frame of its link, whose line points down: x to the right, z up.
pub(super) fn slide_axis(slide: &SlideAxis) -> [f64; 3] {
    let (sin, cos) = (slide.direction_rad - slide.link_rad).sin_cos();
    [sin, 0.0, -cos]
}

/// The value of a joint's effect, if the model has it there.
pub(super) fn value(model: &Model, id: &str, joint: usize, index: usize) -> Option<f64> {
    let here =
        |e: &&EffectInstance| e.effect.info().id == id && e.acts_on(joint, &model.joints[joint]);
    let instance = model.effects.iter().find(here)?;
    instance.values.get(index).copied()
}

/// Every effect but those that the format holds.
pub(super) fn not_carried(model: &Model, held: &[&str], why: &'static str) -> Vec<NotCarried> {
    let missing = |e: &&EffectInstance| !held.contains(&e.effect.info().id);
    let missing = model.effects.iter().filter(missing);
    let said = |e: &EffectInstance| {
        NotCarried::new(e.effect.info().id, e.joint.map(|joint| joint + 1), why)
    };
    missing.map(said).collect()
}
