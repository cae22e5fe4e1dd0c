//! The whole humanoid, with its 18 servos: held still, it is the three links of Table 1.
//!
//! `places` has where servos and joints are, and what they weigh; `block` what Table 1 leaves for
//! frames, controller and batteries, whose weights are not public; `urdf` writes the robot. What
//! is compared with Table 1 is read back from that file, as any robot's is.

mod block;
mod places;
#[cfg(test)]
mod tests;
mod urdf;

use crate::error::Result;
use crate::model::{Model, Robot};
use block::{Block, Lump};
use serde::Serialize;
use std::path::Path;

/// A link of Table 1 beside the block of the whole robot that it stands for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LumpedBlock {
    /// `arms`, `torso` or `legs`.
    pub name: &'static str,
    /// How many of the 18 servos it has.
    pub servos: usize,
    /// Table 1's.
    pub stated: LumpedValues,
    /// The whole robot's, held in the handstand.
    pub lumped: LumpedValues,
    /// The same if the rest were spread evenly along the block, which uses nothing of Table 1 but
    /// masses and lengths.
    pub evenly: LumpedValues,
    /// Mass of what is neither a servo nor a frame of known mass, kg: what Table 1 leaves.
    pub rest_kg: f64,
    /// Where Table 1 leaves it, up from the block's lower axis: its lower and its upper half, m.
    pub rest_at_m: [f64; 2],
    /// From where to where the block reaches, likewise, m.
    pub reach_m: [f64; 2],
}

/// A value of a block, in the units of Table 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BlockValue {
    /// Which block.
    pub block: &'static str,
    /// `m`, `lc` or `I`.
    pub name: &'static str,
    /// `g`, `mm` or `g cm^2`.
    pub unit: &'static str,
    /// Of Table 1, of the whole robot, and with the rest spread evenly.
    pub values: [f64; 3],
}

impl LumpedBlock {
    /// Its mass, centre and moment of inertia.
    pub fn values(&self) -> [BlockValue; 3] {
        let all = [self.stated, self.lumped, self.evenly];
        let value = |name, unit, of: fn(&LumpedValues) -> f64, factor: f64| BlockValue {
            block: self.name,
            name,
            unit,
            values: all.map(|values| factor * of(&values)),
        };
        [
            value("m", "g", |of| of.mass_kg, 1e3),
            value("lc", "mm", |of| of.com_m, 1e3),
            value("I", "g cm^2", |of| of.inertia_kg_m2, 1e7),
        ]
    }
}

/// What a link of a chain is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct LumpedValues {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Centre of mass, up from the lower axis, m.
    pub com_m: f64,
    /// Moment of inertia about it, kg m^2.
    pub inertia_kg_m2: f64,
}

/// The robot as a URDF file; `table` is Table 1 as a model.
pub fn humanoid_urdf(table: &Model) -> String {
    urdf::urdf(&Block::all(&table.links))
}

/// The blocks of the whole robot beside Table 1.
///
/// # Errors
/// None is known: the robot is the project's own.
pub fn lumped_blocks(table: &Model) -> Result<Vec<LumpedBlock>> {
    let blocks = Block::all(&table.links);
    let robot = Robot::parse(&urdf::urdf(&blocks), Path::new("humanoid.urdf"), &[])?;
    let beside = |(block, link): (&Block, &crate::model::Link)| LumpedBlock {
        name: block.place.name,
        servos: block.servos(),
        stated: LumpedValues {
            mass_kg: link.mass_kg,
            com_m: link.com_m,
            inertia_kg_m2: link.inertia_kg_m2,
        },
        lumped: of_robot(&robot, block).up_from(block.from_m),
        evenly: block.evenly().up_from(block.from_m),
        rest_kg: block.rest.mass_kg,
        rest_at_m: block.rest_at_m().map(|height| height - block.from_m),
        reach_m: block.reach_m().map(|height| height - block.from_m),
    };
    Ok(blocks.iter().zip(&table.links).map(beside).collect())
}

/// All links of a block, held where they are in the handstand.
fn of_robot(robot: &Robot, block: &Block) -> Lump {
    let tree = &robot.tree;
    let poses = tree.poses(&vec![0.0; tree.len()]);
    let links = tree.links.iter().zip(poses).zip(&robot.links);
    let of_block = links.filter(|(_, name)| block.has(name));
    let lumps = of_block.map(|((link, pose), _)| {
        let com = pose * nalgebra::Point3::from(link.com_m);
        let turned = pose.rotation.to_rotation_matrix();
        let about = turned.matrix() * link.inertia_kg_m2 * turned.matrix().transpose();
        Lump {
            mass_kg: link.mass_kg,
            com_m: [com.y, com.z],
            inertia_kg_m2: about[(0, 0)],
        }
    });
    Lump::of(&lumps.collect::<Vec<_>>())
}

impl Lump {
    fn up_from(&self, height_m: f64) -> LumpedValues {
        LumpedValues {
            mass_kg: self.mass_kg,
            com_m: self.com_m[1] - height_m,
            inertia_kg_m2: self.inertia_kg_m2,
        }
    }
}
