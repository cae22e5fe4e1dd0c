//! Single samples far off those before and after: damaged bytes, not motion.

use super::LoggedFile;
use super::finding::Findings;
use std::collections::VecDeque;

/// A sample is an outlier where it lies this many times farther off both neighbours than any other
/// two samples lie apart: the joint would have to be so many times as fast as ever else.
const FARTHER: f64 = 5.0;
/// Neighbours of an outlier lie this much nearer to each other than to it, as a share.
const RETURNS: f64 = 0.2;
/// Two samples that lie this near tell nothing of how fast a joint is, rad or m.
const LEAST_STEP: f64 = 2e-3;
/// Candidates remembered with their place.
const CANDIDATES: usize = 100;
/// Largest steps remembered: two belong to each candidate, and one to the motion.
const STEPS: usize = 2 * CANDIDATES + 1;

/// A sample that leaves and comes back.
#[derive(Debug)]
struct Candidate {
    off: f64,
    value: f64,
    sample: usize,
    line: usize,
}

/// Running search in one column of one file.
#[derive(Debug, Default)]
pub(super) struct Outliers {
    samples: usize,
    /// The last two samples and their lines.
    recent: VecDeque<(f64, usize)>,
    /// Farthest first.
    candidates: Vec<Candidate>,
    /// Largest first: size, and the sample in which the step ends.
    steps: Vec<(f64, usize)>,
}

impl Outliers {
    /// Begins a motion, or goes on after a gap.
    pub fn restart(&mut self) {
        self.recent.clear();
    }

    pub fn take(&mut self, value: f64, line: usize) {
        self.samples += 1;
        let sample = self.samples;
        if let Some((previous, _)) = self.recent.back() {
            let step = (value - previous).abs();
            keep(&mut self.steps, (step, sample), STEPS, |step| step.0);
        }
        if let [(before, _), (middle, line)] = self.recent.make_contiguous() {
            let (out, back) = (*middle - *before, *middle - value);
            let off = out.abs().min(back.abs());
            if out * back > 0.0 && (value - *before).abs() < RETURNS * off {
                let candidate = Candidate {
                    off,
                    value: *middle,
                    sample: sample - 1,
                    line: *line,
                };
                keep(&mut self.candidates, candidate, CANDIDATES, |c| c.off);
            }
            self.recent.pop_front();
        }
        self.recent.push_back((value, line));
    }

    /// Says which samples of a column, its name and field, are outliers; `unit` is that of the
    /// values.
    pub fn judge(
        &self,
        (column, field): (&str, usize),
        unit: &str,
        file: &LoggedFile,
        findings: &mut Findings,
    ) {
        let count = (1..=self.candidates.len()).rev().find(|count| {
            let nearest = self.candidates[count - 1].off;
            nearest > FARTHER * self.usual_step(*count)
        });
        let Some(count) = count else {
            return;
        };
        let usual = self.usual_step(count);
        let mut found: Vec<&Candidate> = self.candidates[..count].iter().collect();
        found.sort_by_key(|candidate| candidate.sample);
        for Candidate {
            off, value, line, ..
        } in found
        {
            let what = format!(
                "{column} is {value:.4} {unit} in this row alone, {off:.4} {unit} off the rows \
                 before and after; no other step exceeds {usual:.4} {unit}"
            );
            let remedy = "a damaged reading draws a fit to itself: delete the value, which leaves \
                          a gap";
            findings.warn("outlier", file.at(*line, field), (what, remedy));
        }
    }

    /// The largest step that leads neither to nor from the first `count` candidates.
    fn usual_step(&self, count: usize) -> f64 {
        let outliers = &self.candidates[..count];
        let touches = |end: usize| {
            let mut outliers = outliers.iter();
            outliers.any(|c| end == c.sample || end == c.sample + 1)
        };
        let usual = self.steps.iter().find(|(_, end)| !touches(*end));
        usual.map_or(0.0, |(step, _)| *step).max(LEAST_STEP)
    }
}

/// Puts an item into a list of the `most` largest, largest first.
fn keep<T>(list: &mut Vec<T>, item: T, most: usize, size: impl Fn(&T) -> f64) {
    let full = list.len() >= most;
    if full && list.last().is_some_and(|last| size(last) >= size(&item)) {
        return;
    }
    let at = list.partition_point(|known| size(known) >= size(&item));
    list.insert(at, item);
    list.truncate(most);
}
