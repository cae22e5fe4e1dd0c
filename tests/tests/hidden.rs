//! A sample of `cargo xtask hidden`: the claims hold on a few benches, and threads change nothing.

use handstand::diagnose::Verdict;
use handstand_tests::hidden::{Case, try_all, try_case};

#[test]
fn hidden_effects_are_named_and_none_is_invented() {
    let kinds = ["viscous", "dead_zone", "torque_saturation", "com_angle"];
    let hidden = kinds.map(|kind| Case {
        kind: Some(kind),
        seed: 1,
        left_out: false,
    });
    let nominal = [1, 2].map(|seed| Case {
        kind: None,
        seed,
        left_out: false,
    });
    let cases = [&hidden[..], &nominal[..]].concat();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let outcomes = try_all(&cases, threads, threads, &|_| {}).unwrap();
    for outcome in outcomes {
        if outcome.hidden.is_none() {
            assert_eq!(outcome.verdict, Verdict::Nominal, "{outcome:?}");
            continue;
        }
        assert!(outcome.is_right(), "{outcome:?}");
        assert!(outcome.ratio() <= 1.3, "{outcome:?}");
        assert!(outcome.values.iter().all(|v| v.covered), "{outcome:?}");
    }
}

#[test]
fn the_outcome_is_the_same_on_any_number_of_threads() {
    let case = Case {
        kind: Some("viscous"),
        seed: 2,
        left_out: false,
    };
    let [one, two] = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        serde_json::to_string(&pool.install(|| try_case(&case)).unwrap()).unwrap()
    });
    assert_eq!(one, two);
}
