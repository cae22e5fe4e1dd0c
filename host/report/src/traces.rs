//! Measured against model: per motion and joint the angles, and below them what is left.

use super::page::Section;
use super::table::page_matrix;
use super::{AFTER, BEFORE, FLOOR, MEASURED, Report};
use crate::compare::{COMPARISON_LEGEND, Comparison, SignalError, Trace, comparison_rows};
use crate::model::MeasuredSignal;
use crate::output::number::mrad;
use crate::plot::{Axes, Scale, Tone, span};
use maud::{Markup, html};

/// Charts that are open from the start; the others wait behind their titles.
const OPEN: usize = 6;

/// One motion of one joint by the models at both ends of the chain.
struct Pair<'a> {
    before: &'a Trace,
    after: Option<&'a Trace>,
    floor: Option<f64>,
    /// Absent where no motion was fitted.
    held_out: Option<bool>,
}

pub(super) fn section(report: &Report) -> Option<Section> {
    let before = report.before()?;
    let pairs = pairs(report, before);
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
            @if pairs.iter().any(Pair::restarts) { p.note { (RESTARTS) } }
        }
        @for (index, pair) in pairs.iter().enumerate() { (drawn(pair, index < OPEN)) }
        @if !before.signals.is_empty() { (side_by_side(report)) }
    };
    Some(Section {
        id: "traces",
        title: "Measured against model",
        lead: "Above, the angle that was measured and what each model predicts for the same input. \
               Below, the residual: measured minus predicted. A good model's residual stays inside \
               the shaded floor and shows no pattern. The measurement is the thin line in front. \
               Untick a name to hide its line. Drag across a chart to zoom; double-click shows all \
               of it again.",
        body,
    })
}

/// What the dotted lines are.
const RESTARTS: &str = "At each dotted line the model restarts from a state that is fitted to \
                        the measurement. Its line breaks there: a step shows how far the run \
                        before had gone astray, the model does not jump.";

fn pairs<'a>(report: &'a Report, before: &'a Comparison) -> Vec<Pair<'a>> {
    let after = report.after();
    let same_signal = |a: &Trace, b: &Trace| a.joint == b.joint && a.quantity == b.quantity;
    let same = |a: &Trace, b: &Trace| a.motion == b.motion && same_signal(a, b);
    let floor = |trace: &Trace| {
        let own = |s: &&SignalError| s.joint == trace.joint && s.quantity == trace.quantity;
        before.signals.iter().find(own).map(|signal| signal.floor)
    };
    let pair = |(index, trace): (usize, &'a Trace)| {
        let alike = |other: &&Trace| same(trace, other);
        // Logs of several folders may share a name: the first goes with the first.
        let earlier = before.traces[..index].iter().filter(alike).count();
        Pair {
            before: trace,
            after: after.and_then(|after| after.traces.iter().filter(alike).nth(earlier)),
            floor: floor(trace),
            held_out: report.is_held_out(&trace.motion, earlier),
        }
    };
    before.traces.iter().enumerate().map(pair).collect()
}

impl<'a> Pair<'a> {
    fn both(&self) -> impl Iterator<Item = &'a Trace> + Clone {
        std::iter::once(self.before).chain(self.after)
    }

    /// Whether a model restarts anywhere.
    fn restarts(&self) -> bool {
        self.both().any(|trace| !trace.restarts_s.is_empty())
    }

    /// Where a model restarts, each place once, s.
    fn restarts_s(&self) -> Vec<f64> {
        let mut all: Vec<f64> = self.both().flat_map(|t| t.restarts_s.clone()).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    }

    /// The part that the motion has in the fit, behind its name.
    fn role(&self) -> &'static str {
        match self.held_out {
            Some(true) => " (held out)",
            Some(false) => " (fitted)",
            None => "",
        }
    }
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
                b { (trace.motion) } ", joint " (trace.joint) (pair.role()) " · error "
                (mrad(trace.rms))
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

/// A course with a gap wherever the model restarts: what lies between two windows was run by
/// neither.
fn broken(trace: &Trace, course: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut starts = trace.restarts_s.iter().peekable();
    let mut points = Vec::new();
    for point in course {
        if starts.next_if(|start| **start <= point.0).is_some() {
            points.push((point.0, f64::NAN));
            // A window too short to be drawn begins and ends between two points.
            while starts.next_if(|start| **start <= point.0).is_some() {}
        }
        points.push(point);
    }
    points
}

fn chart(pair: &Pair) -> Markup {
    let both = || pair.both();
    let times = both().flat_map(|trace| trace.time_s.iter().copied());
    let x = Scale::new(span(times, 0.0), (56.0, 750.0));
    let angles = both().flat_map(|t| t.measured.iter().chain(&t.predicted).copied());
    let floor_mrad = 1e3 * pair.floor.unwrap_or(0.0).abs();
    let errors = both().flat_map(|t| residual(t).map(|point| point.1));
    let errors = span(errors.chain([floor_mrad, -floor_mrad]), 0.08);
    let above = Axes {
        x,
        y: Scale::new(span(angles, 0.05), (200.0, 20.0)),
    };
    let below = Axes {
        x,
        y: Scale::new(errors, (345.0, 232.0)),
    };
    let trace = pair.before;
    let label_above = match trace.quantity {
        MeasuredSignal::Rate => "rate, rad/s",
        MeasuredSignal::Displacement => "displacement, m",
        MeasuredSignal::Angle | MeasuredSignal::Nothing => "angle, rad",
    };
    let label_below = format!("residual, {}", trace.quantity.milli());
    let starts = pair.restarts_s();
    let label = format!(
        "motion {}, joint {}{}",
        trace.motion,
        trace.joint,
        pair.role()
    );
    let predicted = |trace: &Trace, tone| {
        let course = timed(trace, &trace.predicted);
        above.curve(broken(trace, course), tone)
    };
    let left = |trace: &Trace, tone| below.curve(broken(trace, residual(trace)), tone);
    let angles_drawn = html! {
        (above.starts(starts.iter().copied()))
        g.traced {
            (predicted(trace, BEFORE))
            @if let Some(after) = pair.after { (predicted(after, AFTER)) }
            (above.curve(timed(trace, &trace.measured), MEASURED))
        }
    };
    let residuals_drawn = html! {
        (below.starts(starts.iter().copied()))
        (left(trace, BEFORE))
        @if let Some(after) = pair.after { (left(after, AFTER)) }
    };
    html! {
        svg viewBox="0 0 760 380" role="img" aria-label=(label) {
            g.columns { (above.columns(8)) (below.columns(8)) }
            (above.rows(5, label_above)) (below.rows(4, &label_below))
            g.ticks { (below.x_labels(8, "time, s")) }
            @if floor_mrad > 0.0 { (below.band(-floor_mrad, floor_mrad, FLOOR)) }
            (above.course(&angles_drawn)) (below.course(&residuals_drawn))
        }
    }
}

/// Models side by side.
fn side_by_side(report: &Report) -> Markup {
    html! {
        h3 { "All motions together" }
        p.note {
            (COMPARISON_LEGEND) ". In runs of so many seconds the model starts afresh from the \
             measurement: wrong physics grows with time, noise does not."
        }
        (page_matrix(&comparison_rows(&report.comparisons)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::sample;
    use super::*;

    fn body(report: &Report) -> String {
        section(report).unwrap().body.into_string()
    }

    /// Class and course of each line of the first chart, in the order of drawing.
    fn lines(report: &Report) -> Vec<(String, String)> {
        let body = body(report);
        let (chart, _) = body.split_once("</svg>").unwrap();
        let paths = chart.split("<path class=\"").skip(1);
        let parts = paths.map(|path| {
            let mut quoted = path.split('"');
            (quoted.next().unwrap().into(), quoted.nth(1).unwrap().into())
        });
        parts.collect()
    }

    fn with_restarts(restarts_s: &[f64]) -> Report {
        let mut report = sample::report();
        for comparison in &mut report.comparisons {
            comparison.traces[0].restarts_s = restarts_s.to_vec();
        }
        report
    }

    #[test]
    fn the_measurement_is_drawn_over_the_models() {
        let classes: Vec<String> = lines(&sample::report()).into_iter().map(|l| l.0).collect();
        let [before, after, measured] = [BEFORE, AFTER, MEASURED].map(|tone| tone.class());
        let over = [before, after, measured, before, after].map(|tone| format!("line {tone}"));
        assert_eq!(classes, over);
    }

    #[test]
    fn a_model_that_restarts_has_a_broken_line() {
        let strokes = |course: &str| course.matches('M').count();
        let drawn = lines(&with_restarts(&[2.9985, 2.9995, 6.5]));
        let counted: Vec<(&str, usize)> = drawn.iter().map(|l| (&*l.0, strokes(&l.1))).collect();
        let (marks, before, after) = (("start", 3), ("line tone-orange", 3), ("line tone-blue", 3));
        let above = [marks, before, after, ("line tone-ink", 1)];
        assert_eq!(counted, [&above[..], &[marks, before, after]].concat());

        assert!(body(&with_restarts(&[3.0])).contains("the model restarts"));
        assert!(!body(&with_restarts(&[])).contains("restarts"));
    }

    #[test]
    fn what_was_held_out_is_said_beside_the_motion() {
        let mut report = sample::report();
        let roles = |report: &Report| {
            let body = body(report);
            let titles = body.split("<summary>").skip(1);
            let titles = titles.filter_map(|title| Some(title.split_once(" · ")?.0.to_string()));
            titles.collect::<Vec<_>>()
        };
        let fitted = "<b>swing</b>, joint 1 (fitted)";
        assert_eq!(roles(&report), [fitted, "<b>sines</b>, joint 1 (held out)"]);

        // Two folders may hold logs of one name.
        let swing = |trace: &mut Trace| trace.motion = "swing".into();
        report.comparisons[0].traces.iter_mut().for_each(swing);
        report.comparisons[2].traces.iter_mut().for_each(swing);
        report.provenance.logs[1].motions = vec!["swing".into()];
        assert_eq!(roles(&report), [fitted, "<b>swing</b>, joint 1 (held out)"]);
        let drawn = pairs(&report, &report.comparisons[0]);
        let second = &report.comparisons[2].traces[1];
        assert!(
            drawn[1]
                .after
                .is_some_and(|after| std::ptr::eq(after, second))
        );

        // A mere comparison fits no motion.
        report.diagnosis = None;
        report.provenance.logs[1].held_out = false;
        assert_eq!(roles(&report), ["<b>swing</b>, joint 1"; 2]);
    }
}
