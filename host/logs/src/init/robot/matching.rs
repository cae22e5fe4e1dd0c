//! Which joint of a robot's file a log's name means.

use crate::error::{Error, Result};
use crate::init::name_guess;
use crate::output::shortened;

/// Names that a message lists.
const LISTED: usize = 40;

/// A joint of the log: the name that is matched, how it is shown, and other names that an explicit
/// mapping may use.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct LogJoint {
    /// Without the quantity: `shoulder_pan`.
    pub name: String,
    /// As the log writes it: `shoulder_pan.pos`, or the column.
    pub shown: String,
    /// The column of its position.
    pub column: String,
    /// Whether the name is what its column's words leave of it: `1` of `joint1_pos_rad`.
    pub is_left_over: bool,
}

impl LogJoint {
    fn is_called(&self, name: &str) -> bool {
        [&self.name, &self.shown, &self.column].contains(&&name.to_string())
    }

    /// How closely its name is that of a joint.
    fn likeness(&self, joint: &str) -> Option<Likeness> {
        let is_left_over = self.is_left_over && !self.name.is_empty();
        if self.name == joint || self.shown == joint {
            Some(Likeness::Equal)
        } else if plain(&self.name) == plain(joint)
            || (is_left_over && name_guess(joint).joint == self.name)
        {
            Some(Likeness::Plain)
        } else if extends(&self.name, joint) || extends(joint, &self.name) {
            Some(Likeness::Words)
        } else {
            None
        }
    }
}

/// How closely two names are one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Likeness {
    /// To the letter.
    Equal,
    /// But for signs and capitals.
    Plain,
    /// But for words before or behind.
    Words,
}

impl Likeness {
    fn matched_by(self) -> MatchedBy {
        match self {
            Likeness::Equal | Likeness::Plain => MatchedBy::Name,
            Likeness::Words => MatchedBy::Words,
        }
    }
}

/// How a name was found to mean a joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MatchedBy {
    /// `--map` says it.
    Mapping,
    /// The names are equal but for signs and capitals.
    Name,
    /// One is the other with words before or behind it: `main_shoulder_pan`.
    Words,
}

/// The log's joint for each of the robot's, in the robot's order.
///
/// # Errors
/// A joint that no name means, or several do; a name that means two joints; a mapping of what is
/// not there. The message names the joints and the log's names, the remedy the options.
pub(super) fn matched(
    robot: &[&str],
    log: &[LogJoint],
    mapped: &[(String, String)],
    what: &str,
) -> Result<Vec<(usize, MatchedBy)>> {
    for (joint, name) in mapped {
        known(robot, log, joint, name)?;
    }
    let mut found: Vec<(usize, MatchedBy)> = Vec::new();
    let mut lacking = Vec::new();
    for joint in robot {
        let mapping = mapped.iter().find(|(own, _)| own == joint);
        let mapping = mapping.and_then(|(_, name)| log.iter().position(|own| own.is_called(name)));
        match mapping {
            Some(index) => found.push((index, MatchedBy::Mapping)),
            None => match of_joint(joint, log, mapped)? {
                Some(own) => found.push(own),
                None => lacking.push(*joint),
            },
        }
    }
    if let Some(first) = lacking.first() {
        let message = format!(
            "{what} has no joint named {}; it has {}; the robot's joints are {}",
            quoted(lacking.iter().copied()),
            quoted(log.iter().map(|own| own.shown.as_str())),
            quoted(robot.iter().copied()),
        );
        let remedy = format!(
            "say which of the log's it is: --map {first}=NAME, or hold it: --lock {first}=0"
        );
        return Err(Error::usage(message, remedy));
    }
    for (index, (own, _)) in found.iter().enumerate() {
        if let Some(before) = found[..index].iter().position(|(other, _)| other == own) {
            let (first, second) = (robot[before], robot[index]);
            let shown = &log[*own].shown;
            return Err(Error::usage(
                format!("{what}: {shown:?} is taken for the joints {first} and {second}"),
                format!("say which it is: --map {first}=NAME and --map {second}=NAME"),
            ));
        }
    }
    Ok(found)
}

/// Refuses a mapping of what is not there.
fn known(robot: &[&str], log: &[LogJoint], joint: &str, name: &str) -> Result<()> {
    if !robot.contains(&joint) {
        let joints = quoted(robot.iter().copied());
        let what = format!("--map {joint}={name}: the robot has no joint {joint:?} that moves");
        return Err(Error::usage(what, format!("its joints: {joints}")));
    }
    if !log.iter().any(|own| own.is_called(name)) {
        let names = quoted(log.iter().map(|own| own.shown.as_str()));
        let what = format!("--map {joint}={name}: the log has no joint {name:?}");
        return Err(Error::usage(what, format!("it has {names}")));
    }
    Ok(())
}

/// The one of the log's joints that this name means, by the closest likeness that any has.
fn of_joint(
    joint: &str,
    log: &[LogJoint],
    mapped: &[(String, String)],
) -> Result<Option<(usize, MatchedBy)>> {
    let is_free = |own: &LogJoint| !mapped.iter().any(|(_, name)| own.is_called(name));
    let likeness = |own: &LogJoint| own.likeness(joint);
    for by in [Likeness::Equal, Likeness::Plain, Likeness::Words] {
        let found = (0..log.len()).filter(|index| is_free(&log[*index]));
        let found: Vec<usize> = found
            .filter(|index| likeness(&log[*index]) == Some(by))
            .collect();
        match found[..] {
            [] => {}
            [index] => return Ok(Some((index, by.matched_by()))),
            _ => {
                let names = quoted(found.iter().map(|index| log[*index].shown.as_str()));
                let first = &log[found[0]].shown;
                return Err(Error::usage(
                    format!("joint {joint} may be any of {names}"),
                    format!("say which it is, such as --map {joint}={first}"),
                ));
            }
        }
    }
    Ok(None)
}

/// Letters and digits alone, small.
fn plain(name: &str) -> String {
    words(name).concat()
}

fn words(name: &str) -> Vec<String> {
    let words = name.split(|letter: char| !letter.is_alphanumeric());
    let words = words.filter(|word| !word.is_empty());
    words.map(str::to_lowercase).collect()
}

/// Whether a name is the other with words before or behind it.
fn extends(long: &str, short: &str) -> bool {
    let (long, short) = (words(long), words(short));
    !short.is_empty() && (long.ends_with(&short) || long.starts_with(&short))
}

/// Names in quotes, the first of many.
pub(super) fn quoted<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    let listed = names.iter().take(LISTED);
    let listed: Vec<String> = listed.map(|name| shortened(name).into_owned()).collect();
    match names.len().saturating_sub(LISTED) {
        0 => listed.join(", "),
        more => format!("{} and {more} more", listed.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(names: &[&str]) -> Vec<LogJoint> {
        let joint = |name: &&str| LogJoint {
            name: (*name).into(),
            shown: format!("{name}.pos"),
            column: format!("state of {name}"),
            is_left_over: false,
        };
        names.iter().map(joint).collect()
    }

    fn places(robot: &[&str], names: &[&str], mapped: &[(&str, &str)]) -> Result<Vec<usize>> {
        let mapped = mapped.iter().map(|(a, b)| ((*a).into(), (*b).into()));
        let mapped: Vec<(String, String)> = mapped.collect();
        let found = matched(robot, &log(names), &mapped, "a.csv")?;
        Ok(found.into_iter().map(|(index, _)| index).collect())
    }

    #[test]
    fn names_mean_joints_exactly_then_by_their_words() {
        let robot = ["pan", "lift"];
        assert_eq!(places(&robot, &["lift", "pan"], &[]).unwrap(), [1, 0]);
        assert_eq!(places(&robot, &["Lift", "main_pan"], &[]).unwrap(), [1, 0]);
        // An equal name comes before a longer one.
        assert_eq!(places(&["pan"], &["main_pan", "pan"], &[]).unwrap(), [1]);
        assert_eq!(places(&["arm_pan"], &["lift", "pan"], &[]).unwrap(), [1]);
        // Half a word is none.
        assert!(places(&["pan"], &["span"], &[]).is_err());
    }

    #[test]
    fn a_mapping_decides() {
        let both = ["left_pan", "right_pan"];
        let error = places(&["pan"], &both, &[]).unwrap_err();
        assert!(
            error.to_string().contains("left_pan.pos, right_pan.pos"),
            "{error}"
        );
        assert!(error.remedy().unwrap().contains("--map pan=left_pan.pos"));
        for name in ["right_pan", "right_pan.pos", "state of right_pan"] {
            assert_eq!(places(&["pan"], &both, &[("pan", name)]).unwrap(), [1]);
        }
        for wrong in [("tilt", "left_pan"), ("pan", "up")] {
            assert_eq!(
                places(&["pan"], &both, &[wrong]).unwrap_err().exit_code(),
                2
            );
        }
        // What is mapped is not taken for another joint.
        let robot = ["pan", "tilt"];
        assert!(places(&robot, &["pan", "x"], &[("tilt", "pan")]).is_err());
    }

    #[test]
    fn what_is_not_matched_is_told_with_both_lists_and_the_remedy() {
        let error = places(&["pan", "jaw"], &["pan", "lift"], &[]).unwrap_err();
        let said = error.to_string();
        assert!(
            said.contains("no joint named jaw; it has pan.pos, lift.pos"),
            "{said}"
        );
        assert!(said.contains("joints are pan, jaw"), "{said}");
        assert!(error.remedy().unwrap().contains("--lock jaw=0"));
        let error = places(&["a_pan", "b_pan"], &["pan"], &[]).unwrap_err();
        assert!(error.to_string().contains("a_pan and b_pan"), "{error}");
    }
}
