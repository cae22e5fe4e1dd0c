//! An effect explained on a terminal: a page for each, and a table of all. Every word and curve
//! comes from the descriptions and the laws.

use super::signatures::{chart, title};
use crate::effects::signature::signature;
use crate::effects::{EFFECTS, Effect, EffectInfo, Needs, OnSlide, Parameter, Scope, Site};
use crate::output::number::given;
use crate::output::table::{plain_table, unbroken};
use comfy_table::Table;

/// Columns of a page.
const WIDTH: usize = 90;

/// One line for each effect.
pub fn overview() -> String {
    let mut table = table(["Name", "Effect", "Law"]);
    let infos = EFFECTS.iter().map(|effect| effect.info());
    table.add_rows(infos.map(|info| [info.id, info.title, info.law]));
    unbroken(table).to_string()
}

/// Everything there is to say of one effect, as plain text.
pub fn page(effect: Effect) -> String {
    let info = effect.info();
    let sections = [
        heading(info),
        section("Also called", &wrapped(&info.aliases.join(", "))),
        section("Law", &wrapped(info.law)),
        section("Parameters", &parameters(info)),
        section("On a joint that slides", &on_slide(effect)),
        section("What a log shows", &wrapped(info.looks_like)),
        section("Signature", &drawn(effect)),
        section("Confused with", &confusions(info)),
        section("Experiment", &wrapped(info.experiment)),
        section("Reference", &wrapped(info.reference)),
    ];
    let sections = sections
        .into_iter()
        .filter(|section| section.contains('\n'));
    sections.collect::<Vec<_>>().join("\n\n") + "\n"
}

/// Law and parameters there, in m and N.
fn on_slide(effect: Effect) -> String {
    match effect.info().on_slide {
        OnSlide::Never => "It does not act there.".to_string(),
        OnSlide::Same => "The same.".to_string(),
        OnSlide::Own(info) => format!("{}\n{}", wrapped(info.law), parameters(info)),
    }
}

fn heading(info: &EffectInfo) -> String {
    let title = format!("{} ({})", info.title, info.id);
    let rule = "=".repeat(title.chars().count());
    let acts = format!(
        "Acts on {}, at {}.{}",
        site(info.site),
        scope(info.scope),
        needs(info.needs)
    );
    format!("{title}\n{rule}\n{}", wrapped(&acts))
}

fn section(name: &str, text: &str) -> String {
    let indented = text
        .lines()
        .map(|line| format!("\n  {line}").trim_end_matches(' ').to_string());
    indented.fold(name.to_string(), |section, line| section + &line)
}

fn site(site: Site) -> &'static str {
    match site {
        Site::Timing => "timing",
        Site::Command => "command",
        Site::Drive => "torque of the drive",
        Site::Gear => "the gear",
        Site::Friction => "friction",
        Site::Joint => "torque on the joint",
        Site::Body => "masses and gravity",
        Site::Encoder | Site::Sensor => "reading",
        Site::Rate => "the rate that is read",
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

fn needs(needs: Needs) -> &'static str {
    match needs {
        Needs::Nothing => "",
        Needs::Supply => " Needs the supply voltage in the log, and the nominal one in the model.",
        Needs::RateSensor => " Needs a rate sensor beside the one of the angle.",
        Needs::GearLoad => " Needs the torque through the gear, which the dynamics compute.",
        Needs::BearingLoad => " Needs the force in the bearing, which the dynamics compute.",
    }
}

fn parameters(info: &EffectInfo) -> String {
    let mut table = table(["Key", "Unit", "Off", "Typical", "Bounds", "Meaning"]);
    for parameter in info.parameters {
        table.add_row([
            parameter.key,
            parameter.unit,
            &off(parameter),
            &range(parameter.typical),
            &range(parameter.bounds),
            parameter.meaning,
        ]);
    }
    unbroken(table).to_string()
}

fn off(parameter: &Parameter) -> String {
    match parameter.off {
        None => "-".to_string(),
        Some(off) if off.is_infinite() => "infinite".to_string(),
        Some(off) => off.to_string(),
    }
}

fn range((low, high): (f64, f64)) -> String {
    format!("{} to {}", given(low), given(high))
}

fn confusions(info: &EffectInfo) -> String {
    let lines = info.confusions().map(|confusion| {
        let id = confusion.with;
        wrapped(&format!("{} ({id}): {}", title(id), confusion.why))
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// The signature with its axes, and what it is drawn for.
fn drawn(effect: Effect) -> String {
    let signature = signature(effect);
    let chart = chart(effect, &signature);
    let mut values = effect.info().parameters.iter().zip(&signature.values);
    let note = if values.any(beyond_typical) {
        " (more than typical, to be seen)"
    } else {
        ""
    };
    let legend = format!("line: {}{note}; dots: without", chart.curves[1].name);
    format!("{}\n{}", chart.text(), wrapped(&legend))
}

fn beyond_typical((parameter, value): (&Parameter, &f64)) -> bool {
    let (low, high) = parameter.typical;
    !(low..=high).contains(value) && parameter.off.is_some()
}

fn table<const N: usize>(header: [&str; N]) -> Table {
    let mut table = plain_table(header);
    table.set_width(WIDTH as u16);
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
