//! Empty fields, columns whose mean counts, rates alone.

use super::*;
use crate::model::{ColumnMean, MeasuredSignal};

/// Two servos that face each other turn one joint.
fn mirrored() -> LogColumns {
    let mut columns = columns();
    let reversed = |name: &str| Column {
        reversed: true,
        ..column(name, "rad")
    };
    columns.joints[0].position = ColumnMean::of(vec![column("q1", "rad"), reversed("q2")]);
    columns.joints[0].input = ColumnMean::of(vec![column("u1", "rad"), reversed("u2")]);
    columns
}

fn twenty(row: impl Fn(usize) -> String) -> String {
    let rows: String = (0..20).map(|k| format!("0.{k:02},{}\n", row(k))).collect();
    format!("t_s,q1,q2,u1,u2,on\n{rows}")
}

#[test]
fn the_mean_of_mirrored_servos_is_the_joint_s_and_a_gap_of_one_is_a_gap() {
    let text = twenty(|k| match k {
        7 => "0.5,,0.2,-0.2,1".into(),
        9 => "NaN,-0.7,0.2,-0.2,1".into(),
        _ => "0.5,-0.7,0.2,-0.4,1".into(),
    });
    let motion = &read_text(&text, &mirrored()).unwrap()[0];
    assert_eq!(motion.len(), 20);
    for (k, angle) in motion.position_rad[0].iter().enumerate() {
        match k {
            7 | 9 => assert!(angle.is_nan()),
            _ => assert!((angle - 0.6).abs() < 1e-12, "{angle}"),
        }
    }
    let goal = motion.input[0].as_ref().unwrap();
    assert!((goal[0] - 0.3).abs() < 1e-12 && (goal[7] - 0.2).abs() < 1e-12);
    // What was read is written, gaps as empty fields.
    let again = to_csv(motion, &mirrored(), &[]);
    let again = &read_text(&again, &mirrored()).unwrap()[0];
    assert_eq!(again.position_rad[0][6], motion.position_rad[0][6]);
    assert!(again.position_rad[0][7].is_nan());
}

#[test]
fn inputs_hold_and_a_motion_begins_when_they_are_known() {
    let text = twenty(|k| match k {
        0..=4 => "0.5,-0.5,,,1".into(),
        12 => "0.5,-0.5,,,1".into(),
        _ => "0.5,-0.5,0.3,-0.3,1".into(),
    });
    let motion = &read_text(&text, &mirrored()).unwrap()[0];
    assert_eq!((motion.len(), motion.time_s[0]), (15, 0.05));
    let goal = motion.input[0].as_ref().unwrap();
    assert!(goal.iter().all(|goal| *goal == 0.3));
    assert_eq!(motion.source.lines, (7, 21));
}

#[test]
fn without_torque_a_goal_may_be_unknown() {
    let mut columns = mirrored();
    columns.torque_on = Some("on".into());
    let text = twenty(|k| match k {
        0..=4 => "0.5,-0.5,,,0".into(),
        _ => "0.5,-0.5,0.3,-0.3,1".into(),
    });
    assert_eq!(read_text(&text, &columns).unwrap()[0].len(), 20);
    let (_, _, what) = refused(
        &text.replace(",,0\n", ",,1\n").replace("0.3,-0.3", ","),
        &columns,
    );
    assert!(what.contains("u1 and u2 holds no value"), "{what}");
    let late = twenty(|k| match k {
        0..=4 => "0.5,-0.5,,,0".into(),
        5..=8 => "0.5,-0.5,,,1".into(),
        _ => "0.5,-0.5,0.3,-0.3,1".into(),
    });
    assert!(refused(&late, &columns).2.contains("u1 and u2"));
}

/// As a recording has it where the report was lost in which torque came or went.
#[test]
fn an_open_torque_flag_holds_the_one_before() {
    let mut columns = mirrored();
    columns.torque_on = Some("on".into());
    let text = twenty(|k| match k {
        0..=1 | 8 | 15 => "0.5,-0.5,0.3,-0.3,".into(),
        2..=7 => "0.5,-0.5,0.3,-0.3,0".into(),
        _ => "0.5,-0.5,0.3,-0.3,1".into(),
    });
    let motion = &read_text(&text, &columns).unwrap()[0];
    // What comes before the first one is left out.
    assert_eq!((motion.len(), motion.time_s[0]), (18, 0.02));
    let on: Vec<bool> = (2..20).map(|k| k > 8).collect();
    assert_eq!(motion.torque_on.as_ref(), Some(&on));
    let none = twenty(|_| "0.5,-0.5,0.3,-0.3,".into());
    assert!(refused(&none, &columns).2.contains("on holds no value"));
}

#[test]
fn a_supply_read_now_and_then_holds() {
    let mut columns = columns();
    columns.supply = Some(column("on", "V"));
    columns.joints[0].position = Some(column("q1", "rad").into());
    columns.joints[0].input = Some(column("u1", "rad").into());
    let text = twenty(|k| match k {
        3 => "0.5,,0.2,,11.5".into(),
        12 => "0.5,,0.2,,11.0".into(),
        _ => "0.5,,0.2,,".into(),
    });
    let motion = &read_text(&text, &columns).unwrap()[0];
    let supply = motion.supply_v.as_ref().unwrap();
    assert_eq!((supply[0], supply[11], supply[19]), (11.5, 11.5, 11.0));
}

#[test]
fn a_rate_stands_where_there_is_no_angle() {
    let mut columns = columns();
    columns.joints[0].position = None;
    columns.joints[0].velocity = Some(column("q1", "deg/s").into());
    columns.joints[0].input = Some(column("u1", "rad").into());
    let signal = columns.joints[0].signal();
    assert_eq!(signal, MeasuredSignal::Rate);
    assert!(columns.unobserved()[0].contains("Joint 1 has no measured angle"));
    let motion = &read_text(&twenty(|_| "180,,0.2,,".into()), &columns).unwrap()[0];
    assert!(motion.position_rad[0].iter().all(|angle| angle.is_nan()));
    let rate = motion.measured(0, signal);
    assert!((rate[3] - std::f64::consts::PI).abs() < 1e-12);
    let (_, _, what) = refused(&twenty(|_| ",,0.2,,".into()), &columns);
    assert!(what.contains("q1 holds no value"), "{what}");
}

#[test]
fn a_gyro_stands_beside_the_angle_and_is_written_again() {
    let mut columns = columns();
    columns.joints[0].position = Some(column("q1", "rad").into());
    columns.joints[0].rate = Some(column("q2", "deg/s").into());
    columns.joints[0].input = Some(column("u1", "rad").into());
    let text = twenty(|k| match k {
        7 => "0.5,,0.2,,".into(),
        _ => format!("0.5,{},0.2,,", 9 * k),
    });
    let motion = &read_text(&text, &columns).unwrap()[0];
    let rate = motion.rate(0).unwrap();
    assert!(rate[7].is_nan() && (rate[3] - 27_f64.to_radians()).abs() < 1e-12);
    assert_eq!(motion.measured(0, columns.joints[0].signal())[3], 0.5);
    let again = &read_text(&to_csv(motion, &columns, &[]), &columns).unwrap()[0];
    let same = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-12 || a.is_nan() && b.is_nan();
    assert!(rate.iter().zip(again.rate(0).unwrap()).all(same));
    let late = Column {
        shift_s: 0.01,
        ..column("q2", "deg/s")
    };
    columns.joints[0].rate = Some(late.into());
    let moved = &read_text(&text, &columns).unwrap()[0];
    assert!((moved.rate(0).unwrap()[0] - rate[0]).abs() < 1e-12);
    assert_eq!(moved.time_s[0], motion.time_s[1]);
    let (_, _, what) = refused(&twenty(|_| "0.5,,0.2,,".into()), &columns);
    assert!(what.contains("q2 holds no value"), "{what}");
}
