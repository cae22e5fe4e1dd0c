//! Where each value of a drafted model comes from.

use super::Draft;
use crate::error::Result;
use crate::model::{JointField, LinkField, Model, ParameterPath};
use serde::Serialize;
use std::path::Path;

/// Where a value comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Origin {
    /// The user says it, or the log itself.
    Given,
    /// A fit to the log.
    Estimated,
    /// Nothing; it has to be measured, or fitted to logs that tell it.
    Guess,
}

/// A value of a drafted model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DraftValue {
    /// Its address.
    pub path: String,
    /// As it is written, in the unit that its key ends in.
    pub value: f64,
    /// 95 % interval of an estimate.
    pub low: Option<f64>,
    /// Its upper end.
    pub high: Option<f64>,
    /// Where it comes from.
    pub origin: Origin,
}

/// A value that a fit to the log gave, with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Its address.
    pub path: ParameterPath,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Draft {
    /// The values of links, drives and friction in the model file, each with where it comes from.
    ///
    /// # Errors
    /// Figures that make no model.
    pub fn values(&self) -> Result<Vec<DraftValue>> {
        let model = Model::parse(&self.toml()?, Path::new("model.toml"))?;
        let links = model.link_count();
        let mut paths: Vec<ParameterPath> = Vec::new();
        for index in 0..links {
            // No joint follows the last link, so its length says nothing.
            let fields = LinkField::ALL.into_iter();
            let fields = fields.filter(|field| *field != LinkField::Length || index + 1 < links);
            paths.extend(fields.map(|field| ParameterPath::Link { index, field }));
            let fields = JointField::ALL.into_iter();
            paths.extend(fields.map(|field| ParameterPath::Joint { index, field }));
        }
        paths.extend(model.effects.iter().flat_map(ParameterPath::of_effect));
        let values = paths.into_iter().filter_map(|path| {
            let value = path.get(&model).filter(|value| value.is_finite())?;
            Some(self.value_at(path, value))
        });
        Ok(values.collect())
    }

    fn value_at(&self, path: ParameterPath, value: f64) -> DraftValue {
        let estimate = self.estimates.iter().find(|known| known.path == path);
        let is_given = match path {
            ParameterPath::Link { field, .. } => {
                let said = match field {
                    LinkField::Length => "length",
                    LinkField::Mass => "mass",
                    LinkField::Com | LinkField::Inertia => "",
                };
                self.columns.knows_links || self.is_known(said)
            }
            _ => false,
        };
        DraftValue {
            path: path.to_string(),
            value,
            low: estimate.map(|known| known.low),
            high: estimate.map(|known| known.high),
            origin: match (estimate, is_given) {
                (Some(_), _) => Origin::Estimated,
                (None, true) => Origin::Given,
                (None, false) => Origin::Guess,
            },
        }
    }
}
