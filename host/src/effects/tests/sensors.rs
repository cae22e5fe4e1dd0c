//! Laws of encoders and sensors.

use super::*;

#[test]
fn encoders_read_scale_times_angle_plus_zero() {
    near(effect("encoder_scale").encode(&[1.02], 0.5), 0.51);
    near(effect("encoder_zero").encode(&[0.02], 0.5), 0.52);
}

#[test]
fn play_trails_by_half_the_gap_after_each_reversal() {
    let mut memory = None;
    let mut read = |angle_rad| effect("backlash").sense(&[0.1], &mut memory, angle_rad, 0.01);
    near(read(0.0), 0.0);
    near(read(0.04), 0.0);
    near(read(0.5), 0.45);
    near(read(0.41), 0.45);
    near(read(-0.5), -0.45);
    near(read(-0.42), -0.45);
    near(read(0.5), 0.45);
}

/// Readings of a lag of `constant_s` over a motion sampled `rate_hz` times a second.
fn lagged(constant_s: f64, rate_hz: usize, end_s: f64, angle: impl Fn(f64) -> f64) -> f64 {
    let step_s = 1.0 / rate_hz as f64;
    let steps = (end_s * rate_hz as f64).round() as usize;
    let mut memory = None;
    let read = |step| {
        effect("sensor_lag").sense(
            &[constant_s],
            &mut memory,
            angle(step as f64 * step_s),
            step_s,
        )
    };
    (0..=steps).map(read).last().unwrap()
}

#[test]
fn a_lag_trails_a_ramp_by_its_time_constant() {
    near(
        lagged(0.05, 100, 2.0, |time_s| 3.0 * time_s),
        3.0 * (2.0 - 0.05),
    );
}

#[test]
fn a_lag_of_a_ramp_is_exact_at_any_step() {
    let exact = 0.3 - 0.1 + 0.1 * (-3.0_f64).exp();
    for rate_hz in [10, 100, 1000] {
        near(lagged(0.1, rate_hz, 0.3, |time_s| time_s), exact);
    }
}

#[test]
fn a_lag_of_a_sine_is_second_order_accurate() {
    let sine = |time_s: f64| (10.0 * time_s).sin();
    let truth = lagged(0.05, 10_000, 1.0, sine);
    let error = |rate_hz| (lagged(0.05, rate_hz, 1.0, sine) - truth).abs();
    let ratio = error(50) / error(100);
    assert!(
        (3.5..4.5).contains(&ratio),
        "half the step leaves 1/{ratio} of the error"
    );
}
