//! Levers of a first model's links: no log tells a lever beside its link's mass and inertia, but
//! one that is held too long or too short leaves the others no room.

use super::settling::Settling;
use crate::fitting::Fit;
use crate::model::{Link, LinkField, Model, ParameterPath};

/// A lever is at most so many times its guess, and at least that share.
const ANY_LEVER: f64 = 10.0;
/// A lever this near, as a share, to the one of the fastest swing is held there by the inertia.
const AT_SHORTEST: f64 = 0.1;
/// The inertia is then taken so many times as large.
const LESS_INERT: f64 = 0.25;
/// A lever is lengthened to so many times itself.
const LONGER: f64 = 1.3;
/// Least inertia of the first link about its own centre of mass, over that of its mass there about
/// the joint. A shorter lever costs it nothing.
const ROOM: f64 = 0.7;
/// Lever of a link that others carry, over the length of the pendulum that swings alike: an even
/// rod's is 0.75. A shorter one makes it heavier than those can make up for, a longer one leaves
/// its own inertia no room.
const CARRIED: std::ops::RangeInclusive<f64> = 0.6..=0.8;
/// Least share of its pull of gravity that a link keeps where the one behind it grows heavier.
const LEFT: f64 = 0.25;

/// What is fitted, and the levers of links whose inertia is; these keep to the model's bounds,
/// which are set: a lever below zero is a mass on the other side, another zero of the angles.
/// Beside a motor whose strength is a guess a lever stays at its own: both scale alike.
pub(super) fn with_levers(free: &[ParameterPath], model: &mut Model) -> Vec<ParameterPath> {
    let moved = |index: &usize| model.joints[*index].drive.motor().is_none();
    let levers = fitted_inertias(free).filter(moved);
    let levers = levers.map(|index| ParameterPath::Link {
        index,
        field: LinkField::Com,
    });
    let levers: Vec<ParameterPath> = levers.filter(|path| !free.contains(path)).collect();
    for path in &levers {
        if let Some(guess) = path.get(model) {
            let bounds = (guess / ANY_LEVER, guess * ANY_LEVER);
            model.bounds.push((*path, bounds));
        }
    }
    [free, &levers].concat()
}

impl Settling<'_> {
    /// The fitted model with other levers where what was fitted has little room, in the order in
    /// which they are tried.
    pub(super) fn roomier(&self, found: &Fit) -> Vec<Model> {
        let (model, free) = (&found.model, &found.free[..]);
        let crowded = crowded(model, free)
            .and_then(|link| with_links(model, |links| self.make_room(links, link)));
        let guess_m = |link: usize| self.drafted.links[link].com_m;
        let misplaced = misplaced(model, free)
            .filter(|(link, com_m)| !self.mass_is_known && is_near(*com_m, guess_m(*link)));
        let misplaced = misplaced
            .filter_map(|(link, com_m)| with_links(model, |links| set_lever(links, link, com_m)));
        let too_long = too_long(model, free).and_then(|link| {
            with_links(model, |links| {
                links[link].inertia_kg_m2 *= LESS_INERT;
                true
            })
        });
        let too_heavy = self.too_heavy(found).and_then(|outer| {
            let longer_m = LONGER * model.links[outer].com_m;
            with_links(model, |links| set_lever(links, outer, longer_m))
        });
        // A heavy outer link leaves the first no inertia: no lever of its own makes up for that.
        let others = too_heavy.into_iter().chain(crowded).chain(too_long);
        misplaced.chain(others).collect()
    }

    /// Shortens a link's lever to half the length of the pendulum that swings alike, or to half of
    /// itself, at the same pull of gravity unless its mass is known, and the same inertia about its
    /// joint. Whether it could.
    fn make_room(&self, links: &mut [Link], index: usize) -> bool {
        let link = &mut links[index];
        let pull_kg_m = link.mass_kg * link.com_m;
        let about_joint_kg_m2 = link.inertia_kg_m2 + pull_kg_m * link.com_m;
        let alike_m = about_joint_kg_m2 / pull_kg_m;
        let com_m = (0.5 * alike_m).clamp(0.5 * link.com_m, link.com_m);
        if !self.mass_is_known {
            return set_lever(links, index, com_m);
        }
        link.com_m = com_m;
        link.inertia_kg_m2 = about_joint_kg_m2 - link.mass_kg * com_m * com_m;
        true
    }

    /// The link behind one that was left no mass: at the lever it has it weighs too much there.
    fn too_heavy(&self, found: &Fit) -> Option<usize> {
        let links = found.model.links.len();
        let on_bound = found.on_bound();
        let mut on_bound = found.free.iter().zip(on_bound).filter(|(_, on)| *on);
        on_bound.find_map(|(path, _)| match path {
            ParameterPath::Link {
                index,
                field: LinkField::Mass,
            } if index + 1 < links && !self.mass_is_known => Some(index + 1),
            _ => None,
        })
    }
}

/// Whether a lever is within the bounds of its guess: what swings like a link that was left no mass
/// is as long as one likes.
fn is_near(com_m: f64, guess_m: f64) -> bool {
    (1.0 / ANY_LEVER..=ANY_LEVER).contains(&(com_m / guess_m.abs()))
}

fn with_links(model: &Model, change: impl FnOnce(&mut [Link]) -> bool) -> Option<Model> {
    let mut model = model.clone();
    change(&mut model.links).then_some(model)
}

/// Links whose inertia is fitted.
fn fitted_inertias(free: &[ParameterPath]) -> impl Iterator<Item = usize> + '_ {
    free.iter().filter_map(|path| match path {
        ParameterPath::Link {
            index,
            field: LinkField::Inertia,
        } => Some(*index),
        _ => None,
    })
}

/// The first link, where its lever leaves its inertia little room below what was fitted; not one
/// whose centre of mass was fitted behind its joint.
fn crowded(model: &Model, free: &[ParameterPath]) -> Option<usize> {
    let link = &model.links[0];
    let about_mass_kg_m2 = link.mass_kg * link.com_m * link.com_m;
    let is_crowded = link.com_m > 0.0 && link.inertia_kg_m2 < ROOM * about_mass_kg_m2;
    fitted_inertias(free).find(|index| *index == 0 && is_crowded)
}

/// Links that others carry and that have an odd lever, with the one of the middle.
fn misplaced<'a>(
    model: &'a Model,
    free: &'a [ParameterPath],
) -> impl Iterator<Item = (usize, f64)> + 'a {
    let carried = fitted_inertias(free).filter(|index| *index > 0);
    carried.filter_map(|index| {
        let link = &model.links[index];
        let alike_m = link.com_m + link.inertia_kg_m2 / (link.mass_kg * link.com_m);
        let middle_m = 0.5 * (CARRIED.start() + CARRIED.end()) * alike_m;
        (!CARRIED.contains(&(link.com_m / alike_m))).then_some((index, middle_m))
    })
}

/// A link whose lever is free and its inertia not, where no lever swings faster: as long as its
/// radius of gyration.
fn too_long(model: &Model, free: &[ParameterPath]) -> Option<usize> {
    let is_free =
        |index: usize, field: LinkField| free.contains(&ParameterPath::Link { index, field });
    (0..model.links.len()).find(|&index| {
        let link = &model.links[index];
        let shortest_m = (link.inertia_kg_m2 / link.mass_kg).sqrt();
        is_free(index, LinkField::Com)
            && !is_free(index, LinkField::Inertia)
            && (link.com_m / shortest_m - 1.0).abs() < AT_SHORTEST
    })
}

/// Gives a link another lever at the same pull of gravity and, as far as there is any, the same
/// inertia about its joint; the links before it make up for its other mass, so that the chain moves
/// as before. Whether they can; else the links are of no use.
fn set_lever(links: &mut [Link], index: usize, com_m: f64) -> bool {
    let more_kg = move_com(&mut links[index], com_m);
    carries(links, index, more_kg)
}

/// Whether the links before this one can make up for a mass that it carries beyond what it did.
fn carries(links: &mut [Link], index: usize, more_kg: f64) -> bool {
    let Some(before) = index.checked_sub(1) else {
        return true;
    };
    let link = &mut links[before];
    let pull_kg_m = link.mass_kg * link.com_m;
    let left_kg_m = pull_kg_m - more_kg * link.length_m;
    if left_kg_m < LEFT * pull_kg_m {
        return false;
    }
    let about_joint_kg_m2 = link.inertia_kg_m2 + pull_kg_m * link.com_m;
    let left_kg_m2 = about_joint_kg_m2 - more_kg * link.length_m * link.length_m;
    let was_kg = link.mass_kg;
    link.mass_kg = left_kg_m / link.com_m;
    link.inertia_kg_m2 = left_kg_m2 - left_kg_m * link.com_m;
    let own_kg = link.mass_kg - was_kg;
    link.inertia_kg_m2 > 0.0 && carries(links, before, more_kg + own_kg)
}

/// Moves a link's centre of mass, the pull of gravity and the inertia about the joint kept; the
/// mass that this adds, kg.
fn move_com(link: &mut Link, com_m: f64) -> f64 {
    let pull_kg_m = link.mass_kg * link.com_m;
    let about_joint_kg_m2 = link.inertia_kg_m2 + pull_kg_m * link.com_m;
    let was_kg = link.mass_kg;
    link.com_m = com_m;
    link.mass_kg = pull_kg_m / com_m;
    let left_kg_m2 = about_joint_kg_m2 - pull_kg_m * com_m;
    link.inertia_kg_m2 = left_kg_m2.max(0.1 * pull_kg_m * com_m);
    link.mass_kg - was_kg
}

#[cfg(test)]
mod tests {
    use super::*;
    use handstand_model::dynamics::EquationsOfMotion;

    /// Three links that hang freely.
    fn hanging() -> Model {
        let links = [
            [0.2, 0.08, 0.9, 0.02],
            [0.25, 0.12, 0.6, 0.02],
            [0.3, 0.16, 0.2, 0.003],
        ];
        let tables = links.map(|[length_m, com_m, mass_kg, inertia_kg_m2]| {
            format!(
                "[[link]]\nlength_m = {length_m}\ncom_m = {com_m}\nmass_kg = {mass_kg}\n\
                 inertia_kg_m2 = {inertia_kg_m2}\n[[joint]]\ndrive = \"passive\"\n"
            )
        });
        let logged = [1, 2, 3].map(|joint| {
            format!("[[log.joint]]\nposition = {{ column = \"q{joint}\", unit = \"rad\" }}\n")
        });
        let text = format!(
            "[rig]\nname = \"three\"\nangle_zero = \"hanging\"\n{}[log]\n\
             time = {{ column = \"t\", unit = \"s\" }}\n{}",
            tables.join(""),
            logged.join("")
        );
        Model::parse(&text, std::path::Path::new("three.toml")).unwrap()
    }

    fn equations(model: &Model) -> EquationsOfMotion {
        EquationsOfMotion::new(&model.chain(), 0.0)
    }

    #[test]
    fn another_lever_leaves_the_motion_as_it_was() {
        for (index, com_m) in [(0, 0.05), (1, 0.1), (1, 0.16), (2, 0.13), (2, 0.2)] {
            let mut model = hanging();
            let links = &mut model.links;
            assert!(set_lever(links, index, com_m), "{index} {com_m}");
            assert_eq!(links[index].com_m, com_m);
            let (before, after) = (equations(&hanging()), equations(&model));
            for angle_rad in [[0.1, -0.4, 0.9], [1.2, 0.3, -2.0]] {
                let mass = after.mass(&angle_rad) - before.mass(&angle_rad);
                let pull = after.gravity(&angle_rad) - before.gravity(&angle_rad);
                assert!(mass.amax() < 1e-12, "{index} {com_m}: {mass}");
                assert!(pull.amax() < 1e-12, "{index} {com_m}: {pull}");
            }
        }
    }

    #[test]
    fn a_centre_of_mass_behind_the_joint_is_not_crowded() {
        let inertia = ParameterPath::Link {
            index: 0,
            field: LinkField::Inertia,
        };
        let mut model = hanging();
        model.links[0].inertia_kg_m2 = 1e-4;
        assert_eq!(crowded(&model, &[inertia]), Some(0));
        model.links[0].com_m = -0.08;
        assert_eq!(crowded(&model, &[inertia]), None);
    }

    #[test]
    fn a_link_without_mass_gets_no_lever_of_miles() {
        let inertia = ParameterPath::Link {
            index: 1,
            field: LinkField::Inertia,
        };
        let mut model = hanging();
        model.links[1].mass_kg = 1e-12;
        let found: Vec<(usize, f64)> = misplaced(&model, &[inertia]).collect();
        assert!(found[0].1 > 1e9, "{found:?}");
        assert!(!is_near(found[0].1, 0.125));
        assert!(!is_near(f64::NAN, 0.125));
        assert!(is_near(0.28, -0.125));
    }

    #[test]
    fn a_lever_that_leaves_the_links_before_it_nothing_is_not_taken() {
        assert!(!set_lever(&mut hanging().links, 2, 0.01));
    }

    #[test]
    fn a_carried_link_gets_the_lever_of_a_rod() {
        let path = |index: usize| ParameterPath::Link {
            index,
            field: LinkField::Inertia,
        };
        let mut model = hanging();
        let free = [path(0), path(1)];
        // It swings like a pendulum of 0.12 + 0.02 / 0.072 = 0.398 m.
        let found: Vec<(usize, f64)> = misplaced(&model, &free).collect();
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].0, 1);
        assert!((found[0].1 - 0.7 * 0.39778).abs() < 1e-4);
        model.links[1].com_m = 0.28;
        model.links[1].inertia_kg_m2 = 0.6 * 0.28 * 0.118;
        assert_eq!(misplaced(&model, &free).count(), 0);
        assert_eq!(misplaced(&model, &free[..1]).count(), 0);
    }
}
