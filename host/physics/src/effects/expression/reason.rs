//! Why a law is refused.

use super::syntax::{FUNCTIONS, VARIABLES};
use crate::error::Reason;
use std::borrow::Cow;

/// What is wrong with the expression of a law, or with what it is given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExpressionReason {
    /// An operator or the end where a value should be.
    #[error("a number, a name or `(` is missing here")]
    OperandMissing,
    /// A value where an operator should be.
    #[error("an operator is missing here")]
    OperatorMissing,
    /// A parenthesis that is never closed.
    #[error("this `(` is never closed")]
    Unclosed,
    /// A parenthesis that was never opened.
    #[error("this `)` closes nothing")]
    Unopened,
    /// A minus sign right behind an operator.
    #[error("a minus sign right behind an operator")]
    BareMinus,
    /// A character that no law has.
    #[error("`{found}` is no part of a law")]
    UnknownCharacter {
        /// The character.
        found: char,
    },
    /// Something like a number.
    #[error("`{text}` is no number")]
    NoNumber {
        /// What was found.
        text: String,
    },
    /// A name that is neither variable nor parameter nor function.
    #[error("unknown name `{name}`")]
    UnknownName {
        /// The name.
        name: String,
        /// The law's parameters.
        known: Vec<String>,
    },
    /// A function without its argument in parentheses.
    #[error("`{name}` is a function and needs its argument in parentheses")]
    NotCalled {
        /// The function.
        name: String,
    },
    /// Parentheses within parentheses, too many.
    #[error("parentheses are more than 32 deep")]
    TooDeep,
    /// A law too long.
    #[error("the law is longer than 500 characters")]
    TooLong,
    /// A name that already means something.
    #[error("the name `{name}` is taken")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// A name of other characters.
    #[error("`{name}` is no name")]
    NoName {
        /// The name.
        name: String,
    },
    /// Too many parameters.
    #[error("{count} parameters, and an effect has at most {most}")]
    TooMany {
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// Bounds without room, or a start outside them.
    #[error("the bounds are not in order, or a start lies outside them")]
    Bounds,
    /// A torque and a friction in one law.
    #[error("`torque` and `friction` in one law")]
    TwoSites,
    /// Too many laws for one run of the program.
    #[error("more than {most} different laws in one run")]
    TooManyLaws {
        /// How many there may be.
        most: usize,
    },
}

impl Reason for ExpressionReason {
    fn remedy(&self) -> Cow<'_, str> {
        use ExpressionReason as R;
        match self {
            R::OperandMissing | R::OperatorMissing => {
                "write it as -c * w * abs(w), with + - * / ^ and parentheses".into()
            }
            R::Unclosed => "close it, or remove it".into(),
            R::Unopened => "remove it, or open one".into(),
            R::BareMinus => "put it into parentheses, as in c * (-w)".into(),
            R::UnknownCharacter { .. } | R::NoNumber { .. } => {
                "a law has numbers, names, + - * / ^ and parentheses".into()
            }
            R::UnknownName { known, .. } => {
                let variables: Vec<&str> = VARIABLES.iter().map(|(name, _)| *name).collect();
                let (variables, known) = (variables.join(", "), known.join(", "));
                let functions = FUNCTIONS.map(|(name, _)| name).join(", ");
                format!("variables: {variables}; parameters: {known}; functions: {functions}; PI")
                    .into()
            }
            R::NotCalled { name } => format!("write {name}(w)").into(),
            R::TooDeep | R::TooLong => "write it shorter, or as several effects".into(),
            R::NameTaken { .. } => "choose another name".into(),
            R::NoName { .. } => "a name is small letters, digits and _, a letter first".into(),
            R::TooMany { .. } => "write the law as several effects".into(),
            R::Bounds => "write low = LOWEST and high = HIGHEST with start between them".into(),
            R::TwoSites => "write two [[expression]] tables, each with its own name".into(),
            R::TooManyLaws { .. } => "start the program again".into(),
        }
    }
}
