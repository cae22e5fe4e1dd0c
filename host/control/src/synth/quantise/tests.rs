use super::*;
use handstand_shared::gains::GainTable;
use handstand_shared::law::control;
use proptest::prelude::*;

fn table(law: &FixedLaw) -> GainTable<2, 6> {
    GainTable::from_bytes(&law.bytes()).unwrap()
}

proptest! {
    #[test]
    fn sixteen_bits_are_the_shared_law_bit_for_bit(
        gains in prop::collection::vec(-200.0f64..200.0, 12),
        x0 in prop::collection::vec(-2.0f64..2.0, 6),
        u0 in prop::collection::vec(-1.0f64..1.0, 2),
        range in prop::collection::vec(0.01f64..10.0, 8),
        x in prop::collection::vec(any::<i16>(), 6),
    ) {
        let k = DMatrix::from_row_slice(2, 6, &gains);
        let ranges = Ranges { state: range[..6].to_vec(), input: range[6..].to_vec() };
        let law = quantise(&k, &x0, &u0, &ranges, &Format::default()).unwrap();
        let table = table(&law);
        prop_assert!(table.is_safe());
        prop_assert_eq!(table.fingerprint(), law.fingerprint());
        let wide: Vec<i64> = x.iter().map(|x| i64::from(*x)).collect();
        let x: [i16; 6] = x.try_into().unwrap();
        let u: Vec<i64> = control(&table, &x).iter().map(|u| i64::from(*u)).collect();
        prop_assert_eq!(u, law.raw(&wide));
    }

    /// Every word length stays within the bound it states, for all states within the ranges.
    #[test]
    fn the_error_stays_within_its_bound(
        bits in 8u32..=32,
        gains in prop::collection::vec(-200.0f64..200.0, 4),
        x0 in prop::collection::vec(-2.0f64..2.0, 2),
        u0 in prop::collection::vec(-1.0f64..1.0, 2),
        range in prop::collection::vec(0.01f64..10.0, 2),
        share in prop::collection::vec(-1.0f64..1.0, 2),
    ) {
        let k = DMatrix::from_row_slice(2, 2, &gains);
        let ranges = Ranges { state: range.clone(), input: vec![1e4; 2] };
        let format = Format { bits, ..Format::default() };
        let law = quantise(&k, &x0, &u0, &ranges, &format).unwrap();
        for peak in law.peaks() {
            prop_assert!(peak < 1 << (2 * bits - 1));
        }
        let plant = crate::synth::Discrete {
            a: DMatrix::identity(2, 2),
            b: DMatrix::identity(2, 2),
            c: DMatrix::identity(2, 2),
            ts_s: 0.01,
            delayed_inputs: 0,
        };
        let exact = crate::synth::Gains {
            k: k.clone(),
            riccati: k.clone(),
            residual: 0.0,
            poles: Vec::new(),
        };
        let loss = law.loss(&plant, &exact, &x0, &u0, &range).unwrap();
        let off: Vec<f64> = (0..2).map(|j| share[j] * range[j]).collect();
        let x: Vec<f64> = (0..2).map(|j| x0[j] + off[j]).collect();
        let u = law.control(&x);
        for i in 0..2 {
            let real = u0[i] - k[(i, 0)] * off[0] - k[(i, 1)] * off[1];
            let bound = loss.gain_error[i] + loss.state_error[i] + loss.input_error[i];
            let slack = 1e-9 * (1.0 + real.abs());
            prop_assert!((u[i] - real).abs() <= bound + slack, "{} {real} {bound}", u[i]);
        }
    }
}

/// Where a shift is needed at all it costs no place of the input: a step is the finest with which
/// the input reaches its range.
#[test]
fn a_shift_costs_no_place_of_the_input() {
    for (gain, range) in [
        (300.0, 2.0),
        (80.0, 2.0),
        (5.0, 2.0),
        (700.0, 8.0),
        (40.0, 0.3),
    ] {
        for bits in [10, 12, 14, 16, 20] {
            let k = DMatrix::from_row_slice(1, 2, &[gain, gain / 9.0]);
            let ranges = Ranges {
                state: vec![0.5, 10.0],
                input: vec![range],
            };
            let format = Format {
                bits,
                ..Format::default()
            };
            let law = quantise(&k, &[0.0; 2], &[0.0], &ranges, &format).unwrap();
            let finest = power_of_two_above(range / largest_word(bits));
            let coarse = law.shift[0] == 0 || law.input_step[0] == finest;
            assert!(coarse, "{gain} {bits}: {} {finest}", law.input_step[0]);
        }
    }
}

#[test]
fn a_sensor_s_steps_are_kept_or_refused() {
    let k = DMatrix::from_row_slice(1, 2, &[30.0, 4.0]);
    let ranges = Ranges {
        state: vec![1.0, 10.0],
        input: vec![2.0],
    };
    let mut format = Format {
        state_step: Some(vec![0.005, 0.5]),
        input_step: Some(vec![0.002]),
        ..Format::default()
    };
    let law = quantise(&k, &[0.0; 2], &[0.0], &ranges, &format).unwrap();
    assert_eq!((law.input_step[0], law.limits[0]), (0.002, [-1000, 1000]));
    assert!((law.gain() - &k).amax() < 1e-3);
    format.state_step = Some(vec![1e-6, 0.5]);
    let error = quantise(&k, &[0.0; 2], &[0.0], &ranges, &format).unwrap_err();
    assert!(error.to_string().contains("1000000 steps"), "{error}");
    assert_eq!(crate::error::Error::from(error).exit_code(), 3);
    format.state_step = Some(vec![0.005, 0.5]);
    format.input_step = Some(vec![1e-4]);
    let error = quantise(&(1000.0 * &k), &[0.0; 2], &[0.0], &ranges, &format).unwrap_err();
    assert!(error.to_string().contains("overflow 16 bits"), "{error}");
    let empty = Ranges {
        state: vec![1.0, 0.0],
        input: vec![2.0],
    };
    let error = quantise(&k, &[0.0; 2], &[0.0], &empty, &Format::default()).unwrap_err();
    assert!(
        error.to_string().contains("range of state 2 is 0"),
        "{error}"
    );
}
