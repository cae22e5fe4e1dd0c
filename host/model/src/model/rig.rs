//! The rigid chain of a model, and the same with the model's body effects applied.

use super::Model;
use crate::dynamics::{Chain, ChainLink};
use crate::effects::{Rig, Scope, Site};

impl Model {
    /// The rigid chain of the links alone, without any effect; without links where they make a
    /// robot in space.
    pub fn chain(&self) -> Chain {
        let planar = if self.is_in_space() {
            0
        } else {
            self.links.len()
        };
        let bodies = self.links.iter().zip(&self.joints).take(planar);
        let links = bodies.map(|(link, joint)| ChainLink {
            length_m: link.length_m,
            com_m: link.com_m,
            com_angle_rad: 0.0,
            mass_kg: link.mass_kg,
            inertia_kg_m2: link.inertia_kg_m2,
            armature_kg_m2: 0.0,
            slide: joint.slide,
        });
        Chain {
            links: links.collect(),
            gravity_m_s2: self.gravity_m_s2,
        }
    }

    /// [`Model::rig`] with a mass bolted on where its logs have the payload.
    pub fn rig_with(&self, turned: bool, payload_kg: f64) -> Rig {
        let mut rig = self.rig(turned);
        if payload_kg > 0.0 {
            match (&mut rig.tree, self.log.payload_on) {
                (Some(tree), Some(place)) => {
                    tree.bolt_on(place.link, payload_kg, place.at_m.into())
                }
                // Whose logs have no payload carries none.
                (Some(_), None) => {}
                (None, _) => rig.chain.bolt_on(payload_kg, self.log.payload_at_m),
            }
        }
        rig
    }

    /// The chain with the body effects applied; `turned` as in [`Rig::turned`].
    pub fn rig(&self, turned: bool) -> Rig {
        let mut rig = Rig {
            chain: self.chain(),
            tree: self.tree(),
            gravity_turn_rad: 0.0,
            turned,
            base_spring: None,
        };
        for instance in &self.effects {
            if instance.effect.info().site == Site::Body {
                let whole = instance.effect.info().scope == Scope::WholeRig;
                for (joint, own) in self.joints.iter().enumerate() {
                    if instance.acts_on(joint, own) || (whole && joint == 0) {
                        instance.effect.body(&instance.values, joint, &mut rig);
                    }
                }
            }
        }
        rig
    }
}
