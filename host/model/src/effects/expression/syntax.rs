//! The grammar of a law: judged here, so that what is wrong has its place, evaluated by `exmex`.
//!
//! A law is numbers, variables and parameters joined by `+ - * / ^`, parentheses, and functions of
//! one argument. There is nothing else: no assignment, no loop, no access to anything.

use super::reason::ExpressionReason;
use std::fmt::Write as _;

/// Variables of a law, and what they are.
pub const VARIABLES: [(&str, &str); 3] = [
    ("q", "angle of the joint, rad, as in the log"),
    ("w", "speed of the joint, rad/s"),
    ("tau", "torque of the joint's drive, N m"),
];
/// Functions of a law.
pub const FUNCTIONS: [&str; 14] = [
    "abs", "signum", "sqrt", "exp", "ln", "sin", "cos", "tan", "asin", "acos", "atan", "sinh",
    "cosh", "tanh",
];
/// Constants of a law.
pub const CONSTANTS: [&str; 1] = ["PI"];
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
    pub reason: ExpressionReason,
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Symbol(char),
}

/// The law as `exmex` reads it: names in braces, so that none is taken for a function, and minus
/// signs that bind as in mathematics.
///
/// # Errors
/// The first thing that is no law of these parameters, with its place.
pub(super) fn judged(law: &str, parameters: &[&str]) -> Result<String, Misplaced> {
    let tokens = tokens(law)?;
    let misplaced = |at: usize, reason| Err(Misplaced { at, reason });
    let end = law.chars().count();
    let mut written = String::new();
    // Whether an operand is wanted next, and the parentheses open, by their place.
    let (mut operand, mut open) = (true, Vec::new());
    // Whether a minus sign may open here: at the start and behind a parenthesis.
    let mut fresh = true;
    let mut previous: Option<Token> = None;
    for (at, token) in tokens {
        let is_function = |name: &str| FUNCTIONS.contains(&name);
        let call = matches!(&previous, Some(Token::Name(name)) if is_function(name));
        match (&token, operand) {
            (Token::Symbol('('), true) => {
                open.push(at);
                if open.len() > DEEPEST {
                    return misplaced(at, ExpressionReason::TooDeep);
                }
                written.push('(');
                fresh = true;
                previous = Some(token);
                continue;
            }
            _ if call => {
                let name = previous.take().map_or(String::new(), |token| match token {
                    Token::Name(name) => name,
                    _ => String::new(),
                });
                return misplaced(at, ExpressionReason::NotCalled { name });
            }
            (Token::Number(value), true) => {
                let _ = write!(written, "{value:?}");
                operand = false;
            }
            (Token::Name(name), true) if is_function(name) => written.push_str(name),
            (Token::Name(name), true) => {
                match known(name, parameters) {
                    Ok(name) => written += &name,
                    Err(reason) => return misplaced(at, reason),
                }
                operand = false;
            }
            (Token::Symbol('-'), true) if fresh => written.push_str("0-"),
            (Token::Symbol('-'), true) => return misplaced(at, ExpressionReason::BareMinus),
            (Token::Symbol(')'), false) => {
                if open.pop().is_none() {
                    return misplaced(at, ExpressionReason::Unopened);
                }
                written.push(')');
            }
            (Token::Symbol(operator @ ('+' | '-' | '*' | '/' | '^')), false) => {
                written.push(*operator);
                operand = true;
            }
            (Token::Symbol(_), true) => return misplaced(at, ExpressionReason::OperandMissing),
            (_, false) => return misplaced(at, ExpressionReason::OperatorMissing),
        }
        fresh = false;
        previous = Some(token);
    }
    if operand {
        return misplaced(end, ExpressionReason::OperandMissing);
    }
    match open.pop() {
        Some(at) => misplaced(at, ExpressionReason::Unclosed),
        None => Ok(written),
    }
}

/// A name as the evaluator reads it: constants as they are, variables and parameters in braces.
fn known(name: &str, parameters: &[&str]) -> Result<String, ExpressionReason> {
    let is_variable = VARIABLES.iter().any(|(known, _)| *known == name);
    if CONSTANTS.contains(&name) {
        return Ok(name.to_string());
    }
    if is_variable || parameters.contains(&name) {
        return Ok(format!("{{{name}}}"));
    }
    Err(ExpressionReason::UnknownName {
        name: name.to_string(),
        known: parameters.iter().map(ToString::to_string).collect(),
    })
}

fn tokens(law: &str) -> Result<Vec<(usize, Token)>, Misplaced> {
    let characters: Vec<char> = law.chars().collect();
    if characters.len() > LONGEST {
        let reason = ExpressionReason::TooLong;
        return Err(Misplaced {
            at: LONGEST,
            reason,
        });
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
                _ => {
                    let reason = ExpressionReason::NoNumber { text };
                    return Err(Misplaced { at, reason });
                }
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
            let reason = ExpressionReason::UnknownCharacter { found: here };
            return Err(Misplaced { at, reason });
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
        use ExpressionReason as R;
        for (law, at, what) in [
            ("", 0, R::OperandMissing),
            ("-c * ", 5, R::OperandMissing),
            ("c w", 2, R::OperatorMissing),
            ("c * (w + 1", 4, R::Unclosed),
            ("c * w)", 5, R::Unopened),
            ("c * -w", 4, R::BareMinus),
            ("c; w", 1, R::UnknownCharacter { found: ';' }),
            (
                "1.2.3 * w",
                0,
                R::NoNumber {
                    text: "1.2.3".into(),
                },
            ),
            ("abs * w", 4, R::NotCalled { name: "abs".into() }),
        ] {
            let found = judged(law, &["c"]).unwrap_err();
            assert_eq!(found, Misplaced { at, reason: what }, "{law}");
        }
        let unknown = judged("-c * v", &["c"]).unwrap_err();
        assert_eq!(unknown.at, 5);
        assert!(judged(&"(".repeat(40), &[]).is_err());
        assert!(judged(&"1+".repeat(400), &[]).is_err());
    }
}
