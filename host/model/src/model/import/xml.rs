//! Elements and attributes of an XML file, with the place of what is wrong.
//!
//! The crate `mjcf-rs` 0.36 gives no place: a damping of `x` in line 4 is "invalid attribute `_` on
//! `<_>`". It takes a damping of `nan` and a class that is not there, and overflows the stack of a
//! debug build on 900 bodies within each other.

use crate::error::{Error, Place, Result};
use nalgebra::Vector3;
use roxmltree::{Document, Node, ParsingOptions};
use std::path::Path;

/// Most elements and texts of a file; a robot with meshes has thousands.
const MOST_NODES: u32 = 1_000_000;
/// Largest number that a robot's file can mean. Exporters write larger ones, or infinity, where
/// nothing limits.
const LARGEST: f64 = 1e9;

/// A file and its elements.
pub(in crate::model) struct XmlFile<'a> {
    pub path: &'a Path,
    pub document: Document<'a>,
    /// Where each line but the first begins: positions are asked for each element.
    lines: Vec<usize>,
}

/// An element with its file.
#[derive(Clone, Copy)]
pub(in crate::model) struct Element<'a> {
    pub file: &'a XmlFile<'a>,
    pub node: Node<'a, 'a>,
}

/// Parses; entities and document types are refused, so no text grows while it is read.
pub(super) fn parsed(text: &str) -> std::result::Result<Document<'_>, roxmltree::Error> {
    let options = ParsingOptions {
        allow_dtd: false,
        nodes_limit: MOST_NODES,
    };
    Document::parse_with_options(text, options)
}

impl<'a> XmlFile<'a> {
    /// Parses as [`parsed`].
    pub fn parse(path: &'a Path, text: &'a str) -> Result<Self> {
        let document = parsed(text).map_err(|error| {
            let at = error.pos();
            let place = Place::at(path, at.row as usize, at.col as usize);
            let remedy = match &error {
                roxmltree::Error::DtdDetected => "delete the <!DOCTYPE ..> and its entities",
                _ => "write the robot's file as XML",
            };
            Error::data(place, format!("no XML: {error}"), remedy)
        })?;
        let lines = text.match_indices('\n').map(|(at, _)| at + 1).collect();
        Ok(XmlFile {
            path,
            document,
            lines,
        })
    }

    pub fn root(&'a self) -> Element<'a> {
        Element {
            file: self,
            node: self.document.root_element(),
        }
    }
}

impl<'a> Element<'a> {
    pub fn tag(&self) -> &'a str {
        self.node.tag_name().name()
    }

    /// The elements within it, but those of another namespace than the root's.
    pub fn elements(&self) -> impl Iterator<Item = Element<'a>> + use<'a> {
        self.children().filter(|element| !element.is_foreign())
    }

    /// The elements within it of a vendor's namespace.
    pub fn foreign(&self) -> impl Iterator<Item = Element<'a>> + use<'a> {
        self.children().filter(Element::is_foreign)
    }

    fn children(&self) -> impl Iterator<Item = Element<'a>> + use<'a> {
        let file = self.file;
        let nodes = self.node.children().filter(Node::is_element);
        nodes.map(move |node| Element { file, node })
    }

    fn is_foreign(&self) -> bool {
        let root = self.file.document.root_element();
        let own = self.node.tag_name().namespace();
        own.is_some() && own != root.tag_name().namespace()
    }

    /// Byte at which it begins.
    pub fn at(&self) -> usize {
        self.node.range().start
    }

    /// Line on which it begins.
    pub fn line(&self) -> usize {
        let at = self.at();
        1 + self.file.lines.partition_point(|line| *line <= at)
    }

    pub fn all(&self, tag: &'a str) -> impl Iterator<Item = Element<'a>> + use<'a> {
        self.elements().filter(move |element| element.tag() == tag)
    }

    pub fn first(&self, tag: &'a str) -> Option<Element<'a>> {
        self.all(tag).next()
    }

    pub fn text(&self, key: &str) -> Option<&'a str> {
        self.node.attribute(key)
    }

    /// The names of its attributes but these.
    pub fn others(&self, known: &[&str]) -> Vec<&'a str> {
        let names = self.node.attributes().map(|own| own.name());
        names.filter(|name| !known.contains(name)).collect()
    }

    /// # Errors
    /// No such attribute.
    pub fn required(&self, key: &str) -> Result<&'a str> {
        let lacks = || {
            self.wrong(
                format!("<{}> lacks {key}", self.tag()),
                format!("add {key}"),
            )
        };
        self.text(key).ok_or_else(lacks)
    }

    /// # Errors
    /// An attribute that is no finite number.
    pub fn number(&self, key: &str) -> Result<Option<f64>> {
        self.text(key)
            .map(|text| self.one_number(key, text))
            .transpose()
    }

    /// # Errors
    /// As [`Element::number`], for numbers with blanks between them.
    pub fn numbers(&self, key: &str) -> Result<Option<Vec<f64>>> {
        self.text(key)
            .map(|text| self.numbers_of(key, text))
            .transpose()
    }

    /// # Errors
    /// As [`Element::numbers`]; not three of them.
    pub fn vector(&self, key: &str) -> Result<Option<Vector3<f64>>> {
        self.numbers(key)?
            .map(|values| self.three(key, &values))
            .transpose()
    }

    /// A limit; none where the file has none, or one so large that it is none.
    ///
    /// # Errors
    /// An attribute that is no number.
    pub fn limit(&self, key: &str) -> Result<Option<f64>> {
        let limit = |text: &'a str| self.limit_of(key, text);
        Ok(self.text(key).map(limit).transpose()?.flatten())
    }

    /// As [`Element::limit`], of a text.
    pub fn limit_of(&self, key: &str, text: &str) -> Result<Option<f64>> {
        let endless = |value: &f64| value.abs() >= LARGEST;
        match text.trim().parse::<f64>() {
            Ok(value) if endless(&value) => Ok(None),
            _ => self.one_number(key, text).map(Some),
        }
    }

    pub fn one_number(&self, key: &str, text: &str) -> Result<f64> {
        let shown: String = text.chars().take(40).collect();
        if shown.contains("${") {
            let what = format!("{key}=\"{shown}\" is a property of xacro");
            return Err(self.wrong(what, super::urdf::EXPAND));
        }
        match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() && value.abs() <= LARGEST => Ok(value),
            Ok(value) if !value.is_nan() => Err(self.wrong(
                format!("{key}=\"{shown}\" is larger than a robot's file can mean"),
                "write a number up to 1e9",
            )),
            _ => Err(self.wrong(
                format!("{key}=\"{shown}\" is no number"),
                "write a number such as 0.25",
            )),
        }
    }

    pub fn numbers_of(&self, key: &str, text: &str) -> Result<Vec<f64>> {
        text.split_whitespace()
            .map(|word| self.one_number(key, word))
            .collect()
    }

    pub fn three(&self, key: &str, values: &[f64]) -> Result<Vector3<f64>> {
        match values {
            [x, y, z] => Ok(Vector3::new(*x, *y, *z)),
            _ => Err(self.wrong(format!("{key} has {} numbers", values.len()), "write three")),
        }
    }

    /// An error at this element.
    pub fn wrong(&self, what: impl Into<String>, remedy: impl Into<String>) -> Error {
        let at = self.file.document.text_pos_at(self.node.range().start);
        let place = Place::at(self.file.path, at.row as usize, at.col as usize);
        Error::data(place, what, remedy)
    }
}
