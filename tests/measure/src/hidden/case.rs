//! A case: what is hidden in which rig at which seed, and the files of it.

use super::approximate::make_approximate;
use super::family::Family;
use super::{mujoco, robot};
use handstand::challenge::{Bench, BenchEffect, Motions, bench, weakened_arm};
use handstand::diagnose::Strategy;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Who makes the logs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Truth {
    /// The independent equations of the library's challenges
    Own,
    /// MuJoCo, by tests/peers/hidden_mujoco.py and hidden_space.py
    Mujoco,
    /// The virtual robot, recorded through the firmware's logic
    Robot,
}

impl Truth {
    /// As the command line calls it.
    pub fn name(self) -> String {
        let value = clap::ValueEnum::to_possible_value(&self);
        value.map_or_else(String::new, |value| value.get_name().to_string())
    }
}

/// A rig to diagnose.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Case {
    /// Who makes its logs.
    pub truth: Truth,
    /// Its family.
    pub family: Family,
    /// Kinds of the effects it hides.
    pub hidden: Vec<&'static str>,
    /// Its seed.
    pub seed: u64,
    /// Parts of the search that are left out.
    pub skipped: Vec<Strategy>,
}

/// An effect that is hidden, with its values.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct HiddenEffect {
    /// Its kind.
    pub kind: String,
    /// Joint it acts on, counted from 1; none when it acts on the whole rig.
    pub joint: Option<usize>,
    /// Its values by key.
    pub parameters: serde_json::Map<String, Value>,
}

/// The files of a case.
#[derive(Debug, Clone)]
pub struct Files {
    /// The model its owner believes in.
    pub nominal: PathBuf,
    /// The true model, where the library can write it.
    pub truth: Option<PathBuf>,
    /// Logs to learn from.
    pub fit: Vec<PathBuf>,
    /// Logs held out.
    pub held_out: Vec<PathBuf>,
    /// What is hidden.
    pub effects: Vec<HiddenEffect>,
}

/// What a script writes of the truth.
#[derive(Debug, Deserialize)]
pub(super) struct TruthFile {
    pub effects: Vec<HiddenEffect>,
    pub in_library: bool,
    pub fit: Vec<String>,
    pub held_out: Vec<String>,
}

impl HiddenEffect {
    /// As results name it: `coulomb@1`.
    pub fn address(&self) -> String {
        match self.joint {
            Some(joint) => format!("{}@{joint}", self.kind),
            None => self.kind.clone(),
        }
    }
}

/// Laws that another's holds as a special case (with two of its values equal, while the drive is
/// on, while friction is larger than the offset): that one explains them rightly.
const GENERAL: [(&str, &str); 6] = [
    ("load_friction", "drive_asymmetry"),
    // With a torque offset of half the difference it resists both ways alike.
    ("coulomb", "direction_asymmetry"),
    ("direction_asymmetry", "torque_offset"),
    ("torque_offset", "direction_asymmetry"),
    ("delay", "time_offset"),
    ("time_offset", "delay"),
];

impl Case {
    /// Effects that the library is to lack: what is hidden, and what holds it as a special case.
    pub fn without(&self) -> Vec<String> {
        match (self.truth, self.family) {
            (Truth::Own, Family::Outside) => {
                let general = GENERAL
                    .into_iter()
                    .filter(|(special, _)| self.hidden.contains(special))
                    .map(|(_, general)| general);
                let hidden = self.hidden.iter().copied();
                hidden.chain(general).map(str::to_string).collect()
            }
            _ => Vec::new(),
        }
    }

    /// Its name as a folder's: `hanging-viscous-1`.
    pub(super) fn name(&self) -> String {
        let kinds = self.hidden.join("-");
        let parts = [self.family.name(), &kinds, &self.seed.to_string()];
        let parts: Vec<&str> = parts.into_iter().filter(|part| !part.is_empty()).collect();
        parts.join("-")
    }

    /// Name of the rig's motions as the script takes it.
    pub(super) fn motions(&self) -> &'static str {
        match self.family.motions() {
            Motions::Arm => "arm",
            Motions::Hanging => "hanging",
            Motions::Balancing => "balancing",
        }
    }

    /// Writes the case into an empty folder.
    ///
    /// # Errors
    /// A file that cannot be written, a rig that cannot be balanced, a script that fails.
    pub fn write(&self, dir: &Path) -> Result<Files, String> {
        let files = match self.truth {
            Truth::Own => {
                let Some(bench) = bench(self.family.motions(), self.seed, &self.hidden) else {
                    return Err("the robot cannot be balanced".to_string());
                };
                written(&bench, dir)
            }
            Truth::Mujoco => mujoco::write(self, dir),
            Truth::Robot => robot::write(self, dir),
        }?;
        if let Some(stated) = self.family.stated() {
            make_approximate(&files.nominal, self.seed, stated)?;
        }
        Ok(files)
    }

    /// Writes the bench arm with what it hides at this share of its strength into an empty folder.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_weakened(&self, share: f64, dir: &Path) -> Result<Files, String> {
        written(&weakened_arm(self.seed, &self.hidden, share), dir)
    }
}

fn written(bench: &Bench, dir: &Path) -> Result<Files, String> {
    let write = |name: &str, content: &str| {
        let path = dir.join(name);
        std::fs::write(&path, content).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok::<PathBuf, String>(path)
    };
    let mut files = Files {
        nominal: write("nominal.toml", &bench.model_toml)?,
        truth: Some(write("true.toml", &bench.true_model_toml)?),
        fit: Vec::new(),
        held_out: Vec::new(),
        effects: bench.effects.iter().map(known).collect(),
    };
    for log in &bench.logs {
        let path = write(&log.name, &log.csv)?;
        if log.held_out {
            files.held_out.push(path)
        } else {
            files.fit.push(path)
        }
    }
    Ok(files)
}

fn known(effect: &BenchEffect) -> HiddenEffect {
    let value = |(key, value): &(&'static str, f64)| (key.to_string(), Value::from(*value));
    HiddenEffect {
        kind: effect.kind.to_string(),
        joint: effect.joint,
        parameters: effect.parameters.iter().map(value).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_library_lacks_what_holds_the_hidden_effect_too() {
        let without = |family, kind| {
            let case = Case {
                truth: Truth::Own,
                family,
                hidden: vec![kind],
                seed: 1,
                skipped: Vec::new(),
            };
            case.without()
        };
        assert_eq!(without(Family::Outside, "mass"), ["mass"]);
        assert_eq!(
            without(Family::Outside, "load_friction"),
            ["load_friction", "drive_asymmetry"]
        );
        assert!(without(Family::Single, "mass").is_empty());
    }
}
