//! Tests of the statistics of residuals.

use super::super::residual_tests::{independence, linearity, whiteness};
use super::noise;

#[test]
fn ljung_box_passes_white_noise_and_fails_noise_with_memory() {
    let passed = |memory| {
        (0..200)
            .filter(|seed| {
                whiteness(&[noise(*seed, 500, memory), noise(seed + 999, 300, memory)]).passed
            })
            .count()
    };
    // 99 % of 200 are 198; fewer than 193 have a probability of 0.1 %.
    assert!(passed(0.0) >= 193, "{}", passed(0.0));
    assert_eq!(passed(0.4), 0);
    // chi-square, 25 degrees of freedom, 99 %: 44.314 in tables; Wilson-Hilferty is within 0.1 %.
    let threshold = whiteness(&[noise(1, 500, 0.0)]).threshold;
    assert!((threshold - 44.314).abs() < 0.05, "{threshold}");
}

#[test]
fn a_residual_that_follows_the_input_is_found_and_one_that_does_not_is_not() {
    let (mut false_alarms, mut missed) = (0, 0);
    for seed in 0..100 {
        let input = noise(seed, 600, 0.9);
        let own = noise(seed + 500, 600, 0.9);
        let follows: Vec<f64> = (0..600)
            .map(|k| own[k] + 0.8 * input[k.saturating_sub(4)])
            .collect();
        let independent = |e: Vec<f64>| {
            independence(&[e], std::slice::from_ref(&input), "input")
                .unwrap()
                .passed
        };
        false_alarms += usize::from(!independent(own));
        missed += usize::from(independent(follows));
    }
    assert!(false_alarms <= 5, "{false_alarms}");
    assert_eq!(missed, 0);
}

#[test]
fn a_residual_with_the_square_of_the_input_is_nonlinear_not_dependent() {
    let input = noise(3, 2000, 0.5);
    let own = noise(4, 2000, 0.0);
    let error: Vec<f64> = input
        .iter()
        .zip(&own)
        .map(|(u, e)| u * u + 0.3 * e)
        .collect();
    let (error, input) = ([error], [input]);
    assert!(independence(&error, &input, "input").unwrap().passed);
    assert!(!linearity(&error, &input, "input").unwrap().passed);
}

#[test]
fn no_product_reaches_across_motions() {
    // Each motion has one value at its end and one at its start: neighbours only if motions were
    // joined.
    let one = |_| vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
    let many: Vec<Vec<f64>> = (0..30).map(one).collect();
    let joined = vec![many.concat()];
    assert!(whiteness(&joined).statistic > whiteness(&many).statistic + 100.0);
}
