use super::*;

fn value(of: &str, value: f64, error: f64) -> OneValue {
    OneValue {
        of: of.to_string(),
        fitted: FittedValue {
            path: "coulomb@1.torque_nm".to_string(),
            key: "torque_nm".to_string(),
            unit: "N m".to_string(),
            value,
            low: value - HALF_WIDTH * error,
            high: value + HALF_WIDTH * error,
            on_bound: false,
        },
        stands_out: false,
    }
}

fn group(values: &[f64], error: f64) -> (String, Vec<OneValue>) {
    let values = values.iter().enumerate();
    let values = values.map(|(k, v)| value(&format!("log{k}"), *v, error));
    ("coulomb@1.torque_nm".to_string(), values.collect())
}

#[test]
fn the_statistic_is_cochrans() {
    // Mean 3, deviations -1, 0, 1 of standard error 0.5: Q = 8 with 2 degrees of freedom.
    let drift = homogeneity(group(&[2.0, 3.0, 4.0], 0.5), 1);
    assert!((drift.mean - 3.0).abs() < 1e-12);
    let expected = (-4.0_f64).exp();
    assert!(
        (drift.probability.unwrap() - expected).abs() < 1e-9,
        "{drift:?}"
    );
}

#[test]
fn one_worn_servo_stands_out_and_the_others_do_not() {
    let mut values = vec![0.030, 0.031, 0.029, 0.0305, 0.0298, 0.060];
    let drifts = tested(vec![group(&values, 0.001)]);
    assert!(drifts[0].differ);
    let out: Vec<bool> = drifts[0]
        .values
        .iter()
        .map(|value| value.stands_out)
        .collect();
    assert_eq!(out, [false, false, false, false, false, true]);
    // Without it all agree.
    values.pop();
    let agreeing = tested(vec![group(&values, 0.001)]);
    assert!(!agreeing[0].differ);
    assert!(agreeing[0].values.iter().all(|value| !value.stands_out));
}

/// Which of these values stand out, each with a standard error.
fn out(values: &[(f64, f64)]) -> Vec<bool> {
    let named = values
        .iter()
        .enumerate()
        .map(|(k, (v, error))| value(&format!("log{k}"), *v, *error));
    let drift = homogeneity(("coulomb@1.torque_nm".to_string(), named.collect()), 1);
    drift.values.iter().map(|value| value.stands_out).collect()
}

#[test]
fn an_outlier_does_not_make_those_that_agree_stand_out() {
    let equal = (0.03, 0.001);
    // However certain the outlier is of itself, and however much it draws the mean.
    for error in [1e-5, 1e-3, 5e-3] {
        let values = [equal, equal, equal, (0.09, error)];
        assert_eq!(out(&values), [false, false, false, true], "{error}");
    }
    let two = [equal, (0.09, 0.001), equal, (0.06, 0.001), equal];
    assert_eq!(out(&two), [false, true, false, true, false]);
}

#[test]
fn where_no_more_than_half_agree_none_stands_out() {
    let (low, high) = ((0.03, 0.001), (0.09, 0.001));
    assert_eq!(out(&[low, high]), [false; 2]);
    assert_eq!(out(&[low, low, high, high]), [false; 4]);
    assert_eq!(out(&[low]), [false]);
}

#[test]
fn more_values_ask_for_more_proof() {
    // Q = 4.5 with one degree of freedom: 3.4 %.
    let apart = || group(&[0.0, 3.0], 1.0);
    assert!(tested(vec![apart()])[0].differ);
    let same = || group(&[1.0, 1.0], 1.0);
    let among = tested(vec![apart(), same(), same()]);
    assert!(among.iter().all(|drift| !drift.differ), "{among:?}");
}

#[test]
fn joints_are_compared_by_effect_and_key() {
    let paths: Vec<ParameterPath> = [
        "coulomb@1.torque_nm",
        "coulomb@2.torque_nm",
        "link1.com_m",
        "delay@2.delay_s",
    ]
    .map(|path| path.parse().unwrap())
    .to_vec();
    let sessions: Vec<Drift> = [0.03, 0.09, 0.1, 0.01]
        .map(|v| homogeneity(group(&[v, v], 0.001), 4))
        .to_vec();
    let groups = between_joints(&paths, &sessions);
    assert_eq!(groups.len(), 1);
    assert_eq!(groups[0].0, "coulomb.torque_nm");
    let joints: Vec<&str> = groups[0].1.iter().map(|value| value.of.as_str()).collect();
    assert_eq!(joints, ["joint1", "joint2"]);
    let (first, error) = (&groups[0].1[0].fitted, 0.001 / 2.0_f64.sqrt());
    assert!((first.high - first.value - HALF_WIDTH * error).abs() < 1e-12);
    assert!(tested(groups)[0].differ);
}
