//! Models.

use crate::errors::exception;
use handstand::fitting::Candidate;
use handstand::output;
use handstand::report::{HashedModel, file_name};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};

/// A model: the text of its file, and what it says.
#[pyclass(frozen, module = "handstand")]
#[derive(Debug, Clone)]
pub struct Model {
    pub text: String,
    pub path: PathBuf,
    pub inner: handstand::Model,
}

impl Model {
    /// The model of this text, read as if it stood in a file of this name.
    pub fn of(text: String, path: PathBuf) -> handstand::Result<Model> {
        let inner = handstand::Model::parse(&text, &path)?;
        Ok(Model { text, path, inner })
    }

    /// Name and hash, for reports.
    pub fn file(&self) -> HashedModel {
        HashedModel::of(file_name(&self.path), self.text.as_bytes())
    }
}

#[pymethods]
impl Model {
    /// Reads a model file.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Model> {
        let text = std::fs::read_to_string(&path)
            .map_err(|error| exception(handstand::Error::file(&path, "read", error)))?;
        Model::of(text, path).map_err(exception)
    }

    /// Reads the text of a model file; errors name it by `name`.
    #[staticmethod]
    #[pyo3(signature = (toml, name="model.toml"))]
    fn parse(toml: String, name: &str) -> PyResult<Model> {
        Model::of(toml, PathBuf::from(name)).map_err(exception)
    }

    /// Writes the model file; a file that is there is replaced only where `overwrite` says so.
    #[pyo3(signature = (path, overwrite=false))]
    fn save(&self, path: PathBuf, overwrite: bool) -> PyResult<()> {
        output::write_new(&path, &self.text, overwrite).map_err(exception)
    }

    /// The model's own name.
    #[getter]
    fn name(&self) -> &str {
        &self.inner.name
    }

    /// The file it came from.
    #[getter]
    fn path(&self) -> &Path {
        &self.path
    }

    /// The text of its file.
    #[getter]
    fn toml(&self) -> &str {
        &self.text
    }

    /// Number of links, each with a joint.
    #[getter]
    fn links(&self) -> usize {
        self.inner.link_count()
    }

    /// Per joint: `passive`, `torque`, `duty`, `position` or `speed`.
    #[getter]
    fn drives(&self) -> Vec<&'static str> {
        let joints = self.inner.joints.iter();
        joints.map(|joint| joint.drive.name()).collect()
    }

    /// Its effects as `add` takes them: `coulomb@1`, `delay@all`.
    #[getter]
    fn effects(&self) -> Vec<String> {
        let effects = self.inner.effects.iter();
        let candidates = effects.map(|e| Candidate {
            effect: e.effect,
            joint: e.joint,
        });
        candidates.map(|candidate| candidate.to_string()).collect()
    }

    fn __repr__(&self) -> String {
        let links = self.inner.link_count();
        let effects = match self.effects().as_slice() {
            [] => "no effect".to_string(),
            effects => effects.join(", "),
        };
        format!("<Model {:?}: {links} links, {effects}>", self.inner.name)
    }
}
