//! What the lab is given: a servo arm, the robot of three links, eighteen links.

use handstand::challenge::{Motions, bench};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A model and its logs.
#[derive(Debug)]
pub struct Rig {
    /// How tables name it.
    pub name: &'static str,
    /// Longest that a slider may take, ms.
    pub slider_ms: f64,
    model: String,
    logs: Vec<(String, String)>,
}

impl Rig {
    /// Those whose sliders are moved; each has 60 s of motions in three logs.
    ///
    /// # Errors
    /// The robot cannot be made.
    pub fn all() -> Result<Vec<Rig>, String> {
        let rigs = [
            ("one arm", Motions::Arm, 50.0),
            ("three links", Motions::Hanging, 150.0),
        ];
        let rigs = rigs.into_iter().map(|(name, motions, slider_ms)| {
            let made = bench(motions, 3, &["coulomb"]).ok_or("no such robot")?;
            let logs = made.logs.into_iter();
            Ok(Rig {
                name,
                slider_ms,
                model: made.model_toml,
                logs: logs.map(|log| (log.name, log.csv)).collect(),
            })
        });
        rigs.collect()
    }

    /// Writes it into a folder; the names of its files, the model first.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn write(&self, folder: &Path) -> std::io::Result<Vec<PathBuf>> {
        let mut files = vec![folder.join("model.toml")];
        std::fs::write(&files[0], &self.model)?;
        for (name, csv) in &self.logs {
            let file = folder.join(name);
            std::fs::write(&file, csv)?;
            files.push(file);
        }
        Ok(files)
    }
}

/// A minute of eighteen joints at 100 Hz, as CSV.
pub fn minute_of_eighteen_joints() -> String {
    let mut log = String::from("time_s");
    for joint in 1..=18 {
        let _ = write!(log, ",q{joint}_rad");
    }
    for sample in 0..6000 {
        let time_s = f64::from(sample) / 100.0;
        let _ = write!(log, "\n{time_s:.2}");
        for joint in 1..=18 {
            let angle_rad = 0.3 * (time_s * (1.0 + 0.1 * f64::from(joint))).sin();
            let _ = write!(log, ",{angle_rad:.4}");
        }
    }
    log
}
