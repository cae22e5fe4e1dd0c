//! BAM's logs.

use super::*;

fn bam(change: &str, to: &str) -> Result<Vec<Motion>, Error> {
    let entries: Vec<String> = (0..12)
        .map(|i| format!(
            r#"{{"timestamp": 0.{i:02}, "position": 0.5, "speed": 1, "input_volts": 12.0, "goal_position": 0.{i}, "torque_enable": true}}"#
        ))
        .collect();
    let text = format!(
        r#"{{"mass": 0.5, "length": 0.1, "kp": 32, "entries": [{}]}}"#,
        entries.join(",")
    );
    let log = file(text.replacen(change, to, 1).as_bytes(), ".json");
    read(&[LogRequest::whole(log.path())], &columns())
}

#[test]
fn reads_bam_logs() {
    let motion = &bam("", "").unwrap()[0];
    assert_eq!(motion.len(), 12);
    assert_eq!(motion.supply_v.as_ref().unwrap()[3], 12.0);
    assert!(motion.torque_on.as_ref().unwrap()[3]);
    assert!(bam("\"speed\": 1,", "").unwrap()[0].velocity_rad_s[0].is_none());
    for (change, to, what) in [
        (
            "\"position\": 0.5",
            "\"position\": \"far\"",
            "entry 0, position: \"far\" is not a number",
        ),
        (
            "\"goal_position\": 0.3,",
            "",
            "entry 3, goal_position: nothing is not a number",
        ),
        (
            "\"timestamp\": 0.05",
            "\"timestamp\": 0.01",
            "entry 5, timestamp: time does not increase",
        ),
        (
            "\"torque_enable\": true",
            "\"torque_enable\": \"on\"",
            "entry 0, torque_enable",
        ),
        ("entries", "samples", "no list 'entries'"),
        ("{\"mass\"", "{mass", "1:2: not JSON"),
    ] {
        let error = bam(change, to).unwrap_err();
        assert!(error.to_string().contains(what), "{what}: {error}");
    }
}

#[test]
fn mass_length_and_gain_are_held_against_the_model() {
    let arm = |mass_kg, com_m| LogColumns {
        arm: Some(ArmFigures { mass_kg, com_m }),
        ..columns()
    };
    let text = |kp: u32| {
        let entry = |i: u32| {
            format!(
                "{{\"timestamp\": {}, \"position\": 0.5, \"goal_position\": 0.5}}",
                f64::from(i)
            )
        };
        let entries: Vec<String> = (0..12).map(entry).collect();
        let entries = entries.join(",");
        format!(
            "{{\"mass\": 0.5, \"length\": 0.1, \"arm_mass\": 0.04, \"kp\": {kp}, \"entries\": [{entries}]}}"
        )
    };
    let log = file(text(32).as_bytes(), ".json");
    let request = LogRequest::whole(log.path());
    let read_as = |columns: &LogColumns| read(std::slice::from_ref(&request), columns);
    assert!(read_as(&arm(0.54, 0.096)).is_ok());
    assert!(read_as(&columns()).is_ok());
    for (wrong, what) in [
        (arm(0.2, 0.1), "mass is 0.5400 kg"),
        (arm(0.54, 0.2), "mass times length"),
    ] {
        let said = read_as(&wrong).unwrap_err().to_string();
        assert!(said.contains(what), "{said}");
    }
    let other = file(text(16).as_bytes(), ".json");
    let both = [request.clone(), LogRequest::whole(other.path())];
    let said = read(&both, &columns()).unwrap_err().to_string();
    assert!(said.contains("kp is 16, and 32 in"), "{said}");
}

/// A log of BAM of these times.
fn timed(times_s: &[f64], kp: u32) -> tempfile::NamedTempFile {
    let entries: Vec<String> = (times_s.iter())
        .map(|time_s| {
            format!("{{\"timestamp\": {time_s}, \"position\": 0.5, \"goal_position\": 0.5}}")
        })
        .collect();
    let entries = entries.join(",");
    file(
        format!("{{\"kp\": {kp}, \"entries\": [{entries}]}}").as_bytes(),
        ".json",
    )
}

/// Twice twelve entries with this pause between.
fn paused(pause_s: f64) -> tempfile::NamedTempFile {
    let times: Vec<f64> = (0..24)
        .map(|i| 0.01 * f64::from(i) + if i < 12 { 0.0 } else { pause_s })
        .collect();
    timed(&times, 32)
}

#[test]
fn a_pause_parts_motions_as_in_other_logs() {
    let cut = LogColumns {
        split_at_gap_s: Some(0.5),
        ..columns()
    };
    let read_as = |pause_s, columns: &LogColumns| {
        let log = paused(pause_s);
        read(&[LogRequest::whole(log.path())], columns)
    };
    let lengths = |motions: Vec<Motion>| motions.iter().map(Motion::len).collect::<Vec<_>>();
    assert_eq!(lengths(read_as(0.4, &cut).unwrap()), [24]);
    assert_eq!(lengths(read_as(0.6, &cut).unwrap()), [12, 12]);
    let said = read_as(101.0, &columns()).unwrap_err().to_string();
    assert!(said.contains("101"), "{said}");
}

#[test]
fn a_log_of_one_joint_is_not_that_of_a_chain() {
    let mut two = columns();
    two.joints.push(two.joints[0].clone());
    let log = paused(0.0);
    let error = read(&[LogRequest::whole(log.path())], &two).unwrap_err();
    let said = error.to_string();
    assert!(
        said.contains("a log of BAM is of one joint, the model of 2"),
        "{said}"
    );
}
