//! A diagnosis read back from its JSON: the effects that it found, and their values.

use crate::effects::at_all;
use crate::error::{Error, Place, Result};
use crate::fitting::Candidate;
use crate::model::{Model, ParameterPath};
use serde_json::Value;
use std::path::{Path, PathBuf};

const WRITE_ONE: &str = "write one: handstand diagnose MODEL.toml LOG.. --json > diagnosis.json";

/// What a diagnosis says of a model, as `diagnose --json` writes it.
#[derive(Debug, Clone)]
pub struct DiagnosisFile {
    path: PathBuf,
    diagnosis: Value,
}

impl DiagnosisFile {
    /// Reads the file.
    ///
    /// # Errors
    /// What the system refuses; a file that holds no diagnosis.
    pub fn read(path: &Path) -> Result<DiagnosisFile> {
        let text =
            std::fs::read_to_string(path).map_err(|error| Error::file(path, "read", error))?;
        DiagnosisFile::parse(&text, path)
    }

    /// The diagnosis in a text; `path` names it in errors.
    ///
    /// # Errors
    /// A text that holds no diagnosis.
    pub fn parse(text: &str, path: &Path) -> Result<DiagnosisFile> {
        let diagnosis: Value = serde_json::from_str(text).map_err(|error| {
            let place = Place::at(path, error.line().max(1), error.column().max(1));
            Error::data(place, format!("no diagnosis: {error}"), WRITE_ONE)
        })?;
        let is_one = diagnosis["verdict"].is_string() && diagnosis["effects"].is_array();
        if !is_one {
            let what = "no diagnosis: it has no `verdict` with `effects`";
            return Err(Error::data(Place::file(path), what, WRITE_ONE));
        }
        Ok(DiagnosisFile {
            path: path.to_path_buf(),
            diagnosis,
        })
    }

    /// Names of the effects that it found, as `coulomb@1`.
    ///
    /// # Errors
    /// It found none; what it found instead is said.
    pub fn effects(&self) -> Result<Vec<String>> {
        let names: Vec<String> = effects_of(&self.diagnosis).map(named).collect();
        if !names.is_empty() {
            return Ok(names);
        }
        let wrong = self.wrong_values();
        let (what, remedy) = match wrong.as_slice() {
            [] => {
                let verdict = self.diagnosis["verdict"].as_str().unwrap_or_default();
                let what = format!("it found no missing effect (`{verdict}`)");
                (what, "name the effect to add".to_string())
            }
            paths => {
                let what = format!(
                    "it found a wrong value, no missing effect: {}",
                    paths.join(", ")
                );
                let free: Vec<String> =
                    paths.iter().map(|path| format!(" --free {path}")).collect();
                (
                    what,
                    format!("handstand fit MODEL.toml LOG..{}", free.concat()),
                )
            }
        };
        Err(Error::data(Place::file(&self.path), what, remedy))
    }

    /// Addresses of values of the model file that it found wrong, beyond what its owner allows.
    pub fn wrong_values(&self) -> Vec<String> {
        let wrong = self.diagnosis["wrong_values"].as_array();
        let mut wrong: Vec<_> = wrong.into_iter().flatten().collect();
        wrong.retain(|value| value["within_uncertainty"] != true);
        let paths = wrong.into_iter().map(|value| &value["path"]);
        paths
            .filter_map(|path| Some(path.as_str()?.to_string()))
            .collect()
    }

    /// The values that it gives these effects: those of its explanation, with the model's free ones
    /// as it refitted them, or of the alternative that has them all. None where none has.
    ///
    /// # Errors
    /// A value that the model has no place for: the diagnosis is of another model.
    pub fn values(
        &self,
        candidates: &[Candidate],
        model: &Model,
    ) -> Result<Vec<(ParameterPath, f64)>> {
        let alternatives = self.diagnosis["alternatives"].as_array();
        let all = std::iter::once(&self.diagnosis).chain(alternatives.into_iter().flatten());
        let Some((set, mut values)) = all
            .enumerate()
            .find_map(|(set, found)| Some((set, values_of(candidates, found)?)))
        else {
            return Ok(Vec::new());
        };
        // The free values were refitted beside the first.
        let base = self.diagnosis["base"].as_array().filter(|_| set == 0);
        for value in base.into_iter().flatten() {
            let address = value["path"].as_str().unwrap_or_default();
            let path = address.parse::<ParameterPath>().ok();
            let known = path.filter(|path| path.get(model).is_some());
            let (Some(path), Some(value)) = (known, value["value"].as_f64()) else {
                return Err(Error::data(
                    Place::file(&self.path),
                    format!("it is of another model: this one has no `{address}`"),
                    WRITE_ONE,
                ));
            };
            values.push((path, value));
        }
        Ok(values)
    }
}

fn effects_of(found: &Value) -> impl Iterator<Item = &Value> {
    found["effects"].as_array().into_iter().flatten()
}

/// "coulomb@1", "delay@all", "base_tilt".
fn named(effect: &Value) -> String {
    let kind = effect["kind"].as_str().unwrap_or_default();
    match effect["joint"].as_u64() {
        Some(joint) => format!("{kind}@{joint}"),
        None => format!("{kind}{}", at_all(kind)),
    }
}

/// The values of all candidates where these effects hold them all.
fn values_of(candidates: &[Candidate], found: &Value) -> Option<Vec<(ParameterPath, f64)>> {
    let mut values = Vec::new();
    for candidate in candidates {
        let name = candidate.to_string();
        let own = effects_of(found).find(|effect| named(effect) == name)?;
        for (parameter, path) in candidate.parameters().iter().zip(candidate.paths()) {
            values.push((path, own["parameters"][parameter.key]["value"].as_f64()?));
        }
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnosis_json;
    use crate::tests::sample::diagnosis;

    #[test]
    fn what_diagnose_writes_is_read_back() {
        let text = diagnosis_json(&diagnosis()).to_string();
        let file = DiagnosisFile::parse(&text, Path::new("d.json")).unwrap();
        let names: Vec<String> = diagnosis()
            .effects
            .iter()
            .map(|effect| format!("{}@{}", effect.kind, effect.joint.unwrap()))
            .collect();
        assert_eq!(file.effects().unwrap(), names);
    }

    #[test]
    fn what_is_no_diagnosis_is_refused_with_how_one_is_written() {
        for text in ["{}", "[1]", "time_s,q", r#"{"verdict": "named"}"#] {
            let error = DiagnosisFile::parse(text, Path::new("d.json")).unwrap_err();
            assert_eq!(error.exit_code(), 3, "{text}");
            assert!(error.remedy().unwrap().contains("diagnose"), "{error}");
        }
        let wrong = r#"{"verdict": "wrong_value", "effects": [],
            "wrong_values": [{"path": "link1.mass_kg"}]}"#;
        let error = DiagnosisFile::parse(wrong, Path::new("d.json"))
            .unwrap()
            .effects();
        let remedy = error.unwrap_err().remedy().unwrap().into_owned();
        assert!(
            remedy.contains("fit MODEL.toml LOG.. --free link1.mass_kg"),
            "{remedy}"
        );
    }
}
