//! What a robot in space calls its links and joints, in place of their numbers.

use super::Model;

/// Names in place of numbers in texts for people: "joint 2", `link2.mass_kg` and `viscous@2` become
/// "joint luff", `link.boom.mass_kg` and `viscous@luff`, which [`ParameterPath::read`] reads.
///
/// Of a planar chain, and where a name would not be read back (blanks, a number), numbers stay.
///
/// [`ParameterPath::read`]: super::ParameterPath::read
#[derive(Debug, Clone, Default, PartialEq)]
pub struct JointNames {
    links: Vec<String>,
    joints: Vec<String>,
}

impl JointNames {
    /// Those of a model's robot; none of a planar chain.
    pub fn of(model: &Model) -> JointNames {
        let Some(robot) = &model.robot else {
            return JointNames::default();
        };
        let usable = |names: &Vec<String>| {
            let all = names.iter().all(|name| is_usable(name));
            if all { names.clone() } else { Vec::new() }
        };
        JointNames {
            links: usable(&robot.links),
            joints: usable(&robot.joints),
        }
    }

    /// The joint of a number, counted from 1; none where it has no name.
    pub fn joint(&self, number: usize) -> Option<&str> {
        named(&self.joints, number)
    }

    /// What a text calls a joint, counted from 0: its name, or its number from 1.
    pub fn label(&self, joint: usize) -> String {
        self.joint(joint + 1)
            .map_or_else(|| (joint + 1).to_string(), str::to_string)
    }

    /// A text with names; of one that has them already, the same.
    pub fn in_text(&self, text: &str) -> String {
        if self.joints.is_empty() && self.links.is_empty() {
            return text.to_string();
        }
        let (mut out, mut rest) = (String::with_capacity(text.len()), text);
        while let Some(letter) = rest.chars().next() {
            let before = out.chars().next_back();
            match self.begins(rest, before) {
                Some((name, length)) => {
                    out += &name;
                    rest = &rest[length..];
                }
                None => {
                    out.push(letter);
                    rest = &rest[letter.len_utf8()..];
                }
            }
        }
        out
    }

    /// What stands for the beginning of a text, and how many bytes of it that is.
    fn begins(&self, text: &str, before: Option<char>) -> Option<(String, usize)> {
        let in_word = before.is_some_and(char::is_alphanumeric);
        if let Some(behind) = text.strip_prefix('@').filter(|_| in_word) {
            let (number, length) = counted(behind)?;
            let ends = !behind[length..].starts_with(char::is_alphanumeric);
            let name = named(&self.joints, number).filter(|_| ends)?;
            return Some((format!("@{name}"), 1 + length));
        }
        // A name itself may be `joint2`.
        if in_word || before.is_some_and(|letter| "_@.-/".contains(letter)) {
            return None;
        }
        let (joints, links) = (&self.joints, &self.links);
        [
            ("joint", joints),
            ("Joint", joints),
            ("link", links),
            ("Link", links),
        ]
        .into_iter()
        .find_map(|(what, names)| {
            let behind = text.strip_prefix(what)?;
            let (number, length) = counted(behind.trim_start_matches(' '))?;
            let blanks = behind.len() - behind.trim_start_matches(' ').len();
            let name = named(names, number)?;
            let tail = &behind[blanks + length..];
            let is_key = tail.strip_prefix('.').is_some_and(is_key);
            let joined = match blanks {
                0 if is_key => ".",
                1 if !tail.starts_with(char::is_alphanumeric) => " ",
                _ => return None,
            };
            Some((
                format!("{what}{joined}{name}"),
                what.len() + blanks + length,
            ))
        })
    }
}

fn is_key(text: &str) -> bool {
    text.starts_with(|letter: char| letter.is_ascii_lowercase())
}

/// Whether an address with this name is read back as one.
fn is_usable(name: &str) -> bool {
    let letter = |letter: char| letter.is_alphanumeric() || "_-./".contains(letter);
    let begins = name.starts_with(|letter: char| letter.is_alphabetic() || letter == '_');
    begins && name != "all" && name.chars().all(letter)
}

fn named(names: &[String], number: usize) -> Option<&str> {
    names.get(number.checked_sub(1)?).map(String::as_str)
}

/// The number with which a text begins, and its length.
fn counted(text: &str) -> Option<(usize, usize)> {
    let ends = |letter: char| !letter.is_ascii_digit();
    let length = text.find(ends).unwrap_or(text.len());
    Some((text[..length].parse().ok()?, length))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(joints: &[&str]) -> JointNames {
        let owned = |names: &[&str]| names.iter().map(|name| name.to_string()).collect();
        JointNames {
            links: owned(&["base_link", "joint2"]),
            joints: owned(joints),
        }
    }

    #[test]
    fn numbers_become_names_and_names_stay() {
        let names = names(&["pan", "joint1"]);
        for (text, wanted) in [
            ("joint 2: rms", "joint joint1: rms"),
            ("of joint 1.", "of joint pan."),
            ("Joint 1, fast", "Joint pan, fast"),
            ("(link1.mass_kg)", "(link.base_link.mass_kg)"),
            (
                "--free joint1.gain_per_rad,",
                "--free joint.pan.gain_per_rad,",
            ),
            ("viscous@2.c + delay@all", "viscous@joint1.c + delay@all"),
            ("cogging@1 at link 2", "cogging@pan at link joint2"),
            (
                "joint 3, joint 12, joint1, @1, link2 m",
                "joint 3, joint 12, joint1, @1, link2 m",
            ),
            ("adjoint 1; joint 1a", "adjoint 1; joint 1a"),
        ] {
            assert_eq!(names.in_text(text), wanted);
            assert_eq!(names.in_text(wanted), wanted);
        }
        assert_eq!(
            [1, 2, 3].map(|number| names.joint(number)),
            [Some("pan"), Some("joint1"), None]
        );
        assert_eq!(JointNames::default().in_text("joint 1"), "joint 1");
    }

    #[test]
    fn a_name_that_no_address_may_have_is_not_used() {
        for name in ["1", "left arm", "all", "", "a=b"] {
            assert!(!is_usable(name), "{name}");
        }
        assert!(is_usable("arm_1/left-shoulder.pitch"));
    }
}
