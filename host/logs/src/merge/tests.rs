use super::*;

/// A chirp from `from_s` on, on a clock of its own.
fn log(from_s: f64, step_s: f64, rows: usize, clock_s: f64, name: &str, scale: f64) -> RawLog {
    let time = |k: usize| from_s + k as f64 * step_s;
    let chirp = |t: f64| (2.0 * t + 0.15 * t * t).sin() + 0.3 * (5.0 * t).sin();
    RawLog {
        names: vec!["time_s".into(), name.into(), "still".into()],
        columns: vec![
            (0..rows).map(|k| time(k) + clock_s).collect(),
            (0..rows).map(|k| scale * chirp(time(k))).collect(),
            vec![1.0; rows],
        ],
        iso: vec![false; 3],
        words: vec![None; 3],
        ..RawLog::default()
    }
}

#[test]
fn the_offset_of_two_clocks_is_found_to_a_fraction_of_a_step() {
    let first = log(0.0, 0.01, 2000, 0.0, "q", 1.0);
    // Begins 3.1 s later, samples at another rate, counts the other way round, in degrees.
    let second = log(3.1, 0.013, 1000, 1000.0, "angle", -57.3);
    let merged = merge(&first, &second, &MergePlan::default()).unwrap();
    assert!(
        (merged.offset_s + 1000.0).abs() < 1e-3,
        "{}",
        merged.offset_s
    );
    let alignment = merged.alignment.unwrap();
    assert_eq!(
        (alignment.first.as_str(), alignment.second.as_str()),
        ("q", "angle")
    );
    assert!(alignment.correlation < -0.99);
    assert_eq!(
        merged.log.names,
        ["time_s", "q", "still", "angle", "still_2"]
    );
    for (k, q) in merged.log.columns[1].iter().enumerate() {
        let angle = merged.log.columns[3][k];
        let overlaps = (3.11..16.0).contains(&merged.log.columns[0][k]);
        assert!(
            !overlaps || (angle + 57.3 * q).abs() < 0.5,
            "{k}: {angle} {q}"
        );
    }
}

#[test]
fn a_given_offset_is_believed_and_gaps_stay_gaps() {
    let first = log(0.0, 0.01, 200, 0.0, "q", 1.0);
    let mut second = log(0.0, 0.01, 200, 5.0, "w", 2.0);
    for value in &mut second.columns[1][50..100] {
        *value = f64::NAN;
    }
    let plan = MergePlan {
        offset_s: Some(-5.0),
        ..MergePlan::default()
    };
    let merged = merge(&first, &second, &plan).unwrap();
    assert!(merged.log.columns[3][70].is_nan());
    assert!((merged.log.columns[3][20] - 2.0 * merged.log.columns[1][20]).abs() < 1e-9);
    let far = MergePlan {
        offset_s: Some(100.0),
        ..MergePlan::default()
    };
    assert!(merge(&first, &second, &far).is_err());
}

#[test]
fn what_cannot_be_aligned_is_refused() {
    let sine = |phase: f64| {
        let mut log = log(0.0, 0.01, 3000, 0.0, "q", 1.0);
        log.columns[1] = (0..3000)
            .map(|k| (0.06 * f64::from(k) + phase).sin())
            .collect();
        log
    };
    let repeats = merge(&sine(0.0), &sine(1.0), &MergePlan::default()).unwrap_err();
    assert!(
        repeats.to_string().contains("repeat themselves"),
        "{repeats}"
    );
    let chirp = log(0.0, 0.01, 2000, 0.0, "q", 1.0);
    let mut noise = chirp.clone();
    let mut state = 1_u64;
    for value in &mut noise.columns[1] {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        *value = (state >> 40) as f64;
    }
    let other = merge(&chirp, &noise, &MergePlan::default()).unwrap_err();
    assert!(other.to_string().contains("agrees"), "{other}");
    // Of two columns of one name, neither counts the other way round.
    let mut turned = chirp.clone();
    turned.columns[1].iter_mut().for_each(|q| *q = -*q);
    let other = merge(&chirp, &turned, &MergePlan::default()).unwrap_err();
    assert!(
        other.to_string().contains("90.0 % are the least"),
        "{other}"
    );
    let align = Some(("q".to_string(), "missing".to_string()));
    let plan = MergePlan {
        align,
        offset_s: None,
    };
    assert!(
        merge(&chirp, &chirp, &plan)
            .unwrap_err()
            .to_string()
            .contains("missing")
    );
}
