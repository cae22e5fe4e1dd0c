//! Effects at joints that slide: the laws are those of hinges, in metres and newtons.

use super::{
    AtRest, Axis, DriveState, EFFECTS, Effect, EffectInfo, Encoded, FrictionState, Gear,
    JointState, MemoryCell, Rig, Scope, SenseMemory, Slope, StepState, ValueBehind,
};
use std::sync::LazyLock;

/// An effect of the library whose values have other keys and units on a slide.
#[derive(Debug)]
struct OnSlide {
    effect: &'static dyn Effect,
    info: &'static EffectInfo,
}

static ON_SLIDE: LazyLock<Vec<OnSlide>> = LazyLock::new(|| {
    let other = |effect: &&'static dyn Effect| {
        let info = effect.slide_info()?;
        (!std::ptr::eq(info, effect.info())).then_some(OnSlide {
            effect: *effect,
            info,
        })
    };
    EFFECTS.iter().filter_map(other).collect()
});

/// An effect as it is at a joint of this kind; none where it cannot act. One of the whole rig is
/// the same everywhere.
pub fn on_axis(effect: &'static dyn Effect, axis: Axis) -> Option<&'static dyn Effect> {
    let id = effect.info().id;
    match (effect.axis(), axis) {
        _ if effect.info().scope == Scope::WholeRig => Some(effect),
        (Axis::Hinge, Axis::Hinge) | (Axis::Slide, Axis::Slide) => Some(effect),
        (Axis::Slide, Axis::Hinge) => super::named(id),
        (Axis::Hinge, Axis::Slide) => {
            if std::ptr::eq(effect.slide_info()?, effect.info()) {
                Some(effect)
            } else {
                let own = ON_SLIDE.iter().find(|own| own.info.id == id)?;
                Some(own)
            }
        }
    }
}

impl Effect for OnSlide {
    fn info(&self) -> &'static EffectInfo {
        self.info
    }

    fn axis(&self) -> Axis {
        Axis::Slide
    }

    fn slide_info(&self) -> Option<&'static EffectInfo> {
        Some(self.info)
    }

    fn difference(&self) -> f64 {
        self.effect.difference()
    }

    fn is_of_servo(&self) -> bool {
        self.effect.is_of_servo()
    }

    fn value_behind(&self) -> Option<ValueBehind> {
        self.effect.value_behind()
    }

    fn body(&self, values: &[f64], joint: usize, rig: &mut Rig) {
        self.effect.body(values, joint, rig);
    }

    fn delay_s(&self, values: &[f64]) -> f64 {
        self.effect.delay_s(values)
    }

    fn command(&self, values: &[f64], duty: f64) -> f64 {
        self.effect.command(values, duty)
    }

    fn drive(&self, values: &[f64], torque_nm: f64, at: &DriveState) -> f64 {
        self.effect.drive(values, torque_nm, at)
    }

    fn rate_scale(&self, values: &[f64]) -> f64 {
        self.effect.rate_scale(values)
    }

    fn rate_bias_rad_s(&self, values: &[f64]) -> f64 {
        self.effect.rate_bias_rad_s(values)
    }

    fn gear(&self, values: &[f64], gear: &mut Gear) {
        self.effect.gear(values, gear);
    }

    fn torque(&self, values: &[f64], at: &JointState) -> f64 {
        self.effect.torque(values, at)
    }

    fn friction(&self, values: &[f64], at: &FrictionState) -> f64 {
        self.effect.friction(values, at)
    }

    fn friction_is_constant(&self) -> bool {
        self.effect.friction_is_constant()
    }

    fn remembers(&self) -> bool {
        self.effect.remembers()
    }

    fn recall(&self, values: &[f64], at: &StepState) -> MemoryCell {
        self.effect.recall(values, at)
    }

    fn remember(&self, values: &[f64], memory: &mut MemoryCell, at: &StepState, step_s: f64) {
        self.effect.remember(values, memory, at, step_s);
    }

    fn hidden_scale(&self, values: &[f64]) -> Option<f64> {
        self.effect.hidden_scale(values)
    }

    fn displaced(&self, values: &[f64], displacement: f64, at: &StepState) -> MemoryCell {
        self.effect.displaced(values, displacement, at)
    }

    fn slip(&self, values: &[f64], slipped: [f64; 2]) -> SenseMemory {
        self.effect.slip(values, slipped)
    }

    fn obey(&self, values: &[f64], memory: MemoryCell, input: f64, step_s: f64) -> f64 {
        self.effect.obey(values, memory, input, step_s)
    }

    fn encode(&self, values: &[f64], angle_rad: f64) -> f64 {
        self.effect.encode(values, angle_rad)
    }

    fn trail_rad(&self, values: &[f64], speed_rad_s: f64) -> Option<f64> {
        self.effect.trail_rad(values, speed_rad_s)
    }

    fn reading_offset_s(&self, values: &[f64]) -> Option<f64> {
        self.effect.reading_offset_s(values)
    }

    fn slope(&self, values: &[f64], at: &AtRest) -> Option<Slope> {
        self.effect.slope(values, at)
    }

    fn sense(
        &self,
        values: &[f64],
        memory: &mut Option<SenseMemory>,
        encoded: Encoded,
        step_s: f64,
    ) -> f64 {
        self.effect.sense(values, memory, encoded, step_s)
    }

    fn slipped(&self, memory: SenseMemory) -> [f64; 2] {
        self.effect.slipped(memory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::suggest::split_unit;

    #[test]
    fn keys_on_a_slide_have_no_angular_unit() {
        for effect in EFFECTS {
            let Some(on_slide) = on_axis(*effect, Axis::Slide) else {
                continue;
            };
            if on_slide.info().scope == Scope::WholeRig {
                continue;
            }
            for (own, hinge) in on_slide
                .info()
                .parameters
                .iter()
                .zip(effect.info().parameters)
            {
                let unit = split_unit(own.key).map_or("1", |(_, unit)| unit);
                let own_unit = if own.unit.is_empty() { "1" } else { own.unit };
                assert_eq!(unit, own_unit, "{} {}", on_slide.info().id, own.key);
                let of_link = on_slide.info().id == "com_angle";
                assert!(of_link || !unit.contains("rad"), "{}", own.key);
                assert_eq!(own.off, hinge.off, "{}", own.key);
                let within = |x: &f64| (own.bounds.0..=own.bounds.1).contains(x);
                assert!(own.starts.iter().all(within), "{}", own.key);
                assert_eq!(own.starts.len(), hinge.starts.len(), "{}", own.key);
            }
        }
    }

    #[test]
    fn what_an_angle_alone_has_is_no_effect_of_a_slide() {
        let refused: Vec<&str> = EFFECTS
            .iter()
            .filter(|effect| on_axis(**effect, Axis::Slide).is_none())
            .map(|effect| effect.info().id)
            .collect();
        let known = ["bearing_friction", "cogging", "rate_scale", "rate_lag"];
        assert_eq!(refused, known);
    }

    #[test]
    fn the_way_back_is_the_effect_itself() {
        for effect in EFFECTS {
            if let Some(on_slide) = on_axis(*effect, Axis::Slide) {
                let back = on_axis(on_slide, Axis::Hinge).unwrap();
                assert!(std::ptr::eq(back.info(), effect.info()));
            }
        }
    }
}
