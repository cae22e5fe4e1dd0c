//! The recorded input as the drive sees it: held from sample to sample, late by the delay.

use std::ops::Range;

/// Mean over `[from_s, to_s]` of an input held from each sample to the next.
///
/// The mean, rather than the value, makes the result continuous in the delay, which a fit needs;
/// where a run stops at the changes of the input, the two are the same.
/// `cursor` is the index of a sample at or before `from_s` from an earlier call; it only moves
/// forward.
pub(super) fn held_mean(
    time_s: &[f64],
    input: &[f64],
    Range {
        start: from_s,
        end: to_s,
    }: Range<f64>,
    cursor: &mut usize,
) -> f64 {
    let last = time_s.len() - 1;
    while *cursor < last && time_s[*cursor + 1] <= from_s {
        *cursor += 1;
    }
    let mut k = *cursor;
    let next = |k: usize| {
        if k < last {
            time_s[k + 1]
        } else {
            f64::INFINITY
        }
    };
    if next(k) >= to_s {
        return input[k];
    }
    let (mut sum, mut at) = (0.0, from_s);
    while at < to_s {
        let until = next(k).min(to_s);
        sum += input[k] * (until - at);
        at = until;
        k = (k + 1).min(last);
    }
    sum / (to_s - from_s)
}

/// Share of a span before the first sample.
pub(super) fn share_before(time_s: &[f64], span_s: &Range<f64>) -> f64 {
    ((time_s[0] - span_s.start) / (span_s.end - span_s.start)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::{held_mean, share_before};

    #[test]
    fn a_step_inside_the_span_counts_by_its_share() {
        let (time, input) = ([0.0, 1.0, 2.0], [0.0, 10.0, 20.0]);
        let mean = |span_s| held_mean(&time, &input, span_s, &mut 0);
        assert_eq!(mean(0.0..1.0), 0.0);
        assert_eq!(mean(0.5..1.5), 5.0);
        assert_eq!(mean(1.75..3.75), 18.75);
        assert_eq!(mean(-1.0..-0.5), 0.0);
    }

    #[test]
    fn a_share_of_a_span_lies_before_the_log() {
        let share = |span_s| share_before(&[1.0, 2.0], &span_s);
        assert_eq!(share(0.0..1.0), 1.0);
        assert_eq!(share(0.75..1.25), 0.5);
        assert_eq!(share(1.0..1.5), 0.0);
    }
}
