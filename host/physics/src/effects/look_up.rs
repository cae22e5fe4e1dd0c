//! Finds effects by what people call them: ids, titles, aliases, and words of their laws.

use super::{EFFECTS, Effect, EffectInfo, expression};

/// What a name means.
#[derive(Debug, Clone, PartialEq)]
pub enum NameMatch {
    /// This effect, and no other, is called so.
    One(Effect),
    /// Each of these is called so, as the friction laws are by `friction`.
    Several(Vec<Effect>),
    /// None is called so; these speak of it in title, aliases or law, or are spelled alike.
    Similar(Vec<Effect>),
}

/// The effects called `name`, whatever its case, hyphens and blanks (`BackEMF`, `dead band`): by
/// id, else by title or alias, those that model files have defined included.
pub fn look_up(name: &str) -> NameMatch {
    let all: Vec<Effect> = EFFECTS
        .iter()
        .copied()
        .chain(expression::defined())
        .collect();
    let wanted = squeezed(name);
    let of_id = |effect: &&Effect| {
        let id = effect.info().id;
        id == name || squeezed(id) == wanted
    };
    if let Some(effect) = all.iter().find(of_id) {
        return NameMatch::One(*effect);
    }
    let called = |effect: &Effect| names(effect.info()).any(|alias| squeezed(alias) == wanted);
    let called: Vec<_> = all.iter().copied().filter(called).collect();
    match called.as_slice() {
        [] => NameMatch::Similar(similar(name, &all)),
        [one] => NameMatch::One(*one),
        _ => NameMatch::Several(called),
    }
}

/// Every name of an effect that is not its id.
fn names(info: &EffectInfo) -> impl Iterator<Item = &'static str> {
    std::iter::once(info.title).chain(info.aliases.iter().copied())
}

/// Effects whose names hold all the words of `name`; where there is none, those whose laws do;
/// where there is none, those whose name is spelled most like it.
fn similar(name: &str, all: &[Effect]) -> Vec<Effect> {
    let of_names = |info: &EffectInfo| names(info).collect::<Vec<_>>().join(" ");
    let of_law = |info: &EffectInfo| info.law.to_string();
    let wanted = words(name);
    for text in [&of_names as &dyn Fn(&EffectInfo) -> String, &of_law] {
        let holds = |effect: &Effect| {
            let there = words(&text(effect.info()));
            !wanted.is_empty() && wanted.iter().all(|word| there.contains(word))
        };
        let found: Vec<_> = all.iter().copied().filter(holds).collect();
        if !found.is_empty() {
            return found;
        }
    }
    let spelled = |effect: &Effect| {
        let info = effect.info();
        let names = std::iter::once(info.id).chain(names(info));
        names.map(squeezed).collect::<Vec<_>>()
    };
    let wanted = squeezed(name);
    // A slip of the keyboard, not a likeness: "friction" is not meant by "frobnicate".
    let slips = |known: &String| strsim::damerau_levenshtein(&wanted, known);
    let known = all.iter().flat_map(spelled);
    let near = known.filter(|known| slips(known) <= known.len() / 4);
    let Some(near) = near.min_by_key(slips) else {
        return Vec::new();
    };
    let so_called = |effect: &Effect| spelled(effect).contains(&near);
    all.iter().copied().filter(so_called).collect()
}

/// Letters and digits alone, in lower case.
fn squeezed(name: &str) -> String {
    let signs = name.chars().filter(|sign| sign.is_alphanumeric());
    signs.flat_map(char::to_lowercase).collect()
}

/// Words that say nothing of an effect.
const FILLERS: [&str; 5] = ["and", "for", "that", "the", "with"];

/// The words of a text in lower case and the singular, without fillers and words of one or two
/// letters.
fn words(text: &str) -> Vec<String> {
    let words = text.split(|sign: char| !sign.is_alphanumeric());
    let words = words.filter(|word| word.chars().count() > 2);
    words
        .map(|word| {
            let word = word.to_lowercase();
            let singular = word.strip_suffix('s').filter(|stem| stem.len() > 3);
            singular.map(str::to_string).unwrap_or(word)
        })
        .filter(|word| !FILLERS.contains(&word.as_str()))
        .collect()
}

/// A line for each effect: its id and its title.
pub fn listed(effects: &[Effect]) -> Vec<String> {
    let infos = || effects.iter().map(|effect| effect.info());
    let width = infos().map(|info| info.id.len()).max().unwrap_or_default();
    infos()
        .map(|info| format!("{:width$}  {}", info.id, info.title))
        .collect()
}

#[cfg(test)]
mod tests;
