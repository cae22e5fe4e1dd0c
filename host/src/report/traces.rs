//! Measured against model: per motion and joint the angles, and below them what is left.

use super::page::{Section, table};
use super::{AFTER, BEFORE, FLOOR, MEASURED, Report};
use crate::compare::{Comparison, SignalError, Trace};
use crate::model::MeasuredSignal;
use crate::output::number::{mrad, short};
use crate::output::plot::{Axes, Scale, Tone, span};
use maud::{Markup, html};

/// Charts that are open from the start; the others wait behind their titles.
const OPEN: usize = 6;

/// One motion of one joint by the models at both ends of the chain.
struct Pair<'a> {
    before: &'a Trace,
    after: Option<&'a Trace>,
    floor: Option<f64>,
}

pub(super) fn section(report: &Report) -> Option<Section> {
    let before = report.before()?;
    let pairs = pairs(before, report.after());
    if pairs.is_empty() && before.signals.is_empty() {
        return None;
    }
    let body = html! {
        @if !pairs.is_empty() {
            div.legend {
                (toggle("measured", "measured", MEASURED))
                (toggle("before", &before.model, BEFORE))
                @if let Some(after) = report.after() { (toggle("after", &after.model, AFTER)) }
                span class={ "key " (FLOOR.class()) } { span.swatch {} "± floor" }
            }
        }
        @for (index, pair) in pairs.iter().enumerate() { (drawn(pair, index < OPEN)) }
        @if !before.signals.is_empty() { (fits(report)) }
    };
    Some(Section {
        id: "traces",
        title: "Measured against model",
        lead: "Above, the angle that was measured and what each model predicts for the same input. \
               Below, the residual: measured minus predicted. A good model's residual stays inside \
               the shaded floor and shows no pattern. Untick a name to hide its line.",
        body,
    })
}

fn pairs<'a>(before: &'a Comparison, after: Option<&'a Comparison>) -> Vec<Pair<'a>> {
    let same_signal = |a: &Trace, b: &Trace| a.joint == b.joint && a.quantity == b.quantity;
    let same = |a: &Trace, b: &Trace| a.motion == b.motion && same_signal(a, b);
    let floor = |trace: &Trace| {
        let own = |s: &&SignalError| s.joint == trace.joint && s.quantity == trace.quantity;
        before.signals.iter().find(own).map(|signal| signal.floor)
    };
    let pair = |trace: &'a Trace| Pair {
        before: trace,
        after: after.and_then(|after| after.traces.iter().find(|other| same(trace, other))),
        floor: floor(trace),
    };
    before.traces.iter().map(pair).collect()
}

fn toggle(what: &str, name: &str, tone: Tone) -> Markup {
    html! {
        label class={ "key " (tone.class()) } {
            input type="checkbox" id={ "show-" (what) } checked;
            span.swatch {} (name)
        }
    }
}

fn drawn(pair: &Pair, open: bool) -> Markup {
    let trace = pair.before;
    html! {
        details.chart open[open] {
            summary {
                b { (trace.motion) } ", joint " (trace.joint) " · error " (mrad(trace.rms))
                @if let Some(after) = pair.after { " → " (mrad(after.rms)) }
                " " (trace.quantity.milli())
            }
            div.scroll { (chart(pair)) }
        }
    }
}

fn timed<'a>(trace: &'a Trace, of: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    trace.time_s.iter().copied().zip(of.iter().copied())
}

fn residual(trace: &Trace) -> impl Iterator<Item = (f64, f64)> + '_ {
    let left = trace.measured.iter().zip(&trace.predicted);
    let left = left.map(|(measured, predicted)| 1e3 * (measured - predicted));
    trace.time_s.iter().copied().zip(left)
}

fn chart(pair: &Pair) -> Markup {
    let both = || std::iter::once(pair.before).chain(pair.after);
    let times = both().flat_map(|trace| trace.time_s.iter().copied());
    let x = Scale::new(span(times, 0.0), (56.0, 750.0));
    let angles = both().flat_map(|t| t.measured.iter().chain(&t.predicted).copied());
    let floor_mrad = 1e3 * pair.floor.unwrap_or(0.0).abs();
    let left = both().flat_map(|t| residual(t).map(|point| point.1));
    let left = span(left.chain([floor_mrad, -floor_mrad]), 0.08);
    let above = Axes {
        x,
        y: Scale::new(span(angles, 0.05), (200.0, 20.0)),
    };
    let below = Axes {
        x,
        y: Scale::new(left, (345.0, 232.0)),
    };
    let trace = pair.before;
    let label_above = match trace.quantity {
        MeasuredSignal::Rate => "rate, rad/s",
        MeasuredSignal::Displacement => "displacement, m",
        MeasuredSignal::Angle | MeasuredSignal::Nothing => "angle, rad",
    };
    let label_below = format!("residual, {}", trace.quantity.milli());
    let label = format!("motion {}, joint {}", trace.motion, trace.joint);
    html! {
        svg viewBox="0 0 760 380" role="img" aria-label=(label) {
            (above.columns(8)) (above.rows(5, label_above))
            (above.curve(timed(trace, &trace.measured), MEASURED))
            (above.curve(timed(trace, &trace.predicted), BEFORE))
            @if let Some(after) = pair.after {
                (above.curve(timed(after, &after.predicted), AFTER))
            }
            (below.columns(8)) (below.rows(4, &label_below))
            @if floor_mrad > 0.0 { (below.band(-floor_mrad, floor_mrad, FLOOR)) }
            (below.curve(residual(trace), BEFORE))
            @if let Some(after) = pair.after { (below.curve(residual(after), AFTER)) }
            (below.x_labels(8, "time, s"))
        }
    }
}

/// Behind the figures of a rate, or a displacement, in a column of mrad.
fn per_s(signal: &SignalError) -> &'static str {
    match signal.quantity {
        MeasuredSignal::Rate => " /s",
        MeasuredSignal::Displacement => " mm",
        MeasuredSignal::Angle | MeasuredSignal::Nothing => "",
    }
}

/// Per joint, each model of the chain.
fn fits(report: &Report) -> Markup {
    let headings = html! {
        th { "Model" } th.number { "Joint" } th.number { "RMS, mrad" } th.number { "Largest, mrad" }
        th.number { "Fit" } th.number { "Floor, mrad" }
    };
    let rows = html! {
        @for comparison in &report.comparisons {
            @for signal in &comparison.signals {
                tr {
                    td { (comparison.model) }
                    td.number { (signal.joint) @if signal.beside_angle { ", rate" } }
                    td.number { (mrad(signal.rms)) (per_s(signal)) }
                    td.number { (mrad(signal.largest)) (per_s(signal)) }
                    td.number { (short(signal.fit_percent)) " %" }
                    td.number { (mrad(signal.floor)) (per_s(signal)) }
                }
            }
        }
    };
    html! { h3 { "All motions together" } (table(&headings, &rows)) }
}
