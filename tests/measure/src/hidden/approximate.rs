//! Model files as people have them: every value a little wrong.

use handstand::Model;
use handstand::model::ParameterPath;
use handstand::model::edit::set_values;
use rand::{Rng, SeedableRng};
use std::path::Path;

/// Masses, moments of inertia, centres of mass, torques and speeds are off by up to this share.
const OFF: f64 = 0.1;
/// Stream of the seed that draws by how much; none of a rig's own.
const STREAM: u64 = 900;

/// What the owner of a file says of its values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stated {
    /// That they are as uncertain as such values are.
    Uncertain,
    /// That they are to be fitted.
    Free,
}

/// Makes the values of the model in this file wrong, drawn by the seed, and says so in it.
///
/// # Errors
/// A file that is no model or cannot be written.
pub(super) fn make_approximate(file: &Path, seed: u64, stated: Stated) -> Result<(), String> {
    let text = std::fs::read_to_string(file).map_err(|why| format!("{}: {why}", file.display()))?;
    let wrong = approximate(&text, file, seed, stated).map_err(|error| error.to_string())?;
    std::fs::write(file, wrong).map_err(|why| format!("{}: {why}", file.display()))
}

fn approximate(text: &str, file: &Path, seed: u64, stated: Stated) -> handstand::Result<String> {
    let model = Model::parse(text, file)?;
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(STREAM);
    let known = model.typically_uncertain();
    let off: Vec<(ParameterPath, f64)> = known
        .iter()
        .map(|value| {
            (
                value.path,
                value.given * (1.0 + rng.random_range(-OFF..OFF)),
            )
        })
        .collect();
    let wrong = set_values(text, file, &off)?;
    let section = match stated {
        Stated::Uncertain => "[uncertainty]\ntypical = true\n".to_string(),
        Stated::Free => {
            let free = known.iter().map(|value| value.path).chain(model.free);
            let free: Vec<String> = free.map(|path| format!("\"{path}\"")).collect();
            format!("[fit]\nfree = [{}]\n", free.join(", "))
        }
    };
    Ok(format!("{wrong}\n{section}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use handstand::challenge::{Motions, bench};

    #[test]
    fn every_value_is_off_by_a_tenth_at_most_and_the_file_says_so() {
        let text = bench(Motions::Arm, 1, &["delay"]).unwrap().model_toml;
        let file = Path::new("nominal.toml");
        let exact = Model::parse(&text, file).unwrap();
        for stated in [Stated::Uncertain, Stated::Free] {
            let wrong = approximate(&text, file, 1, stated).unwrap();
            let wrong = Model::parse(&wrong, file).unwrap();
            for known in exact.typically_uncertain() {
                let ratio = known.path.get(&wrong).unwrap() / known.given;
                assert!(
                    (0.9..=1.1).contains(&ratio) && ratio != 1.0,
                    "{known:?} {ratio}"
                );
                assert!(wrong.free.contains(&known.path));
                assert_eq!(
                    wrong.uncertain(known.path).is_some(),
                    stated == Stated::Uncertain
                );
            }
        }
    }
}
