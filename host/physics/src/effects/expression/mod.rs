//! Effects that a model file defines by an expression: `torque = "-c * w * abs(w)"`, or
//! `friction = "c * abs(q)"`.
//!
//! A definition becomes an [`Effect`] like those of the library and lives as long as the program;
//! equal definitions are one effect.

mod law;
mod program;
mod syntax;

pub use law::MOST_VALUES;
pub use syntax::{CONSTANTS, FUNCTIONS, Misplaced, VARIABLES};

use super::{Effect, EffectInfo, JointState, Needs, OnSlide, Parameter, Scope, Site};
use crate::error::Problem;
use law::ExpressionLaw;
use program::Program;
use std::sync::{LazyLock, RwLock};

/// Most different laws of one run of the program, which keeps each.
const MOST_LAWS: usize = 10_000;

/// A parameter of a user's law.
#[derive(Debug, Clone, PartialEq)]
pub struct LawParameter {
    /// Its key in model files, and its name in the expression.
    pub key: String,
    /// Unit as shown to people.
    pub unit: String,
    /// What it is.
    pub meaning: String,
    /// Values to start fits from, the first one before the others; at least one.
    pub starts: Vec<f64>,
    /// Lowest and highest value.
    pub bounds: (f64, f64),
}

/// What the expression of a law is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LawSite {
    /// A torque on the joint.
    Torque,
    /// The magnitude of a friction, which holds the joint at rest; what of the sum is below zero is
    /// none.
    Friction,
}

impl LawSite {
    /// All there are.
    pub const ALL: [LawSite; 2] = [LawSite::Torque, LawSite::Friction];

    /// Its key in model files.
    pub fn key(self) -> &'static str {
        match self {
            LawSite::Torque => "torque",
            LawSite::Friction => "friction",
        }
    }
}

/// A law as a model file defines it.
#[derive(Debug, Clone, PartialEq)]
pub struct LawDefinition {
    /// Its name: the kind of the effect.
    pub name: String,
    /// What the expression is.
    pub site: LawSite,
    /// Torque on the joint, or friction, N m.
    pub expression: String,
    /// Its parameters.
    pub parameters: Vec<LawParameter>,
    /// Whether it has a meaning where a joint slides: in m, m/s and N.
    pub slides: bool,
}

/// What of a definition is wrong.
#[derive(Debug, Clone, PartialEq)]
pub enum DefinitionFault {
    /// The name, or the number of parameters or laws.
    Name(Problem),
    /// The parameter of this index.
    Parameter(usize, Problem),
    /// The expression, at one of its characters.
    Expression(Misplaced),
}

type ExpressionLaws = Vec<(LawDefinition, Effect)>;

static LAWS: LazyLock<RwLock<ExpressionLaws>> = LazyLock::new(RwLock::default);

/// The effect of this definition.
///
/// # Errors
/// Names that are taken, bounds without room, an expression that is no law.
pub fn effect(definition: &LawDefinition) -> Result<Effect, DefinitionFault> {
    let mut laws = LAWS.write().unwrap_or_else(|broken| broken.into_inner());
    if let Some(index) = laws.iter().position(|(known, _)| known == definition) {
        // The last definition of a name is what the name alone stands for.
        let known = laws.remove(index);
        let effect = known.1;
        laws.push(known);
        return Ok(effect);
    }
    if laws.len() >= MOST_LAWS {
        return Err(DefinitionFault::Name(Problem::new(
            format!("more than {MOST_LAWS} different laws in one run"),
            "start the program again",
        )));
    }
    let effect = compiled(definition)?;
    laws.push((definition.clone(), effect));
    Ok(effect)
}

/// The effect that was last defined by this name.
pub(super) fn named(id: &str) -> Option<Effect> {
    let laws = LAWS.read().unwrap_or_else(|broken| broken.into_inner());
    let mut effects = laws.iter().rev().map(|(_, effect)| *effect);
    effects.find(|effect| effect.info().id == id)
}

/// The effects of all definitions so far.
pub fn defined() -> Vec<Effect> {
    let laws = LAWS.read().unwrap_or_else(|broken| broken.into_inner());
    laws.iter().rev().map(|(_, effect)| *effect).collect()
}

fn compiled(definition: &LawDefinition) -> Result<Effect, DefinitionFault> {
    names(definition)?;
    let keys: Vec<&str> = definition
        .parameters
        .iter()
        .map(|p| p.key.as_str())
        .collect();
    let program = syntax::parsed(&definition.expression, &keys);
    let program = program.map_err(DefinitionFault::Expression)?;
    let off: Vec<Option<f64>> = (0..keys.len())
        .map(|i| off(&program, definition, i))
        .collect();
    let law = Box::leak(Box::new(ExpressionLaw {
        program,
        site: definition.site,
    }));
    Ok(Effect::of(law, info(definition, &off)))
}

/// Judges names, bounds and starts.
fn names(definition: &LawDefinition) -> Result<(), DefinitionFault> {
    let is_name = |name: &str| {
        let mut letters = name.chars();
        letters
            .next()
            .is_some_and(|first| first.is_ascii_lowercase())
            && letters.all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
    };
    let no_name = |name: &str| {
        Problem::new(
            format!("`{name}` is no name"),
            "a name is small letters, digits and _, a letter first",
        )
    };
    let taken =
        |name: &str| Problem::new(format!("the name `{name}` is taken"), "choose another name");
    let name = &definition.name;
    if !is_name(name) {
        return Err(DefinitionFault::Name(no_name(name)));
    }
    if super::EFFECTS
        .iter()
        .chain(super::CONTROLS)
        .any(|e| e.info().id == *name)
    {
        return Err(DefinitionFault::Name(taken(name)));
    }
    let count = definition.parameters.len();
    if count > MOST_VALUES {
        return Err(DefinitionFault::Name(Problem::new(
            format!("{count} parameters, and an effect has at most {MOST_VALUES}"),
            "write the law as several effects",
        )));
    }
    let reserved = |key: &str| {
        let keys = ["kind", "joint", "fitted"]
            .into_iter()
            .chain(FUNCTIONS.map(|(name, _)| name))
            .chain(CONSTANTS.map(|(name, _)| name));
        keys.chain(VARIABLES.map(|(name, _)| name))
            .any(|known| known == key)
    };
    for (index, parameter) in definition.parameters.iter().enumerate() {
        let name = &parameter.key;
        let twice = definition.parameters[..index]
            .iter()
            .any(|other| other.key == *name);
        let (low, high) = parameter.bounds;
        let problem = if !is_name(name) {
            no_name(name)
        } else if twice || reserved(name) {
            taken(name)
        } else if low < high
            && !parameter.starts.is_empty()
            && parameter
                .starts
                .iter()
                .all(|start| (low..=high).contains(start))
        {
            continue;
        } else {
            Problem::new(
                "the bounds are not in order, or a start lies outside them",
                "write low = LOWEST and high = HIGHEST with start between them",
            )
        };
        return Err(DefinitionFault::Parameter(index, problem));
    }
    Ok(())
}

/// 0 for a parameter at whose zero the torque vanishes, whatever the joint does.
fn off(law: &Program, definition: &LawDefinition, index: usize) -> Option<f64> {
    let parameters = &definition.parameters;
    let (low, high) = parameters[index].bounds;
    if !(low..=high).contains(&0.0) {
        return None;
    }
    let mut values: Vec<f64> = parameters.iter().map(|p| p.starts[0]).collect();
    values[index] = 0.0;
    let states = [(0.3, 1.7, 0.4), (-1.1, -0.6, -0.9), (2.3, -4.0, 0.2)];
    let vanishes = states.iter().all(|&(angle_rad, speed_rad_s, drive_nm)| {
        let state = JointState {
            drive_nm,
            ..JointState::undriven(angle_rad, speed_rad_s)
        };
        law.value(&values, &(&state).into()) == 0.0
    });
    vanishes.then_some(0.0)
}

fn info(definition: &LawDefinition, off: &[Option<f64>]) -> &'static EffectInfo {
    let text = |text: &str| -> &'static str { Box::leak(text.to_string().into_boxed_str()) };
    let parameter = |(p, off): (&LawParameter, &Option<f64>)| Parameter {
        key: text(&p.key),
        unit: text(&p.unit),
        meaning: text(&p.meaning),
        off: *off,
        typical: p.bounds,
        bounds: p.bounds,
        starts: Box::leak(p.starts.clone().into_boxed_slice()),
    };
    let parameters: Vec<Parameter> = definition
        .parameters
        .iter()
        .zip(off)
        .map(parameter)
        .collect();
    Box::leak(Box::new(EffectInfo {
        id: text(&definition.name),
        title: text(&definition.name),
        aliases: &[],
        law: text(&format!(
            "{} = {}",
            definition.site.key(),
            definition.expression
        )),
        scope: Scope::AnyJoint,
        site: match definition.site {
            LawSite::Torque => Site::Joint,
            LawSite::Friction => Site::Friction,
        },
        needs: Needs::Nothing,
        on_slide: if definition.slides {
            OnSlide::Same
        } else {
            OnSlide::Never
        },
        parameters: Box::leak(parameters.into_boxed_slice()),
        looks_like: "what its law says",
        confused_with: &[],
        experiment: "move the joint where the law acts most",
        reference: "the model file",
    }))
}

#[cfg(test)]
mod tests;
