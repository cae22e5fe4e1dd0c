//! The effects explained to people: a page for each, and a table of all. Every word and curve comes from the
//! descriptions and the laws.

use super::canvas::{plot, rounded};
use super::signature::signature;
use super::{EFFECTS, Effect, EffectInfo, Needs, Parameter, Scope, Site, named};
use comfy_table::{ContentArrangement, Table, TableComponent, presets};

/// Columns of a page.
const WIDTH: usize = 90;

/// One line for each effect.
pub fn overview() -> Table {
    let mut table = table(["Name", "Effect", "Law"]);
    for effect in EFFECTS {
        let info = effect.info();
        table.add_row([info.id, info.title, info.law]);
    }
    table
}

/// Everything there is to say of one effect, as plain text.
pub fn page(effect: &dyn Effect) -> String {
    let info = effect.info();
    let sections = [
        heading(info),
        section("Law", &wrapped(info.law)),
        section("Parameters", &parameters(info).to_string()),
        section("What a log shows", &wrapped(info.looks_like)),
        section("Signature", &drawn(effect)),
        section("Confused with", &confusions(info)),
        section("Experiment", &wrapped(info.experiment)),
        section("Reference", &wrapped(info.reference)),
    ];
    sections.join("\n\n") + "\n"
}

fn heading(info: &EffectInfo) -> String {
    let title = format!("{} ({})", info.title, info.id);
    let rule = "=".repeat(title.chars().count());
    let acts = format!("Acts on {}, at {}.", site(info.site), scope(info.scope));
    let needs = match needs(info.needs) {
        Some(needs) => format!("{acts} Needs {needs}."),
        None => acts,
    };
    format!("{title}\n{rule}\n{}", wrapped(&needs))
}

fn section(name: &str, text: &str) -> String {
    let indented: Vec<String> = text
        .lines()
        .map(|line| format!("  {line}").trim_end().to_string())
        .collect();
    format!("{name}\n{}", indented.join("\n"))
}

fn site(site: Site) -> &'static str {
    match site {
        Site::Timing => "timing",
        Site::Command => "command",
        Site::Drive => "torque of the drive",
        Site::Friction => "friction",
        Site::Joint => "torque on the joint",
        Site::Body => "masses and gravity",
        Site::Encoder | Site::Sensor => "reading",
    }
}

fn scope(scope: Scope) -> &'static str {
    match scope {
        Scope::AnyJoint => "any joint",
        Scope::DrivenJoint => "a driven joint",
        Scope::PassiveJoint => "a passive joint",
        Scope::WholeRig => "the whole rig at once",
    }
}

fn needs(needs: Needs) -> Option<&'static str> {
    match needs {
        Needs::Nothing => None,
        Needs::Supply => Some("the supply voltage in the log, and the nominal one in the model"),
        Needs::GearLoad => Some("the torque through the gear, which the dynamics compute"),
        Needs::BearingLoad => Some("the force in the bearing, which the dynamics compute"),
    }
}

fn parameters(info: &EffectInfo) -> Table {
    let mut table = table(["Key", "Unit", "Off", "Typical", "Bounds", "Meaning"]);
    for parameter in info.parameters {
        table.add_row([
            parameter.key.to_string(),
            parameter.unit.to_string(),
            off(parameter),
            range(parameter.typical),
            range(parameter.bounds),
            parameter.meaning.to_string(),
        ]);
    }
    table
}

fn off(parameter: &Parameter) -> String {
    match parameter.off {
        None => "-".to_string(),
        Some(off) if off.is_infinite() => "infinite".to_string(),
        Some(off) => off.to_string(),
    }
}

fn range((low, high): (f64, f64)) -> String {
    format!("{} to {}", rounded(low), rounded(high))
}

fn confusions(info: &EffectInfo) -> String {
    let title = |id| named(id).map_or(id, |effect| effect.info().title);
    let line = |(id, why): (&'static str, &str)| wrapped(&format!("{} ({id}): {why}", title(id)));
    let lines: Vec<String> = info
        .confused_with
        .iter()
        .map(|c| line((c.with, c.why)))
        .collect();
    lines.join("\n")
}

/// The signature with its axes, and what it is drawn for.
fn drawn(effect: &dyn Effect) -> String {
    let signature = signature(effect);
    let pairs = effect.info().parameters.iter().zip(&signature.values);
    let values: Vec<String> = pairs
        .map(|(parameter, value)| format!("{} = {}", parameter.key, rounded(*value)))
        .collect();
    let exaggerated = effect
        .info()
        .parameters
        .iter()
        .zip(&signature.values)
        .any(beyond_typical);
    let note = if exaggerated {
        " (more than typical, to be seen)"
    } else {
        ""
    };
    let legend = format!("line: with {}{note}; dots: without", values.join(", "));
    format!("{}\n{}", plot(&signature), wrapped(&legend))
}

fn beyond_typical((parameter, value): (&Parameter, &f64)) -> bool {
    let (low, high) = parameter.typical;
    !(low..=high).contains(value) && parameter.off.is_some()
}

fn table<const N: usize>(header: [&str; N]) -> Table {
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(WIDTH as u16)
        .set_header(header)
        .remove_style(TableComponent::HorizontalLines)
        .remove_style(TableComponent::MiddleIntersections);
    table
}

/// Broken into lines between words.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let line = lines.last_mut().expect("there is a first line");
        if line.is_empty() {
            line.push_str(word);
        } else if line.chars().count() + 1 + word.chars().count() <= WIDTH - 2 {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_string());
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_holds_its_info_and_a_drawing() {
        for effect in EFFECTS {
            let (info, page) = (effect.info(), page(*effect));
            let flat = page.split_whitespace().collect::<Vec<_>>().join(" ");
            for text in [
                info.title,
                info.law,
                info.looks_like,
                info.experiment,
                info.reference,
            ] {
                let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
                assert!(flat.contains(&text), "{}: {text}", info.id);
            }
            assert!(
                info.parameters.iter().all(|p| page.contains(p.key)),
                "{}",
                info.id
            );
            let dots = page
                .chars()
                .filter(|sign| ('\u{2801}'..='\u{28ff}').contains(sign))
                .count();
            assert!(dots >= 30, "{}: {dots} signs drawn", info.id);
        }
    }

    #[test]
    fn overview_lists_all() {
        let text = overview().to_string();
        assert!(EFFECTS.iter().all(|effect| text.contains(effect.info().id)));
    }
}
