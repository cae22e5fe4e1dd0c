//! The page: numbers, figures, findings.

use super::findings::Finding;
use super::humanoid::{BlockValue, LumpedBlock};
use super::{Agreement, CheckedNumber, Computed, Holds, PaperFigure, Reproduction};
use crate::plot::Chart;
use crate::report::page::{Section, document};
use crate::report::table::{Columns, columns_of, page_table};
use maud::{Markup, html as markup};
use nalgebra::Complex;

/// Size of a chart, px.
const SIZE: (f64, f64) = (460.0, 250.0);

/// A self-contained page. `command` is the line that makes it again.
pub fn html(study: &Reproduction, command: &str) -> String {
    let sections = [
        numbers(study),
        whole(study),
        figures(study),
        findings(study),
        origin(command),
    ];
    document("The paper, reproduced", &header(study), &sections)
}

fn header(study: &Reproduction) -> Markup {
    let misprints = study
        .rows
        .iter()
        .filter(|row| row.verdict != Agreement::Agrees)
        .count();
    let hold = |figure: &&PaperFigure| figure.holds == Holds::Yes;
    markup! {
        header.verdict-named {
            p.title { "Development of a simulation environment of an entertainment humanoid robot" }
            h1 {
                (study.rows.len() - misprints) " of " (study.rows.len())
                " numbers agree to every digit, " (misprints) " are misprints."
            }
            p {
                "What the paper concludes from its figures holds here for "
                (study.figures.iter().filter(hold).count()) " of " (study.figures.len())
                "; the others say below where it does not."
            }
        }
    }
}

fn numbers(study: &Reproduction) -> Section {
    let body = markup! {
        (page_table(&study.rows, &number_columns()))
        h3 { "What follows without being printed" }
        ul {
            @for (what, value) in follows(&study.computed) {
                li { (what) ": " (value.replace("+-", "±")) }
            }
        }
    };
    Section {
        id: "numbers",
        title: "Printed and computed",
        lead: "Computed from Table 1: linearised upright, sampled, solved. The last printed digit \
               decides. Rows marked recomputed are not printed; SciPy found them from Table 1. The \
               servo's coefficients are those of a Box-Jenkins model found in data made with eq. \
               (2), with half their 95 % interval.",
        body,
    }
}

/// The columns of numbers printed and computed.
pub fn number_columns<'a>() -> Columns<'a, CheckedNumber> {
    columns_of::<CheckedNumber>()
        .text("Where", |row| row.printed.place.to_string())
        .text("Quantity", |row| row.printed.quantity.name())
        .drawn("Unit", |row| markup! { (row.printed.quantity.unit()) })
        .number("Stated", |row| row.printed.text.to_string())
        .number("Computed", CheckedNumber::computed_text)
        .text("Verdict", |row| row.verdict.to_string())
        .judged(|row| row.verdict == Agreement::Agrees)
}

fn whole(study: &Reproduction) -> Section {
    let blocks = &study.computed.blocks;
    let values: Vec<BlockValue> = blocks.iter().flat_map(LumpedBlock::values).collect();
    Section {
        id: "whole",
        title: "The whole robot, held still",
        lead: "The robot with its 18 servos in three dimensions, as a URDF file that is read like \
               any other. Its servos are where its parts put them and weigh what Robotis says. \
               The rest, whose weight is not public, is put where Table 1 leaves it, and beside \
               that spread evenly along each block.",
        body: markup! {
            (page_table(&values, &block_columns()))
            ul { @for line in rest_of_blocks(blocks) { li { (line) } } }
        },
    }
}

/// The columns of a block's values: Table 1, the whole robot, and the rest spread evenly.
pub fn block_columns<'a>() -> Columns<'a, BlockValue> {
    let digits = |value: f64| format!("{value:.2}");
    columns_of::<BlockValue>()
        .text("Block", |own| own.block.to_string())
        .text("Quantity", |own| format!("{}, {}", own.name, own.unit))
        .number("Table 1", |own| format!("{:.1}", own.values[0]))
        .number("Whole robot", move |own| digits(own.values[1]))
        .number("Rest spread evenly", move |own| digits(own.values[2]))
}

/// Where Table 1 leaves the rest of each block: a sentence each.
pub fn rest_of_blocks(blocks: &[LumpedBlock]) -> Vec<String> {
    let sentence = |block: &LumpedBlock| {
        let mm = |metres: f64| format!("{:.0}", 1e3 * metres);
        let (LumpedBlock { name, servos, .. }, rest_g) = (block, 1e3 * block.rest_kg);
        let ([low, high], [from, to]) = (block.rest_at_m, block.reach_m);
        format!(
            "{name}: {servos} servos; a rest of {rest_g:.1} g, half at {} mm, half at {} mm (the \
             block: {} to {} mm)",
            mm(low),
            mm(high),
            mm(from),
            mm(to)
        )
    };
    blocks.iter().map(sentence).collect()
}

/// What follows from the numbers without being printed: what it is, and its value.
pub fn follows(computed: &Computed) -> Vec<(String, String)> {
    let zeros = computed.zeros.iter().map(|zeros| {
        let [a, b] = zeros.outputs;
        let j = if zeros.squared < 0.0 { " j" } else { "" };
        let what = format!("zeros from the torques to (q{a}, q{b})");
        (what, format!("+-{:.4}{j} 1/s", zeros.squared.abs().sqrt()))
    });
    let facts = &computed.servo_facts;
    let poles = facts.poles.iter().filter(|pole| pole.im >= 0.0);
    let poles = poles.map(|pole| {
        let size = pole.norm();
        let place = format!("z = {:.4} +- {:.4} j, |z| = {size:.4}", pole.re, pole.im);
        ("servo, poles", place)
    });
    let Complex { re, im } = facts.continuous;
    let gain = ("servo, static gain", format!("{:.4}", facts.gain));
    let continuous = format!("{re:.2} +- {:.2} j 1/s", im.abs());
    let ends = [
        ("servo, poles in continuous time", continuous),
        (
            "servo, settles to 2 % in",
            format!("{:.2} s", facts.settling_s),
        ),
    ];
    let servo = std::iter::once(gain).chain(poles).chain(ends);
    let servo = servo.map(|(what, value)| (what.to_string(), value));
    zeros.chain(servo).collect()
}

fn figures(study: &Reproduction) -> Section {
    Section {
        id: "figures",
        title: "The figures, from our own simulation",
        lead: "Each with what the paper concludes from it, and whether that holds here.",
        body: markup! { @for figure in &study.figures { (drawn(figure)) } },
    }
}

fn drawn(figure: &PaperFigure) -> Markup {
    let words = markup! {
        p { (figure.sentence) }
        p.note {
            "The paper: " (figure.claim) ". "
            b class=(good(figure.holds == Holds::Yes)) { (capital(figure.holds.words())) "." }
        }
    };
    let alone = figure.charts.len() == 1;
    markup! {
        h3 { "Figure " (figure.number) ": " (figure.title) }
        @if !alone { (words) }
        div.panels {
            @for chart in &figure.charts { (drawn_chart(chart)) }
            @if alone { div { (words) } }
        }
    }
}

fn good(is: bool) -> &'static str {
    if is { "good" } else { "bad" }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}

fn drawn_chart(chart: &Chart) -> Markup {
    let (width, height) = SIZE;
    markup! {
        figure {
            figcaption { b { (chart.title) } (chart.legend()) }
            (chart.svg(width, height))
        }
    }
}

fn findings(study: &Reproduction) -> Section {
    let columns = columns_of::<Finding>()
        .number("", |row| row.number.to_string())
        .text("Found there", |row| row.found.to_string())
        .text("Here", |row| row.said.clone())
        .drawn("Command", |row| markup! { code { (row.command) } })
        .text("Verdict", |row| row.holds.words().to_string())
        .judged(|row| matches!(row.holds, Holds::Yes | Holds::ShownElsewhere));
    Section {
        id: "findings",
        title: "What the paper found",
        lead: "Everything it measured, simulated or left open, with the command that shows it \
               here.",
        body: page_table(&study.findings, &columns),
    }
}

fn origin(command: &str) -> Section {
    Section {
        id: "origin",
        title: "Where this comes from",
        lead: "The same program makes the same page again.",
        body: markup! {
            p { "Program version " b { (env!("CARGO_PKG_VERSION")) } "." }
            pre { code { (command) } }
        },
    }
}
