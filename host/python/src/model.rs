//! Models.

use crate::errors::{exception, no_address, usage};
use crate::value::counted;
use handstand::fitting::Candidate;
use handstand::model::edit::set_values_exactly;
use handstand::model::{JointField, LinkField, ParameterPath};
use handstand::output;
use handstand::report::{HashedModel, file_name};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyIterator, PyType};
use std::path::{Path, PathBuf};

/// A model: the text of its file, and what it says.
///
/// `Model.load(path)` reads a file, `Model(toml)` its text. Its numbers are read and set by their
/// addresses, as `handstand fit` names them: `model["coulomb@1.torque_nm"] = 0.05`; the text
/// follows, with its comments. Models are equal where they say the same.
///
/// Parameters
/// ----------
/// toml : str
///     The text of a model file.
/// name : str
///     What errors and reports call it.
#[pyclass(module = "handstand")]
#[derive(Debug, Clone)]
pub struct Model {
    pub text: String,
    pub path: PathBuf,
    pub inner: handstand::Model,
}

impl Model {
    /// Addresses of all numbers that it has.
    fn addresses(&self) -> Vec<ParameterPath> {
        let links = 0..self.inner.link_count();
        let of_links = links.clone().flat_map(|index| {
            let fields = LinkField::ALL.into_iter();
            fields.map(move |field| ParameterPath::Link { index, field })
        });
        let of_joints = links.flat_map(|index| {
            let fields = JointField::ALL.into_iter();
            fields.map(move |field| ParameterPath::Joint { index, field })
        });
        let of_effects = self.inner.effects.iter().flat_map(ParameterPath::of_effect);
        let all = of_links.chain(of_joints).chain(of_effects);
        all.filter(|path| path.get(&self.inner).is_some_and(f64::is_finite))
            .collect()
    }

    /// The number at an address.
    fn found(&self, address: &str) -> PyResult<(ParameterPath, f64)> {
        let path = ParameterPath::read(address, &self.inner).map_err(|error| {
            let remedy = error.remedy().unwrap_or_default();
            no_address(&error.to_string(), &remedy)
        })?;
        let value = path.get(&self.inner).filter(|value| value.is_finite());
        let value = value.ok_or_else(|| {
            let all: Vec<String> = self.addresses().iter().map(ToString::to_string).collect();
            no_address(
                &format!("there is no {address} in {:?}", self.inner.name),
                &format!("it has {}", all.join(", ")),
            )
        })?;
        Ok((path, value))
    }

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
    #[new]
    #[pyo3(signature = (toml, name="model.toml"))]
    fn new(toml: String, name: &str) -> PyResult<Model> {
        Model::parse(toml, name)
    }

    /// All its numbers by their addresses, in SI: links, drives, effects.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let values = PyDict::new(py);
        for path in self.addresses() {
            values.set_item(path.to_string(), path.get(&self.inner))?;
        }
        Ok(values)
    }

    fn __getitem__(&self, address: &str) -> PyResult<f64> {
        Ok(self.found(address)?.1)
    }

    fn __setitem__(&mut self, address: &str, value: f64) -> PyResult<()> {
        let (path, _) = self.found(address)?;
        let text = set_values_exactly(&self.text, &self.path, &[(path, value)]);
        let text = text.map_err(|error| match &error {
            // Its place is a file that is not written.
            handstand::Error::Data { problem, .. } => usage(
                format!("{address} = {value}: {problem}"),
                error.remedy().unwrap_or_default(),
            ),
            _ => exception(error),
        })?;
        *self = Model::of(text, self.path.clone()).map_err(exception)?;
        Ok(())
    }

    fn __contains__(&self, address: &str) -> bool {
        self.found(address).is_ok()
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.values(py)?.try_iter()
    }

    fn __eq__(&self, other: PyRef<'_, Model>) -> bool {
        self.inner == other.inner
    }

    /// Copies and pickles carry the text.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyType>, (String, String)) {
        let own = slf.borrow();
        let path = own.path.to_string_lossy().into_owned();
        (slf.get_type(), (own.text.clone(), path))
    }

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
        let links = counted(self.inner.link_count(), "link");
        let effects = match self.effects().as_slice() {
            [] => "no effect".to_string(),
            effects => effects.join(", "),
        };
        format!("<Model {:?}: {links}, {effects}>", self.inner.name)
    }
}
