//! Attributes of an element, filled from its class.

use crate::error::Result;
use crate::model::import::xml::Element;
use nalgebra::Vector3;
use std::collections::{BTreeMap, HashMap};

/// Name of the outermost class.
const MAIN: &str = "main";
/// Classes within classes.
const DEEPEST: usize = 50;

type AttributeValues<'a> = BTreeMap<&'a str, &'a str>;

/// Every class: per tag, its attributes with those of the classes around it.
pub(in crate::model) struct Defaults<'a> {
    classes: HashMap<&'a str, HashMap<&'a str, AttributeValues<'a>>>,
}

/// An element's attributes, its own before those of its class.
pub(in crate::model) struct Attributes<'a> {
    pub element: Element<'a>,
    from_class: AttributeValues<'a>,
}

impl<'a> Defaults<'a> {
    pub fn of(root: Element<'a>) -> Result<Self> {
        let mut defaults = Defaults {
            classes: HashMap::from([(MAIN, HashMap::new())]),
        };
        for element in root.all("default") {
            defaults.add(element, None, 0)?;
        }
        Ok(defaults)
    }

    fn add(&mut self, element: Element<'a>, around: Option<&str>, depth: usize) -> Result<()> {
        if depth > DEEPEST {
            return Err(element.wrong("classes lie too deep within each other", super::FLATTEN));
        }
        let name = match (element.text("class"), around) {
            (Some(name), _) => name,
            (None, None) => MAIN,
            (None, Some(_)) => return Err(element.wrong("a class without a name", "add class")),
        };
        let mut class = self
            .classes
            .get(around.unwrap_or(MAIN))
            .cloned()
            .unwrap_or_default();
        for child in element.elements().filter(|child| child.tag() != "default") {
            let values = class.entry(child.tag()).or_default();
            values.extend(child.node.attributes().map(|own| (own.name(), own.value())));
        }
        self.classes.insert(name, class);
        for child in element.all("default") {
            self.add(child, Some(name), depth + 1)?;
        }
        Ok(())
    }

    /// # Errors
    /// A class that is not there.
    pub fn attributes(&self, element: Element<'a>, around: Option<&str>) -> Result<Attributes<'a>> {
        let name = element.text("class").or(around).unwrap_or(MAIN);
        let class = self.classes.get(name).ok_or_else(|| {
            element.wrong(
                format!("there is no class \"{name}\""),
                "mend the name of the class",
            )
        })?;
        Ok(Attributes {
            element,
            from_class: class.get(element.tag()).cloned().unwrap_or_default(),
        })
    }
}

impl<'a> Attributes<'a> {
    /// Those of the element alone.
    pub fn own(element: Element<'a>) -> Self {
        Attributes {
            element,
            from_class: AttributeValues::new(),
        }
    }

    pub fn text(&self, key: &str) -> Option<&'a str> {
        self.element
            .text(key)
            .or_else(|| self.from_class.get(key).copied())
    }

    /// Names of its attributes and its class's but these.
    pub fn others(&self, known: &[&str]) -> Vec<&'a str> {
        let of_class = self.from_class.keys().copied();
        let mut names = self.element.others(known);
        names.extend(of_class.filter(|name| !known.contains(name)));
        names.sort_unstable();
        names.dedup();
        names
    }

    /// # Errors
    /// An attribute that is no numbers.
    pub fn numbers(&self, key: &str) -> Result<Option<Vec<f64>>> {
        self.text(key)
            .map(|text| self.element.numbers_of(key, text))
            .transpose()
    }

    /// # Errors
    /// As [`Attributes::numbers`]; none of them.
    pub fn number(&self, key: &str) -> Result<Option<f64>> {
        self.text(key)
            .map(|text| self.element.one_number(key, text))
            .transpose()
    }

    /// # Errors
    /// As [`Attributes::numbers`]; not three of them.
    pub fn vector(&self, key: &str) -> Result<Option<Vector3<f64>>> {
        let numbers = self.numbers(key)?;
        numbers
            .map(|values| self.element.three(key, &values))
            .transpose()
    }
}
