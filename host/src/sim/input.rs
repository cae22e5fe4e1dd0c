//! The recorded input as the drive sees it: held from sample to sample, late by the delay.

/// Mean over `[from_s, to_s]` of an input held from each sample to the next.
///
/// The mean, rather than the value, makes the result continuous in the delay, which a fit needs;
/// where a run stops at the changes of the input, the two are the same.
/// `cursor` is the index of a sample at or before `from_s` from an earlier call; it only moves
/// forward.
pub(super) fn held_mean(
    time_s: &[f64],
    input: &[f64],
    from_s: f64,
    to_s: f64,
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

#[cfg(test)]
mod tests {
    use super::held_mean;

    #[test]
    fn a_step_inside_the_span_counts_by_its_share() {
        let (time, input) = ([0.0, 1.0, 2.0], [0.0, 10.0, 20.0]);
        assert_eq!(held_mean(&time, &input, 0.0, 1.0, &mut 0), 0.0);
        assert_eq!(held_mean(&time, &input, 0.5, 1.5, &mut 0), 5.0);
        assert_eq!(held_mean(&time, &input, 1.75, 3.75, &mut 0), 18.75);
        assert_eq!(held_mean(&time, &input, -1.0, -0.5, &mut 0), 0.0);
    }
}
