//! What is to be told of a file's parts that the model does not hold, or holds otherwise.

use std::fmt;

/// Most parts that are named one by one where one reason concerns all of them.
const NAMED: usize = 3;

/// A part of a file that the model does not hold, or holds otherwise.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize)]
pub struct Remark {
    /// The element, or the quantity: `range`, `mimic`, `tendon`.
    pub part: String,
    /// The joint or body, where it is of one.
    pub name: Option<String>,
    /// Line of the robot's file, where it stands on one.
    pub line: Option<usize>,
    /// Why, and what was taken instead.
    pub why: String,
}

impl Remark {
    pub(super) fn new(part: &str, name: Option<&str>, why: impl Into<String>) -> Self {
        Remark {
            part: part.to_string(),
            name: name.map(str::to_string),
            line: None,
            why: why.into(),
        }
    }

    /// The same with the line on which it stands.
    pub(super) fn on(self, line: usize) -> Self {
        Remark {
            line: Some(line),
            ..self
        }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.part)?;
        if let Some(name) = &self.name {
            write!(f, " of {name}")?;
        }
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        write!(f, ": {}", self.why)
    }
}

/// What is told of parts: in one sentence where the same is to be said of several.
pub fn told(remarks: &[Remark]) -> Vec<String> {
    let alike = |a: &Remark, b: &Remark| {
        a.name.is_some() && b.name.is_some() && (&a.part, &a.why) == (&b.part, &b.why)
    };
    let is_first = |at: &usize| !remarks[..*at].iter().any(|old| alike(old, &remarks[*at]));
    let firsts = (0..remarks.len()).filter(is_first).map(|at| {
        let first = &remarks[at];
        let others = remarks[at + 1..].iter().filter(|own| alike(first, own));
        let group: Vec<&Remark> = [first].into_iter().chain(others).collect();
        if let [alone] = group[..] {
            alone.to_string()
        } else {
            of_several(&group)
        }
    });
    firsts.collect()
}

/// What is said of several parts alike.
fn of_several(group: &[&Remark]) -> String {
    let mut names: Vec<&str> = group.iter().filter_map(|own| own.name.as_deref()).collect();
    let more = names.len() - NAMED.min(names.len());
    names.truncate(NAMED);
    let mut lines: Vec<String> = (group.iter().filter_map(|own| own.line))
        .map(|line| line.to_string())
        .collect();
    let mut names = names.join(", ");
    if more > 0 {
        names += &format!(" and {more} more");
        lines.truncate(NAMED);
        lines.push("...".to_string());
    }
    let part = &group[0].part;
    let lines = match lines.len() {
        0 => String::new(),
        _ => format!(", lines {}", lines.join(", ")),
    };
    format!("{part} of {names}{lines}: {}", group[0].why)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(joint: &str, line: usize) -> Remark {
        Remark::new("range", Some(joint), "no end stops").on(line)
    }

    #[test]
    fn the_same_reason_is_told_once() {
        let limit = |joint| Remark::new("effort limit", Some(joint), "a drive has its own");
        let alone = Remark::new("tendon", None, "no tendons");
        let mut remarks = vec![
            range("hip", 3),
            limit("hip"),
            range("knee", 7),
            limit("knee"),
        ];
        remarks.extend([alone.clone(), alone]);
        assert_eq!(
            told(&remarks),
            [
                "range of hip, knee, lines 3, 7: no end stops",
                "effort limit of hip, knee: a drive has its own",
                "tendon: no tendons",
                "tendon: no tendons",
            ]
        );
    }

    #[test]
    fn of_many_parts_the_first_are_named() {
        let remarks: Vec<Remark> = ["a", "b", "c", "d", "e"]
            .iter()
            .zip(1..)
            .map(|(joint, line)| range(joint, line))
            .collect();
        assert_eq!(
            told(&remarks),
            ["range of a, b, c and 2 more, lines 1, 2, 3, ...: no end stops"]
        );
        assert_eq!(told(&remarks[..1]), ["range of a, line 1: no end stops"]);
    }
}
