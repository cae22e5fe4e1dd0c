//! The page: one document that needs nothing but itself.

use super::{
    Report, candidates, closed_loop, failures, headline, parameters, provenance, remains,
    signatures, traces, waterfall,
};
use crate::model::JointNames;
use crate::plot;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Dark colours and layout; screen, phone and paper.
/// The style of every page.
pub const STYLE: &str = include_str!("page.css");
/// Zoom of the charts, and buttons that copy commands; without it the page shows the same.
const SCRIPT: &str = include_str!("page.js");

/// A part of the page that is there only if its data are.
pub struct Section {
    /// Anchor.
    pub id: &'static str,
    /// Heading.
    pub title: &'static str,
    /// What to look for, to someone who sees such a thing for the first time.
    pub lead: &'static str,
    /// The rest.
    pub body: Markup,
}

/// A self-contained page: no scripts, fonts or pictures from elsewhere.
pub fn html(report: &Report) -> String {
    html_with(report, Vec::new())
}

/// The same with sections of the caller's above the others.
pub fn html_with(report: &Report, above: Vec<Section>) -> String {
    let parts: [fn(&Report) -> Option<Section>; 10] = [
        traces::section,
        closed_loop::section,
        failures::section,
        waterfall::section,
        candidates::section,
        signatures::section,
        parameters::section,
        remains::section,
        provenance::section,
        provenance::terms,
    ];
    let own = parts.iter().filter_map(|part| part(report));
    let named = above.into_iter().chain(own).map(|section| Section {
        body: with_names(&section.body, &report.names),
        ..section
    });
    let sections: Vec<Section> = named.collect();
    let header = with_names(&headline::header(report), &report.names);
    document(&report.title, &header, &sections)
}

/// Begins what a screen reader says of an element.
const LABEL: &str = "aria-label=\"";

/// A part of the page with names in what one reads or hears of it; other attributes, as commands to
/// copy, keep their numbers.
fn with_names(part: &Markup, names: &JointNames) -> Markup {
    let mut named = String::with_capacity(part.0.len());
    for piece in part.0.split_inclusive('>') {
        let (text, tag) = piece.split_at(piece.find('<').unwrap_or(piece.len()));
        named += &names.in_text(text);
        let label = tag.find(LABEL).map_or(tag.len(), |at| at + LABEL.len());
        let (before, label) = tag.split_at(label);
        let (label, behind) = label.split_at(label.find('"').unwrap_or(0));
        named += before;
        named += &names.in_text(label);
        named += behind;
    }
    PreEscaped(named)
}

/// A document of sections, with links to them.
pub fn document(title: &str, header: &Markup, sections: &[Section]) -> String {
    let style = html! { (PreEscaped(plot::STYLE)) (PreEscaped(STYLE)) };
    let body = html! {
        main {
            (header)
            nav aria-label="Sections" {
                @for section in sections { a href={ "#" (section.id) } { (section.title) } }
            }
            @for section in sections {
                section id=(section.id) {
                    h2 { (section.title) }
                    p.lead { (section.lead) }
                    (section.body)
                }
            }
        }
        script { (PreEscaped(SCRIPT)) }
    };
    self_contained(title, &style, &body)
}

/// An HTML document around a style sheet and a body.
pub(crate) fn self_contained(title: &str, style: &Markup, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (style) }
            }
            body { (body) }
        }
    };
    page.into_string()
}
