//! Gains as a page: what the loop does, how robust it is, and from where it comes back.

use super::margins::{MarginsPart, margins_parts};
use super::page::{Section, document};
use super::table::page_matrix;
use super::verification_text;
use crate::error::Result;
use crate::model::Model;
use crate::plot::{Chart, Curve, Tone};
use crate::study::{LoopResponse, MappedStart, Verification, region_map, response, step_response};
use crate::synth::export::{self, Provenance};
use crate::synth::{Design, LoopFigures, Request, SingularValues, singular_values};
use maud::{Markup, html};
use nalgebra::Complex;

/// Width and height of a chart, px.
const CHART_PX: (f64, f64) = (760.0, 260.0);
/// Of a map, px.
const MAP_PX: (f64, f64) = (760.0, 640.0);
/// Length of the responses, s.
const SECONDS: f64 = 4.0;
/// Departure of the first joint from which the initial response begins, rad: 1 deg.
const LEAN_RAD: f64 = std::f64::consts::PI / 180.0;
/// Torque of the step on the first joint, N m.
const STEP_NM: f64 = 0.001;
/// Ends of the map of starts: this many half-widths of the cube, and at least so much, rad.
const MAP_REGIONS: f64 = 2.0;
const MAP_LEAST_RAD: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// Colours of joints and inputs, in turn.
const TONES: [Tone; 5] = [Tone::Blue, Tone::Orange, Tone::Green, Tone::Ink, Tone::Grey];

/// What a page of gains is made of.
#[derive(Debug, Clone, Copy)]
pub struct GainsReport<'a> {
    /// The model with all its effects.
    pub model: &'a Model,
    /// What was asked.
    pub request: &'a Request,
    /// What was designed.
    pub design: &'a Design,
    /// Margins, of a stable loop.
    pub figures: Option<&'a LoopFigures>,
    /// What the simulated loop does.
    pub verified: &'a Verification,
    /// Where it came from.
    pub made: &'a Provenance,
}

/// The page; it simulates the responses and the map of starts.
///
/// # Errors
/// Models that cannot be simulated.
pub fn gains_page(report: &GainsReport<'_>) -> Result<String> {
    let GainsReport {
        model,
        request,
        design,
        verified,
        ..
    } = *report;
    let mut lean = vec![0.0; model.link_count()];
    lean[0] = LEAN_RAD;
    let initial = response(model, design, request, &lean, SECONDS)?;
    let step = step_response(model, design, request, STEP_NM, SECONDS)?;
    let span_rad = (MAP_REGIONS * verified.region_rad).max(MAP_LEAST_RAD);
    let map = region_map(model, design, request, span_rad)?;
    let mut sections = vec![
        words(report),
        responses(design, &initial, &step),
        poles(design),
        region(design, &map),
        provenance(report),
    ];
    if let Some(section) = robustness(report)? {
        sections.insert(2, section);
    }
    let verdict = if verified.stabilised {
        "stabilised"
    } else {
        "NOT stabilised"
    };
    let header = html! {
        header {
            h1 { "Gains for " (design.model) }
            p { "The simulated loop is " strong { (verdict) } "." }
        }
    };
    let title = format!("Gains for {}", design.model);
    Ok(document(&title, &header, &sections))
}

fn words(report: &GainsReport<'_>) -> Section {
    let text = verification_text(report.verified, report.model);
    Section {
        id: "verdict",
        title: "Verdict",
        lead: "What the law does in the simulation, with every effect of the model.",
        body: html! {
            @for line in text.lines().filter(|line| !line.is_empty()) { p { (line) } }
        },
    }
}

/// Angles and commands after a lean and under a lasting torque.
fn responses(design: &Design, initial: &LoopResponse, step: &LoopResponse) -> Section {
    let (from, under) = match Shown::of(design, 0) {
        Shown::Deg => (
            format!("a lean of {:.0} deg", LEAN_RAD.to_degrees()),
            format!("torque of {STEP_NM} N m"),
        ),
        Shown::Mm => (
            format!("a departure of {:.1} mm", 1e3 * LEAN_RAD),
            format!("force of {STEP_NM} N"),
        ),
    };
    let body = html! {
        h3 { (format!("From {from} of the first joint")) }
        (departures(design, initial))
        (commands(design, initial))
        h3 { (format!("Under a lasting {under} on the first joint")) }
        (departures(design, step))
        (commands(design, step))
    };
    Section {
        id: "responses",
        title: "Initial and step response",
        lead: "The loop with every effect, its law, sensors and delay. A loop in order comes back \
               without ringing and leaves the inputs room to their limits.",
        body,
    }
}

/// The unit in which a joint's departure is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shown {
    Deg,
    Mm,
}

impl Shown {
    /// That of a joint, counted from 0: mm of one that slides. Of a rig of one joint the second
    /// place is that of its speed, and no start departs along it.
    fn of(design: &Design, joint: usize) -> Shown {
        match design.states[joint].unit {
            "m" => Shown::Mm,
            _ => Shown::Deg,
        }
    }

    /// A coordinate in rad or m in this unit.
    fn value(self, coordinate: f64) -> f64 {
        match self {
            Shown::Deg => coordinate.to_degrees(),
            Shown::Mm => 1e3 * coordinate,
        }
    }

    fn unit(self) -> &'static str {
        match self {
            Shown::Deg => "deg",
            Shown::Mm => "mm",
        }
    }
}

/// A chart of the joints that turn, and one of those that slide.
fn departures(design: &Design, response: &LoopResponse) -> Markup {
    let curves = |unit: Shown| -> Vec<Curve> {
        let joints = response.angle_rad.iter().enumerate();
        let own = joints.filter(|(joint, _)| Shown::of(design, *joint) == unit);
        own.map(|(joint, coordinates)| {
            let values = coordinates.iter().map(|coordinate| unit.value(*coordinate));
            let points = response.time_s.iter().copied().zip(values);
            let name = design.states[joint].name.clone();
            Curve::line(name, TONES[joint % TONES.len()], points.collect())
        })
        .collect()
    };
    let chart = |title: &str, axis: &str, unit: Shown| {
        let curves = curves(unit);
        (!curves.is_empty()).then(|| drawn(&Chart::new(title, "time, s", axis, curves)))
    };
    html! {
        @if let Some(chart) = chart("Departure of each joint", "angle, deg", Shown::Deg) { (chart) }
        @if let Some(chart) = chart("Departure of each slide", "path, mm", Shown::Mm) { (chart) }
    }
}

fn commands(design: &Design, response: &LoopResponse) -> Markup {
    let curves = response.command.iter().zip(&design.inputs).enumerate();
    let curves = curves.map(|(place, (command, signal))| {
        let points = response.time_s.iter().copied().zip(command.iter().copied());
        let name = format!("{} [{}]", signal.name, signal.unit);
        Curve::line(name, TONES[(place + 1) % TONES.len()], points.collect())
    });
    drawn(&Chart::new("Inputs", "time, s", "input", curves.collect()))
}

/// Margins in words, and S and T over frequency.
fn robustness(report: &GainsReport<'_>) -> Result<Option<Section>> {
    let Some(values) = singular_values(report.design)? else {
        return Ok(None);
    };
    let decibels = |value: f64| 20.0 * value.max(1e-6).log10();
    let points = |of: fn(&SingularValues) -> f64| {
        let seen = values.iter().filter(|value| value.frequency_rad_s > 0.0);
        seen.map(|value| (value.frequency_rad_s.log10(), decibels(of(value))))
            .collect()
    };
    let curves = vec![
        Curve::line("S", Tone::Blue, points(|value| value.sensitivity)),
        Curve::line("T", Tone::Orange, points(|value| value.complementary)),
    ];
    let chart = Chart::new(
        "Largest singular values at the inputs",
        "log10 of the frequency in rad/s",
        "dB",
        curves,
    );
    let parts = margins_parts(report.figures, report.design);
    Ok(Some(Section {
        id: "margins",
        title: "Margins and singular values",
        lead: "How much the linear loop may be wrong before it is unstable. A peak of S of 6 dB \
               leaves half of the distance to instability.",
        body: html! {
            @for part in &parts {
                @match part {
                    MarginsPart::Rows(rows) => (page_matrix(rows)),
                    MarginsPart::Line(line) => p { (line) },
                }
            }
            (drawn(&chart))
        },
    }))
}

/// Poles of plant and loop, zeros, and the edge of stability.
fn poles(design: &Design) -> Section {
    let point = |pole: &Complex<f64>| (pole.re, pole.im);
    let dots = |name: &str, tone: Tone, all: &[Complex<f64>]| {
        Curve::dots(name, tone, all.iter().map(point).collect())
    };
    let (curves, across, up, lead) = match &design.sampled {
        Some((sampled, _)) => {
            let circle = (0..=200).map(|step| {
                let turn = std::f64::consts::TAU * f64::from(step) / 200.0;
                (turn.cos(), turn.sin())
            });
            let shift = |pole: &Complex<f64>| (pole * sampled.ts_s).exp();
            let plant: Vec<Complex<f64>> = design.poles.iter().map(shift).collect();
            let curves = vec![
                Curve::line("edge of stability", Tone::Grey, circle.collect()),
                dots("plant", Tone::Orange, &plant),
                dots("loop", Tone::Blue, &design.gains.poles),
            ];
            let lead = "Sampled: poles of a stable loop are within the circle, slow ones near 1.";
            (curves, "real part of z", "imaginary part of z", lead)
        }
        None => {
            let curves = vec![
                dots("plant", Tone::Orange, &design.poles),
                dots("zeros to the driven joints", Tone::Green, &design.zeros),
                dots("loop", Tone::Blue, &design.gains.poles),
            ];
            let lead = "Continuous: poles of a stable loop are to the left of 0.";
            (curves, "real part, 1/s", "imaginary part, 1/s", lead)
        }
    };
    let chart = Chart::new("Poles and zeros", across, up, curves);
    let zeros = design.zeros.iter().map(|zero| format!("{:.4}", zero.re));
    let zeros: Vec<String> = zeros.collect();
    Section {
        id: "poles",
        title: "Poles and zeros",
        lead,
        body: html! {
            (mapped(&chart))
            @if !zeros.is_empty() {
                p { "Zeros from the inputs to the driven joints: " (zeros.join(", ")) " 1/s." }
            }
        },
    }
}

/// Starts that come back and starts that do not.
fn region(design: &Design, map: &[MappedStart]) -> Section {
    let [first, second] = [0, 1].map(|joint| Shown::of(design, joint));
    let starts = |stabilised: bool| {
        let own = map
            .iter()
            .filter(move |start| start.stabilised == stabilised);
        own.map(|start| (first.value(start.first_rad), second.value(start.second_rad)))
            .collect()
    };
    let curves = vec![
        Curve::dots("does not come back", Tone::Orange, starts(false)),
        Curve::dots("comes back", Tone::Blue, starts(true)),
    ];
    let axis = |joint: usize, unit: Shown| {
        let unit = unit.unit();
        format!("joint {}, {unit}", design.names.label(joint))
    };
    let chart = Chart::new(
        "Starts in the plane of the first two joints",
        &axis(0, first),
        &axis(1, second),
        curves,
    );
    Section {
        id: "region",
        title: "Region",
        lead: "Each dot is a run of 5 s from there, at rest, the other joints at the pose.",
        body: mapped(&chart),
    }
}

fn provenance(report: &GainsReport<'_>) -> Section {
    let made = report.made;
    Section {
        id: "design",
        title: "Design",
        lead: "The gains and what they follow from.",
        body: html! {
            pre { (export::text(report.design).trim()) }
            p { "Model " code { (made.model) } ", SHA-256 " code { (made.sha256) } "." }
            p { "Made by " code { (made.command) } "." }
        },
    }
}

fn drawn(chart: &Chart) -> Markup {
    html! {
        figure {
            figcaption { (chart.title) " " (chart.legend()) }
            (chart.zoomable_svg(CHART_PX.0, CHART_PX.1))
        }
    }
}

fn mapped(chart: &Chart) -> Markup {
    html! {
        figure {
            figcaption { (chart.title) " " (chart.legend()) }
            (chart.svg(MAP_PX.0, MAP_PX.1))
        }
    }
}
