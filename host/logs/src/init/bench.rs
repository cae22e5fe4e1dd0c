//! The model of a bench whose log says what its arm is.

use super::Guess;
use super::evidence::link;
use super::log_guess::{LogGuess, PayloadGuess};
use crate::BenchFigures;
use crate::model::new_model::LinkPlan;

/// The arm as its one link: the rod, with the weight as each log's payload; where the log says
/// nothing of the rod, the weight alone.
pub fn links(
    bench: BenchFigures,
    columns: &mut LogGuess,
    guesses: &mut Vec<Guess>,
) -> Vec<LinkPlan> {
    let BenchFigures {
        mass_kg,
        arm_mass_kg,
        length_m,
    } = bench;
    let why = "the log says so";
    let joint = &columns.joints[0];
    let link = if arm_mass_kg > 0.0 {
        let rod = format!("an even rod of {length_m} m and {arm_mass_kg} kg");
        guesses.push(Guess::new("link", rod, why));
        let weight = format!("the key \"mass\" of each log, {mass_kg} kg here");
        guesses.push(Guess::new("payload", weight, why));
        columns.payload = Some(PayloadGuess {
            key: "mass",
            at_m: length_m,
        });
        link(joint, length_m, arm_mass_kg)
    } else {
        let weight = format!("{mass_kg} kg at {length_m} m");
        guesses.push(Guess::new("link", weight, why));
        LinkPlan {
            com_m: length_m,
            inertia_kg_m2: Some(0.0),
            ..link(joint, length_m, mass_kg)
        }
    };
    guesses.push(Guess::new(
        "motor",
        "1.5 N m at standstill, 6 rad/s without load",
        "a guess: its data sheet says",
    ));
    columns.knows_links = true;
    vec![link]
}
