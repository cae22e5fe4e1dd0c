//! A block of Table 1: what of it is servos, and what is left for frames, controller and batteries.

use super::places::{BLOCKS, BlockPlace, SHOULDER_M, SidePart};
use crate::model::Link;

/// Mass, centre and moment of inertia of parts together, for turns about the axis from hand to
/// hand.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lump {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Its centre: forward, and up from the bar, m.
    pub com_m: [f64; 2],
    /// About the centre, kg m^2.
    pub inertia_kg_m2: f64,
}

impl Lump {
    /// Parts together.
    pub fn of(parts: &[Lump]) -> Lump {
        let mass_kg: f64 = parts.iter().map(|part| part.mass_kg).sum();
        let mean = |axis: usize| {
            let moments = parts.iter().map(|part| part.mass_kg * part.com_m[axis]);
            moments.sum::<f64>() / mass_kg
        };
        let com_m = [mean(0), mean(1)];
        let about = |part: &Lump| part.inertia_kg_m2 + part.mass_kg * squared(part.com_m, com_m);
        Lump {
            mass_kg,
            com_m,
            inertia_kg_m2: parts.iter().map(about).sum(),
        }
    }

    /// A box of evenly spread mass.
    pub fn cuboid(mass_kg: f64, com_m: [f64; 2], [deep, high]: [f64; 2]) -> Lump {
        Lump {
            mass_kg,
            com_m,
            inertia_kg_m2: mass_kg * (deep * deep + high * high) / 12.0,
        }
    }

    /// What has to be added for this to become `whole`.
    fn lacking(&self, whole: &Lump) -> Lump {
        let mass_kg = whole.mass_kg - self.mass_kg;
        let com = |axis: usize| {
            let moment = whole.mass_kg * whole.com_m[axis] - self.mass_kg * self.com_m[axis];
            moment / mass_kg
        };
        let com_m = [com(0), com(1)];
        let known = self.inertia_kg_m2 + self.mass_kg * squared(self.com_m, whole.com_m);
        Lump {
            mass_kg,
            com_m,
            inertia_kg_m2: whole.inertia_kg_m2 - known - mass_kg * squared(com_m, whole.com_m),
        }
    }
}

fn squared(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}

/// A block: its servos, and what Table 1 leaves for the rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Block {
    pub place: BlockPlace,
    /// Height of its lower axis over the bar, m.
    pub from_m: f64,
    /// Servos, and the frames whose mass is taken as known.
    pub known: Lump,
    /// All that is left.
    pub rest: Lump,
}

impl Block {
    /// The three, from the bar up; `table` is Table 1.
    pub fn all(table: &[Link]) -> Vec<Block> {
        let mut from_m = 0.0;
        let block = |(place, link): (BlockPlace, &Link)| {
            let known = Lump::of(&place.parts().map(both).collect::<Vec<_>>());
            let whole = Lump {
                mass_kg: link.mass_kg,
                com_m: [0.0, from_m + link.com_m],
                inertia_kg_m2: link.inertia_kg_m2,
            };
            let block = Block {
                place,
                from_m,
                known,
                rest: known.lacking(&whole),
            };
            from_m += link.length_m;
            block
        };
        BLOCKS.into_iter().zip(table).map(block).collect()
    }

    /// Its servos.
    pub fn servos(&self) -> usize {
        let own = self.place.parts();
        2 * own.filter(|part| part.servo.is_some()).count()
    }

    /// Whether a link of the whole robot belongs to it.
    pub fn has(&self, link: &str) -> bool {
        let sided = link.strip_prefix("right_").or(link.strip_prefix("left_"));
        self.place.links.contains(&sided.unwrap_or(link))
    }

    /// Heights over the bar of the rest as two equal cubes, which have its centre and its moment of
    /// inertia, m.
    pub fn rest_at_m(&self) -> [f64; 2] {
        let edge_m2 = self.place.edge_m * self.place.edge_m;
        let apart_m = (self.rest.inertia_kg_m2 / self.rest.mass_kg - edge_m2 / 6.0).sqrt();
        let height_m = self.rest.com_m[1];
        [height_m - apart_m, height_m + apart_m]
    }

    /// Its reach, up from the bar, m.
    pub fn reach_m(&self) -> [f64; 2] {
        self.place.reach_m.map(|height| SHOULDER_M + height)
    }

    /// The block with the rest spread evenly along its reach instead.
    pub fn evenly(&self) -> Lump {
        let [low, high] = self.reach_m();
        let centre_m = [0.0, 0.5 * (low + high)];
        let rest = Lump::cuboid(self.rest.mass_kg, centre_m, [0.0, high - low]);
        Lump::of(&[self.known, rest])
    }
}

/// A part and its mirror image, which share centre and height.
fn both(part: &SidePart) -> Lump {
    let [_, forward, height] = part.at_m;
    let [_, deep, high] = part.size_m;
    Lump::cuboid(
        2.0 * part.mass_kg,
        [forward, SHOULDER_M + height],
        [deep, high],
    )
}
