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
    let mut read = |angle_rad| {
        let encoded = Encoded::still(angle_rad);
        effect("backlash").sense(&[0.1], &mut memory, encoded, 0.01)
    };
    near(read(0.0), 0.0);
    near(read(0.04), 0.0);
    near(read(0.5), 0.45);
    near(read(0.41), 0.45);
    near(read(-0.5), -0.45);
    near(read(-0.42), -0.45);
    near(read(0.5), 0.45);
}

/// A hand that speeds up at 100 rad/s^2 for 0.1 s and turns on at 10 rad/s; its grip passes on
/// 40 rad/s^2, so that the shaft has caught up after 0.25 s, 0.75 rad behind.
#[test]
fn a_grip_that_slips_loses_the_way_it_slips_and_no_more() {
    let step_s = 0.02;
    let hand = |time_s: f64| {
        let speeding_s = time_s.min(0.1);
        Encoded {
            angle_rad: 50.0 * speeding_s * speeding_s + 10.0 * (time_s - speeding_s),
            speed_rad_s: 100.0 * speeding_s,
            mean: None,
        }
    };
    let slipped_at = |values: &[f64], end_s: f64| {
        let mut memory = Some(SenseMemory {
            shaft_rad_s: Some(0.0),
            ..SenseMemory::default()
        });
        let mut read_rad = 0.0;
        for step in 1..=(end_s / step_s).round() as usize {
            let encoded = hand(step as f64 * step_s);
            read_rad = effect("grip_slip").sense(values, &mut memory, encoded, step_s);
        }
        let [slipped_rad, _] = effect("grip_slip").slipped(memory.unwrap());
        near(slipped_rad, hand(end_s).angle_rad - read_rad);
        slipped_rad
    };
    // Halfway: 0.5 * (100 - 40) * 0.1^2.
    near(slipped_at(&[40.0], 0.1), 0.3);
    for end_s in [0.3, 0.6] {
        near(slipped_at(&[40.0], end_s), 0.75);
    }
    near(slipped_at(&[101.0], 0.6), 0.0);
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
            Encoded::still(angle(step as f64 * step_s)),
            step_s,
        )
    };
    (0..=steps).map(read).last().unwrap()
}

#[test]
fn an_offset_is_of_either_sign_and_never_longer_than_its_bounds() {
    let offset_s = |value| effect("time_offset").reading_offset_s(&[value]).unwrap();
    assert_eq!([offset_s(0.02), offset_s(-0.02)], [0.02, -0.02]);
    assert_eq!([offset_s(1e300), offset_s(f64::NEG_INFINITY)], [0.1, -0.1]);
    assert!(offset_s(f64::NAN).is_nan());
    let others = EFFECTS.iter().filter(|e| e.info().id != "time_offset");
    for other in others {
        let values = off_values(*other);
        assert_eq!(other.reading_offset_s(&values), None, "{}", other.info().id);
    }
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

/// A rate that grows as the square of time: T^2 y'' = 2 T^2 where it has long been so.
#[test]
fn a_lag_of_a_rate_s_parabola_is_exact_at_any_step() {
    let exact = 0.09 - 0.06 + 0.02 * (1.0 - (-3.0_f64).exp());
    for steps in [3, 30, 300] {
        let step_s = 0.3 / f64::from(steps);
        let mut memory = None;
        let read = |step: i32| {
            let (end_s, begin_s) = (step_s * f64::from(step), step_s * f64::from(step - 1));
            let encoded = Encoded {
                mean: Some((end_s.powi(3) - begin_s.powi(3)) / (3.0 * step_s)),
                ..Encoded::still(end_s * end_s)
            };
            effect("rate_lag").sense(&[0.1], &mut memory, encoded, step_s)
        };
        near((0..=steps).map(read).last().unwrap(), exact);
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

#[test]
fn a_rate_sensor_reads_scale_times_rate_plus_bias() {
    let (scale, bias) = (effect("rate_scale"), effect("rate_bias"));
    near(scale.rate_scale(&[0.95]), 0.95);
    near(bias.rate_bias_rad_s(&[0.03]), 0.03);
    for other in EFFECTS.iter().filter(|e| e.info().site != Site::Rate) {
        let values: Vec<f64> = other
            .info()
            .parameters
            .iter()
            .map(|p| p.typical.1)
            .collect();
        assert_eq!(other.rate_scale(&values), 1.0, "{}", other.info().id);
        assert_eq!(other.rate_bias_rad_s(&values), 0.0, "{}", other.info().id);
    }
    near(scale.rate_scale(&off_values(scale)), 1.0);
    near(bias.rate_bias_rad_s(&off_values(bias)), 0.0);
}

#[test]
fn a_rate_lags_as_an_angle_does() {
    let step_s = 0.01;
    let (mut of_rate, mut of_angle) = (None, None);
    for step in 0..100 {
        let encoded = Encoded::still((0.07 * f64::from(step)).sin());
        let rate = effect("rate_lag").sense(&[0.03], &mut of_rate, encoded, step_s);
        let angle = effect("sensor_lag").sense(&[0.03], &mut of_angle, encoded, step_s);
        assert_eq!(rate, angle);
    }
    assert_eq!(effect("rate_lag").trail_rad(&[0.03], 2.0), Some(0.06));
}
