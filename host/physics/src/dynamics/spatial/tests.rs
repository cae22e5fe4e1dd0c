use super::*;
use crate::dynamics::{Chain, ChainLink, SlideAxis, Workspace};
use nalgebra::{Translation3, UnitQuaternion};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn vector(random: &mut ChaCha8Rng, size: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.random_range(-size..size))
}

fn link(random: &mut ChaCha8Rng, parent: Option<usize>) -> SpatialLink {
    // Moments that a body can have: those of points.
    let mut inertia_kg_m2 = Matrix3::zeros();
    for _ in 0..4 {
        let arm = vector(random, 0.1).cross_matrix();
        inertia_kg_m2 -= arm * arm * random.random_range(0.1..1.0);
    }
    SpatialLink {
        parent,
        place: Isometry3::from_parts(
            Translation3::from(vector(random, 0.3)),
            UnitQuaternion::from_scaled_axis(vector(random, 3.0)),
        ),
        axis: Unit::new_normalize(vector(random, 1.0)),
        slides: random.random_bool(0.3),
        mass_kg: random.random_range(0.1..2.0),
        com_m: vector(random, 0.2),
        inertia_kg_m2,
        armature_kg_m2: random.random_range(0.0..0.01),
    }
}

fn tree(random: &mut ChaCha8Rng) -> SpatialTree {
    let count: usize = random.random_range(1..12);
    let links = (0..count).map(|i| {
        let parent: usize = random.random_range(0..=i);
        link(random, parent.checked_sub(1))
    });
    SpatialTree {
        links: links.collect(),
        gravity_m_s2: vector(random, 10.0),
    }
}

fn numbers(random: &mut ChaCha8Rng, count: usize, size: f64) -> Vec<f64> {
    (0..count)
        .map(|_| random.random_range(-size..size))
        .collect()
}

/// What is held needs the torque that it is told, and the others get the accelerations that Newton
/// and Euler ask these torques for.
#[test]
fn forward_undoes_inverse_whatever_is_held() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..200 {
        let tree = tree(&mut random);
        let n = tree.len();
        let held: Vec<bool> = (0..n).map(|_| random.random_bool(0.3)).collect();
        let angle = numbers(&mut random, n, 3.0);
        let mut speed = numbers(&mut random, n, 2.0);
        let mut wanted = numbers(&mut random, n, 10.0);
        for (i, held) in held.iter().enumerate() {
            if *held {
                (speed[i], wanted[i]) = (0.0, 0.0);
            }
        }
        let mut work = SpatialWorkspace::default();
        let mut torque = vec![0.0; n];
        SpatialEquations::new(&tree).inverse(
            &mut work,
            [&angle, &speed, &wanted],
            &mut torque,
            |_, _| {},
        );
        let lacking = numbers(&mut random, n, 1.0);
        for i in 0..n {
            if held[i] {
                torque[i] -= lacking[i];
                wanted[i] = lacking[i];
            }
        }
        let mut found = vec![0.0; n];
        SpatialEquations::new(&tree).forward(
            &mut work,
            [&angle, &speed, &torque],
            &held,
            &mut found,
        );
        for (found, wanted) in found.iter().zip(&wanted) {
            assert!(
                (found - wanted).abs() < 1e-9 * (1.0 + wanted.abs()),
                "{found} {wanted}"
            );
        }
    }
}

/// The planar chain, its plane turned any way in space.
#[test]
fn a_planar_chain_is_a_tree_whose_axes_are_parallel() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..200 {
        let n = random.random_range(1..7);
        let mut links = Vec::new();
        for _ in 0..n {
            let slides = random.random_bool(0.2);
            links.push(ChainLink {
                length_m: random.random_range(0.0..0.3),
                com_m: random.random_range(-0.1..0.2),
                com_angle_rad: random.random_range(-0.5..0.5),
                mass_kg: random.random_range(0.1..1.0),
                inertia_kg_m2: random.random_range(1e-4..1e-2),
                armature_kg_m2: random.random_range(0.0..0.01),
                slide: slides.then(|| SlideAxis {
                    direction_rad: random.random_range(-3.0..3.0),
                    link_rad: random.random_range(-3.0..3.0),
                }),
            });
        }
        let chain = Chain {
            links,
            gravity_m_s2: 9.81,
        };
        let tree = in_space(&chain, &mut random);
        let angle = numbers(&mut random, n, 3.0);
        let speed = numbers(&mut random, n, 5.0);
        let torque = numbers(&mut random, n, 2.0);
        let held = vec![false; n];
        let (mut planar, mut spatial) = (vec![0.0; n], vec![0.0; n]);
        let base = chain.base_m_s2(0.0);
        let mut work = Workspace::new(n);
        chain.forward(&mut work, base, &angle, &speed, &torque, &held, &mut planar);
        let mut work = SpatialWorkspace::default();
        SpatialEquations::new(&tree).forward(
            &mut work,
            [&angle, &speed, &torque],
            &held,
            &mut spatial,
        );
        for (planar, spatial) in planar.iter().zip(&spatial) {
            let most = 1e-9 * (1.0 + planar.abs());
            assert!((planar - spatial).abs() < most, "{planar} {spatial}");
        }
    }
}

/// The chain in the plane x, y, y up, its joints about z; all of it turned at random.
fn in_space(chain: &Chain, random: &mut ChaCha8Rng) -> SpatialTree {
    let turned = UnitQuaternion::from_scaled_axis(vector(random, 3.0));
    // A link's own line is its x: hanging is a turn by -90 degrees.
    let about_z = |angle: f64| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
    let mut end = Isometry3::from_parts(
        Translation3::identity(),
        turned * about_z(-std::f64::consts::FRAC_PI_2),
    );
    let mut links = Vec::new();
    for (i, link) in chain.links.iter().enumerate() {
        let (turn, axis) = match link.slide {
            None => (UnitQuaternion::identity(), Vector3::z_axis()),
            Some(slide) => (
                about_z(slide.link_rad),
                Unit::new_normalize(about_z(slide.direction_rad - slide.link_rad) * Vector3::x()),
            ),
        };
        links.push(SpatialLink {
            parent: i.checked_sub(1),
            place: end * turn,
            axis,
            slides: link.slide.is_some(),
            mass_kg: link.mass_kg,
            com_m: about_z(link.com_angle_rad) * Vector3::x() * link.com_m,
            inertia_kg_m2: Matrix3::identity() * link.inertia_kg_m2,
            armature_kg_m2: link.armature_kg_m2,
        });
        end = Isometry3::translation(link.length_m, 0.0, 0.0);
    }
    SpatialTree {
        links,
        gravity_m_s2: turned * Vector3::new(0.0, -chain.gravity_m_s2, 0.0),
    }
}

/// Power of the torques is what the energy gains: by Runge-Kutta of fourth order over a short time.
#[test]
fn energy_is_what_torques_put_in() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for _ in 0..50 {
        let tree = tree(&mut random);
        let n = tree.len();
        let angle = numbers(&mut random, n, 3.0);
        let speed = numbers(&mut random, n, 2.0);
        let torque = numbers(&mut random, n, 2.0);
        let mut work = SpatialWorkspace::default();
        let mut acceleration = vec![0.0; n];
        let held = vec![false; n];
        SpatialEquations::new(&tree).forward(
            &mut work,
            [&angle, &speed, &torque],
            &held,
            &mut acceleration,
        );
        let energy_after = |h: f64| {
            let at = |i: usize| angle[i] + h * speed[i] + 0.5 * h * h * acceleration[i];
            let fast = |i: usize| speed[i] + h * acceleration[i];
            let (angle, speed): (Vec<f64>, Vec<f64>) = (0..n).map(|i| (at(i), fast(i))).unzip();
            let (kinetic, potential) = tree.energy_j(&angle, &speed);
            kinetic + potential
        };
        let h = 1e-5;
        let gained = (energy_after(h) - energy_after(-h)) / (2.0 * h);
        let power: f64 = torque
            .iter()
            .zip(&speed)
            .map(|(torque, speed)| torque * speed)
            .sum();
        assert!(
            (gained - power).abs() < 1e-4 * (1.0 + power.abs()),
            "{gained} {power}"
        );
    }
}

/// Mass matrix and gravity against Newton and Euler, their slope against its difference.
#[test]
fn the_closed_form_is_that_of_newton_and_euler() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for _ in 0..100 {
        let tree = tree(&mut random);
        let n = tree.len();
        let (angle, still) = (numbers(&mut random, n, 3.0), vec![0.0; n]);
        let holds = |angle: &[f64], acceleration: &[f64]| {
            let mut torque = vec![0.0; n];
            let joints = [angle, &still, acceleration];
            let mut work = SpatialWorkspace::default();
            SpatialEquations::new(&tree).inverse(&mut work, joints, &mut torque, |_, _| {});
            nalgebra::DVector::from_vec(torque)
        };
        let found = TreeAtPose::new(&tree, &angle);
        let (mass, gravity) = (found.mass(), holds(&angle, &still));
        let size = 1.0 + mass.amax().max(gravity.amax());
        assert!((found.gravity() - &gravity).amax() < 1e-12 * size);
        assert!(gravity.amax() <= found.largest_gravity_nm() * (1.0 + 1e-12));
        let slope = found.gravity_slope();
        for joint in 0..n {
            let mut one = still.clone();
            one[joint] = 1.0;
            let column = holds(&angle, &one) - &gravity;
            assert!((mass.column(joint) - column).amax() < 1e-12 * size);
            let moved = |by: f64| {
                let mut angle = angle.clone();
                angle[joint] += by;
                holds(&angle, &still)
            };
            let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((slope.column(joint) - difference).amax() < 1e-7 * size);
        }
        assert_eq!(slope, slope.transpose());
    }
}

/// Energy with a point mass is the energy without it and the point's own.
#[test]
fn a_mass_bolted_on_moves_and_falls_with_its_link() {
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for _ in 0..50 {
        let tree = tree(&mut random);
        let n = tree.len();
        let (link, mass_kg) = (random.random_range(0..n), random.random_range(0.1..2.0));
        let at_m = vector(&mut random, 0.3);
        let (angle, speed) = (numbers(&mut random, n, 3.0), numbers(&mut random, n, 2.0));
        let mut loaded = tree.clone();
        loaded.bolt_on(link, mass_kg, at_m);
        let place = |later_s: f64| {
            let moved = angle.iter().zip(&speed).map(|(q, dq)| q + later_s * dq);
            tree.poses(&moved.collect::<Vec<_>>())[link] * nalgebra::Point3::from(at_m)
        };
        let velocity = (place(1e-5) - place(-1e-5)) / 2e-5;
        let own = (
            0.5 * mass_kg * velocity.norm_squared(),
            -mass_kg * tree.gravity_m_s2.dot(&place(0.0).coords),
        );
        let (before, after) = (
            tree.energy_j(&angle, &speed),
            loaded.energy_j(&angle, &speed),
        );
        let scale = 1.0 + after.0.abs() + after.1.abs();
        assert!((after.0 - before.0 - own.0).abs() < 1e-7 * scale);
        assert!((after.1 - before.1 - own.1).abs() < 1e-12 * scale);
    }
}
