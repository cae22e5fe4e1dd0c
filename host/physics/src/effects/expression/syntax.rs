//! The grammar of a law: what is wrong has its place.
//!
//! A law is numbers, variables and parameters joined by `+ - * / ^`, parentheses, and functions of
//! one argument. There is nothing else: no assignment, no loop, no access to anything.

use super::program::{LawOperator, Node, Program, Slot};
use crate::error::Problem;

/// Variables of a law, and what they are.
pub const VARIABLES: [(&str, &str); 7] = [
    ("q", "angle of the joint, rad, as in the log"),
    ("w", "speed of the joint, rad/s"),
    (
        "dir",
        "direction of the motion, +1 or -1; at rest that of the push, and 0 to a torque",
    ),
    ("tau", "torque of the joint's drive, N m"),
    (
        "input",
        "input of the drive: goal, rad or rad/s, duty, or torque, N m",
    ),
    (
        "supply",
        "supply over nominal supply; 1 where the log has none",
    ),
    ("time", "time of the motion, s"),
];
/// A function of one argument.
pub type LawFunction = fn(f64) -> f64;

/// Functions of a law.
pub const FUNCTIONS: [(&str, LawFunction); 14] = [
    ("abs", f64::abs),
    ("signum", f64::signum),
    ("sqrt", f64::sqrt),
    ("exp", f64::exp),
    ("ln", f64::ln),
    ("sin", f64::sin),
    ("cos", f64::cos),
    ("tan", f64::tan),
    ("asin", f64::asin),
    ("acos", f64::acos),
    ("atan", f64::atan),
    ("sinh", f64::sinh),
    ("cosh", f64::cosh),
    ("tanh", f64::tanh),
];
/// Constants of a law.
pub const CONSTANTS: [(&str, f64); 1] = [("PI", std::f64::consts::PI)];
/// Longest law, characters.
const LONGEST: usize = 500;
/// Deepest parentheses.
const DEEPEST: usize = 32;

/// What is wrong with a law, and at which of its characters, counted from 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Misplaced {
    /// Where.
    pub at: usize,
    /// What.
    pub problem: Problem,
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Symbol(char),
}

/// The law of these parameters, ready to be evaluated.
///
/// # Errors
/// The first thing that is no law, with its place.
pub(super) fn parsed(law: &str, parameters: &[&str]) -> Result<Program, Misplaced> {
    let mut parser = Parser {
        tokens: tokens(law)?.into_iter().peekable(),
        end: law.chars().count(),
        parameters,
        open: 0,
        program: Program::default(),
    };
    parser.whole()?;
    match parser.tokens.next() {
        None => Ok(parser.program),
        Some((at, Token::Symbol(')'))) => {
            misplaced(at, "this `)` closes nothing", "remove it, or open one")
        }
        Some((at, _)) => operator_missing(at),
    }
}

fn misplaced<T>(
    at: usize,
    what: impl Into<String>,
    remedy: impl Into<String>,
) -> Result<T, Misplaced> {
    let problem = Problem::new(what, remedy);
    Err(Misplaced { at, problem })
}

/// Something is missing at `at`: `what` says that.
fn missing<T>(at: usize, what: &str) -> Result<T, Misplaced> {
    let remedy = "write it as -c * w * abs(w), with + - * / ^ and parentheses";
    misplaced(at, format!("{what} is missing here"), remedy)
}

fn operand_missing<T>(at: usize) -> Result<T, Misplaced> {
    missing(at, "a number, a name or `(`")
}

fn operator_missing<T>(at: usize) -> Result<T, Misplaced> {
    missing(at, "an operator")
}

/// A law has nothing like `what` says.
fn no_part<T>(at: usize, what: String) -> Result<T, Misplaced> {
    misplaced(
        at,
        what,
        "a law has numbers, names, + - * / ^ and parentheses",
    )
}

fn too_long<T>(at: usize, what: String) -> Result<T, Misplaced> {
    misplaced(at, what, "write it shorter, or as several effects")
}

/// How an operator joins what stands beside it, and how strongly; all go from the left.
fn operator(symbol: char) -> Option<(u8, LawOperator)> {
    Some(match symbol {
        '+' => (1, |a, b| a + b),
        '-' => (1, |a, b| a - b),
        '*' => (2, |a, b| a * b),
        '/' => (2, |a, b| a / b),
        '^' => (3, f64::powf),
        _ => return None,
    })
}

/// A parser by precedence (Pratt, Top down operator precedence, 1973).
struct Parser<'a> {
    tokens: std::iter::Peekable<std::vec::IntoIter<(usize, Token)>>,
    /// The place behind the last character.
    end: usize,
    parameters: &'a [&'a str],
    /// Parentheses that are open.
    open: usize,
    program: Program,
}

impl Parser<'_> {
    /// A law, or what stands between parentheses: a minus sign may open it. Its last node is its
    /// value, as of all that follow.
    fn whole(&mut self) -> Result<usize, Misplaced> {
        let first = match self.tokens.peek() {
            Some((_, Token::Symbol('-'))) => self.program.push(Node::Number(0.0)),
            _ => self.operand()?,
        };
        self.joined(first, 1)
    }

    /// What operators of this strength or more join to what stands before them.
    fn joined(&mut self, mut left: usize, least: u8) -> Result<usize, Misplaced> {
        while let Some((_, Token::Symbol(symbol))) = self.tokens.peek() {
            let Some((strength, apply)) = operator(*symbol).filter(|(own, _)| *own >= least) else {
                break;
            };
            self.tokens.next();
            let right = self.operand()?;
            let right = self.joined(right, strength + 1)?;
            left = self.program.push(Node::Join(apply, left, right));
        }
        Ok(left)
    }

    /// A number, a name, a call, or something between parentheses.
    fn operand(&mut self) -> Result<usize, Misplaced> {
        let Some((at, token)) = self.tokens.next() else {
            return operand_missing(self.end);
        };
        match token {
            Token::Number(value) => Ok(self.program.push(Node::Number(value))),
            Token::Name(name) => match FUNCTIONS.iter().find(|(known, _)| *known == name) {
                Some((_, function)) => self.call(name, *function),
                None => self.named(at, &name),
            },
            Token::Symbol('(') => self.between(at),
            Token::Symbol('-') => misplaced(
                at,
                "a minus sign right behind an operator",
                "put it into parentheses, as in c * (-w)",
            ),
            Token::Symbol(_) => operand_missing(at),
        }
    }

    fn call(&mut self, name: String, function: LawFunction) -> Result<usize, Misplaced> {
        match self.tokens.next() {
            Some((at, Token::Symbol('('))) => {
                let argument = self.between(at)?;
                Ok(self.program.push(Node::Call(function, argument)))
            }
            other => misplaced(
                other.map_or(self.end, |(at, _)| at),
                format!("`{name}` is a function and needs its argument in parentheses"),
                format!("write {name}(w)"),
            ),
        }
    }

    /// What follows a parenthesis that was opened at `at`, and its end.
    fn between(&mut self, at: usize) -> Result<usize, Misplaced> {
        self.open += 1;
        if self.open > DEEPEST {
            return too_long(at, format!("parentheses are more than {DEEPEST} deep"));
        }
        let inner = self.whole()?;
        self.open -= 1;
        match self.tokens.next() {
            Some((_, Token::Symbol(')'))) => Ok(inner),
            Some((at, _)) => operator_missing(at),
            None => misplaced(at, "this `(` is never closed", "close it, or remove it"),
        }
    }

    fn named(&mut self, at: usize, name: &str) -> Result<usize, Misplaced> {
        let node = match name {
            "q" => Node::Slot(Slot::Angle),
            "w" => Node::Slot(Slot::Speed),
            "dir" => Node::Slot(Slot::Direction),
            "tau" => Node::Slot(Slot::Drive),
            "input" => Node::Slot(Slot::Input),
            "supply" => Node::Slot(Slot::Supply),
            "time" => Node::Slot(Slot::Time),
            _ => match CONSTANTS.iter().find(|(known, _)| *known == name) {
                Some((_, value)) => Node::Number(*value),
                None => match self.parameters.iter().position(|known| *known == name) {
                    Some(index) => Node::Slot(Slot::Value(index)),
                    None => return self.unknown(at, name),
                },
            },
        };
        Ok(self.program.push(node))
    }

    fn unknown<T>(&self, at: usize, name: &str) -> Result<T, Misplaced> {
        let variables = VARIABLES.map(|(name, _)| name).join(", ");
        let functions = FUNCTIONS.map(|(name, _)| name).join(", ");
        let known = self.parameters.join(", ");
        misplaced(
            at,
            format!("unknown name `{name}`"),
            format!("variables: {variables}; parameters: {known}; functions: {functions}; PI"),
        )
    }
}

fn tokens(law: &str) -> Result<Vec<(usize, Token)>, Misplaced> {
    let characters: Vec<char> = law.chars().collect();
    if characters.len() > LONGEST {
        let what = format!("the law is longer than {LONGEST} characters");
        return too_long(LONGEST, what);
    }
    let run = |from: usize, belongs: &dyn Fn(usize) -> bool| {
        let end = (from..characters.len()).find(|&k| !belongs(k));
        end.unwrap_or(characters.len())
    };
    let mut tokens = Vec::new();
    let mut at = 0;
    while at < characters.len() {
        let here = characters[at];
        let end = if here.is_whitespace() {
            at += 1;
            continue;
        } else if here.is_ascii_digit() || here == '.' {
            let exponent = |k: usize| {
                matches!(characters[k], '+' | '-') && matches!(characters[k - 1], 'e' | 'E')
            };
            let belongs = |k: usize| {
                let c = characters[k];
                c.is_ascii_digit() || c == '.' || c == 'e' || c == 'E' || k > at && exponent(k)
            };
            let end = run(at, &belongs);
            let text: String = characters[at..end].iter().collect();
            match text.parse::<f64>() {
                Ok(value) if value.is_finite() => tokens.push((at, Token::Number(value))),
                _ => return no_part(at, format!("`{text}` is no number")),
            }
            end
        } else if here.is_ascii_alphabetic() || here == '_' {
            let end = run(at, &|k| {
                characters[k].is_ascii_alphanumeric() || characters[k] == '_'
            });
            tokens.push((at, Token::Name(characters[at..end].iter().collect())));
            end
        } else if "+-*/^()".contains(here) {
            tokens.push((at, Token::Symbol(here)));
            at + 1
        } else {
            return no_part(at, format!("`{here}` is no part of a law"));
        };
        at = end;
    }
    Ok(tokens)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_has_its_place() {
        let (operand, operator) = (
            "a number, a name or `(` is missing here",
            "an operator is missing here",
        );
        for (law, at, what) in [
            ("", 0, operand),
            ("-c * ", 5, operand),
            ("c w", 2, operator),
            ("c * (w + 1", 4, "this `(` is never closed"),
            ("c * w)", 5, "this `)` closes nothing"),
            ("c * -w", 4, "a minus sign right behind an operator"),
            ("c; w", 1, "`;` is no part of a law"),
            ("1.2.3 * w", 0, "`1.2.3` is no number"),
            (
                "abs * w",
                4,
                "`abs` is a function and needs its argument in parentheses",
            ),
            (
                "c * abs",
                7,
                "`abs` is a function and needs its argument in parentheses",
            ),
            ("(c w)", 3, operator),
            ("()", 1, operand),
        ] {
            let found = parsed(law, &["c"]).unwrap_err();
            assert_eq!((found.at, &*found.problem.what), (at, what), "{law}");
        }
        let unknown = parsed("-c * v", &["c"]).unwrap_err();
        assert_eq!(unknown.at, 5);
        assert!(parsed(&"(".repeat(40), &[]).is_err());
        assert!(parsed(&"1+".repeat(400), &[]).is_err());
    }
}
